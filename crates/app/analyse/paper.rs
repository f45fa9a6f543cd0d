//! As the paper did it: Tables 3 to 6, goodness of fit, and what deleting a group of variables costs.

use experiment::analysis::json::PAPERS_CYCLE;
use experiment::analysis::newton::cycles;
use experiment::analysis::noticed::Noticed;
use experiment::analysis::regression::Regression;
use experiment::analysis::study::Analysis;
use experiment::analysis::subjects::{LEVELS, PARAMETERS};
use experiment::analysis::tails;

use super::report::{Block, Table, digits, p};

/// Terms beyond this probability are left out of the summary (Table 5).
const SIGNIFICANT: f64 = 0.05;

/// This part of the report.
pub fn blocks(analysis: &Analysis) -> Vec<Block> {
    let mut blocks = vec![Block::Heading("As the paper did it".to_owned())];
    blocks.extend(sickness(analysis));
    blocks.extend(analysis.noticed.as_ref().map(noticed));
    blocks.push(Block::Figure("answers"));
    blocks.extend(summary(&analysis.regression));
    blocks.push(estimates(&analysis.regression));
    blocks.extend(footnotes(&analysis.regression));
    blocks.push(Block::Figure("coefficients"));
    blocks.push(deletions(&analysis.regression));
    blocks
}

fn sickness(analysis: &Analysis) -> Option<Block> {
    let counts = analysis.sickness();
    let all: usize = counts.iter().sum();
    if all == 0 {
        return None;
    }
    let levels: Vec<String> = (1..=7).map(|level| level.to_string()).collect();
    let mut header = vec!["level"];
    header.extend(levels.iter().map(String::as_str));
    header.push("subjects");
    let mut table = Table::new("Table 3. Reported sickness level", &header);
    let mut row = vec!["%".to_owned()];
    row.extend(
        counts
            .iter()
            .map(|&count| format!("{:.0}", 100.0 * count as f64 / all as f64)),
    );
    row.push(all.to_string());
    table.rows.push(row);
    Some(Block::Table(table))
}

fn noticed(noticed: &Noticed) -> Block {
    let caption = if noticed.is_papers {
        "Table 4. Response to parameter changes: the PAPER's counts, because this table has no column \"noticed\""
    } else {
        "Table 4. Response to parameter changes: numbers of subjects"
    };
    let mut header = vec![""];
    header.extend(noticed.rows.iter().map(|(i, _)| PARAMETERS[*i]));
    let mut table = Table::new(caption, &header);
    for (column, name) in ["no change observed", "change observed"]
        .into_iter()
        .enumerate()
    {
        let counts = noticed.rows.iter().map(|(_, row)| row[column].to_string());
        table
            .rows
            .push(std::iter::once(name.to_owned()).chain(counts).collect());
    }
    Block::Table(table)
}

/// Table 5: the fitted predictor for each changed parameter, with what is significant.
fn summary(regression: &Regression) -> Vec<Block> {
    let names = regression.design.names(&regression.fit.aliases.kept);
    if !names.iter().any(|name| name.starts_with("change")) {
        return Vec::new();
    }
    let mut table = Table::new(
        "Table 5. Summary of the logistic regression model",
        &["parameter changed", "fitted linear predictor"],
    );
    for (i, parameter) in PARAMETERS.iter().enumerate() {
        let mut predictor = "Const.".to_owned();
        // Sickness first and the physics after it, as in the paper.
        let is_level = |k: &usize| variable_in(&names[*k], i).is_some_and(|v| LEVELS.contains(&v));
        let mut order: Vec<usize> = (0..names.len()).collect();
        order.sort_by_key(is_level);
        for k in order {
            let (estimate, error) = (regression.fit.estimate[k], regression.fit.error[k]);
            let Some(variable) = variable_in(&names[k], i) else {
                continue;
            };
            // An infinite estimate has no Wald test; it is in.
            if estimate.is_infinite() {
                predictor += &format!(" {} Inf*{variable}", if estimate < 0.0 { '-' } else { '+' });
            } else if tails::normal_both(estimate / error) < SIGNIFICANT {
                let sign = if estimate < 0.0 { '-' } else { '+' };
                predictor += &format!(" {sign} {:.1}*{variable}", estimate.abs());
            }
        }
        table.rows.push(vec![(*parameter).to_owned(), predictor]);
    }
    let fit = &regression.fit;
    let mut blocks = vec![Block::Table(table)];
    if fit.df() > 0 {
        blocks.push(Block::Text(format!(
            "chi-squared = {:.3}, d.f. = {}; tabulated chi-squared = {:.3} for P = 0.10; P of a larger one = {}{}.",
            fit.deviance,
            fit.df(),
            tails::chi_squared_beyond(0.10, fit.df()),
            p(tails::chi_squared(fit.deviance, fit.df())),
            if fit.is_valid() { "" } else { " (an infimum: some estimates are infinite)" },
        )));
    }
    blocks
}

/// The variable of a column in the predictor of those whose parameter `i` changed; experience and the indicators are
/// hidden in the constant, as in the paper.
fn variable_in(name: &str, i: usize) -> Option<&str> {
    if name == "vr" || name == "constant" {
        return None;
    }
    if let Some(rest) = name.strip_prefix("change") {
        return rest.strip_prefix(&format!("{}_", i + 1));
    }
    // The parameter that changes has no level of its own.
    (name != LEVELS[i]).then_some(name)
}

/// A column's name as the paper writes it.
pub fn papers_name(name: &str) -> String {
    if name == "vr" {
        return "vrbefore(2)".to_owned();
    }
    let Some(rest) = name.strip_prefix("change") else {
        return name.to_owned();
    };
    match rest.split_once('_') {
        Some((number, variable)) => format!("change({number}).{variable}"),
        None => format!("change({rest})"),
    }
}

fn estimates(regression: &Regression) -> Block {
    let fit = &regression.fit;
    let early = cycles(&fit.rows, PAPERS_CYCLE);
    let early = early.last().filter(|_| fit.is_valid());
    let cycle = format!("S.E. of cycle {PAPERS_CYCLE}");
    let header = [
        "parameter",
        "estimate",
        "S.E.",
        &cycle,
        "z",
        "P",
        "profile 95 %",
    ];
    let mut table = Table::new(
        "Table 6. Parameter estimates and standard errors (maximum likelihood)",
        &header,
    );
    for (k, name) in regression
        .design
        .names(&fit.aliases.kept)
        .iter()
        .enumerate()
    {
        let (estimate, error) = (fit.estimate[k], fit.error[k]);
        let shown = if estimate.is_nan() {
            "+-Inf".to_owned()
        } else {
            digits(estimate)
        };
        let z = estimate / error;
        let wald = (error.is_finite() && estimate.is_finite()).then(|| tails::normal_both(z));
        let interval = regression.intervals[k];
        table.rows.push(vec![
            papers_name(name),
            shown,
            digits(error),
            early.map_or("-".to_owned(), |early| digits(early.errors[k])),
            if wald.is_some() {
                digits(z)
            } else {
                "-".to_owned()
            },
            p(wald),
            super::report::interval(interval.low, interval.high),
        ]);
    }
    Block::Table(table)
}

fn footnotes(regression: &Regression) -> Vec<Block> {
    let mut blocks = Vec::new();
    if regression.fit.is_valid() {
        blocks.push(Block::Text(format!(
            "S.E. are converged. Printed ones may be of an early cycle of the iterations, as the paper's are: beside them those of \
             cycle {PAPERS_CYCLE} from R's start, taken from the weights that the cycle began with."
        )));
    } else {
        blocks.push(Block::Text(
            "Some estimates are infinite (see Separation): their standard errors, z and P mean nothing and are not given."
                .to_owned(),
        ));
    }
    if regression
        .design
        .columns
        .iter()
        .any(|column| column.name == "vr")
    {
        blocks.push(Block::Text(
            "vrbefore(2) is 1 for those who had experience of virtual reality before, as section 4 of the paper says; its Appendix B says the opposite."
                .to_owned(),
        ));
    }
    blocks
}

fn deletions(regression: &Regression) -> Block {
    let header = [
        "deleted",
        "d.f.",
        "change in deviance",
        "of d.f.",
        "P (chi-squared)",
        "F (quasi)",
        "P (F)",
    ];
    let mut table = Table::new(
        "Deleting each group of variables: the paper's test, and the quasi-binomial one",
        &header,
    );
    for deletion in &regression.deletions {
        let mark = if deletion.is_separated { " *" } else { "" };
        table.rows.push(vec![
            format!("{}{mark}", deletion.group),
            deletion.df.to_string(),
            format!("{:.3}", deletion.change),
            deletion.change_df.to_string(),
            p(deletion.p),
            deletion
                .quasi
                .map_or("-".to_owned(), |(value, _)| digits(value)),
            p(deletion.quasi.map(|(_, p)| p)),
        ]);
    }
    if regression
        .deletions
        .iter()
        .any(|deletion| deletion.is_separated)
    {
        table.caption += "; * separated without it";
    }
    Block::Table(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_the_papers() {
        let pairs = [
            ("change2_E", "change(2).E"),
            ("change1", "change(1)"),
            ("vr", "vrbefore(2)"),
            ("sick", "sick"),
        ];
        for (name, papers) in pairs {
            assert_eq!(papers_name(name), papers);
        }
        // Elasticity changes: F counts, S only through its own column, E not at all.
        assert_eq!(variable_in("F", 0), Some("F"));
        assert_eq!(variable_in("F", 1), None);
        assert_eq!(
            (variable_in("change1_S", 0), variable_in("change2_S", 0)),
            (Some("S"), None)
        );
        assert_eq!(
            (variable_in("vr", 0), variable_in("change1", 0)),
            (None, None)
        );
    }
}
