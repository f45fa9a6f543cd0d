//! What was answered: `participants.tsv` and `phenotype/presence.tsv`.

use serde_json::{Value, json};

use super::{Column, Table};
use crate::protocol::AnsweredIn;
use crate::questionnaire::{Answer, Item, Kind, Presence, Questionnaire, Stage};
use crate::record::{SessionRecord, Status};

/// A row for each participant; the answers of the first session.
pub(super) fn participants(questionnaire: &Questionnaire, records: &[SessionRecord]) -> Table {
    let items = questionnaire.asked_at(Stage::Before, false);
    let mut columns = vec![
        Column::new(
            "participant_id",
            "random label; nobody's name is known to the program",
        ),
        Column::new(
            "slot",
            "row of the allocation, which is kept outside this dataset; conditions are joined after unblinding",
        ),
    ];
    columns.extend(items.iter().map(|item| column(&item.id, item)));
    columns.push(Column::new("status", "of the last session").with_levels([
        (Status::Complete.name(), "both games and all forms"),
        (Status::Partial.name(), "stopped early"),
    ]));
    let mut table = Table::new(columns);
    for (index, record) in records.iter().enumerate() {
        if index > 0 && records[index - 1].participant == record.participant {
            continue;
        }
        let last = records
            .iter()
            .rfind(|other| other.participant == record.participant);
        let mut row = vec![record.participant.to_string(), record.slot.to_string()];
        row.extend(
            items
                .iter()
                .map(|item| cell(record.answer(Stage::Before, &item.id))),
        );
        row.push(last.unwrap_or(record).status.name().to_owned());
        table.push(row);
    }
    table
}

/// Which answers become columns: those of the last form, and those that were asked between or after the games.
fn asked(questionnaire: &Questionnaire, each_game: bool) -> Vec<(Stage, &Item, String)> {
    let mut asked = Vec::new();
    for stage in [Stage::AfterGame(1), Stage::AfterGame(2), Stage::After] {
        for item in questionnaire.asked_at(stage, each_game) {
            let name = match stage {
                Stage::AfterGame(game) if item.each_game => format!("{}_game{game}", item.id),
                _ => item.id.clone(),
            };
            asked.push((stage, item, name));
        }
    }
    asked
}

/// A row for each session: what was asked between and after the games, and the paper's count.
pub(super) fn presence(
    questionnaire: &Questionnaire,
    each_game: bool,
    records: &[SessionRecord],
) -> Table {
    let asked = asked(questionnaire, each_game);
    let scored: &[(Stage, &str)] = if each_game {
        &[
            (Stage::AfterGame(1), "_game1"),
            (Stage::AfterGame(2), "_game2"),
        ]
    } else {
        &[(Stage::After, "")]
    };
    let mut columns = vec![
        Column::new("participant_id", "as in participants.tsv"),
        Column::new("session_id", "session"),
    ];
    columns.extend(asked.iter().map(|(_, item, name)| column(name, item)));
    let high = questionnaire.high_from;
    for (_, suffix) in scored {
        columns.push(Column::new(
            format!("presence_count{suffix}"),
            format!(
                "number of answers from {high} up among the presence_n{suffix} answered items {}",
                questionnaire.score_items.join(", ")
            ),
        ));
        columns.push(Column::new(
            format!("presence_n{suffix}"),
            "number of these items that were answered: the binomial n",
        ));
    }
    columns.push(
        Column::new("answered_in", "where the last form was filled in").with_levels([
            ("headset", "on a panel in the virtual room"),
            ("desktop", "at the desk"),
            ("script", "by a simulated participant"),
        ]),
    );
    let mut table = Table::new(columns);
    for record in records {
        let mut row = vec![
            record.participant.to_string(),
            format!("ses-{:02}", record.session),
        ];
        row.extend(
            asked
                .iter()
                .map(|(stage, item, _)| cell(record.answer(*stage, &item.id))),
        );
        for (stage, _) in scored {
            let counted = record
                .form(*stage)
                .map(|form| form.answers.presence(questionnaire));
            let Presence { count, answered } = counted.unwrap_or(Presence {
                count: 0,
                answered: 0,
            });
            row.push(if answered > 0 {
                count.to_string()
            } else {
                String::new()
            });
            row.push(answered.to_string());
        }
        let last = record.form(Stage::After).or(record.forms.last());
        row.push(last.map_or(String::new(), |form| place(form.answered_in).to_owned()));
        table.push(row);
    }
    table
}

/// The dictionary of `presence.tsv`.
pub(super) fn presence_dictionary(questionnaire: &Questionnaire, table: &Table) -> Value {
    let mut dictionary = table.dictionary();
    dictionary.insert(
        "MeasurementToolMetadata".to_owned(),
        json!({
            "Description": format!(
                "questionnaire {} (language {}), {} presence items after Appendix A of Uno and Slater (1997)",
                questionnaire.version, questionnaire.language, questionnaire.score_items.len()
            ),
        }),
    );
    Value::Object(dictionary)
}

fn column(name: &str, item: &Item) -> Column {
    let column = Column::new(name, &item.text);
    match &item.kind {
        Kind::Scale { low, high } => column.with_levels([
            ("1", low.as_str()),
            ("2", ""),
            ("3", ""),
            ("4", ""),
            ("5", ""),
            ("6", ""),
            ("7", high),
        ]),
        Kind::YesNo => column.with_levels([("yes", "yes"), ("no", "no")]),
        Kind::Choice {
            options, several, ..
        } => {
            let levels = options
                .iter()
                .map(|option| (option.id.as_str(), option.text.as_str()));
            let mut column = column.with_levels(levels);
            if *several {
                column.about["Description"] =
                    format!("{} Several are separated by semicolons.", item.text).into();
            }
            column
        }
        Kind::Text => Column::new(
            name,
            format!(
                "{} Free text: it may identify a person, so read it before sharing.",
                item.text
            ),
        ),
    }
}

fn cell(answer: Option<&Answer>) -> String {
    answer.map_or_else(String::new, Answer::cell)
}

fn place(answered_in: AnsweredIn) -> &'static str {
    match answered_in {
        AnsweredIn::Headset => "headset",
        AnsweredIn::Desk => "desktop",
        AnsweredIn::Script => "script",
    }
}
