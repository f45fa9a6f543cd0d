//! Writes a small study with made-up sessions, for trying readers of its tables: `study_folder DIR`.

use std::path::Path;

use experiment::consent::{ConsentForm, Ticks};
use experiment::participant::{Model, Simulated};
use experiment::plan::{About, Button, Plan, Row, Scheme, SessionRules};
use experiment::protocol::AnsweredIn;
use experiment::questionnaire::{Form, Stage};
use experiment::random::SplitMix64;
use experiment::record::{
    EventRow, FilledForm, HeadResponse, MotionRow, Provenance, Run, SessionRecord, Status, Task,
    TrialType,
};
use experiment::study::{Lock, Study};
use experiment::tables::{Export, Format, Tables};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Some(root) = std::env::args().nth(1) else {
        return Err("say which new folder the study goes to".into());
    };
    let root = Path::new(&root);
    let study = create(&root.join("study"))?;
    let lock = study.lock()?;
    let mut records = Vec::new();
    for seed in 0..6 {
        records.push(session(&study, &lock, seed)?);
    }
    let tables = Tables::of(&study, &lock);
    for record in &records {
        tables.write_session(record)?;
        let journal = study.journal_folder(&record.participant, record.session);
        experiment::files::create_folder(&journal)?;
        experiment::files::append_line(&journal.join("session.jsonl"), "{}")?;
    }
    tables.write_study(&records)?;
    for (name, with_motion, format) in [
        ("bids", true, Format::Bids),
        ("still", false, Format::Bids),
        ("csv", true, Format::Csv),
    ] {
        Export {
            with_motion,
            format,
        }
        .write(&study, &records, &root.join(name))?;
    }
    Ok(())
}

fn create(root: &Path) -> Result<Study, Box<dyn std::error::Error>> {
    let about = About {
        title: "Made-up sessions".to_owned(),
        laboratory: "a program".to_owned(),
        contact: "nobody".to_owned(),
        withdrawal_until: "2027-06-30".to_owned(),
        retention_until: "2036-12-31".to_owned(),
    };
    let fields = [
        ("laboratory", about.laboratory.as_str()),
        ("contact", &about.contact),
        ("withdrawal_until", &about.withdrawal_until),
        ("retention_until", &about.retention_until),
    ];
    let form = include_str!("../../../config/consent.md").to_owned();
    let form = ConsentForm::parse(form, Path::new("config/consent.md"))?.filled(&fields);
    let (plan, rows) = Plan::new(
        &Scheme::Table2,
        18,
        1997,
        about.clone(),
        SessionRules::default(),
    )?;
    let questionnaire = include_str!("../../../config/questionnaire.toml");
    Ok(Study::create(
        root,
        &plan,
        &rows,
        questionnaire,
        &form.text,
        1,
    )?)
}

fn session(
    study: &Study,
    lock: &Lock,
    seed: u64,
) -> Result<SessionRecord, Box<dyn std::error::Error>> {
    let assignment = study.admit(lock, seed)?;
    let ticks = Ticks {
        take_part: true,
        share_data: true,
        share_motion: seed != 2,
        contact: false,
    };
    let consent = study.consent_form().agree(ticks, "2026-11-22")?;
    study.record_consent(lock, &assignment.participant, &consent)?;
    let row = study.row(assignment.slot);
    let mut forms = Vec::new();
    for stage in [Stage::Before, Stage::AfterGame(1), Stage::After] {
        forms.push(filled(study, row, stage, seed)?);
    }
    Ok(SessionRecord {
        session: 1,
        slot: assignment.slot,
        status: if seed == 5 {
            Status::Partial
        } else {
            Status::Complete
        },
        consent,
        forms,
        runs: (1..=2).map(|game| run(game, row.button(game))).collect(),
        pairs: None,
        provenance: Provenance {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: "unknown".to_owned(),
            seed,
            device: if seed.is_multiple_of(2) {
                "headset"
            } else {
                "script"
            }
            .to_owned(),
            refresh_hz: 90.0,
            settings_digest: study.settings_digest(&assignment.participant, 1, "{}"),
            ..Provenance::default()
        },
        began: "2026-11-22T10:00:00.000000Z".to_owned(),
        immersed_s: 900.0,
        participant: assignment.participant,
    })
}

fn filled(
    study: &Study,
    row: &Row,
    stage: Stage,
    seed: u64,
) -> Result<FilledForm, Box<dyn std::error::Error>> {
    let design = study.plan().design();
    let person = Simulated::new(&Model::TABLE_6, study.questionnaire(), &design, row, seed);
    let mut form = Form::new(study.questionnaire(), stage, false);
    let mut at_s = 0.0;
    while let Some(item) = form.current() {
        let (act, thinks_s) = person.answer(stage, item);
        at_s += thinks_s;
        form.act(at_s, act)?;
    }
    Ok(FilledForm {
        answered_in: AnsweredIn::Script,
        answers: form.answers(),
    })
}

fn run(game: u8, button: Button) -> Run {
    let mut random = SplitMix64::new(u64::from(game));
    let mut pose = |height: f64| [0.01 * random.normal(), height, 4.4, 0.0, 0.0, 0.0, 1.0];
    let motion = (0..180).map(|frame| MotionRow {
        time_s: f64::from(frame) / 90.0,
        head: Some(pose(1.6)),
        hand: (frame % 50 != 3).then(|| pose(1.0)),
    });
    let mut throw = EventRow::new(0.8, TrialType::BallRoll);
    (throw.duration_s, throw.button) = (Some(0.9), Some(button));
    (throw.frame, throw.ball, throw.pins_down) = (Some(1), Some(1), Some(7));
    let mut toward = EventRow::new(1.1, TrialType::TowardHead);
    toward.object = Some("pin 7".to_owned());
    toward.response = Some(HeadResponse {
        time_to_contact_s: 0.4,
        miss_distance_m: 0.05,
        onset_s: Some(0.25),
        displacement_m: 0.2,
        speed_mps: 0.8,
        gain_m: 0.01,
        score: 9.0,
    });
    Run {
        number: u32::from(game),
        task: Task::Game {
            number: game,
            button,
        },
        began: format!("2026-11-22T10:{}0:00.000000Z", game),
        sampling_hz: 90.0,
        motion: motion.collect(),
        events: vec![
            EventRow::new(0.0, TrialType::GameStart),
            throw,
            toward,
            EventRow::new(1.99, TrialType::GameEnd),
        ],
    }
}
