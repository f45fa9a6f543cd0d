//! The first-order search that the second-order one is measured against: the reflection of the separating vector.
//!
//! K. Chung and W. Wang, *Quick Collision Detection of Polytopes in Virtual Environments*, VRST 1996, 125-131: if the
//! support points p of a along n and q of b along -n do not part the bodies, n is reflected at the plane square to
//! q - p. It tells whether two bodies are apart, not how far.

use super::oracle::{Placed, support};

/// Whether a normal that parts two shapes was found, and how many new ones that took.
pub fn apart(a: Placed, b: Placed, cap: u32) -> (bool, u32) {
    let Some(mut n) = (b.1.position - a.1.position).try_normalize() else {
        return (false, 0);
    };
    for iteration in 0..=cap {
        let between = support(b, -n) - support(a, n);
        if n.dot(between) > 0.0 {
            return (true, iteration);
        }
        let Some(r) = between.try_normalize() else {
            return (false, iteration);
        };
        n -= r * (2.0 * r.dot(n));
    }
    (false, cap)
}
