//! Who attends to a session: the experimenter at a terminal, or nobody, where a simulated participant answers.

use anyhow::Result;
use experiment::participant::Simulated;
use experiment::protocol::{AnsweredIn, Place};

use super::console::Console;
use crate::session::Session;

/// Who answers, or asks the participant for answers.
#[derive(Debug)]
pub enum Attendant {
    /// The experimenter at a terminal.
    Console(Box<Console>),
    /// A simulated participant.
    Simulated(Box<Simulated>),
}

impl Attendant {
    /// Does what is due and can be done now; never waits.
    ///
    /// # Errors
    /// When the journal cannot be written.
    pub fn attend(&mut self, session: &mut Session) -> Result<()> {
        match self {
            Self::Console(console) => console.attend(session),
            Self::Simulated(participant) => answer(participant, session),
        }
    }
}

/// A simulated participant answers everything at once and listens to the debriefing.
fn answer(participant: &Simulated, session: &mut Session) -> Result<()> {
    let place = |session: &Session| session.course().map(|course| course.protocol().place());
    while let Some(Place::Form(stage)) = place(session) {
        let Some(item) = session.form().and_then(|form| form.current()) else {
            return Ok(());
        };
        let (act, _) = participant.answer(stage, item);
        session.answer(act, AnsweredIn::Script)?;
    }
    if place(session) == Some(Place::Debriefing) {
        session.debriefed()?;
    }
    Ok(())
}
