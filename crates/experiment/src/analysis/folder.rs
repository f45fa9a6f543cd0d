//! A study's folder as one plain table: who, what changed, what was answered.
//!
//! | file | columns that are used |
//! |---|---|
//! | `data/participants.tsv` | `participant_id`, `slot`, `vr_before` |
//! | `data/phenotype/presence.tsv` | `participant_id`, `q1` to `q6` or `presence_count_game1` and so on, `sick`, `noticed`, `noticed_what` |
//! | `plan/allocation.csv` | `slot`, `block`, `efs`, `changed`, `order` |

use std::path::Path;

use super::table::{Table, TableError};

/// The columns of `presence.tsv` that are taken over where they are.
const ANSWERS: [&str; 11] = [
    "q1",
    "q2",
    "q3",
    "q4",
    "q5",
    "q6",
    "presence_count",
    "presence_n",
    "sick",
    "noticed",
    "noticed_what",
];
/// The columns of the allocation that are taken over.
const ALLOCATION: [&str; 4] = ["block", "efs", "changed", "order"];
/// Columns of a study that asks after each game, and their names here: in the order of the games.
const EACH_GAME: [&str; 4] = [
    "presence_count_game1",
    "presence_n_game1",
    "presence_count_game2",
    "presence_n_game2",
];

/// Reads a study, or a plain table where `path` is a file.
///
/// # Errors
/// When a file of the study is missing, a participant has no slot of the allocation, or two sessions.
pub fn read(path: &Path) -> Result<Table, TableError> {
    if !path.is_dir() {
        return Table::read(path);
    }
    let participants = Table::read(&path.join("data/participants.tsv"))?;
    let presence = Table::read(&path.join("data/phenotype/presence.tsv"))?;
    let allocation = Table::read(&path.join("plan/allocation.csv"))?;
    join(
        &path.display().to_string(),
        &participants,
        &presence,
        &allocation,
    )
}

fn join(
    name: &str,
    participants: &Table,
    presence: &Table,
    allocation: &Table,
) -> Result<Table, TableError> {
    let id = participants.needed(&["participant_id"], "names the participants")?;
    let slot = participants.needed(&["slot"], "joins participants and allocation")?;
    let vr = participants.column(&["vr_before", "vr"]);
    let answered_by = presence.needed(&["participant_id"], "names the participants")?;
    let allocated = allocation.needed(&["slot"], "joins participants and allocation")?;
    let each_game: Vec<usize> = EACH_GAME
        .iter()
        .filter_map(|name| presence.column(&[name]))
        .collect();
    let is_each_game = each_game.len() == EACH_GAME.len();
    let mut table = Table {
        name: name.to_owned(),
        ..Table::default()
    };
    let answers: Vec<(&str, usize)> = ANSWERS
        .iter()
        .filter_map(|name| Some((*name, presence.column(&[name])?)))
        .collect();
    let mut header = vec!["id", "vr"];
    header.extend(ALLOCATION);
    header.extend(answers.iter().map(|(name, _)| *name));
    if is_each_game {
        header.extend(["y_low", "n_low", "y_high", "n_high", "y", "n"]);
    }
    table.header = header.into_iter().map(str::to_owned).collect();
    for row in 0..participants.rows.len() {
        let who = &participants.rows[row][id];
        let place = (0..allocation.rows.len())
            .find(|&place| allocation.rows[place][allocated] == participants.rows[row][slot]);
        let Some(place) = place else {
            return Err(participants.refuse(row, slot, "a slot of plan/allocation.csv"));
        };
        let mut sessions =
            (0..presence.rows.len()).filter(|&session| &presence.rows[session][answered_by] == who);
        let session = sessions.next();
        if let Some(second) = sessions.next() {
            let problem = format!(
                "{who} has answered in two sessions; leave the one out that does not count"
            );
            return Err(presence.contradiction(second, problem));
        }
        let from = |table: &Table, row: Option<usize>, column: Option<usize>| {
            row.zip(column)
                .and_then(|(row, column)| table.cell(row, column))
                .unwrap_or("")
                .to_owned()
        };
        let mut cells = vec![who.clone(), from(participants, Some(row), vr)];
        cells.extend(
            ALLOCATION
                .iter()
                .map(|name| from(allocation, Some(place), allocation.column(&[name]))),
        );
        cells.extend(
            answers
                .iter()
                .map(|(_, column)| from(presence, session, Some(*column))),
        );
        if is_each_game {
            let counts: Vec<String> = each_game
                .iter()
                .map(|&column| from(presence, session, Some(column)))
                .collect();
            let is_low_first =
                from(allocation, Some(place), allocation.column(&["order"])) == "0-first";
            cells.extend(by_level(&counts, is_low_first));
        }
        table.rows.push(cells);
        table.lines.push(participants.lines[row]);
    }
    Ok(table)
}

/// Counts of the game at the low level, of the one at the high level, and of both, from those of the first and second.
fn by_level(counts: &[String], is_low_first: bool) -> Vec<String> {
    let [y1, n1, y2, n2] = counts else {
        return vec![String::new(); 6];
    };
    // A game in which nothing was answered has a blank count out of 0.
    let number = |text: &str| text.parse::<u32>().unwrap_or(0);
    let both = |a: &str, b: &str| (number(a) + number(b)).to_string();
    let (low, high) = if is_low_first {
        ((y1, n1), (y2, n2))
    } else {
        ((y2, n2), (y1, n1))
    };
    let cell = |text: &String| text.clone();
    vec![
        cell(low.0),
        cell(low.1),
        cell(high.0),
        cell(high.1),
        both(y1, y2),
        both(n1, n2),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tables(presence: &str) -> Result<Table, TableError> {
        let participants = Table::parse(
            "participants.tsv",
            "participant_id\tslot\tvr_before\nsub-b\t2\tno\nsub-a\t1\tyes\n",
        );
        let allocation =
            "slot,block,efs,changed,order\n1,1,010,shape,0-first\n2,1,001,friction,1-first\n";
        let allocation = Table::parse("allocation.csv", allocation);
        join(
            "study",
            &participants?,
            &Table::parse("presence.tsv", presence)?,
            &allocation?,
        )
    }

    #[test]
    fn join_puts_answers_and_places_to_participants() {
        let table = tables("participant_id\tsick\tq1\tnoticed\nsub-a\t2\t7\tyes\n").unwrap();
        assert_eq!(
            table.header,
            [
                "id", "vr", "block", "efs", "changed", "order", "q1", "sick", "noticed"
            ]
        );
        assert_eq!(
            table.rows[0],
            ["sub-b", "no", "1", "001", "friction", "1-first", "", "", ""]
        );
        assert_eq!(
            table.rows[1],
            [
                "sub-a", "yes", "1", "010", "shape", "0-first", "7", "2", "yes"
            ]
        );
    }

    #[test]
    fn join_tells_the_games_by_their_level() {
        let head = "participant_id\tpresence_count_game1\tpresence_n_game1\tpresence_count_game2\tpresence_n_game2\n";
        let table = tables(&format!("{head}sub-a\t1\t6\t4\t5\nsub-b\t1\t6\t4\t5\n")).unwrap();
        let first = table.column(&["y_low"]).unwrap();
        assert_eq!(table.rows[0][first..], ["4", "5", "1", "6", "5", "11"]);
        assert_eq!(table.rows[1][first..], ["1", "6", "4", "5", "5", "11"]);
    }

    #[test]
    fn join_refuses_two_sessions_and_unknown_slots() {
        let problem = tables("participant_id\tq1\nsub-a\t2\nsub-a\t3\n")
            .unwrap_err()
            .to_string();
        assert!(
            problem.contains("presence.tsv, line 3: sub-a has answered in two sessions"),
            "{problem}"
        );
        let participants =
            Table::parse("participants.tsv", "participant_id\tslot\nsub-a\t9\n").unwrap();
        let allocation = Table::parse("allocation.csv", "slot,efs\n1,000\n").unwrap();
        let presence = Table::parse("presence.tsv", "participant_id\tq1\nsub-a\t2\n").unwrap();
        let problem = join("study", &participants, &presence, &allocation)
            .unwrap_err()
            .to_string();
        assert!(problem.contains("line 2, column slot: \"9\""), "{problem}");
    }
}
