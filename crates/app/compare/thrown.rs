//! A recorded throw as something that can be thrown again: from a session's journal, or from the file of a shot.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use game::{BareAlley, Config, EventKind, Game, Model, ReleaseVelocity};
use glam::DVec3;
use physics::Pose;
use serde::Deserialize;

use super::condition::with;
use crate::args::{CompareArguments, unusable};
use crate::journal::{self, Recording};
use crate::output::JOURNAL;
use crate::replay::check_inputs;
use crate::shot::record::{FORMAT, VERSION};
use crate::shot::throw::Release;

/// What was let go, at what, and who watched.
#[derive(Clone, Debug)]
pub struct Thrown {
    /// What it is called in captions.
    pub name: String,
    /// Settings that it was thrown under, with the changes of the command line.
    pub config: Config,
    /// The session's Red and Blue, as recorded.
    pub buttons: Option<[Config; 2]>,
    /// Number of the ball, from 0.
    pub ball: u8,
    /// The ball at the release, world frame.
    pub pose: Pose,
    /// Its velocity [m/s].
    pub linear: DVec3,
    /// [rad/s].
    pub angular: DVec3,
    /// Pins that stood, and where [m].
    pub pins: Vec<(u8, (f64, f64))>,
    /// Pins that fell when it was recorded.
    pub fallen: Option<usize>,
    /// When they were counted, after the release [s].
    pub counted: Option<f64>,
    /// Time since the release [s], and `world_from_head` from then on; never empty.
    heads: Vec<(f64, Pose)>,
}

impl Thrown {
    /// Reads what `--throw` names.
    ///
    /// # Errors
    /// When there is no such recording or throw, or it does not replay.
    pub fn read(arguments: &CompareArguments) -> Result<Self> {
        let path = &arguments.recording;
        let mut thrown = if path.is_dir() || path.file_name().is_some_and(|name| name == JOURNAL) {
            of_session(arguments)?
        } else {
            of_shot(path)?
        };
        thrown.config = with(&thrown.config, &arguments.settings)?;
        Ok(thrown)
    }

    /// The participant's head at a time after the release [s]: where it was last tracked before.
    pub fn head(&self, time: f64) -> Pose {
        let after = self
            .heads
            .partition_point(|(since, _)| *since <= time + 1e-9);
        self.heads[after.saturating_sub(1)].1
    }
}

/// A release that may become a throw.
struct Candidate {
    ball: u8,
    pose: Pose,
    linear: DVec3,
    angular: DVec3,
    pins: Vec<(u8, (f64, f64))>,
    config: Config,
}

fn of_session(arguments: &CompareArguments) -> Result<Thrown> {
    let path = &arguments.recording;
    let journal: PathBuf = if path.is_dir() {
        path.join(JOURNAL)
    } else {
        path.clone()
    };
    let recording = journal::read(&journal)?;
    check_inputs(&recording.conditions, &recording.inputs)?;
    let throws = recording
        .events
        .iter()
        .filter(|(_, event)| event["event"] == "throw_started");
    let count = throws.count();
    let wanted = arguments.throw as usize;
    if count == 0 {
        bail!("{}: no ball was thrown in this session", path.display());
    }
    if wanted > count {
        bail!(unusable(format!(
            "--throw {wanted}: {} has {count} throws; give from 1 to {count}",
            path.display()
        )));
    }
    let mut watcher = Watcher {
        wanted,
        duration: arguments.duration.unwrap_or(0.0),
        seen: 0,
        released: 0.0,
        candidate: None,
        heads: Vec::new(),
        thrown: None,
    };
    replay(&recording, &mut watcher).with_context(|| path.display().to_string())?;
    let mut thrown = watcher.thrown.with_context(|| {
        format!(
            "{}: the ball of throw {wanted} was not let go by a hand, so there is nothing to repeat; give another --throw",
            path.display()
        )
    })?;
    thrown.name = format!("{}, throw {wanted} of {count}", thrown.name);
    if !watcher.heads.is_empty() {
        thrown.heads = watcher.heads;
    }
    let conditions = recording.conditions;
    thrown.buttons = Some([conditions.red, conditions.blue]);
    Ok(thrown)
}

/// Plays the inputs again until the throw is over.
fn replay(recording: &Recording, watcher: &mut Watcher) -> Result<()> {
    let header = &recording.header;
    let mut game = Game::new(recording.conditions.clone(), header.frames)
        .context("cannot set up the recorded alley")?;
    let mut recorded = recording.events.iter().peekable();
    for (index, input) in recording.inputs.iter().enumerate() {
        game.step(input);
        for event in game.events() {
            let same = recorded.next_if(|(at, _)| *at == index);
            // Another version may have brought the ball elsewhere: then this is not the recorded throw.
            if same
                .is_none_or(|(_, value)| serde_json::to_value(event).ok().as_ref() != Some(value))
            {
                bail!(
                    "its replay differs from the recording at {:.2} s: `bowling replay` says more",
                    game.time()
                );
            }
        }
        if watcher.look(&game) {
            break;
        }
    }
    Ok(())
}

/// Waits for a throw while a session is played again.
struct Watcher {
    wanted: usize,
    duration: f64,
    seen: usize,
    /// When the last ball was let go, until the throw is found [s].
    released: f64,
    candidate: Option<Candidate>,
    heads: Vec<(f64, Pose)>,
    thrown: Option<Thrown>,
}

impl Watcher {
    /// Takes notice of a frame; true when all is known.
    fn look(&mut self, game: &Game) -> bool {
        for event in game.events() {
            match &event.kind {
                EventKind::Released(release) if self.thrown.is_none() => {
                    if let Model::Ball(ball) = release.model {
                        self.candidate = candidate(game, ball, &release.used);
                        self.released = game.time();
                        self.heads.clear();
                    }
                }
                EventKind::ThrowStarted { frame, ball, .. } => {
                    self.seen += 1;
                    if self.seen == self.wanted {
                        let candidate = self.candidate.take();
                        self.thrown = candidate.map(|c| c.thrown(game, *frame, *ball));
                    }
                }
                EventKind::Settled { fallen, .. } => {
                    if let Some(thrown) = &mut self.thrown {
                        thrown.fallen = thrown.fallen.or(Some(fallen.len()));
                        thrown.counted = thrown.counted.or(Some(game.time() - self.released));
                    }
                }
                _ => {}
            }
        }
        let since = game.time() - self.released;
        if let Some(head) = game.head_pose_world() {
            self.heads.push((since, head));
        }
        let is_counted = |thrown: &Thrown| thrown.fallen.is_some();
        since > self.duration && self.thrown.as_ref().is_some_and(is_counted)
    }
}

/// The state in which a hand has just let a ball go.
fn candidate(game: &Game, ball: u8, velocity: &ReleaseVelocity) -> Option<Candidate> {
    let visible = game.visible();
    let seen = visible
        .iter()
        .find(|seen| seen.model == Model::Ball(ball))?;
    let pins = game.observe().pins;
    let standing = pins.iter().filter(|pin| pin.is_standing);
    Some(Candidate {
        ball,
        pose: seen.pose,
        linear: velocity.linear,
        angular: velocity.angular,
        pins: standing
            .map(|pin| (pin.number, (pin.position.x, pin.position.z)))
            .collect(),
        config: game.config().clone(),
    })
}

impl Candidate {
    fn thrown(self, game: &Game, frame: u32, ball: u32) -> Thrown {
        let name = match game.playing() {
            Some(button) => format!("{button}, frame {frame}, ball {ball}"),
            None => "practice".to_owned(),
        };
        Thrown {
            name,
            heads: vec![(0.0, onlooker(&self.config))],
            config: self.config,
            buttons: None,
            ball: self.ball,
            pose: self.pose,
            linear: self.linear,
            angular: self.angular,
            pins: self.pins,
            fallen: None,
            counted: None,
        }
    }
}

/// The head of a participant who has thrown and looks at the pins.
fn onlooker(config: &Config) -> Pose {
    let participant = &config.participant;
    let z = participant.stand_behind_foul_line_m;
    Pose::from_position(DVec3::new(0.0, participant.eye_height_m, z))
}

/// First line of the file of a shot.
#[derive(Deserialize)]
struct Head {
    format: String,
    version: u32,
    bodies: Vec<String>,
    release: Release,
    settings: Config,
}

/// A state of the file of a shot.
#[derive(Deserialize)]
struct State {
    time: f64,
}

/// Last line of the file of a shot.
#[derive(Deserialize)]
struct Tail {
    result: TailResult,
}

#[derive(Deserialize)]
struct TailResult {
    fallen: Vec<u8>,
}

fn of_shot(path: &Path) -> Result<Thrown> {
    let name = path.display();
    let text = fs::read_to_string(path).with_context(|| {
        format!("cannot read {name}: give a folder of `bowling play` or a file of `bowling shot --record`")
    })?;
    let first = text.lines().next().unwrap_or_default();
    let head: Head = serde_json::from_str(first).ok().filter(|head: &Head| head.format == FORMAT).with_context(
        || format!("{name} line 1: no throw of this program; give a folder of `bowling play` or a file of `bowling shot --record`"),
    )?;
    if head.version != VERSION {
        let version = head.version;
        bail!(
            "{name}: the throw is of version {version}, and this program reads version {VERSION}"
        );
    }
    let last = text.lines().last().unwrap_or_default();
    let tail: Tail = serde_json::from_str(last).with_context(|| {
        format!("{name}: the last line is no result, so the file was cut short")
    })?;
    let states = text.lines().rev().skip(1);
    let state = states.map(serde_json::from_str::<State>).next();
    let config = head.settings;
    config.check().with_context(|| name.to_string())?;
    let mut pins = Vec::new();
    for body in head
        .bodies
        .iter()
        .filter_map(|body| body.strip_prefix("pin "))
    {
        let number = body
            .parse()
            .with_context(|| format!("{name} line 1: `pin {body}` is no pin"))?;
        pins.push(number);
    }
    let release = head.release;
    let alley = BareAlley::new(&config, &pins).with_context(|| name.to_string())?;
    let spots = alley.pins().iter().map(|(number, id)| {
        let at = alley.world.body(*id).pose().position;
        (*number, (at.x, at.z))
    });
    let radius = config.balls.first().map_or(0.0, |ball| ball.radius_m());
    let (linear, angular) = release.velocities(radius);
    let z = config.lane.headpin_z_m + release.start;
    Ok(Thrown {
        name: "throw without a hand".to_owned(),
        buttons: None,
        ball: 0,
        pose: Pose::from_position(DVec3::new(release.offset, radius, z)),
        linear,
        angular,
        pins: spots.collect(),
        fallen: Some(tail.result.fallen.len()),
        counted: state.and_then(Result::ok).map(|state| state.time),
        heads: vec![(0.0, onlooker(&config))],
        config,
    })
}
