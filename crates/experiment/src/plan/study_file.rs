//! `plan/study.toml`: everything that a study was decided to be before its first participant.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::scheme::{CellEntry, FactorEntry, design_of, entries_of};
use super::{
    Design, Row, Scheme, SchemeError, TableError, allocate, allocation_csv, parse_allocation,
};
use crate::consent::is_date;
use crate::digest;
use crate::questionnaire::line_of;
use crate::staircase::{StaircaseError, StaircasePlan};

/// Version of the file's meaning.
pub const SCHEMA: u32 = 1;
/// Most participants that a plan is made for.
const MOST_SUBJECTS: u32 = 100_000;

/// A study's plan, without its allocation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// [`SCHEMA`] of the program that made it.
    pub schema: u32,
    /// Seed of the allocation.
    pub seed: u64,
    /// Name of the scheme.
    pub scheme: String,
    /// Participants.
    pub subjects: u32,
    /// SHA-256 of `plan/allocation.csv`, 64 hexadecimal digits.
    pub design_sha256: String,
    /// Who does the study, and until when data are kept.
    pub about: About,
    /// What happens in a session.
    pub session: SessionRules,
    /// Trials of a just-noticeable difference, in a study that has them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub staircase: Option<StaircasePlan>,
    factor: Vec<FactorEntry>,
    cell: Vec<CellEntry>,
}

/// Who does the study, and until when data are kept: what the consent form's fields are filled with.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct About {
    /// The study's name in `dataset_description.json`; the participant does not read it.
    pub title: String,
    /// Who is responsible; empty until somebody is.
    pub laboratory: String,
    /// Where a participant turns to; empty until that is known.
    pub contact: String,
    /// Last day on which a participant's data can be erased on request, `YYYY-MM-DD`.
    pub withdrawal_until: String,
    /// Last day on which data that can be tied to a person are kept, `YYYY-MM-DD`.
    pub retention_until: String,
}

impl About {
    /// What is due on `today`, `YYYY-MM-DD`, as a sentence: the day until which data are kept has passed.
    pub fn reminder(&self, today: &str) -> Option<String> {
        // Days in this form are in order as texts are.
        (today > self.retention_until.as_str()).then(|| {
            format!(
                "data that can be tied to a person were to be kept until {}: erase the participants, or make the data anonymous",
                self.retention_until
            )
        })
    }
}

/// What happens in a session.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SessionRules {
    /// Bowling frames of a game, 1 to 10.
    pub frames_per_game: u32,
    /// Throws before game one that do not count.
    pub training_throws: u32,
    /// Training throws are in the condition of game one, so that nobody meets a third; otherwise in that of the lobby.
    pub training_in_first_condition: bool,
    /// Items with `each_game` are asked after each game.
    pub items_after_each_game: bool,
    /// A press of the button that is not due starts its game instead of being refused.
    pub undue_presses_allowed: bool,
    /// Answer to a question about sickness, 1 to 7, from which on ending the session is advised.
    pub sickness_stop: u8,
    /// What helps a participant besides the training throws; a plan that does not say has nothing of it.
    #[serde(default)]
    pub guidance: Guidance,
}

/// What helps a newcomer. All of it is off unless a plan has it: it tells how to play, and of a release what only the eye is to tell.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Guidance {
    /// What the hand could take, or holds, glows.
    pub glow: bool,
    /// Hints in the room until the first throw is over.
    pub hints: bool,
    /// How a ball was let go, on the scoreboard.
    pub feedback: bool,
    /// One gesture measures height and reach, and places what must be reached.
    pub calibration: bool,
}

impl Guidance {
    /// The settings of the program that it stands for, with their values.
    pub fn settings(self) -> [(&'static str, bool); 4] {
        [
            ("guidance.glow", self.glow),
            ("guidance.hints", self.hints),
            ("guidance.feedback", self.feedback),
            ("calibration.gesture", self.calibration),
        ]
    }
}

impl Default for SessionRules {
    /// A whole game of ten frames, three throws before it, and a stop from 5 on.
    fn default() -> Self {
        SessionRules {
            frames_per_game: 10,
            training_throws: 3,
            training_in_first_condition: true,
            items_after_each_game: false,
            undue_presses_allowed: false,
            sickness_stop: 5,
            guidance: Guidance::default(),
        }
    }
}

/// Why there is no plan.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    /// The design cannot be used.
    #[error(transparent)]
    Scheme(#[from] SchemeError),
    /// The allocation is not as it was written.
    #[error(transparent)]
    Allocation(#[from] TableError),
    /// The staircase cannot be run.
    #[error("the plan cannot be used: {0}")]
    Staircase(#[from] StaircaseError),
    /// A value is out of range.
    #[error("the plan cannot be used: {0}")]
    Content(String),
    /// The file is not TOML of the right form.
    #[error("{path} is no plan: line {line}: {message}; restore it from a backup")]
    Syntax {
        /// Which file.
        path: String,
        /// Line, from 1.
        line: usize,
        /// What the reader of TOML says.
        message: String,
    },
    /// Another version of the program made it.
    #[error("{path} is of schema {found}, and this program reads {SCHEMA}: {}", age(*found))]
    Schema {
        /// Which file.
        path: String,
        /// Its schema.
        found: u32,
    },
}

fn age(found: u32) -> &'static str {
    if found > SCHEMA {
        "the study was made by a newer program, use that one"
    } else {
        "no program is known that wrote such a study, so nothing is guessed from it"
    }
}

impl Plan {
    /// A plan and its allocation.
    ///
    /// # Errors
    /// When the scheme or a value cannot be used.
    pub fn new(
        scheme: &Scheme,
        subjects: u32,
        seed: u64,
        about: About,
        session: SessionRules,
    ) -> Result<(Plan, Vec<Row>), PlanError> {
        let staircase = match scheme {
            Scheme::Staircase(plan) => Some(plan.clone()),
            _ => None,
        };
        // Before its ends become a design.
        staircase.as_ref().map_or(Ok(()), StaircasePlan::check)?;
        let design = scheme.design()?;
        if !(1..=MOST_SUBJECTS).contains(&subjects) {
            return Err(PlanError::Content(format!(
                "{subjects} participants: there have to be 1 to {MOST_SUBJECTS}"
            )));
        }
        let rows = allocate(&design, subjects, seed);
        let (factor, cell) = entries_of(&design);
        let plan = Plan {
            schema: SCHEMA,
            seed,
            scheme: scheme.name().to_owned(),
            subjects,
            design_sha256: digest::sha256(allocation_csv(&design, &rows).as_bytes()),
            about,
            session,
            staircase,
            factor,
            cell,
        };
        plan.check()?;
        Ok((plan, rows))
    }

    /// The factors and cells.
    pub fn design(&self) -> Design {
        design_of(self.factor.clone(), self.cell.clone())
            .expect("checked when the plan was made or read")
    }

    /// The file's text.
    pub fn to_toml(&self) -> String {
        let body = toml::to_string(self).expect("numbers, words and tables have a form in TOML");
        format!(
            "# The plan of a study, made once; docs/study.md explains it. The program refuses it when a byte is changed.\n\n{body}"
        )
    }

    /// Reads the text of `path`, which is for messages.
    ///
    /// # Errors
    /// When it is not a plan of this schema.
    pub fn parse(text: &str, path: &Path) -> Result<Plan, PlanError> {
        #[derive(Deserialize)]
        struct Version {
            schema: u32,
        }
        let syntax = |error: toml::de::Error| PlanError::Syntax {
            path: path.display().to_string(),
            line: line_of(text, error.span()),
            message: error.message().trim().replace('\n', " "),
        };
        // The version first: what else a file of another version has is not known.
        let version: Version = toml::from_str(text).map_err(syntax)?;
        if version.schema != SCHEMA {
            let path = path.display().to_string();
            return Err(PlanError::Schema {
                path,
                found: version.schema,
            });
        }
        let plan: Plan = toml::from_str(text).map_err(syntax)?;
        plan.check()?;
        Ok(plan)
    }

    /// Reads the allocation that belongs to this plan.
    ///
    /// # Errors
    /// When it is not the one that the plan was made with.
    pub fn parse_allocation(&self, text: &str) -> Result<Vec<Row>, PlanError> {
        let rows = parse_allocation(&self.design(), text)?;
        if digest::sha256(text.as_bytes()) == self.design_sha256
            && rows.len() == self.subjects as usize
        {
            return Ok(rows);
        }
        Err(PlanError::Content(
            "the allocation is not the one that the plan was made with: restore it from a backup"
                .to_owned(),
        ))
    }

    fn check(&self) -> Result<(), PlanError> {
        let wrong = |what: String| Err(PlanError::Content(what));
        design_of(self.factor.clone(), self.cell.clone()).map_err(PlanError::Content)?;
        if self.seed > i64::MAX as u64 {
            return wrong(format!(
                "the seed {} is above {}, the largest number of a TOML file",
                self.seed,
                i64::MAX
            ));
        }
        let session = &self.session;
        if !(1..=10).contains(&session.frames_per_game) {
            return wrong(format!(
                "frames_per_game is {}, and has to be 1 to 10",
                session.frames_per_game
            ));
        }
        if session.training_throws > 100 {
            return wrong(format!(
                "training_throws is {}, and has to be at most 100",
                session.training_throws
            ));
        }
        if !(1..=7).contains(&session.sickness_stop) {
            return wrong(format!(
                "sickness_stop is {}, and has to be 1 to 7",
                session.sickness_stop
            ));
        }
        let about = &self.about;
        for date in [&about.withdrawal_until, &about.retention_until] {
            if !is_date(date) {
                return wrong(format!("{date:?} is no date: it has to be YYYY-MM-DD"));
            }
        }
        // Days in this form are in order as texts are.
        if about.withdrawal_until > about.retention_until {
            return wrong(format!(
                "data can be erased until {} and are kept until {}: nobody can erase what is not kept any more",
                about.withdrawal_until, about.retention_until
            ));
        }
        if about.title.trim().is_empty() || about.title.chars().any(char::is_control) {
            return wrong("the title is empty or has a line break".to_owned());
        }
        if let Some(staircase) = &self.staircase {
            staircase.check()?;
        }
        Ok(())
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) fn about() -> About {
        About {
            title: "A study".to_owned(),
            laboratory: "A laboratory".to_owned(),
            contact: "its door".to_owned(),
            withdrawal_until: "2027-06-30".to_owned(),
            retention_until: "2036-12-31".to_owned(),
        }
    }

    fn plan(
        subjects: u32,
        seed: u64,
        about: About,
        session: SessionRules,
    ) -> Result<(Plan, Vec<Row>), PlanError> {
        Plan::new(&Scheme::Table2, subjects, seed, about, session)
    }

    #[test]
    fn plan_is_read_back_as_it_was() {
        let (made, rows) = plan(18, 1997, about(), SessionRules::default()).unwrap();
        let read = Plan::parse(&made.to_toml(), Path::new("study.toml")).unwrap();
        assert_eq!(read, made);
        let csv = allocation_csv(&read.design(), &rows);
        assert_eq!(read.parse_allocation(&csv).unwrap(), rows);
        let (_, others) = plan(18, 1998, about(), SessionRules::default()).unwrap();
        let other = allocation_csv(&read.design(), &others);
        let error = read.parse_allocation(&other).unwrap_err().to_string();
        assert!(
            error.contains("not the one that the plan was made with"),
            "{error}"
        );
    }

    #[test]
    fn data_that_are_not_kept_cannot_be_erased_later() {
        let about = About {
            withdrawal_until: "2037-01-01".to_owned(),
            ..about()
        };
        let error = plan(18, 1997, about, SessionRules::default()).unwrap_err();
        let error = error.to_string();
        assert!(error.contains("until 2037-01-01 and are kept"), "{error}");
    }

    #[test]
    fn reminder_comes_the_day_after() {
        assert_eq!(about().reminder("2036-12-31"), None);
        let reminder = about().reminder("2037-01-01").unwrap();
        assert!(reminder.contains("until 2036-12-31"), "{reminder}");
    }

    #[test]
    fn plan_keeps_its_staircase() {
        let staircase = StaircasePlan {
            key: "objects.friction_rate".to_owned(),
            standard: 0.0,
            furthest: 1.0,
            rule: crate::staircase::Rule::Bayesian,
            trials: 60,
            catch_share: 0.2,
        };
        let broken = StaircasePlan {
            trials: 0,
            ..staircase.clone()
        };
        let make = |staircase| {
            let rules = SessionRules::default();
            Plan::new(&Scheme::Staircase(staircase), 18, 1997, about(), rules)
        };
        assert!(make(broken).is_err());
        let (made, rows) = make(staircase).unwrap();
        assert_eq!(rows.len(), 18);
        assert_eq!(made.scheme, "staircase");
        let text = made.to_toml();
        assert!(text.contains("rule = \"bayesian\""), "{text}");
        assert_eq!(Plan::parse(&text, Path::new("study.toml")).unwrap(), made);
        let error = Plan::parse(
            &text.replace("catch_share = 0.2", "catch_share = 2.0"),
            Path::new("study.toml"),
        );
        assert!(
            error
                .unwrap_err()
                .to_string()
                .contains("staircase.catch_share is 2")
        );
    }

    #[test]
    fn a_plan_that_says_nothing_of_guidance_has_none() {
        let (made, _) = plan(18, 1997, about(), SessionRules::default()).unwrap();
        let text = made.to_toml();
        let section = "[session.guidance]\nglow = false\nhints = false\nfeedback = false\ncalibration = false\n";
        assert!(text.contains(section), "{text}");
        let parse = |text: &str| Plan::parse(text, Path::new("study.toml"));
        assert_eq!(parse(&text.replace(section, "")).unwrap(), made);
        let asked = parse(&text.replace("hints = false", "hints = true")).unwrap();
        assert_eq!(
            asked.session.guidance.settings().map(|(_, is_on)| is_on),
            [false, true, false, false]
        );
        let error = parse(&text.replace("hints = false", "hint = true")).unwrap_err();
        assert!(
            error.to_string().contains("unknown field `hint`"),
            "{error}"
        );
    }

    #[test]
    fn parse_refuses_other_versions_and_broken_files() {
        let (made, _) = plan(18, 1997, about(), SessionRules::default()).unwrap();
        let text = made.to_toml();
        let cases = [
            (
                "schema = 1",
                "schema = 2\nnews = 1",
                "made by a newer program",
            ),
            ("schema = 1", "schema = 0", "no program is known"),
            ("schema = 1", "", "missing field `schema`"),
            (
                "frames_per_game = 10",
                "frames_per_game = 11",
                "frames_per_game is 11",
            ),
            ("frames_per_game = 10", "frames_per_game = ten", "line 17: "),
            ("2027-06-30", "2027-06-31", "is no date"),
            ("seed = 1997", "sead = 1997", "unknown field `sead`"),
        ];
        for (from, to, expected) in cases {
            assert!(text.contains(from), "{from} in {text}");
            let error = Plan::parse(&text.replacen(from, to, 1), Path::new("study.toml"))
                .unwrap_err()
                .to_string();
            assert!(
                error.contains(expected) && error.lines().count() == 1,
                "{error}"
            );
        }
    }

    #[test]
    fn new_refuses_what_cannot_be_run() {
        let fails = |made: Result<(Plan, Vec<Row>), PlanError>| made.unwrap_err().to_string();
        let rules = SessionRules::default;
        assert!(fails(plan(0, 1, about(), rules())).contains("0 participants"));
        assert!(fails(plan(18, u64::MAX, about(), rules())).contains("the seed"));
        let sick = SessionRules {
            sickness_stop: 8,
            ..rules()
        };
        assert!(fails(plan(18, 1, about(), sick)).contains("sickness_stop is 8"));
        let nameless = About {
            title: " ".to_owned(),
            ..about()
        };
        assert!(fails(plan(18, 1, nameless, rules())).contains("the title"));
        assert!(plan(1, 1, about(), rules()).is_ok());
    }
}
