//! Time: how long two bodies need not be looked at, and when they touch.
//!
//! A normal with a positive gap parts two shapes until they have moved that gap towards each other; with bounds of
//! their motions it is a [`Certificate`] for a length of time. Conservative advancement goes from one such time to the
//! next: along the normal, as far as the planes prove the shapes apart, then with a new normal from there
//! ([`time_of_impact`]). A step of the world does the same with its own motions (`step/approach.rs`).

mod certificate;
mod impact;
mod stretch;

pub use certificate::{Certificate, Course, time_to_close};
pub use impact::{TimeOfImpact, Travel, time_of_impact};
pub(crate) use stretch::{Grade, Held, hold};
