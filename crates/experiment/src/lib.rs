//! The experiment: who plays what, what is asked, what is kept, and what it says. No graphics, no game, no clock.
//!
//! Knows neither balls nor headsets: the app hands over plain numbers and rows, and the times at which they happened.
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod analysis;
pub mod background;
pub mod behaviour;
pub mod consent;
pub mod digest;
pub mod files;
pub mod journal;
pub mod participant;
pub mod plan;
pub mod protocol;
pub mod questionnaire;
pub mod random;
pub mod record;
pub mod staircase;
pub mod study;
pub mod tables;
