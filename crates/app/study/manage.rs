//! Making, looking at and giving away a study.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use experiment::consent::ConsentForm;
use experiment::files;
use experiment::plan::{About, Balance, Guidance, Plan, Scheme, SessionRules, balance};
use experiment::record::Pairs;
use experiment::staircase::{Rule, StaircasePlan};
use experiment::study::{ParticipantId, Study};
use experiment::tables::{Export, Format};

use super::folder::{self, place_text};
use super::{entropy, seat, tables, utc_now};
use crate::args::{
    EraseArguments, ExportArguments, GuidanceChoice, NewStudyArguments, PlanArguments, RuleChoice,
    UnblindArguments, unusable,
};

/// Makes a study.
///
/// # Errors
/// When something cannot be used, or the folder cannot be written; nothing is left behind then.
pub fn new(arguments: &NewStudyArguments, root: &Path) -> Result<()> {
    let about = About {
        title: arguments.title.clone(),
        laboratory: arguments.laboratory.clone(),
        contact: arguments.contact.clone(),
        withdrawal_until: arguments.withdrawal_until.clone(),
        retention_until: arguments.retention_until.clone(),
    };
    let own = |file: &Option<PathBuf>, name: &str| {
        file.clone()
            .unwrap_or_else(|| root.join("config").join(name))
    };
    let questionnaire = own(&arguments.questionnaire, "questionnaire.toml");
    let consent = own(&arguments.consent, "consent.md");
    let study = create(
        &arguments.plan,
        about,
        [&questionnaire, &consent],
        entropy(),
        root,
    )?;
    print!("{}", balance(&study.plan().design(), study.rows()));
    let unfilled = study.consent_form().unfilled();
    println!("\nStudy in {}.", study.root().display());
    if !unfilled.is_empty() {
        println!(
            "The consent form still has the empty fields {}: no session begins before a study has them (--laboratory, --contact).",
            unfilled.join(", ")
        );
    }
    Ok(())
}

/// Makes the folder of a study; `texts` are the files of questionnaire and consent form.
///
/// # Errors
/// As [`new`].
pub fn create(
    arguments: &PlanArguments,
    about: About,
    texts: [&Path; 2],
    entropy: u64,
    root: &Path,
) -> Result<Study> {
    let rules = SessionRules {
        frames_per_game: arguments.frames,
        training_throws: arguments.training,
        training_in_first_condition: !arguments.training_in_the_scene,
        items_after_each_game: arguments.items_after_each_game,
        undue_presses_allowed: arguments.allow_undue_presses,
        guidance: Guidance {
            glow: arguments.guidance.contains(&GuidanceChoice::Glow),
            hints: arguments.guidance.contains(&GuidanceChoice::Hints),
            feedback: arguments.guidance.contains(&GuidanceChoice::Feedback),
            calibration: arguments.guidance.contains(&GuidanceChoice::Calibration),
        },
        ..SessionRules::default()
    };
    let scheme = scheme(arguments, root)?;
    let [questionnaire, consent] = texts;
    let form = ConsentForm::read(consent)?.filled(&[
        ("laboratory", &about.laboratory),
        ("contact", &about.contact),
        ("retention_until", &about.retention_until),
        ("withdrawal_until", &about.withdrawal_until),
    ]);
    let (plan, rows) = Plan::new(&scheme, arguments.subjects, arguments.seed, about, rules)?;
    let questionnaire = files::read(questionnaire)?;
    Ok(Study::create(
        &arguments.folder,
        &plan,
        &rows,
        &questionnaire,
        &form.text,
        entropy,
    )?)
}

/// The scheme that is asked for; a staircase is tried out.
fn scheme(arguments: &PlanArguments, root: &Path) -> Result<Scheme> {
    let asked = &arguments.staircase;
    let values = (&asked.parameter, asked.standard, asked.furthest);
    if arguments.scheme != "staircase" {
        if values != (&None, None, None) {
            bail!(unusable(
                "--parameter, --standard and --furthest belong to --scheme staircase"
            ));
        }
        return Ok(Scheme::named(&arguments.scheme));
    }
    let (Some(key), Some(standard), Some(furthest)) = values else {
        bail!(unusable(
            "--scheme staircase needs --parameter, --standard and --furthest, as objects.elasticity, 1.0 and 0.5"
        ));
    };
    let plan = StaircasePlan {
        key: key.clone(),
        standard,
        furthest,
        rule: match asked.rule {
            RuleChoice::OneUpTwoDown => Rule::OneUpTwoDown,
            RuleChoice::Bayesian => Rule::Bayesian,
        },
        trials: asked.pairs,
        catch_share: asked.catch_share,
    };
    plan.check()?;
    seat::check_staircase(&plan, root)?;
    Ok(Scheme::Staircase(plan))
}

/// Prints the balance of a study's allocation.
///
/// # Errors
/// When there is no study, or its allocation has not what its design promises.
pub fn verify(folder: &Path) -> Result<()> {
    let study = Study::open(folder)?;
    let balance: Balance = balance(&study.plan().design(), study.rows());
    print!("{balance}");
    if !balance.problems.is_empty() {
        bail!("the allocation is not what its design promises");
    }
    Ok(())
}

/// Lists a study's participants.
///
/// # Errors
/// When there is no study; what is wrong with a journal is part of the list.
pub fn status(folder: &Path) -> Result<()> {
    let study = Study::open(folder)?;
    let assignments = study.assignments()?;
    println!(
        "{}: {} of {} participants",
        study.root().display(),
        assignments.len(),
        study.plan().subjects
    );
    let mut damaged = 0;
    for assignment in assignments {
        let participant = assignment.participant;
        let text = match folder::progress(&study, &participant) {
            Ok(None) => "has not begun".to_owned(),
            Ok(Some(progress)) => {
                let place = place_text(progress.protocol.place());
                let torn = progress.story.torn;
                let torn = torn.map_or(String::new(), |torn| format!("; {torn}"));
                let open = if progress.is_open() {
                    ", to be resumed"
                } else {
                    ""
                };
                let pairs = progress
                    .pairs
                    .map_or(String::new(), |pairs| estimate(&pairs));
                format!("{place}{open}{pairs}{torn}")
            }
            Err(error) => {
                damaged += 1;
                format!("DAMAGED: {error:#}")
            }
        };
        println!("  {participant}  {text}");
    }
    if damaged > 0 {
        bail!(
            "{damaged} of the journals cannot be read: nothing was changed; restore them from a backup"
        );
    }
    Ok(())
}

/// What pairs of throws have come to.
fn estimate(pairs: &Pairs) -> String {
    let count = pairs.compared.len();
    let Some(estimate) = pairs.estimate else {
        return format!("; {count} pairs, which do not tell the threshold yet");
    };
    let [low, high] = estimate.interval;
    format!(
        "; threshold {:.4} ({low:.4} to {high:.4}) from {count} pairs, {} of {} without a difference called different",
        estimate.threshold, estimate.false_alarms, estimate.catches
    )
}

/// Shows the allocation, after it was written down who looks.
///
/// # Errors
/// When it cannot be written down.
pub fn unblind(arguments: &UnblindArguments) -> Result<()> {
    let study = Study::open(&arguments.folder)?;
    let lock = study.lock()?;
    let rows = study.unblind(&lock, &arguments.who, &utc_now(), &arguments.why)?;
    print!(
        "{}",
        experiment::plan::allocation_csv(&study.plan().design(), rows)
    );
    Ok(())
}

/// Erases a participant.
///
/// # Errors
/// When there is none, or something of the participant remains.
pub fn erase(arguments: &EraseArguments) -> Result<()> {
    let study = Study::open(&arguments.folder)?;
    let lock = study.lock()?;
    let participant = ParticipantId::parse(&arguments.participant)?;
    let erased = study.erase(&lock, &participant, &arguments.who, &utc_now())?;
    println!(
        "Erased {participant}: {} files removed, {} shortened. Backups and copies elsewhere are out of reach.",
        erased.removed.len(),
        erased.shortened.len()
    );
    if let Some(slot) = erased.slot {
        println!("Slot {slot} is free again.");
    }
    Ok(())
}

/// Copies what can be shared.
///
/// # Errors
/// When the copy cannot be written.
pub fn export(arguments: &ExportArguments) -> Result<()> {
    let study = Study::open(&arguments.folder)?;
    // Nobody may write journals meanwhile.
    let _lock = study.lock()?;
    let records = tables::records(&study)?;
    let export = Export {
        with_motion: !arguments.without_motion,
        format: if arguments.csv {
            Format::Csv
        } else {
            Format::Bids
        },
    };
    let exported = export.write(&study, &records, &arguments.out)?;
    let count = exported.participants.len();
    println!("{count} participants in {}.", arguments.out.display());
    for (who, why) in [
        (
            &exported.left_out,
            "left out, because they did not agree to sharing",
        ),
        (&exported.without_motion, "without motion"),
    ] {
        if !who.is_empty() {
            let names: Vec<String> = who.iter().map(ToString::to_string).collect();
            println!("{why}: {}", names.join(", "));
        }
    }
    Ok(())
}
