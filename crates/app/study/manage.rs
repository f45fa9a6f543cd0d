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
use super::{entropy, seat, tables, today, utc_now};
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
    match &study.plan().staircase {
        Some(plan) => println!("{}", pairs_text(plan, study.plan().subjects)),
        None => print!("{}", balance(&study.plan().design(), study.rows())),
    }
    let unfilled = study.consent_form().unfilled();
    println!("\nStudy in {}.", study.root().display());
    remind(&study);
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
    // What no session could be played with must not make a folder.
    if plan.staircase.is_none() {
        seat::check_design(&plan.design(), &plan.session, root)?;
    }
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

/// Pairs of throws of a participant where nobody says, those without a difference included.
const USUAL_PAIRS: u32 = 40;
/// Share of pairs without a difference where nobody says.
const USUAL_CATCH_SHARE: f64 = 0.2;

/// The scheme that is asked for; a staircase is tried out.
fn scheme(arguments: &PlanArguments, root: &Path) -> Result<Scheme> {
    let asked = &arguments.staircase;
    let values = (&asked.parameter, asked.standard, asked.furthest);
    if arguments.scheme != "staircase" {
        let how = (asked.rule, asked.pairs, asked.catch_share);
        if values != (&None, None, None) || how != (None, None, None) {
            bail!(unusable(
                "--parameter, --standard, --furthest, --rule, --pairs and --catch-share belong to --scheme staircase"
            ));
        }
        return Ok(Scheme::named(&arguments.scheme));
    }
    if arguments.items_after_each_game
        || arguments.allow_undue_presses
        || arguments.training_in_the_scene
    {
        bail!(unusable(
            "--items-after-each-game, --allow-undue-presses and --training-in-the-scene belong to games, which --scheme staircase has none of"
        ));
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
            Some(RuleChoice::OneUpTwoDown) => Rule::OneUpTwoDown,
            Some(RuleChoice::Bayesian) | None => Rule::Bayesian,
        },
        trials: asked.pairs.unwrap_or(USUAL_PAIRS),
        catch_share: asked.catch_share.unwrap_or(USUAL_CATCH_SHARE),
    };
    plan.check()?;
    seat::check_staircase(&plan, root)?;
    Ok(Scheme::Staircase(plan))
}

/// What a study of differences compares; it has no games whose order and buttons could be balanced.
fn pairs_text(plan: &StaircasePlan, subjects: u32) -> String {
    let rule = match plan.rule {
        Rule::OneUpTwoDown => "one-up two-down",
        Rule::Bayesian => "Bayesian",
    };
    format!(
        "{subjects} participants, {} pairs of throws each, {:.0} % of them without a difference.\n{} is {} in one throw of a pair and from \
         there to {} in the other; which comes first is drawn pair by pair.\nThe next difference is chosen by the {rule} rule.",
        plan.trials,
        100.0 * plan.catch_share,
        plan.key,
        plan.standard,
        plan.furthest,
    )
}

/// Prints the balance of a study's allocation, or what its pairs compare.
///
/// # Errors
/// When there is no study, or its allocation has not what its design promises.
pub fn verify(folder: &Path) -> Result<()> {
    let study = Study::open(folder)?;
    if let Some(plan) = &study.plan().staircase {
        println!("{}", pairs_text(plan, study.plan().subjects));
        return Ok(());
    }
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
    remind(&study);
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

/// Says what is due by now of keeping data.
fn remind(study: &Study) {
    let reminder = study.plan().about.reminder(&today());
    if let Some(reminder) = reminder {
        println!("Reminder: {reminder}.");
    }
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
