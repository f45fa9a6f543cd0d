//! The detection before a judge that shares no code with it.
#![allow(
    clippy::disallowed_methods,
    reason = "what is expected may come from any library"
)]

/// Answers in numbers: random poses far, near, touching and deep.
mod accuracy;
/// Bodies for which the gap is a formula: spheres, half-spaces, coaxial and axis-aligned bodies, capsules.
mod closed;
/// Bodies with one centre.
mod coincident;
/// Overlaps that are none.
mod doubt;
/// Faces, lines, rims and apexes that meet exactly, and one unit in the last place off.
mod exact;
/// Sizes of any magnitude.
mod extreme;
/// The time of impact.
mod impact;
/// What an answer claims of itself: its interval, its budget, its certificates.
mod intervals;
/// What the answers know about each other: mirrors, motions, sweeps.
mod laws;

mod judge;
#[path = "../support/mod.rs"]
mod support;

use glam::DVec3;
use judge::cases::Case;
use physics::query::{Limits, Separation, separation};

/// The solver's answer from `start`, within `limits`.
fn ask(case: &Case, start: Option<DVec3>, limits: Limits) -> Separation {
    let (a, b) = (case.a.shape(), case.b.shape());
    separation((&a, &case.pose_a), (&b, &case.pose_b), start, limits)
}

/// The solver's answer from a cold start within the default limits.
fn answer(case: &Case) -> Separation {
    ask(case, None, Limits::default())
}

/// What a test found wrong; it looks at everything before it fails.
#[derive(Default)]
struct Wrong {
    checks: usize,
    found: Vec<String>,
}

impl Wrong {
    /// Notes what `say` says unless `ok`.
    fn unless(&mut self, ok: bool, say: impl FnOnce() -> String) {
        self.checks += 1;
        if !ok {
            self.found.push(say());
        }
    }

    /// Fails if anything was wrong.
    fn end(self) {
        let shown = self.found.len().min(40);
        assert!(
            self.found.is_empty(),
            "{} of {} checks failed:\n{}",
            self.found.len(),
            self.checks,
            self.found[..shown].join("\n")
        );
        assert!(self.checks > 0, "nothing was checked");
    }
}
