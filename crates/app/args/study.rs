//! Arguments of `bowling study`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

use super::{DeviceChoice, HeadsetArguments};

/// Arguments of `bowling study`.
#[derive(Debug, Args)]
pub struct StudyArguments {
    /// What to do with the study.
    #[command(subcommand)]
    pub command: StudyCommand,
}

/// What is done with a study.
#[derive(Debug, Subcommand)]
pub enum StudyCommand {
    /// Make a study: its plan and allocation, questionnaire and consent form, in a new folder.
    New(NewStudyArguments),
    /// Print the balance that the allocation has, and prove Table 2 where it is one.
    Verify(StudyFolder),
    /// Run a participant's session: consent, questions, training throws, both games, questions, debriefing.
    ///
    /// The terminal is the experimenter's: it asks for what is due, and takes `/note WORDS`, `/stop REASON` and `/status` at any
    /// time. It never says what a condition is, only Red and Blue.
    Run(RunArguments),
    /// Take up a session that was broken off, at its last complete bowling frame.
    Resume(ResumeArguments),
    /// List the participants, how far they got, and what is wrong with their journals.
    Status(StudyFolder),
    /// Make every table anew from the journals, playing each session again to its last bit.
    Rebuild(StudyFolder),
    /// Show the allocation to somebody, which is written down first.
    Unblind(UnblindArguments),
    /// Erase everything about one participant, and leave a tombstone.
    Erase(EraseArguments),
    /// Copy what can be shared to another folder.
    Export(ExportArguments),
    /// Make a study and play all of it with simulated participants, answers included.
    Simulate(SimulateArguments),
}

/// A study's folder.
#[derive(Debug, Args)]
pub struct StudyFolder {
    /// The study's folder.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

/// What a plan is made from.
#[derive(Debug, Args)]
pub struct PlanArguments {
    /// The study's folder, which must be new or empty.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,

    /// Participants.
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 18, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub subjects: u32,

    /// Seed of the allocation; the same seed gives the same plan.
    #[arg(
        long,
        value_name = "S",
        allow_negative_numbers = true,
        default_value_t = 1997
    )]
    pub seed: u64,

    /// Design: table2 (Table 2 of the paper), balanced (equal cells), full (every pair of conditions), continuous (drawn values), staircase
    /// (pairs of throws instead of games, for a just-noticeable difference), or a file.
    #[arg(
        long,
        value_name = "table2|balanced|full|continuous|staircase|FILE",
        default_value = "table2"
    )]
    pub scheme: String,

    /// What pairs of throws differ in, with --scheme staircase.
    #[command(flatten)]
    pub staircase: StaircaseArguments,

    /// Bowling frames per game.
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=10))]
    pub frames: u32,

    /// Training throws before game one.
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 3, value_parser = clap::value_parser!(u32).range(0..=100))]
    pub training: u32,

    /// Make the training throws in the scene as it is instead of in the condition of game one.
    #[arg(long)]
    pub training_in_the_scene: bool,

    /// Ask the items that say so after each game, not only at the end.
    #[arg(long)]
    pub items_after_each_game: bool,

    /// Let a press of a button that is not due start its game instead of refusing it.
    #[arg(long)]
    pub allow_undue_presses: bool,

    /// Help that participants have besides the training [default: none].
    #[arg(long, value_enum, value_delimiter = ',', value_name = "WHAT,..")]
    pub guidance: Vec<GuidanceChoice>,
}

/// What may help a participant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum GuidanceChoice {
    /// What the hand could take glows.
    Glow,
    /// Hints until the first throw is over.
    Hints,
    /// How a ball was let go, on the scoreboard.
    Feedback,
    /// One gesture measures height and reach, and places what must be reached.
    Calibration,
}

/// What a study of differences compares.
#[derive(Debug, Args)]
pub struct StaircaseArguments {
    /// With --scheme staircase: the setting that differs, any number of config/default.toml, as objects.elasticity.
    #[arg(long, value_name = "KEY")]
    pub parameter: Option<String>,

    /// With --scheme staircase: its value in one throw of every pair.
    #[arg(long, value_name = "VALUE", allow_negative_numbers = true)]
    pub standard: Option<f64>,

    /// With --scheme staircase: its value at the largest difference.
    #[arg(long, value_name = "VALUE", allow_negative_numbers = true)]
    pub furthest: Option<f64>,

    /// With --scheme staircase: how the next difference is chosen [default: bayesian].
    #[arg(long, value_enum)]
    pub rule: Option<RuleChoice>,

    /// With --scheme staircase: pairs of throws of a participant, those without a difference included [default: 40].
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub pairs: Option<u32>,

    /// With --scheme staircase: share of pairs without a difference, 0 to 0.5 [default: 0.2].
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    pub catch_share: Option<f64>,
}

/// How the next difference is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum RuleChoice {
    /// Larger after 'same', smaller after two 'different' in a row.
    OneUpTwoDown,
    /// The one whose answer is expected to tell most.
    Bayesian,
}

/// Arguments of `bowling study new`.
#[derive(Debug, Args)]
pub struct NewStudyArguments {
    /// What the plan is made from.
    #[command(flatten)]
    pub plan: PlanArguments,

    /// Name of the study in the shared data; participants do not read it.
    #[arg(long, value_name = "TITLE", default_value = "A study at the alley")]
    pub title: String,

    /// Who is responsible, for the consent form.
    #[arg(long, value_name = "NAME", default_value = "")]
    pub laboratory: String,

    /// Where participants turn to, for the consent form.
    #[arg(long, value_name = "ADDRESS", default_value = "")]
    pub contact: String,

    /// Last day on which data can be erased on request.
    #[arg(long, value_name = "YYYY-MM-DD")]
    pub withdrawal_until: String,

    /// Last day on which data that can be tied to a person are kept.
    #[arg(long, value_name = "YYYY-MM-DD")]
    pub retention_until: String,

    /// Questionnaire to use instead of config/questionnaire.toml.
    #[arg(long, value_name = "FILE")]
    pub questionnaire: Option<PathBuf>,

    /// Consent form to use instead of config/consent.md.
    #[arg(long, value_name = "FILE")]
    pub consent: Option<PathBuf>,
}

/// Arguments of `bowling study run`.
#[derive(Debug, Args)]
pub struct RunArguments {
    /// The study's folder.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,

    /// Who plays: a new participant, or the id of one who has not begun.
    #[arg(long, value_name = "new|ID", default_value = "new")]
    pub participant: String,

    /// Who bowls [default: the first of headset, desk, script that is there].
    #[arg(long, value_enum)]
    pub device: Option<DeviceChoice>,

    /// What is asked of a headset.
    #[command(flatten)]
    pub headset: HeadsetArguments,
}

/// Arguments of `bowling study resume`.
#[derive(Debug, Args)]
pub struct ResumeArguments {
    /// The study's folder.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,

    /// Whose session [default: the only one that was broken off].
    #[arg(long, value_name = "ID")]
    pub participant: Option<String>,

    /// Who bowls [default: the first of headset, desk, script that is there].
    #[arg(long, value_enum)]
    pub device: Option<DeviceChoice>,

    /// What is asked of a headset.
    #[command(flatten)]
    pub headset: HeadsetArguments,
}

/// Arguments of `bowling study unblind`.
#[derive(Debug, Args)]
pub struct UnblindArguments {
    /// The study's folder.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,

    /// Who looks.
    #[arg(long, value_name = "NAME")]
    pub who: String,

    /// Why.
    #[arg(long, value_name = "WORDS")]
    pub why: String,
}

/// Arguments of `bowling study erase`.
#[derive(Debug, Args)]
pub struct EraseArguments {
    /// The study's folder.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,

    /// Whose data.
    #[arg(value_name = "ID")]
    pub participant: String,

    /// Who erases.
    #[arg(long, value_name = "NAME")]
    pub who: String,
}

/// Arguments of `bowling study export`.
#[derive(Debug, Args)]
pub struct ExportArguments {
    /// The study's folder.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,

    /// The copy's folder, which must be new or empty.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,

    /// Leave out head and hand, by which people can be recognised, and the journals that hold them.
    #[arg(long)]
    pub without_motion: bool,

    /// Write tables with commas instead of the BIDS dataset with tabs.
    #[arg(long)]
    pub csv: bool,
}

/// Arguments of `bowling study simulate`.
#[derive(Debug, Args)]
pub struct SimulateArguments {
    /// What the plan is made from.
    #[command(flatten)]
    pub plan: PlanArguments,

    /// With --scheme staircase: the difference, in the parameter's unit, that the simulated participants call different 70.7 % of
    /// the time [default: a quarter of the range].
    #[arg(long, value_name = "DIFFERENCE", allow_negative_numbers = true)]
    pub threshold: Option<f64>,
}
