//! Friction of contacts that last: what the laws take of a slip.

use glam::DVec3;

/// What a lasting contact takes of the slip in half a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Friction {
    None,
    /// This share of it, Eq. (9) with e = 0.
    Rate(f64),
    /// All, as far as the tangential impulse stays below this multiple of the normal one.
    Cone(f64),
}

/// What friction makes of the motion of a whole base.
pub(crate) struct Hold {
    /// Impulse of the friction [N s].
    pub impulse: DVec3,
    /// Velocity along the face that is left [m/s], and angular momentum about the normal [N m s].
    pub along: DVec3,
    pub spin: DVec3,
}

impl Hold {
    /// Friction of a base of `radius` [m] on a body of mass `m` [kg] that presses with `load` [N s].
    ///
    /// What is left is said by itself and not as a sum, which would leave a rounding error of a full stop. A disc that
    /// presses evenly withstands a torsion of 2/3 mu r per load.
    pub fn new(
        friction: Friction,
        m: f64,
        (along, spin): (DVec3, DVec3),
        load: f64,
        radius: f64,
    ) -> Hold {
        let left = |v: DVec3, taken: f64| {
            let length = v.length();
            if length <= taken {
                DVec3::ZERO
            } else {
                v * (1.0 - taken / length)
            }
        };
        match friction {
            Friction::None => Hold {
                impulse: DVec3::ZERO,
                along,
                spin,
            },
            Friction::Rate(rate) => Hold {
                impulse: along * (-m * rate),
                along: along * (1.0 - rate),
                spin: spin * (1.0 - rate),
            },
            Friction::Cone(mu) => Hold {
                impulse: (along * -m).clamp_length_max(mu * load),
                along: left(along, mu * load / m),
                spin: left(spin, 2.0 / 3.0 * mu * load * radius),
            },
        }
    }
}
