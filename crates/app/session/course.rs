//! A session as a part of a study: what is due, what is answered, and what of it the journal is told.

use anyhow::{Context, Result};
use experiment::plan::{Button as Colour, SessionRules};
use experiment::protocol::{AnsweredIn, Happening, Note, Place, Protocol, Who};
use experiment::questionnaire::{Act, Form, Logged, Questionnaire};
use experiment::record::{Compared, Pairs};
use experiment::staircase::{Reply, Staircase, StaircasePlan, Trial};
use game::{Button, EventKind};

use crate::journal::Story;

/// What a plan says of one session.
#[derive(Debug, Clone)]
pub struct Plan {
    /// What happens in it.
    pub rules: SessionRules,
    /// Button of game one.
    pub first: Colour,
    /// What is asked.
    pub questionnaire: Questionnaire,
    /// Pairs of throws instead of games, and their seed.
    pub staircase: Option<(StaircasePlan, u64)>,
}

/// The course of a session under way.
#[derive(Debug)]
pub struct Course {
    plan: Plan,
    protocol: Protocol,
    form: Option<Form>,
    is_in_game: bool,
    staircase: Option<Staircase>,
    /// What was said of the pairs.
    compared: Vec<Compared>,
}

/// A throw of a pair, and the value that it is made with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Throw {
    /// Number of the pair, from 1.
    pub pair: u32,
    /// Throw of the pair, 1 or 2.
    pub throw: u8,
    /// The parameter.
    pub value: f64,
}

/// A button as the plan calls it.
pub fn colour(button: Button) -> Colour {
    match button {
        Button::Red => Colour::Red,
        Button::Blue => Colour::Blue,
    }
}

/// A button as the game calls it.
pub fn button(colour: Colour) -> Button {
    match colour {
        Colour::Red => Button::Red,
        Colour::Blue => Button::Blue,
    }
}

impl Course {
    /// From its beginning.
    ///
    /// # Errors
    /// When the plan's staircase cannot be run.
    pub fn new(plan: Plan) -> Result<Self> {
        let mut protocol = Protocol::new(plan.rules.clone(), plan.first, &plan.questionnaire);
        let staircase = match &plan.staircase {
            Some((staircase, seed)) => {
                protocol = protocol.comparing(staircase.trials);
                Some(Staircase::new(staircase, *seed)?)
            }
            None => None,
        };
        let mut course = Self {
            plan,
            protocol,
            form: None,
            is_in_game: false,
            staircase,
            compared: Vec::new(),
        };
        course.lay_out();
        Ok(course)
    }

    /// Tells it what the journals of a session that was broken off have of it.
    ///
    /// # Errors
    /// When they do not fit the plan.
    pub fn catch_up(&mut self, story: &Story) -> Result<()> {
        let mut notes = story.notes.iter().peekable();
        let mut events = story.events.iter().peekable();
        for count in 0..=story.inputs.len() {
            while let Some((_, event)) = events.next_if(|(at, _)| at + 1 == count) {
                self.hear(&serde_json::from_value(event.clone())?);
            }
            while let Some((_, note)) = notes.next_if(|(at, _)| *at == count) {
                self.recall(note)?;
            }
        }
        notes.try_for_each(|(_, note)| self.recall(note))
    }

    fn recall(&mut self, note: &serde_json::Value) -> Result<()> {
        let note: Note = serde_json::from_value(note.clone())
            .context("the journal has a note that cannot be understood")?;
        match note {
            Note::Form {
                act, answered_in, ..
            } => {
                self.act(act.at_s, act.act, answered_in)
                    .context("the journal's answers do not fit the study's questionnaire")?;
            }
            Note::Reached {
                place: Place::Complete,
                ..
            } => {
                self.debriefed();
            }
            Note::Stopped { .. } => {
                self.happen(Happening::Stop);
            }
            Note::Reply {
                reply,
                answered_in,
                at_s,
                ..
            } => {
                self.compare(at_s, reply, answered_in)
                    .context("the journal's replies do not fit the study's plan")?;
            }
            Note::Consent(_)
            | Note::Reached { .. }
            | Note::Remark { .. }
            | Note::Clock { .. }
            | Note::Throw { .. } => {}
        }
        Ok(())
    }

    /// Where the session is.
    pub fn protocol(&self) -> &Protocol {
        &self.protocol
    }

    /// The form that is to be filled in.
    pub fn form(&self) -> Option<&Form> {
        self.form.as_ref()
    }

    /// What is compared, in a study of differences.
    pub fn staircase_plan(&self) -> Option<&StaircasePlan> {
        self.plan.staircase.as_ref().map(|(plan, _)| plan)
    }

    /// From which answer about sickness on ending the session is advised.
    pub fn sickness_stop(&self) -> u8 {
        self.plan.rules.sickness_stop
    }

    /// Takes what happened in the alley; returns where the session has got to by it.
    pub fn hear(&mut self, event: &EventKind) -> Option<Place> {
        let happening = match event {
            EventKind::GameStarted { button } => Happening::GameStarted(colour(*button)),
            EventKind::GameOver { .. } => Happening::GameOver,
            EventKind::Settled { .. } if !self.is_in_game => Happening::PracticeThrow,
            _ => return None,
        };
        match happening {
            Happening::GameStarted(_) => self.is_in_game = true,
            Happening::GameOver => self.is_in_game = false,
            _ => {}
        }
        self.happen(happening)
    }

    /// Takes an act at the form that is due, at `at_s` since the session began [s], done in `answered_in`; returns the note of it, and where the
    /// session has got to by it.
    ///
    /// # Errors
    /// When no form is due or the act does not fit; nothing has changed then.
    pub fn act(
        &mut self,
        at_s: f64,
        act: Act,
        answered_in: AnsweredIn,
    ) -> Result<(Note, Option<Place>)> {
        let Place::Form(stage) = self.protocol.place() else {
            anyhow::bail!("no question is due now");
        };
        let form = self.form.as_mut().context("no question is due now")?;
        form.act(at_s, act)?;
        let act: Logged = form
            .log()
            .last()
            .cloned()
            .context("an act that was taken is in the form's log")?;
        let note = Note::Form {
            form: stage,
            act,
            answered_in,
        };
        let is_done = form.current().is_none();
        let reached = is_done.then(|| self.happen(Happening::FormDone)).flatten();
        Ok((note, reached))
    }

    /// The throw that is to be made now, in a study of differences.
    pub fn throw(&self) -> Option<Throw> {
        let Place::Pair { number, throw } = self.protocol.place() else {
            return None;
        };
        let trial = self.staircase.as_ref()?.open_trial()?;
        Some(Throw {
            pair: number,
            throw,
            value: if throw == 1 {
                trial.first
            } else {
                trial.second
            },
        })
    }

    /// The pair that is to be compared now, as a part of the range, for a participant that is a program.
    pub fn trial(&self) -> Option<Trial> {
        let Place::Comparing(_) = self.protocol.place() else {
            return None;
        };
        self.staircase.as_ref()?.open_trial()
    }

    /// Takes what was said of the pair, as [`Course::act`] takes answers.
    ///
    /// # Errors
    /// When no pair is to be compared; nothing has changed then.
    pub fn compare(
        &mut self,
        at_s: f64,
        reply: Reply,
        answered_in: AnsweredIn,
    ) -> Result<(Note, Option<Place>)> {
        let trial = self.trial().context("no pair is to be compared now")?;
        let staircase = self.staircase.as_mut();
        staircase.context("the plan has no pairs")?.reply(reply)?;
        self.compared.push(Compared {
            trial,
            reply,
            at_s,
            answered_in,
        });
        let note = Note::Reply {
            pair: trial.number,
            reply,
            answered_in,
            at_s,
        };
        Ok((note, self.happen(Happening::Compared)))
    }

    /// The pairs so far, in a study of differences.
    pub fn pairs(&self) -> Option<Pairs> {
        Some(Pairs {
            compared: self.compared.clone(),
            estimate: self.staircase.as_ref()?.estimate(),
        })
    }

    /// The participant was told what the study is about.
    pub fn debriefed(&mut self) -> Option<Place> {
        self.happen(Happening::Debriefed)
    }

    /// Ends the session at once; returns the note of it.
    pub fn stop(&mut self, by: Who, reason: String, at_s: f64) -> Note {
        self.happen(Happening::Stop);
        Note::Stopped { by, reason, at_s }
    }

    fn happen(&mut self, happening: Happening) -> Option<Place> {
        let before = self.protocol.place();
        // What has no place here changes nothing: a ball that rolls while the participant reads.
        let place = self.protocol.happen(happening).ok()?;
        if place == before {
            return None;
        }
        self.lay_out();
        Some(place)
    }

    /// Takes out the form, or draws the pair, that is due.
    fn lay_out(&mut self) {
        if let Place::Pair { throw: 1, .. } = self.protocol.place()
            && let Some(staircase) = &mut self.staircase
            && staircase.open_trial().is_none()
        {
            staircase
                .next_trial()
                .expect("the last pair has its reply, or this place is not reached");
        }
        self.form = match self.protocol.place() {
            Place::Form(stage) => Some(Form::new(
                &self.plan.questionnaire,
                stage,
                self.plan.rules.items_after_each_game,
            )),
            _ => None,
        };
    }
}
