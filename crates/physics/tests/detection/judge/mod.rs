//! The judge of the detection: what is true about two placed shapes, by formulas of its own.
//!
//! It shares no code with the solver. A shape is known here by its support height alone; what follows from that,
//! the largest gap over all normals, is searched by brute force.
#![allow(
    dead_code,
    reason = "tests and benches each use their own part of the judge"
)]

pub mod cases;
pub mod known;
