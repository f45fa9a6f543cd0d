//! Writes down what happens while a session is played again.

mod device;

use std::collections::VecDeque;

use anyhow::{Context, Result};
use experiment::protocol::{AnsweredIn, Note};
use experiment::questionnaire::{Form, Logged, Stage};
use experiment::record::{
    EventRow, FilledForm, MotionRow, Run, SessionRecord, Status, Task, TrialType,
};
use experiment::study::{ParticipantId, Study};
use game::{EventKind, Game, Model, TrackedPart};
use physics::Pose;

use super::approaches::Approaches;
use super::folder::Progress;
use crate::journal::Story;
use crate::output;
use crate::session::course::colour;

/// A session as rows, while it is played again.
pub struct Scribe {
    rate_hz: f64,
    /// When the game waited for its device: after how many inputs, and how long [s].
    pauses: VecDeque<(usize, Option<f64>)>,
    /// Throws of pairs, by how many inputs there were before the alley was laid out for each: pair and throw.
    throws: VecDeque<(usize, [u32; 2])>,
    /// The throw of a pair that is to be made.
    throw: Option<[u32; 2]>,
    frames: usize,
    runs: Vec<Run>,
    /// When each run began, since the session did [s].
    begins: Vec<f64>,
    /// What happened before the first game, by time since the session began.
    training: Vec<EventRow>,
    /// When the run under way began, since the session did [s].
    run_began: Option<f64>,
    games_over: u8,
    /// When the last ball was let go, since the session began [s].
    released: f64,
    /// When head and hand were lost, since the session began [s].
    lost: [Option<f64>; 2],
    approaches: Approaches,
}

impl Scribe {
    /// Of a session that a journal tells.
    pub fn new(story: &Story) -> Self {
        let number = |note: &serde_json::Value, key: &str| note[key].as_u64().unwrap_or(0) as u32;
        let laid_out = story
            .notes
            .iter()
            .filter(|(_, note)| note["note"] == "throw");
        let throws =
            laid_out.map(|(at, note)| (*at, [number(note, "pair"), number(note, "throw")]));
        Self {
            throws: throws.collect(),
            throw: None,
            begins: Vec::new(),
            rate_hz: device::provenance(&story.header, &story.device).refresh_hz,
            pauses: device::pauses(&story.device).into(),
            frames: 0,
            runs: Vec::new(),
            training: Vec::new(),
            run_began: None,
            games_over: 0,
            released: 0.0,
            lost: [None; 2],
            approaches: Approaches::default(),
        }
    }

    /// Takes down the frame that `game` has finished.
    pub fn frame(&mut self, game: &Game) {
        while let Some((_, throw)) = self.throws.pop_front_if(|(at, _)| *at <= self.frames) {
            self.throw = Some(throw);
            if self.run_began.is_none() {
                self.begin(game.time(), Task::Pairs);
            }
        }
        for event in game.events() {
            self.event(game, &event.kind);
        }
        self.frames += 1;
        let frames = self.frames;
        while let Some((_, seconds)) = self.pauses.pop_front_if(|(at, _)| *at <= frames) {
            let pause = device::pause(game.time(), seconds);
            self.put(pause);
        }
        if let (Some(began), Some(run)) = (self.run_began, self.runs.last_mut()) {
            self.approaches.frame(game);
            run.motion.push(MotionRow {
                time_s: game.time() - began,
                head: game.head_pose_world().map(numbers),
                hand: game.hand_pose_world().map(numbers),
            });
        }
    }

    fn event(&mut self, game: &Game, kind: &EventKind) {
        let now = game.time();
        match kind {
            EventKind::GameStarted { button } => {
                let button = colour(*button);
                let number = self.games_over + 1;
                self.begin(now, Task::Game { number, button });
                self.row(now, TrialType::GameStart, |row| row.button = Some(button));
            }
            EventKind::GameOver { button, .. } => {
                self.row(now, TrialType::GameEnd, |row| {
                    row.button = Some(colour(*button));
                });
                self.end_run();
                self.games_over += 1;
            }
            EventKind::Released(release) if matches!(release.model, Model::Ball(_)) => {
                self.released = now;
            }
            EventKind::Settled { fallen, .. } if !self.is_game() => {
                let (released, pins) = (self.released, fallen.len() as u32);
                // What is thrown while a pair is asked about does not count either.
                let throw = self.throw.take();
                let kind = match throw {
                    Some(_) => TrialType::BallRoll,
                    None => TrialType::TrainingThrow,
                };
                self.row(released, kind, |row| {
                    row.duration_s = Some(now - released);
                    row.pins_down = Some(pins);
                    row.frame = throw.map(|[pair, _]| pair);
                    row.ball = throw.map(|[_, throw]| throw);
                });
            }
            EventKind::Rolled {
                button,
                frame,
                ball,
                roll,
            } => {
                let released = self.released;
                self.row(released, TrialType::BallRoll, |row| {
                    row.duration_s = Some(now - released);
                    row.button = Some(colour(*button));
                    row.frame = Some(*frame);
                    row.ball = Some(*ball);
                    row.pins_down = Some(u32::from(roll.fallen));
                });
            }
            EventKind::Refused { button } => {
                self.row(now, TrialType::RefusedPress, |row| {
                    row.button = Some(colour(*button));
                });
            }
            EventKind::Tracking { part, found } => self.tracking(now, *part, *found),
            _ => {}
        }
    }

    /// The run under way is over, or was broken off.
    fn end_run(&mut self) {
        self.run_began = None;
        let rows = self.approaches.take();
        if let Some(run) = self.runs.last_mut() {
            run.events.extend(rows);
        }
    }

    /// Whether a game is under way.
    fn is_game(&self) -> bool {
        let task = self.runs.last().map(|run| run.task);
        self.run_began.is_some() && matches!(task, Some(Task::Game { .. }))
    }

    fn begin(&mut self, now: f64, task: Task) {
        self.end_run();
        self.run_began = Some(now);
        self.begins.push(now);
        self.runs.push(Run {
            number: self.runs.len() as u32 + 1,
            task,
            began: String::new(),
            sampling_hz: self.rate_hz,
            motion: Vec::new(),
            events: Vec::new(),
        });
    }

    fn tracking(&mut self, now: f64, part: TrackedPart, found: bool) {
        let lost = &mut self.lost[part as usize];
        if !found {
            *lost = Some(now);
        } else if let Some(since) = lost.take() {
            self.row(since, TrialType::TrackingLost, |row| {
                row.duration_s = Some(now - since);
                row.object = Some(
                    match part {
                        TrackedPart::Head => "head",
                        TrackedPart::Hand => "hand",
                    }
                    .to_owned(),
                );
            });
        }
    }

    /// Adds a row to the run under way, or to the last one, or to what was before the first.
    fn row(&mut self, at: f64, kind: TrialType, fill: impl FnOnce(&mut EventRow)) {
        let mut row = EventRow::new(at, kind);
        fill(&mut row);
        self.put(row);
    }

    fn put(&mut self, row: EventRow) {
        match self.runs.last_mut() {
            Some(run) => run.events.push(row),
            None => self.training.push(row),
        }
    }

    /// The session's record; `who` is the participant, the session's number and the slot.
    ///
    /// # Errors
    /// When the journal's notes cannot be understood.
    pub fn finish(
        mut self,
        study: &Study,
        who: (&ParticipantId, u32, u32),
        progress: &Progress,
        played_s: f64,
    ) -> Result<SessionRecord> {
        let notes = notes(progress)?;
        let consent = notes
            .iter()
            .find_map(|note| match note {
                Note::Consent(consent) => Some(consent.clone()),
                _ => None,
            })
            .context("the journal has no consent")?;
        let clock = notes.iter().find_map(|note| match note {
            Note::Clock { utc, .. } => Some(utc.clone()),
            _ => None,
        });
        let began = clock.unwrap_or_else(|| format!("{}T00:00:00Z", consent.date));
        self.end_run();
        self.stopped(&notes);
        self.settle(&began)?;
        let header = &progress.story.header;
        let (participant, session, slot) = who;
        Ok(SessionRecord {
            participant: participant.clone(),
            session,
            slot,
            status: if progress.is_open() || progress.protocol.place() == STOPPED {
                Status::Partial
            } else {
                Status::Complete
            },
            consent,
            forms: forms(study, &notes)?,
            runs: self.runs,
            pairs: progress.pairs.clone(),
            provenance: device::provenance(header, &progress.story.device),
            began,
            immersed_s: played_s,
        })
    }

    fn stopped(&mut self, notes: &[Note]) {
        for note in notes {
            if let Note::Stopped { at_s, .. } = note {
                self.row(*at_s, TrialType::Stop, |_| ());
            }
        }
    }

    /// Counts the times of a run's rows from its own beginning, and puts them in their order.
    fn settle(&mut self, session_began: &str) -> Result<()> {
        let mut training = std::mem::take(&mut self.training);
        for (run, began) in self.runs.iter_mut().zip(&self.begins) {
            run.events.splice(0..0, training.drain(..));
            for row in &mut run.events {
                row.onset_s -= began;
            }
            run.events.sort_by(|a, b| a.onset_s.total_cmp(&b.onset_s));
            run.began = output::utc_later(session_began, *began)
                .with_context(|| format!("{session_began:?} is no time"))?;
        }
        Ok(())
    }
}

const STOPPED: experiment::protocol::Place = experiment::protocol::Place::Stopped;

fn numbers(pose: Pose) -> [f64; 7] {
    let [x, y, z] = pose.position.to_array();
    let [qx, qy, qz, qw] = pose.rotation.to_array();
    [x, y, z, qx, qy, qz, qw]
}

fn notes(progress: &Progress) -> Result<Vec<Note>> {
    let notes = progress.story.notes.iter();
    notes
        .map(|(_, note)| serde_json::from_value(note.clone()))
        .collect::<Result<_, _>>()
        .context("the journal has a note that cannot be understood")
}

/// The forms that were begun, in the order of a session.
fn forms(study: &Study, notes: &[Note]) -> Result<Vec<FilledForm>> {
    let mut acts: Vec<(Stage, AnsweredIn, Vec<Logged>)> = Vec::new();
    for note in notes {
        let Note::Form {
            form,
            act,
            answered_in,
        } = note
        else {
            continue;
        };
        match acts.iter_mut().find(|(stage, _, _)| stage == form) {
            Some((_, place, log)) => {
                *place = *answered_in;
                log.push(act.clone());
            }
            None => acts.push((*form, *answered_in, vec![act.clone()])),
        }
    }
    let each_game = study.plan().session.items_after_each_game;
    let filled = acts.into_iter().map(|(stage, place, log)| {
        let form = Form::new(study.questionnaire(), stage, each_game).replay(&log)?;
        Ok(FilledForm {
            answered_in: place,
            answers: form.answers(),
        })
    });
    filled.collect()
}
