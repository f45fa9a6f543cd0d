//! The judge of the detection: what is true about two placed shapes, by formulas of its own.
//!
//! It shares no code with the solver. A shape is known here by its support height and by a bound on how far a point
//! lies outside; what follows from these is brought about by construction (`built`), bounded from both sides by the
//! two formulas, or searched by brute force (`oracle`).
#![allow(
    dead_code,
    reason = "tests and benches each use their own part of the judge"
)]

pub mod built;
pub mod cases;
pub mod hull;
pub mod known;
pub mod line;
pub mod oracle;
pub mod slender;
pub mod verdict;
