//! Pairs of throws, in a study of differences: `beh/*_task-pairs_beh.tsv`, and `phenotype/thresholds.tsv` with what they came to.

use super::{Column, Table, number, optional};
use crate::protocol::AnsweredIn;
use crate::record::{Pairs, SessionRecord};
use crate::staircase::{Reply, StaircasePlan};

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
            number(trial.first),
            number(trial.second),
            number((trial.first - trial.second).abs()),
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
            number(plan.standard),
            pairs.compared.len().to_string(),
            optional(estimate, |estimate| number(estimate.threshold)),
            optional(estimate, |estimate| number(estimate.interval[0])),
            optional(estimate, |estimate| number(estimate.interval[1])),
            optional(estimate, |estimate| estimate.catches.to_string()),
            optional(estimate, |estimate| estimate.false_alarms.to_string()),
        ]);
    }
    table
}
