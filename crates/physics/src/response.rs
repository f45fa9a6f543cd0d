//! Collision response: the impulse of one impact, Eq. (3)-(9) of the paper in closed form.
//!
//! `n` is the unit normal from a to b, `dv` the velocity of a's contact point relative to b's (Eq. (8)), approaching
//! when `n.dv > 0`. `F` is the impulse on a, `-F` that on b (Eq. (3)-(6)), so that `dv' = dv + K F` with the
//! symmetric, positive definite `K` of [`compliance`]. With it Eq. (7), the energy, reads `F.(dv + dv') = 0`.

use glam::{DMat3, DVec3};

/// How a collision is answered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Response {
    /// Eq. (3)-(9) to the letter: what a replication of the experiment runs.
    UnoSlater,
    /// The same without pull and without hop.
    ///
    /// *Pull*: in about 2 % of random frictional collisions Eq. (9) draws the bodies together; the friction rate is
    /// then lowered until it does not. *Hop*: F11 turns sliding into bouncing, so that a ball can leave the lane
    /// faster than it came; the separating speed is limited to the approach speed. Both only lose energy.
    #[default]
    Guarded,
    /// Restitution with a cone of friction: the physical reference that the other two are judged against.
    ///
    /// The impulse is `(1+e) F00 + s (F01 - F00)` with the largest share s of 0 to 1 that keeps it in the cone
    /// |F_t| <= mu F_n (A. Chatterjee and A. Ruina, J. Appl. Mech. 65, 1998, with e_t = 0). `F01 - F00` is
    /// K-orthogonal to the normal: the bodies part with e times the approach speed whatever the friction does, and
    /// both terms lose energy by themselves.
    Coulomb,
}

/// Coefficients of a pair.
///
/// Under the paper's laws the products of the two objects' coefficients (§2.2), under Coulomb's those of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    /// Elasticity, or restitution, 0 to 1.
    pub elasticity: f64,
    /// Friction rate, 0 to 1; under Coulomb's law the coefficient of friction, 0 or more.
    pub friction: f64,
}

/// One body's share of `K`: `1/m - [r] I^-1 [r]` at the arm `r` from its centre of mass [1/kg].
pub fn compliance(inv_mass: f64, inv_inertia: &DMat3, arm: DVec3) -> DMat3 {
    let cross = DMat3::from_cols(
        DVec3::new(0.0, arm.z, -arm.y),
        DVec3::new(-arm.z, 0.0, arm.x),
        DVec3::new(arm.y, -arm.x, 0.0),
    );
    DMat3::from_diagonal(DVec3::splat(inv_mass)) - cross * *inv_inertia * cross
}

/// Impulse on a [N s], world frame; zero when the bodies separate already.
///
/// `k` is the sum of both bodies' [`compliance`]. Each of the four special impulses neither adds energy nor leaves
/// the bodies approaching, and Eq. (9) is a convex combination of them; kinetic energy is convex in the impulse, so
/// no coefficients from 0 to 1 ever add energy.
pub fn impulse(response: Response, pair: Coefficients, n: DVec3, dv: DVec3, k: &DMat3) -> DVec3 {
    let approach = n.dot(dv);
    let (e, mu) = (pair.elasticity, pair.friction);
    if mu == 0.0 || approach <= 0.0 {
        return smooth_impulse(e, n, dv, k);
    }
    let inverse = k.inverse();
    if response == Response::Coulomb {
        let f00 = inelastic_impulse(n, dv, k);
        let (smooth, rub) = (f00 * (1.0 + e), -(inverse * dv) - f00);
        return smooth + rub * share_in_cone(mu, -smooth.dot(n), n, rub);
    }
    let rough = rough_impulse(response, e, n, dv, &inverse);
    let pulls = response == Response::Guarded && rough.dot(n) > 0.0;
    if mu == 1.0 && !pulls {
        return rough;
    }
    let smooth = smooth_impulse(e, n, dv, k);
    let mu = if response == Response::Guarded {
        rate_without_pull(mu, smooth.dot(n), rough.dot(n))
    } else {
        mu
    };
    // Eq. (9), gathered by friction rate: (1-mu) [(1-e) F00 + e F10] + mu [(1-e) F01 + e F11].
    smooth * (1.0 - mu) + rough * mu
}

/// `(1-e) F00 + e F10`, the smooth end of Eq. (9): all that an impact without friction needs.
///
/// F10 = 2 F00 is the other root of Eq. (7) along n.
pub(crate) fn smooth_impulse(e: f64, n: DVec3, dv: DVec3, k: &DMat3) -> DVec3 {
    if n.dot(dv) <= 0.0 {
        return DVec3::ZERO;
    }
    inelastic_impulse(n, dv, k) * (1.0 + e)
}

/// F00: along n, and dv'.n = 0.
fn inelastic_impulse(n: DVec3, dv: DVec3, k: &DMat3) -> DVec3 {
    n * (-n.dot(dv) / n.dot(*k * n))
}

/// The largest share of `rub` that, added to the pressing impulse `pressed` [N s], stays in the cone of friction.
fn share_in_cone(mu: f64, pressed: f64, n: DVec3, rub: DVec3) -> f64 {
    let pull = rub.dot(n);
    // |s rub_t| <= mu (pressed - s pull)
    let demand = (rub - n * pull).length() + mu * pull;
    if demand <= mu * pressed {
        1.0
    } else {
        mu * pressed / demand
    }
}

/// `(1-e) F01 + e F11`, the rough end of Eq. (9).
fn rough_impulse(response: Response, e: f64, n: DVec3, dv: DVec3, k_inv: &DMat3) -> DVec3 {
    // F01: dv' = 0.
    let f01 = -(*k_inv * dv);
    if e == 0.0 {
        return f01;
    }
    // F11: dv' = -speed n with the energy kept; Eq. (7) leaves dv.K^-1 dv = speed^2 n.K^-1 n.
    let energy = (-dv.dot(f01)).max(0.0);
    let mut speed = (energy / n.dot(*k_inv * n)).sqrt();
    if response == Response::Guarded {
        speed = speed.min(n.dot(dv));
    }
    let f11 = *k_inv * (-n * speed - dv);
    if e == 1.0 {
        return f11;
    }
    f01 * (1.0 - e) + f11 * e
}

/// The largest friction rate up to `mu` whose impulse does not pull; the impulse along n is linear in it.
pub(crate) fn rate_without_pull(mu: f64, smooth: f64, rough: f64) -> f64 {
    let pull = smooth + mu * (rough - smooth);
    if pull <= 0.0 {
        mu
    } else {
        (smooth / (smooth - rough)).clamp(0.0, mu.max(0.0))
    }
}

/// The friction rate of one step of `dt` [s] for contacts that last, Eq. (9) being a rule for one impact.
///
/// `1 - (1 - mu)^(dt/reference)`: after `reference` seconds of contact the slip has shrunk by `1 - mu`, whatever
/// the step.
pub fn friction_rate_per_step(friction_rate: f64, dt: f64, reference: f64) -> f64 {
    if friction_rate >= 1.0 {
        return 1.0;
    }
    1.0 - libm::pow(1.0 - friction_rate, dt / reference)
}
