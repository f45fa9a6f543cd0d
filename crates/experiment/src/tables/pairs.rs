//! Pairs of throws, in a study of differences: `beh/*_task-pairs_beh.tsv`, and `phenotype/thresholds.tsv` with what they came to.

use super::{Column, Table, number, optional};
use crate::protocol::AnsweredIn;
use crate::record::{Pairs, SessionRecord};
use crate::staircase::{Reply, StaircasePlan};

/// A value of the parameter, or a difference: six decimals, and more where the whole range is less than a tenth.
fn value(value: f64, plan: &StaircasePlan) -> String {
    let size = libm::log10(plan.range());
    let more = (-libm::floor(size) - 1.0).clamp(0.0, 300.0) as usize;
    format!("{value:.*}", 6 + more)
}

/// A row for each pair.
pub(super) fn compared(pairs: &Pairs, plan: &StaircasePlan) -> Table {
    let mut table = Table::new(vec![
        Column::new("pair", "number of the pair"),
        Column::new("first", format!("{} in the first throw", plan.key)),
        Column::new("second", format!("{} in the second throw", plan.key)),
        Column::new(
            "difference",
            "between the two, in the parameter's unit; 0 in a catch trial",
        ),
        Column::new("reply", "what was said").with_levels([
            ("same", "the two throws felt alike"),
            ("different", "they did not"),
        ]),
        Column::new("at", "when, since the session began").with_units("s"),
        Column::new("answered_in", "where").with_levels([
            ("headset", "on the panel in the room"),
            ("desktop", "in a window or a terminal"),
            ("script", "by a simulated participant"),
        ]),
    ]);
    for compared in &pairs.compared {
        let trial = &compared.trial;
        table.push(vec![
            trial.number.to_string(),
            value(trial.first, plan),
            value(trial.second, plan),
            value((trial.first - trial.second).abs(), plan),
            match compared.reply {
                Reply::Same => "same",
                Reply::Different => "different",
            }
            .to_owned(),
            number(compared.at_s),
            match compared.answered_in {
                AnsweredIn::Headset => "headset",
                AnsweredIn::Desk => "desktop",
                AnsweredIn::Script => "script",
            }
            .to_owned(),
        ]);
    }
    table
}

/// A row for each session.
pub(super) fn thresholds(records: &[SessionRecord], plan: &StaircasePlan) -> Table {
    let mut table = Table::new(vec![
        Column::new("participant_id", "random label"),
        Column::new("session_id", "session"),
        Column::new("parameter", "key of the configuration that differed"),
        Column::new("standard", "its value in one throw of every pair"),
        Column::new("pairs", "pairs of throws that were compared"),
        Column::new(
            "threshold",
            "the difference that is called different 70.7 % of the time, in the parameter's unit; n/a when the pairs do not tell",
        ),
        Column::new("low", "lower end of its nominal 95 % interval"),
        Column::new("high", "upper end of it"),
        Column::new("catches", "pairs without a difference"),
        Column::new("false_alarms", "those of them that were called different"),
    ]);
    for record in records {
        let Some(pairs) = &record.pairs else { continue };
        let estimate = pairs.estimate.as_ref();
        table.push(vec![
            record.participant.to_string(),
            format!("ses-{:02}", record.session),
            plan.key.clone(),
            value(plan.standard, plan),
            pairs.compared.len().to_string(),
            optional(estimate, |estimate| value(estimate.threshold, plan)),
            optional(estimate, |estimate| value(estimate.interval[0], plan)),
            optional(estimate, |estimate| value(estimate.interval[1], plan)),
            optional(estimate, |estimate| estimate.catches.to_string()),
            optional(estimate, |estimate| estimate.false_alarms.to_string()),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::staircase::Rule;

    #[test]
    fn value_tells_the_differences_of_a_small_range() {
        let plan = |standard: f64, furthest: f64| StaircasePlan {
            key: "objects.elasticity".to_owned(),
            standard,
            furthest,
            rule: Rule::Bayesian,
            trials: 1,
            catch_share: 0.0,
        };
        assert_eq!(value(0.4, &plan(1.0, 0.4)), "0.400000");
        assert_eq!(value(40.0, &plan(0.0, 400.0)), "40.000000");
        // A hundredth of the range, the smallest difference that is tried.
        assert_eq!(value(2e-6, &plan(0.0, 2e-4)), "0.000002000");
    }
}
