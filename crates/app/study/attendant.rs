//! Who attends to a session: the experimenter at a terminal, or nobody, where a simulated participant answers.

use anyhow::Result;
use experiment::participant::Simulated;
use experiment::protocol::{AnsweredIn, Place};
use experiment::random::SplitMix64;
use experiment::staircase::Observer;
use winit::event_loop::EventLoop;

use super::console::Console;
use crate::session::Session;

/// How long a simulated participant takes to say whether two throws were the same [s].
const COMPARING_S: f64 = 1.5;

/// Who attends, and the windows that show what is attended to.
#[derive(Debug)]
pub struct Attendance {
    /// Who answers.
    pub attendant: Attendant,
    /// The window system, where a window of the study was there before the session's: a program has it once.
    pub events: Option<EventLoop<()>>,
}

/// Who answers, or asks the participant for answers.
#[derive(Debug)]
pub enum Attendant {
    /// The experimenter at a terminal.
    Console(Box<Console>),
    /// A simulated participant.
    Simulated(Box<Somebody>),
}

/// A simulated participant who takes time to answer.
#[derive(Debug)]
pub struct Somebody {
    person: Simulated,
    observer: Observer,
    seed: u64,
    /// Since when what is asked now has been asked [s]: after how many answers it came, and the time.
    asked: Option<(usize, f64)>,
    answers: usize,
}

impl Attendant {
    /// A participant who answers forms as `person` and pairs of throws as `observer`, with the chances that `seed` gives.
    pub fn simulated(person: Simulated, observer: Observer, seed: u64) -> Self {
        Self::Simulated(Box::new(Somebody {
            person,
            observer,
            seed,
            asked: None,
            answers: 0,
        }))
    }

    /// Does what is due and can be done now; never waits.
    ///
    /// # Errors
    /// When the journal cannot be written.
    pub fn attend(&mut self, session: &mut Session) -> Result<()> {
        match self {
            Self::Console(console) => console.attend(session),
            Self::Simulated(somebody) => somebody.answer(session),
        }
    }
}

impl Somebody {
    /// Answers what was asked long enough ago, and listens to the debriefing.
    fn answer(&mut self, session: &mut Session) -> Result<()> {
        let place = session.course().map(|course| course.protocol().place());
        match place {
            Some(Place::Form(stage)) => {
                let Some(item) = session.form().and_then(|form| form.current()) else {
                    return Ok(());
                };
                let (act, thinks_s) = self.person.answer(stage, item);
                if self.has_thought(session, thinks_s) {
                    session.answer(act, AnsweredIn::Script)?;
                }
            }
            Some(Place::Comparing(number)) => {
                let trial = session.course().and_then(|course| course.trial());
                let difference = trial.map_or(0.0, |trial| trial.difference);
                // The number alone decides: who takes the session up again is the same person.
                let mut random = SplitMix64::for_index(self.seed, u64::from(number));
                let reply = self.observer.reply(difference, &mut random);
                if self.has_thought(session, COMPARING_S) {
                    session.compare(reply, AnsweredIn::Script)?;
                }
            }
            Some(Place::Debriefing) => session.debriefed()?,
            _ => {}
        }
        Ok(())
    }

    /// Whether what is asked now was asked `thinks_s` ago [s]; the next question begins when it was.
    fn has_thought(&mut self, session: &Session, thinks_s: f64) -> bool {
        let now = session.game().time();
        let (_, since) = *self
            .asked
            .filter(|(answers, _)| *answers == self.answers)
            .as_ref()
            .unwrap_or(&(self.answers, now));
        self.asked = Some((self.answers, since));
        let has_thought = now - since >= thinks_s;
        self.answers += usize::from(has_thought);
        has_thought
    }
}
