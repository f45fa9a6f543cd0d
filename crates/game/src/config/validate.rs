//! The one place that says which settings are possible: ranges as tables, then the relations between keys.

mod alley;
mod session;
mod things;

use super::Config;
use super::wording::number;

/// A key whose value is impossible.
#[derive(Debug)]
pub(super) struct Invalid {
    /// The key, with its table.
    pub key: String,
    /// Other keys that the value is measured by: any of them may be the one to correct.
    pub related: Vec<&'static str>,
    /// What is wrong and what to do.
    pub problem: String,
}

/// A key of a table, its value, and the smallest and the largest possible one.
type Range<'a> = (&'a str, f64, f64, f64);

/// Every value of `table` lies in its range; NaN and infinity never do.
fn ranges(table: &str, ranges: &[Range<'_>]) -> Result<(), Invalid> {
    ranges
        .iter()
        .try_for_each(|(key, value, low, high)| limited(table, (key, *value, *low, *high), &[]))
}

/// A value lies in its range, whose limits follow from the keys in `by`.
fn limited(
    table: &str,
    (key, value, low, high): Range<'_>,
    by: &[&'static str],
) -> Result<(), Invalid> {
    let (shown, low_shown, high_shown) = (number(value), number(low), number(high));
    let why = if by.is_empty() {
        String::new()
    } else {
        format!(", which follows from {}", by.join(" and "))
    };
    let problem =
        format!("{shown} is out of range; give a number from {low_shown} to {high_shown}{why}");
    relation(table, key, by, (low..=high).contains(&value), &problem)
}

/// `holds`, a relation of a key to those in `by`.
fn relation(
    table: &str,
    key: &str,
    by: &[&'static str],
    holds: bool,
    problem: &str,
) -> Result<(), Invalid> {
    if holds {
        return Ok(());
    }
    Err(Invalid {
        key: format!("{table}.{key}"),
        related: by.to_vec(),
        problem: problem.to_owned(),
    })
}

/// Checks every value, and the relations between them.
pub(super) fn validate(config: &Config) -> Result<(), Invalid> {
    session::physics(config)?;
    alley::building(config)?;
    alley::room(config)?;
    alley::furniture(config)?;
    things::balls(config)?;
    things::pin(&config.pin)?;
    things::hand(config)?;
    session::rules(config)?;
    session::pinsetter(config)?;
    session::display(config)?;
    session::participant(config)?;
    session::sound(&config.sound)?;
    session::guidance(&config.guidance)?;
    session::comfort(config)?;
    session::practice(&config.practice)
}
