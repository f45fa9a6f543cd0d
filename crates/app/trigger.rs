//! When a trigger counts as pulled, for what is chosen by it.

/// It counts as pulled from here up, and as let go from the other down.
pub const PULLED: f64 = 0.6;
const LET_GO: f64 = 0.4;

/// A trigger that is followed from frame to frame.
#[derive(Debug, Default)]
pub struct Trigger {
    is_pulled: bool,
}

impl Trigger {
    /// One that has to be let go before it counts.
    pub fn held() -> Self {
        Self { is_pulled: true }
    }

    /// Follows it to `value`, from 0 (open) to 1 (closed); tells whether it was pulled just now.
    pub fn press(&mut self, value: f64) -> bool {
        let was_pulled = self.is_pulled;
        self.is_pulled = value > if was_pulled { LET_GO } else { PULLED };
        self.is_pulled && !was_pulled
    }
}
