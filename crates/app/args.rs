//! The command line: what a person may ask for, and what is refused before anything starts.

mod accuracy;
mod analyse;
mod capture;
mod compare;
mod study;
mod throw;

use std::path::PathBuf;

use clap::error::ErrorKind;
use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum};

pub use accuracy::AccuracyArguments;
pub use analyse::{AnalyseArguments, PowerArguments};
pub use capture::{CaptureArguments, ViewChoice};
pub use compare::{CompareArguments, Sweep};
pub use study::{
    EraseArguments, ExportArguments, GuidanceChoice, NewStudyArguments, PlanArguments,
    ResumeArguments, RuleChoice, RunArguments, SimulateArguments, StudyArguments, StudyCommand,
    StudyFolder, UnblindArguments,
};
pub use throw::{
    ModelChoice, PinNumbers, ShapeChoice, ShotArguments, Span, StrikeMapArguments, ThrowArguments,
};

const EXAMPLES: &str = "\
Examples:
  bowling play                            headset, else window, else a scripted game without a screen
  bowling play --device desk              bowl with the mouse (F1 in the window shows the keys)
  bowling play --offscreen --frames 3     a short scripted recording, no screen needed
  bowling play --set objects.elasticity=0.9   change one setting for this run
  bowling replay out/2026-01-31T10-15-00Z-seed1   check a recording to the last bit
  bowling query pairs.jsonl --time        how far apart are two shapes, and how long does it take to tell
  bowling shot --offset 0.07 --repeat 1000 --jitter-offset 0.01   how many pins fall, and how often all";

/// Immersive pin bowling for presence experiments.
///
/// A hand throws a ball at ten pins, under two versions of the physics that are
/// called Red and Blue. Every run leaves a folder with all that happened in it.
#[derive(Debug, Parser)]
#[command(name = "bowling", version, after_help = EXAMPLES, disable_help_subcommand = true)]
pub struct Arguments {
    /// What to do; nothing prints the help.
    #[command(subcommand)]
    pub command: Option<Command>,

    /// Folder that holds config/, assets/ and shaders/ [default: found beside the program].
    #[arg(
        long,
        global = true,
        hide = true,
        env = "BOWLING_ROOT",
        value_name = "DIR"
    )]
    pub root: Option<PathBuf>,
}

impl Arguments {
    /// The arguments, unless they contradict each other.
    ///
    /// # Errors
    /// As clap's own: a sentence for the error stream.
    pub fn consistent(self) -> Result<Self, clap::Error> {
        if let Some(Command::Play(play)) = &self.command
            && play.offscreen
            && let Some(device @ (DeviceChoice::Desk | DeviceChoice::Headset)) = play.device
        {
            let name = if device == DeviceChoice::Desk {
                "desk"
            } else {
                "headset"
            };
            let problem = format!(
                "--offscreen opens no display, but --device {name} needs one: leave one of the two out"
            );
            return Err(unusable(problem));
        }
        let problem = match &self.command {
            Some(Command::Shot(shot)) => shot.contradiction(),
            Some(Command::StrikeMap(map)) => map.contradiction(),
            _ => None,
        };
        if let Some(problem) = problem {
            return Err(unusable(problem));
        }
        Ok(self)
    }
}

/// The refusal of arguments that cannot be used: a sentence for the error stream, and exit code 2.
pub fn unusable(problem: impl std::fmt::Display) -> clap::Error {
    Arguments::command().error(ErrorKind::ArgumentConflict, problem)
}

/// What the program does.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Bowl: a game under Red and one under Blue, recorded into a folder.
    ///
    /// Takes the headset if there is one, else a window, else lets a scripted participant play
    /// without a screen, and says which and why. The folder then holds the journal (everything
    /// that the game consumed), the motion of head and hand, both score sheets, and per game a
    /// contact sheet and a video of highlights, for both eyes.
    Play(PlayArguments),
    /// Play a recording again from its inputs and check that the same came out.
    ///
    /// Fails when the final state, a score, an event or the motion table differs from what was recorded.
    Replay(ReplayArguments),
    /// Ask the collision detection about pairs of shapes, one JSON object a line.
    ///
    /// A line is {"a":{"shape":"cylinder","radius":0.5,"half_height":0.3,"position":[x,y,z],
    /// "rotation":[x,y,z,w]},"b":{...}}; docs/query.md lists shapes and answers. Lengths are in
    /// metres. Each line is answered in its place, a bad one with the reason, and then the exit
    /// code is 1.
    Query(QueryArguments),
    /// Try what is hard for a rigid-body engine against what analysis says.
    ///
    /// One line a case: verdict, time, section, name, what is right and from where, when it passes, and
    /// what was measured; docs/hard-cases.md says more. The exit code is 1 if any fails.
    HardCases(HardCasesArguments),
    /// Throw a ball at the pins without hands or pictures.
    ///
    /// Says which pins fell, what ball and first pin did just after the first hit, energy and momentum
    /// before and after, and what it cost; with --repeat how that is distributed. docs/shot.md
    /// explains every number.
    Shot(ShotArguments),
    /// Map how often all pins fall, by the offset and the angle at which the ball comes to the head pin.
    ///
    /// Writes strike-map.csv (shares of strikes and mean pins with their 95 % intervals) and
    /// strike-map.svg. The same arguments give the same map. docs/strike-map.md compares maps with
    /// what is published.
    StrikeMap(StrikeMapArguments),
    /// Show what a scene calls for and shows, and what each effect costs.
    ///
    /// Prints the stages that a step of the scene runs with the effects that act in each, and for
    /// every effect how often it acts in a step, its share of the step's time, and the time with and
    /// without it; then the same of everything that is seen, and of sound.
    Effects(EffectsArguments),
    /// Draw a scene from six places, for both eyes.
    ///
    /// Writes a contact sheet and prints how many triangles the scene has, which passes draw it, and how long a picture
    /// of both eyes takes.
    Look(LookArguments),
    /// Show what accuracy costs in time, dial by dial.
    ///
    /// Prints a table per dial (iteration cap, shape, step, solver, response, precision, four public scenes) and writes
    /// accuracy.csv, a figure per dial and one of all as SVG and PNG: error against time, the default and the knee marked.
    /// docs/accuracy.md reads them.
    Accuracy(AccuracyArguments),
    /// Repeat one recorded throw under the eight conditions of the paper's Table 1, side by side.
    ///
    /// Prints how far each parts from the base condition and whether that explains who noticed what (Table 4), and
    /// writes tables, a contact sheet of the same instants and a video; with --sweep, figures along a parameter
    /// instead. docs/compare.md explains the numbers.
    Compare(CompareArguments),
    /// Draw any moment of a session, or film a span of it, again from its journal.
    Capture(CaptureArguments),
    /// Plan and run an experiment, and keep its data.
    ///
    /// A study is a folder: `plan/` with what was decided and who plays what, for the experimenter's eyes, and `data/`, a BIDS
    /// dataset that can be shared and never says what a button meant. docs/study.md explains every file.
    Study(StudyArguments),
    /// Analyse a study or a table: the paper's tables, and what an honest reader needs beside them.
    ///
    /// Prints the report and writes report.html, which stands alone, report.json with every number, and the figures.
    /// docs/analysis.md names the columns of a table and explains the numbers.
    Analyse(AnalyseArguments),
    /// Say how many subjects a study needs: simulates studies and analyses them.
    ///
    /// Prints how often the paper's chi-squared test and the quasi-binomial F test reject, by number of subjects, with
    /// intervals, how often they reject where there is no effect, and what follows. docs/analysis.md says from what.
    Power(PowerArguments),
}

/// Who or what bowls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DeviceChoice {
    /// A virtual reality headset through OpenXR.
    Headset,
    /// Mouse, keyboard or gamepad in a window.
    Desk,
    /// A simulated participant, the same for the same seed.
    Script,
}

/// Which display is imitated in pictures and videos.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DisplayChoice {
    /// The field of view and resolution of a present-day headset.
    Modern,
    /// The head-mounted display of the 1997 paper: 75 by 40 degrees, 704x480 relayed to 360x240.
    #[value(name = "1996")]
    Nineties,
}

impl From<DisplayChoice> for game::DisplayProfileName {
    fn from(choice: DisplayChoice) -> Self {
        match choice {
            DisplayChoice::Modern => Self::Modern,
            DisplayChoice::Nineties => Self::Of1996,
        }
    }
}

impl DisplayChoice {
    /// The profile's name in the configuration (`display.profile`).
    pub fn name(self) -> &'static str {
        match self {
            DisplayChoice::Modern => "modern",
            DisplayChoice::Nineties => "1996",
        }
    }
}

/// Arguments of `bowling play`.
#[derive(Debug, Args)]
pub struct PlayArguments {
    /// Who bowls [default: the first of headset, desk, script that is there].
    #[arg(long, value_enum)]
    pub device: Option<DeviceChoice>,

    /// What is asked of a headset.
    #[command(flatten)]
    pub headset: HeadsetArguments,

    /// Open no window; the scripted participant plays and pictures go to files.
    #[arg(long)]
    pub offscreen: bool,

    /// Bowling frames per game.
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=10))]
    pub frames: u32,

    /// Seed of the scripted participant's scatter; the same seed gives the same game.
    #[arg(
        long,
        value_name = "N",
        allow_negative_numbers = true,
        default_value_t = 1
    )]
    pub seed: u64,

    /// Throw as often as you like, without a game; the lane shows its oil and the way of the last ball.
    #[arg(long)]
    pub practice: bool,

    /// Pins that stand before each throw of practice, as 7,10.
    #[arg(long, value_name = "PINS", requires = "practice", value_parser = throw::leave)]
    pub leave: Option<PinNumbers>,

    /// Weights of the balls on the rack in practice, from the far end to the near one, in kilograms.
    #[arg(long, value_name = "KG,..", requires = "practice", value_delimiter = ',', allow_negative_numbers = true, value_parser = throw::ball_kg)]
    pub ball_kg: Vec<f64>,

    /// Folder for the recording; must not hold one already [default: out/TIME-seedN].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// Make no videos of highlights.
    #[arg(long)]
    pub no_video: bool,

    /// Scene to play in: a file of config/scenes, without its ending.
    #[arg(long, value_name = "NAME")]
    pub scene: Option<String>,

    /// Display to imitate in pictures and videos [default: display.profile of the configuration].
    #[arg(long, value_enum)]
    pub display: Option<DisplayChoice>,

    /// File of every word that is seen, in the folder config [default: guidance.words of the configuration].
    #[arg(long, value_name = "FILE")]
    pub words: Option<String>,

    /// Change one setting in both conditions; may be given several times.
    ///
    /// Takes precedence over conditions, scene and defaults. The settings are the keys of
    /// config/default.toml, with dots between table and key.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<String>,
}

/// What is asked of a headset, whoever plays in it.
#[derive(Debug, Args)]
pub struct HeadsetArguments {
    /// Refresh rate of the headset, in hertz [default: the highest that it offers].
    #[arg(long, value_name = "HZ", allow_negative_numbers = true, value_parser = refresh_rate)]
    pub refresh_rate: Option<f32>,
}

/// What is asked about two shapes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Question {
    /// Are they apart? Stops at the first separating normal.
    Apart,
    /// How far: the signed gap with its bounds.
    Gap,
    /// Where they touch: the gap, its depth and up to four points of contact.
    Contact,
}

/// Arguments of `bowling query`.
#[derive(Debug, Args)]
pub struct QueryArguments {
    /// File of JSON lines [default: standard input].
    #[arg(value_name = "FILE")]
    pub file: Option<PathBuf>,

    /// Largest number of iterations for a query; 5 to 20 in the paper.
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..))]
    pub cap: u32,

    /// A search ends when it expects to gain less than this, in metres.
    #[arg(long, value_name = "T", allow_negative_numbers = true, default_value = "1e-13", value_parser = tolerance)]
    pub tolerance: f64,

    /// What is asked.
    #[arg(long, value_enum, default_value = "gap")]
    pub question: Question,

    /// Then ask everything again and again, and write the median time of a query, without reading
    /// and writing, to standard error.
    #[arg(long)]
    pub time: bool,
}

fn refresh_rate(text: &str) -> Result<f32, String> {
    match text.parse() {
        Ok(value) if (20.0..=500.0).contains(&value) => Ok(value),
        _ => Err("a refresh rate is a number of hertz from 20 to 500".to_owned()),
    }
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if value > 0.0 && f64::is_finite(value) => Ok(value),
        _ => Err("a tolerance is a positive number of metres".to_owned()),
    }
}

/// Arguments of `bowling hard-cases`.
#[derive(Debug, Args)]
pub struct HardCasesArguments {
    /// Only the case of this name, those whose names begin so, or those of a section (3, 3.1).
    #[arg(long, value_name = "NAME", value_parser = crate::hard_cases::known_name)]
    pub only: Option<String>,

    /// Print a JSON array instead of a table, one object a case.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `bowling effects`.
#[derive(Debug, Args)]
pub struct EffectsArguments {
    /// Throws to measure with: more of them give steadier times.
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 4, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub throws: u64,

    /// Scene: a file of config/scenes, without its ending.
    #[arg(long, value_name = "NAME", default_value = "alley")]
    pub scene: String,

    /// Change one setting, as in `bowling play`; may be given several times.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<String>,

    /// What to measure; several with commas between.
    #[arg(
        long,
        value_name = "WHAT",
        value_delimiter = ',',
        default_value = "physics,pictures,sound"
    )]
    pub of: Vec<EffectsOf>,
}

/// What `bowling effects` measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum EffectsOf {
    /// What the steps compute.
    Physics,
    /// What is seen.
    Pictures,
    /// What is heard.
    Sound,
}

/// Arguments of `bowling look`.
#[derive(Debug, Args)]
pub struct LookArguments {
    /// Scene: a file of config/scenes, without its ending.
    #[arg(long, value_name = "NAME", default_value = "alley")]
    pub scene: String,

    /// The contact sheet.
    #[arg(long, value_name = "FILE", default_value = "look.png")]
    pub out: PathBuf,

    /// Width of one eye's picture, in pixels; it is three quarters as high.
    #[arg(long, value_name = "PX", default_value_t = 480, value_parser = clap::value_parser!(u32).range(64..=2048))]
    pub width: u32,

    /// Change one setting, as in `bowling play`; may be given several times.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<String>,
}

/// Arguments of `bowling replay`.
#[derive(Debug, Args)]
pub struct ReplayArguments {
    /// The recording's folder, as printed at the end of `bowling play`.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn play(arguments: &[&str]) -> Result<PlayArguments, clap::Error> {
        let all = ["bowling", "play"].iter().chain(arguments);
        match Arguments::try_parse_from(all)?.command {
            Some(Command::Play(play)) => Ok(play),
            other => panic!("expected play, got {other:?}"),
        }
    }

    #[test]
    fn arguments_are_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn play_defaults_to_two_whole_games() {
        let play = play(&[]).expect("no argument is required");
        assert_eq!((play.frames, play.seed), (10, 1));
        assert!(play.device.is_none() && !play.offscreen && !play.no_video);
    }

    #[test]
    fn frames_out_of_range_are_refused_with_the_range() {
        for frames in ["0", "11", "-1", "ten"] {
            let error = play(&["--frames", frames]).expect_err(frames).to_string();
            assert!(error.contains("--frames"), "{error}");
        }
    }

    #[test]
    fn a_display_and_none_are_a_contradiction() {
        let parse = |device| {
            Arguments::try_parse_from(["bowling", "play", "--offscreen", "--device", device])
                .expect("each argument is good")
                .consistent()
        };
        for device in ["desk", "headset"] {
            let error = parse(device).expect_err("contradiction");
            assert_eq!(error.exit_code(), 2);
            let text = error.to_string();
            assert!(
                text.contains("--offscreen") && text.contains(device),
                "{text}"
            );
        }
        assert!(parse("script").is_ok());
    }

    /// Of whoever plays in a headset: `play`, and a study's `run` and `resume`.
    #[test]
    fn a_refresh_rate_is_taken_or_refused_alike_wherever_somebody_plays() {
        let rate = |begin: &[&str], rate: &str| {
            let all = [&["bowling"], begin, &["--refresh-rate", rate]].concat();
            let command = Arguments::try_parse_from(all)?.command;
            let headset = match command {
                Some(Command::Play(play)) => play.headset,
                Some(Command::Study(study)) => match study.command {
                    StudyCommand::Run(run) => run.headset,
                    StudyCommand::Resume(resume) => resume.headset,
                    other => panic!("expected run or resume, got {other:?}"),
                },
                other => panic!("expected somebody who plays, got {other:?}"),
            };
            Ok::<_, clap::Error>(headset.refresh_rate)
        };
        let refused = |begin: &[&str], number: &str| {
            let error = rate(begin, number).expect_err(number);
            error.to_string()
        };
        let players: [&[&str]; 3] = [&["play"], &["study", "run", "s"], &["study", "resume", "s"]];
        for begin in players {
            assert_eq!(rate(begin, "90").expect("a rate"), Some(90.0));
            for number in ["19", "501", "-90", "fast"] {
                let error = refused(begin, number);
                assert!(error.contains("from 20 to 500"), "{error}");
            }
        }
    }

    #[test]
    fn settings_accumulate_in_order() {
        let play = play(&["--set", "a.b=1", "--set", "c=2"]).expect("two settings");
        assert_eq!(play.settings, ["a.b=1", "c=2"]);
    }

    #[test]
    fn display_1996_is_spelt_as_a_year() {
        let play = play(&["--display", "1996"]).expect("a known display");
        assert_eq!(play.display.map(DisplayChoice::name), Some("1996"));
    }
}
