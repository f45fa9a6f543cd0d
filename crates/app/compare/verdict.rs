//! Whether a throw explains Table 4 of the paper: who noticed which change, against how far the balls' paths part.

use super::condition::{Factor, Table1, name_of};
use super::course::Course;
use super::divergence::Divergence;
use super::thrown::Thrown;

/// Two conditions of Table 1 that differ in one factor: an edge of the cube, a row of Table 2.
#[derive(Clone, Debug)]
pub struct Edge {
    /// Which factor changes, from 0.
    pub factor: usize,
    /// Names of the conditions, level 0 of the factor first.
    pub names: [String; 2],
    /// How the two courses part.
    pub divergence: Divergence,
    /// When the ball met the first pin under each [s].
    pub hits: [Option<f64>; 2],
    /// Pins that fell under each.
    pub pins: [usize; 2],
}

impl Edge {
    /// How much sooner one of the balls met the pins [s]; never, if only one did.
    pub fn between_hits(&self) -> f64 {
        match self.hits {
            [Some(a), Some(b)] => (a - b).abs(),
            [None, None] => 0.0,
            _ => f64::INFINITY,
        }
    }
}

/// The twelve edges, factor by factor. The courses are those of [`Table1::cells`].
pub fn edges(thrown: &Thrown, courses: &[Course]) -> Vec<Edge> {
    let cells: Vec<[usize; 3]> = Table1::cells().collect();
    let mut edges = Vec::new();
    for factor in 0..3 {
        let lows = cells
            .iter()
            .enumerate()
            .filter(|(_, levels)| levels[factor] == 0);
        for (low, levels) in lows {
            let mut other = *levels;
            other[factor] = 1;
            let Some(high) = cells.iter().position(|cell| *cell == other) else {
                continue;
            };
            let both = [&courses[low], &courses[high]];
            edges.push(Edge {
                factor,
                names: [name_of(*levels), name_of(other)],
                divergence: Divergence::of(thrown, both[0], both[1]),
                hits: both.map(|course| course.first_hit.map(|hit| hit.time)),
                pins: both.map(|course| course.fallen.len()),
            });
        }
    }
    edges
}

/// How visible one factor is in a throw.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Visibility {
    /// Pairs whose balls part for the eye, of how many.
    seen: (usize, usize),
    /// Median time until they do, the lower one; infinite where most never do [s].
    seen_after: f64,
    /// Median time between the two balls' first hits [s].
    between_hits: f64,
}

impl Visibility {
    fn of(edges: &[&Edge]) -> Self {
        let times = edges
            .iter()
            .map(|edge| edge.divergence.seen.unwrap_or(f64::INFINITY));
        let times: Vec<f64> = times.collect();
        let seen = times.iter().filter(|time| time.is_finite()).count();
        let [seen_after, _] = middle(times);
        let [low, high] = middle(edges.iter().map(|edge| edge.between_hits()).collect());
        Self {
            seen: (seen, edges.len()),
            seen_after,
            between_hits: 0.5 * (low + high),
        }
    }
}

/// The values on both sides of the middle; the same one twice where their number is odd.
///
/// Half of the pairs may never part: the lower one then says when the others do, as a mean with infinity would not.
fn middle(mut values: Vec<f64>) -> [f64; 2] {
    values.sort_by(f64::total_cmp);
    [values[(values.len() - 1) / 2], values[values.len() / 2]]
}

/// Something that a participant may have gone by.
struct Sign {
    words: &'static str,
    /// Whether the first is more visible than the second.
    exceeds: fn(&Visibility, &Visibility) -> bool,
    /// Whether there is anything to see.
    shows: fn(&Visibility) -> bool,
}

/// Two balls that meet the pins within a frame of a headset are not told apart [s].
const FRAME: f64 = 1.0 / 90.0;

const SIGNS: [Sign; 2] = [
    Sign {
        words: "By the ball's path (5 degrees for the eye)",
        exceeds: |a, b| {
            a.seen.0 > b.seen.0 || (a.seen.0 == b.seen.0 && a.seen_after < b.seen_after)
        },
        shows: |a| a.seen.0 > 0,
    },
    Sign {
        words: "By when the ball meets the pins",
        exceeds: |a, b| a.between_hits > b.between_hits + FRAME,
        shows: |a| a.between_hits > FRAME,
    },
];

/// What the edges say about Table 4: a line for each factor, then a sentence for each sign.
pub fn verdict(table: &Table1, edges: &[Edge]) -> String {
    let mut text = format!(
        "{:<11}{:>11}{:>26}{:>12}{:>28}\n",
        "changed",
        "noticed by",
        "5 degrees apart in pairs",
        "median [s]",
        "between the first hits [s]"
    );
    let mut visible = Vec::new();
    for (index, factor) in table.factors.iter().enumerate() {
        let own: Vec<&Edge> = edges.iter().filter(|edge| edge.factor == index).collect();
        let visibility = Visibility::of(&own);
        let or_never = |time: f64| match time.is_finite() {
            true => format!("{time:.2}"),
            false => "n/a".to_owned(),
        };
        text += &format!(
            "{:<11}{:>11}{:>26}{:>12}{:>28}\n",
            factor.name,
            format!("{} of {}", factor.noticed, factor.subjects),
            format!("{} of {}", visibility.seen.0, visibility.seen.1),
            or_never(visibility.seen_after),
            or_never(visibility.between_hits),
        );
        visible.push((factor, visibility));
    }
    for sign in &SIGNS {
        text += &(sentence(sign, &visible) + "\n");
    }
    text
}

/// Of two factors the more noticed one must be the more visible one; equally noticed ones may lie anyhow.
fn sentence(sign: &Sign, visible: &[(&Factor, Visibility)]) -> String {
    let words = sign.words;
    let noticed = |factor: &Factor| f64::from(factor.noticed) / f64::from(factor.subjects);
    let mut wrong = Vec::new();
    for (a, seen_a) in visible {
        for (b, seen_b) in visible {
            if noticed(a) > noticed(b) && !(sign.exceeds)(seen_a, seen_b) {
                wrong.push(format!("{} shows no more than {}", a.name, b.name));
            }
        }
    }
    if !wrong.is_empty() {
        return format!(
            "{words}, this throw contradicts Table 4: {}.",
            wrong.join(", ")
        );
    }
    let shows = |(factor, seen): &&(&Factor, Visibility)| factor.noticed == 0 && (sign.shows)(seen);
    let unnoticed: Vec<&str> = visible
        .iter()
        .filter(shows)
        .map(|(factor, _)| factor.name.as_str())
        .collect();
    if unnoticed.is_empty() {
        return format!(
            "{words}, this throw explains Table 4: the more subjects noticed a change, the more it shows, and what nobody \
             noticed does not show."
        );
    }
    format!(
        "{words}, this throw explains the order of Table 4, but not that nobody noticed {}, which shows too.",
        unnoticed.join(" and ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table1 {
        toml::from_str(include_str!("../../../config/table1.toml")).expect("the shipped table")
    }

    /// Edges that part for the eye at the given times, four for each factor, and meet the pins so far apart.
    fn edges(times: [[Option<f64>; 4]; 3], between: [f64; 3]) -> Vec<Edge> {
        let edge = |factor: usize, seen: Option<f64>| Edge {
            factor,
            names: [String::new(), String::new()],
            divergence: Divergence {
                apart: seen,
                seen,
                most_deg: 0.0,
                most_at: 0.0,
            },
            hits: [Some(3.0), Some(3.0 - between[factor])],
            pins: [0; 2],
        };
        let all = times.iter().enumerate();
        all.flat_map(|(factor, times)| times.map(|seen| edge(factor, seen)))
            .collect()
    }

    /// The sentences of a verdict.
    fn sentences(times: [[Option<f64>; 4]; 3], between: [f64; 3]) -> [String; 2] {
        let text = verdict(&table(), &edges(times, between));
        let lines: Vec<String> = text.lines().skip(4).map(str::to_owned).collect();
        lines.try_into().expect("a sentence for each sign")
    }

    const NEVER: [Option<f64>; 4] = [None; 4];
    const HALF: [Option<f64>; 4] = [Some(3.0), None, Some(4.0), None];

    #[test]
    fn verdict_explains_what_shows_as_it_was_noticed() {
        let [path, hits] = sentences([HALF, [Some(0.5); 4], NEVER], [0.1, 0.8, 0.001]);
        assert!(path.contains("explains Table 4"), "{path}");
        assert!(hits.contains("explains Table 4"), "{hits}");
    }

    #[test]
    fn verdict_contradicts_when_shape_parts_sooner_than_friction() {
        let [path, hits] = sentences([NEVER, [Some(2.0); 4], [Some(1.0); 4]], [0.5, 0.1, 0.0]);
        let wrong = "elasticity shows no more than shape, friction shows no more than shape";
        assert!(
            path.contains("contradicts") && path.contains(wrong),
            "{path}"
        );
        assert!(
            hits.contains("friction shows no more than elasticity"),
            "{hits}"
        );
    }

    #[test]
    fn verdict_says_when_the_unnoticed_shows_too() {
        let late = [Some(6.0), None, None, None];
        let [path, hits] = sentences([[Some(3.0); 4], [Some(0.5); 4], late], [0.2, 0.8, 0.1]);
        assert!(path.contains("not that nobody noticed shape"), "{path}");
        assert!(hits.contains("not that nobody noticed shape"), "{hits}");
    }

    #[test]
    fn verdict_tells_pairs_and_medians() {
        let text = verdict(
            &table(),
            &edges([HALF, [Some(0.5); 4], NEVER], [0.1, 0.8, 0.0]),
        );
        let row = |name: &str| {
            let line = text.lines().find(|line| line.starts_with(name));
            line.expect("every factor has a line")
                .split_whitespace()
                .collect::<Vec<_>>()
                .join(" ")
        };
        assert_eq!(row("elasticity"), "elasticity 3 of 6 2 of 4 4.00 0.10");
        assert_eq!(row("shape"), "shape 0 of 6 0 of 4 n/a 0.00");
    }
}
