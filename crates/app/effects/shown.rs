//! What a scene shows and lets be heard: what each costs, with it and without.

use std::path::Path;

use anyhow::{Context, Result};
use game::{Button, Conditions, ShowsConfig};
use renderer::{BackendChoice, Gpu};
use sound::{Event, Mixer};

use crate::devices::script::Velocities;
use crate::look::Stage;
use crate::rehearsal::rehearse;
use crate::shot::clock::thread_seconds;
use crate::sound::{self as app_sound, Reporter};

/// Each time of a picture is the lower of so many medians, taken in turns so that the machine's moods strike both alike.
const ROUNDS: usize = 2;

/// Something that a picture may have: its key under `[shows]`, and how its setting is read.
type Key = (&'static str, fn(&ShowsConfig) -> bool);

/// All of `[shows]` that is seen.
const SEEN: [Key; 8] = [
    ("shadows", |shows| shows.shadows),
    ("reflection", |shows| shows.reflection),
    ("ambient_occlusion", |shows| shows.ambient_occlusion),
    ("neighbouring_lanes", |shows| shows.neighbouring_lanes),
    ("furnishings", |shows| shows.furnishings),
    ("materials", |shows| shows.materials),
    ("smooth_edges", |shows| shows.smooth_edges),
    ("low_polygon", |shows| shows.low_polygon),
];

/// A scene, to be changed one key at a time.
pub struct Shown<'a> {
    root: &'a Path,
    scene: &'a str,
    settings: &'a [String],
}

/// What a picture of both eyes takes and is made of.
struct Picture {
    stage: Stage,
    milliseconds: f64,
}

impl<'a> Shown<'a> {
    /// The scene under these settings.
    pub fn new(root: &'a Path, scene: &'a str, settings: &'a [String]) -> Self {
        Self {
            root,
            scene,
            settings,
        }
    }

    /// A line for everything that is seen, handed over as soon as it is measured; where nothing can draw, one line that says so.
    ///
    /// # Errors
    /// When the scene cannot be drawn, or `write` fails.
    pub fn pictures(&self, mut write: impl FnMut(&str) -> Result<()>) -> Result<()> {
        let gpu = match Gpu::new(BackendChoice::Auto) {
            Ok(gpu) => gpu,
            Err(error) => return write(&format!("\nPictures are not timed: {error}")),
        };
        write(&format!("\nPictures of both eyes, with {gpu}\n{PICTURES}"))?;
        let mut own = Picture::open(&gpu, self, None)?;
        for (key, read) in SEEN {
            let is_on = read(&own.stage.config.shows);
            let mut other = Picture::open(&gpu, self, Some((key, !is_on)))?;
            own.milliseconds = f64::INFINITY;
            for _ in 0..ROUNDS {
                own.time()?;
                other.time()?;
            }
            let (with, without) = if is_on {
                (&own, &other)
            } else {
                (&other, &own)
            };
            write(&row(key, is_on, with, without))?;
        }
        Ok(())
    }

    /// The line of what is heard: processor time for each second of a frame that the scripted participant bowls.
    ///
    /// # Errors
    /// When the participant cannot play with these settings.
    pub fn sound(&self) -> Result<String> {
        let folder = self.root.join("config");
        let is_on = |on: bool| Conditions::load(&folder, self.scene, &self.with("sound", on));
        let state = Conditions::load(&folder, self.scene, self.settings)?
            .lobby
            .shows
            .sound;
        let [with, without] = [is_on(true)?, is_on(false)?].map(|conditions| heard(&conditions));
        let (with, without) = (with?, without?);
        Ok(format!(
            "{:<20}{:<12}{:>10.2} {:>10.2}   {} blows and {} reports of rolling balls in {:.0} s",
            "sound",
            if state { "yes" } else { "no" },
            with.milliseconds_per_second,
            without.milliseconds_per_second,
            with.blows,
            with.rolling,
            with.seconds,
        ))
    }

    /// The settings with one key of `[shows]` turned on or off.
    fn with(&self, key: &str, is_on: bool) -> Vec<String> {
        let mut settings = self.settings.to_vec();
        settings.push(format!("shows.{key}={is_on}"));
        settings
    }
}

const PICTURES: &str =
    "shown               in scene     with [ms]    without  share [%]  triangles  passes";

impl Picture {
    fn open(gpu: &Gpu, shown: &Shown<'_>, change: Option<(&str, bool)>) -> Result<Self> {
        let settings = change.map_or_else(
            || shown.settings.to_vec(),
            |(key, is_on)| shown.with(key, is_on),
        );
        Ok(Self {
            stage: Stage::open(gpu, shown.root, shown.scene, &settings)?,
            milliseconds: f64::INFINITY,
        })
    }

    fn time(&mut self) -> Result<()> {
        let seconds = self.stage.seconds().context("a picture cannot be drawn")?;
        self.milliseconds = self.milliseconds.min(1e3 * seconds);
        Ok(())
    }
}

/// Times with and without; triangles and passes that are there with it alone (or, with a minus, without it alone).
fn row(key: &str, is_on: bool, with: &Picture, without: &Picture) -> String {
    let share = 1e2 * (1.0 - without.milliseconds / with.milliseconds);
    let triangles = with.stage.triangles() as i64 - without.stage.triangles() as i64;
    let passes = [with, without].map(|picture| picture.stage.renderer.passes());
    let only = |mine: usize, sign: &str| -> Vec<String> {
        let others = &passes[1 - mine];
        let own = passes[mine].iter().filter(|pass| !others.contains(pass));
        own.map(|pass| format!("{sign}{pass}")).collect()
    };
    let passes = [only(0, "+"), only(1, "-")].concat().join(", ");
    let line = format!(
        "{key:<20}{:<12}{:>10.1} {:>10.1} {share:>10.1} {triangles:>+10}  {passes}",
        if is_on { "yes" } else { "no" },
        with.milliseconds,
        without.milliseconds,
    );
    line.trim_end().to_owned()
}

/// What there was to hear, and what it took.
struct Heard {
    milliseconds_per_second: f64,
    seconds: f64,
    blows: usize,
    rolling: usize,
}

/// Lets the scripted participant bowl a frame and listens with its ears.
fn heard(conditions: &Conditions) -> Result<Heard> {
    let config = &conditions.lobby;
    let mut reporter = Reporter::of(config);
    let mut mixer = app_sound::settings(config).map(|settings| Mixer::new(&settings));
    let (mut spent, mut blows, mut rolling) = (0.0, 0, 0);
    let mut samples = Vec::new();
    let game = rehearse(
        conditions,
        1,
        1,
        Velocities::Measured,
        &[Button::Red],
        |game| {
            let started = thread_seconds();
            if let (Some(reporter), Some(mixer)) = (&mut reporter, &mut mixer) {
                let events = reporter.report(game);
                let is_blow = |event: &&Event| matches!(event.sounding, sound::Sounding::Impact(_));
                let is_rolling =
                    |event: &&Event| matches!(event.sounding, sound::Sounding::Rolling(_));
                blows += events.iter().filter(is_blow).count();
                rolling += events.iter().filter(is_rolling).count();
                events.into_iter().for_each(|event| mixer.submit(event));
                let due = (game.time() - mixer.time()).max(0.0) * mixer.sample_rate();
                samples.resize(due as usize, [0.0; 2]);
                mixer.render(&mut samples);
            }
            spent += thread_seconds() - started;
        },
    )?;
    Ok(Heard {
        milliseconds_per_second: 1e3 * spent / game.time(),
        seconds: game.time(),
        blows,
        rolling,
    })
}
