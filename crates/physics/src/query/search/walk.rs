//! Following a way over the sphere: through kinks behind which s rises, up to the one behind which it falls.

use glam::DVec3;

use super::super::cores::Core;
use super::super::pair::{OF_B, Tips};
use super::super::path::Path;
use super::{ROUNDING, Search};

/// How a way ended.
pub(super) enum End {
    /// At an ordinary normal; `whole` if nothing stopped it short of where it was to go.
    Open {
        x: f64,
        n: DVec3,
        tips: Tips,
        whole: bool,
    },
    /// On a kink that it must not cross, with the support points below it.
    Kink { index: usize, n: DVec3, below: Tips },
}

/// What a look at the kinks on a way tells.
enum Look {
    Clear,
    /// s rises no farther than to here; `again` if the way to there has to be looked at again.
    Shorten {
        x: f64,
        again: bool,
    },
    Kink {
        index: usize,
        n: DVec3,
        below: Tips,
    },
}

impl<A: Core, B: Core> Search<'_, A, B> {
    /// Follows a way up to `end`; `rise` is the slope of s at its start.
    #[inline(always)]
    pub(super) fn walk<P: Path>(&self, path: &P, rise: f64, end: f64) -> End {
        let (pair, held) = (self.pair, self.held);
        let sides = self.tips.sides();
        let mut x = end;
        let mut whole = true;
        let mut n = path.at(x);
        let mut tips = pair.tips_held(n, held, sides);
        for _ in 0..4 {
            if tips.sides() == sides {
                break;
            }
            match self.look(path, rise, x, sides ^ tips.sides()) {
                Look::Clear => break,
                Look::Kink { index, n, below } => return End::Kink { index, n, below },
                Look::Shorten { x: shorter, again } => {
                    x = shorter;
                    whole = false;
                    n = path.at(x);
                    tips = pair.tips_held(n, held, sides);
                    if !again {
                        break;
                    }
                }
            }
        }
        for _ in 0..12 {
            if n.dot(pair.between(&tips)) >= self.s - ROUNDING * pair.size {
                break;
            }
            x *= 0.35;
            whole = false;
            n = path.at(x);
            tips = pair.tips_held(n, held, sides);
        }
        End::Open { x, n, tips, whole }
    }

    /// Looks at the kinks (`crossed`, as bits) between the start of the way and `end`, in their order.
    #[inline(never)]
    fn look<P: Path>(&self, path: &P, rise: f64, end: f64, crossed: u8) -> Look {
        let (pair, held) = (self.pair, self.held);
        let mut list = [(0.0, 0usize, DVec3::ZERO); 2 * OF_B];
        let mut count = 0;
        let small = pair.a.has_small_circle() || pair.b.has_small_circle();
        for index in (0..2 * OF_B).filter(|i| crossed >> i & 1 == 1) {
            if let Some((x, n)) = path.meets(&pair.circle(index), index, end) {
                let mut at = count;
                while at > 0 && list[at - 1].0 > x {
                    list[at] = list[at - 1];
                    at -= 1;
                }
                list[at] = (x, index, n);
                count += 1;
            }
        }
        let list = &list[..count];
        let mut sides = self.tips.sides();
        let (mut from, mut slope) = (0.0, rise);
        for &(x, index, n) in list {
            let bit = 1u8 << index;
            if small {
                // A small circle may have been crossed twice in between: then the way there comes first.
                let ties = list.iter().filter(|k| (k.0 - x).abs() < 1e-12);
                let ties = ties.fold(bit, |bits, k| bits | 1 << k.1);
                let seen = pair.tips_held(n, held, sides).sides();
                if (seen ^ sides) & !ties != 0 && x < end {
                    return Look::Shorten { x, again: true };
                }
            }
            let tips = pair.tips_on(n, sides);
            let heading = path.heading(n);
            let before = heading.dot(pair.between(&tips));
            if before < 0.0 {
                // The top lies before the kink: as regula falsi finds it.
                if x <= from {
                    return Look::Clear;
                }
                let share = (slope / (slope - before)).clamp(0.05, 0.95);
                let x = from + (x - from) * share;
                return Look::Shorten { x, again: false };
            }
            sides ^= bit;
            let circle = &pair.circle(index);
            let after = before - circle.jump * circle.axis.dot(heading).abs() / circle.radius;
            if after <= 0.0 {
                return self.stop_at(index, n, sides);
            }
            (from, slope) = (x, after);
        }
        Look::Clear
    }

    /// The kink `index` ends the way, unless rounding puts it below where the way began.
    #[inline(always)]
    fn stop_at(&self, index: usize, n: DVec3, sides: u8) -> Look {
        let pair = self.pair;
        let on_one = self.held == 0;
        let n = if on_one {
            pair.circle(index).nearest(n).unwrap_or(n)
        } else {
            n
        };
        let below = pair.tips_on(n, sides & !(self.held | 1 << index));
        let s = n.dot(pair.between(&below));
        // Circles that almost touch cross in no exact normal: what is held there would not be what s is.
        let exact = on_one || s - pair.gap(n) <= 10.0 * ROUNDING * pair.size;
        if exact && s >= self.s - 10.0 * ROUNDING * pair.size {
            Look::Kink { index, n, below }
        } else {
            Look::Clear
        }
    }
}
