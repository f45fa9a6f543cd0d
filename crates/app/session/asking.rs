//! A session as a part of a study: what is asked, answered, noted and stopped.

use anyhow::{Context, Result};
use experiment::protocol::{AnsweredIn, Note, Place, Who};
use experiment::questionnaire::{Act, Form};
use experiment::staircase::Reply;

use super::Session;
use super::course::{Course, Throw};
use crate::study::seat;

const NO_STUDY: &str = "this session is no part of a study";

impl Session {
    /// The course of a study's session.
    pub fn course(&self) -> Option<&Course> {
        self.course.as_ref()
    }

    /// The form that is to be filled in now.
    pub fn form(&self) -> Option<&Form> {
        self.course()?.form()
    }

    /// True when a study's session is complete or was stopped.
    pub fn is_over(&self) -> bool {
        self.course
            .as_ref()
            .is_some_and(|course| course.protocol().is_over())
    }

    /// Takes an act at the form that is due.
    ///
    /// # Errors
    /// When no form is due, the act does not fit, or the journal cannot be written.
    pub fn answer(&mut self, act: Act, answered_in: AnsweredIn) -> Result<()> {
        let at_s = self.now();
        let course = self.course.as_mut().context(NO_STUDY)?;
        let (note, reached) = course.act(at_s, act, answered_in)?;
        self.journal.study(&note)?;
        self.reached(reached)
    }

    /// Takes what is said of the pair of throws that is to be compared.
    ///
    /// # Errors
    /// When none is, or the journal cannot be written.
    pub fn compare(&mut self, reply: Reply, answered_in: AnsweredIn) -> Result<()> {
        let at_s = self.now();
        let course = self.course.as_mut().context(NO_STUDY)?;
        let (note, reached) = course.compare(at_s, reply, answered_in)?;
        self.journal.study(&note)?;
        self.reached(reached)
    }

    /// Whether the participant is asked something now.
    pub fn is_asking(&self) -> bool {
        let place = self.course.as_ref().map(|course| course.protocol().place());
        matches!(place, Some(Place::Form(_) | Place::Comparing(_)))
    }

    /// The participant was told what the study is about.
    ///
    /// # Errors
    /// When this is no study's session, or the journal cannot be written.
    pub fn debriefed(&mut self) -> Result<()> {
        let reached = self.course.as_mut().context(NO_STUDY)?.debriefed();
        self.reached(reached)
    }

    /// Keeps a remark of the experimenter.
    ///
    /// # Errors
    /// When the journal cannot be written.
    pub fn remark(&mut self, text: String) -> Result<()> {
        let at_s = self.now();
        self.journal.study(&Note::Remark { text, at_s })
    }

    /// Ends a study's session at once.
    ///
    /// # Errors
    /// When this is no study's session, or the journal cannot be written.
    pub fn stop(&mut self, by: Who, reason: String) -> Result<()> {
        let at_s = self.now();
        let note = self
            .course
            .as_mut()
            .context(NO_STUDY)?
            .stop(by, reason, at_s);
        self.journal.study(&note)
    }

    fn reached(&mut self, place: Option<Place>) -> Result<()> {
        let at_s = self.now();
        match place {
            Some(place) => self.journal.study(&Note::Reached { place, at_s }),
            None => Ok(()),
        }
    }

    /// Lays the alley out for the throw of a pair that is due, once; whoever plays the journal again does it before the same input.
    pub(super) fn lay_out(&mut self) -> Result<()> {
        let throw = self.course.as_ref().and_then(Course::throw);
        let Some(Throw { pair, throw, value }) = throw else {
            return Ok(());
        };
        if self.laid_out == Some((pair, throw)) {
            return Ok(());
        }
        let plan = self.course.as_ref().and_then(Course::staircase_plan);
        let key = &plan.context(NO_STUDY)?.key;
        let config = seat::with_value(&self.game.conditions().lobby, key, value)?;
        let at_s = self.now();
        self.journal.study(&Note::Throw { pair, throw, at_s })?;
        self.game
            .lay_out(&config)
            .context("cannot lay out the alley")?;
        self.laid_out = Some((pair, throw));
        Ok(())
    }
}
