//! What the experiment notes in a session's journal.

use serde::{Deserialize, Serialize};

use super::Place;
use crate::consent::Consent;
use crate::questionnaire::{Logged, Stage};
use crate::staircase::Reply;

/// Who stopped a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Who {
    /// The participant.
    Participant,
    /// The experimenter.
    Experimenter,
}

/// Where a form was filled in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AnsweredIn {
    /// On the panel in the room.
    Headset,
    /// In a window or a terminal.
    Desk,
    /// By a simulated participant.
    Script,
}

/// What the experiment notes in the journal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "note", rename_all = "snake_case")]
pub enum Note {
    /// The gate was passed.
    Consent(Consent),
    /// The session reached a place.
    Reached {
        /// Which.
        place: Place,
        /// Since the session began [s].
        at_s: f64,
    },
    /// One act at a form.
    Form {
        /// Which form.
        form: Stage,
        /// What was done.
        act: Logged,
        /// Where.
        answered_in: AnsweredIn,
    },
    /// The alley was laid out for a throw of a pair; with which value follows from the plan and the replies.
    Throw {
        /// Number of the pair, from 1.
        pair: u32,
        /// Throw of the pair, 1 or 2.
        throw: u8,
        /// Since the session began [s].
        at_s: f64,
    },
    /// What was said of a pair of throws.
    Reply {
        /// Number of the pair, from 1.
        pair: u32,
        /// What.
        reply: Reply,
        /// Where.
        answered_in: AnsweredIn,
        /// Since the session began [s].
        at_s: f64,
    },
    /// A remark of the experimenter; it may identify somebody.
    Remark {
        /// The words.
        text: String,
        /// Since the session began [s].
        at_s: f64,
    },
    /// The session was stopped.
    Stopped {
        /// By whom.
        by: Who,
        /// Why.
        reason: String,
        /// Since the session began [s].
        at_s: f64,
    },
    /// The program was begun or begun again.
    Clock {
        /// Coordinated Universal Time, `YYYY-MM-DDThh:mm:ssZ`.
        utc: String,
        /// Since the session began [s].
        at_s: f64,
    },
}
