//! How a body moves between contacts, and bounds of it.

use glam::{DQuat, DVec3};

use super::{Body, MassProperties, Motion};
use crate::compound::Symmetry;
use crate::effects::{Effect, Effects};
use crate::pose::Pose;

/// How a dynamic body turns while nothing exerts a torque on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Spin {
    /// Not at all, whatever torques act.
    Never,
    /// About a fixed axis at a fixed rate: its three moments of inertia are equal.
    Even,
    /// So that the angular momentum stays: precession, tumbling.
    Free,
    /// So that the angular velocity stays, though the moments of inertia differ.
    Steady,
}

impl Spin {
    pub fn new(mass: &MassProperties, effects: Effects) -> Spin {
        let i = mass.inertia;
        if !effects.contains(Effect::Rotation) {
            Spin::Never
        } else if i.x == i.y && i.y == i.z {
            Spin::Even
        } else if effects.contains(Effect::Gyroscopic) {
            Spin::Free
        } else {
            Spin::Steady
        }
    }
}

/// Bounds of how the surface moves, whatever the shape: what certificates are made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sweep {
    /// Fastest that turning carries a surface point [m/s].
    pub turning: f64,
    /// Largest acceleration of a surface point [m/s2].
    pub acceleration: f64,
}

impl Sweep {
    const STILL: Sweep = Sweep {
        turning: 0.0,
        acceleration: 0.0,
    };

    /// Bounds for a surface within `radius` [m] that turns about its own axis and across it [rad/s].
    ///
    /// A turn of an axisymmetric body about its own axis does not move its surface; it still turns the axis of the
    /// turn across, and so bends the ways of the surface.
    pub fn new(along: f64, across: f64, radius: f64) -> Sweep {
        if across == 0.0 {
            return Sweep::STILL;
        }
        // The largest stretch of the matrix [w']x + [w]x^2, with w across the axis and w' = w along.
        let bend = 0.5 * across * (across + (across * across + 4.0 * along * along).sqrt());
        Sweep {
            turning: across * radius,
            acceleration: bend * radius,
        }
    }
}

impl Body {
    /// Bounds for the current motion.
    pub(crate) fn sweep(&self) -> Sweep {
        let mut sweep = self.sweep_of_turning();
        sweep.acceleration += self.acceleration.length();
        sweep
    }

    /// How fast the body turns in a way that moves its surface [rad/s].
    pub(crate) fn turning_across(&self) -> f64 {
        match self.compound.symmetry() {
            Symmetry::Full => 0.0,
            Symmetry::Axis => {
                let axis = self.rotation * DVec3::Y;
                let across = self.momentum - axis * axis.dot(self.momentum);
                across.length() / self.mass.inertia.x
            }
            Symmetry::None => self.angular_velocity().length(),
        }
    }

    fn sweep_of_turning(&self) -> Sweep {
        let symmetry = self.compound.symmetry();
        let radius = self.compound.bounding_radius();
        let i = self.mass.inertia;
        match self.motion {
            Motion::Fixed => Sweep::STILL,
            _ if symmetry == Symmetry::Full => Sweep::STILL,
            Motion::Dynamic if self.spin == Spin::Never => Sweep::STILL,
            Motion::Driven => Sweep::new(0.0, self.turning.length(), radius),
            Motion::Dynamic if self.spin == Spin::Steady => self.sweep_of_steady_turning(),
            Motion::Dynamic if symmetry == Symmetry::Axis && i.x == i.z => {
                let axis = self.rotation * DVec3::Y;
                let along = axis.dot(self.momentum);
                let across = self.momentum - axis * along;
                Sweep::new(along / i.x, across.length() / i.x, radius)
            }
            Motion::Dynamic => {
                let rate = self.momentum.length() / i.min_element();
                let mut sweep = Sweep::new(0.0, rate, radius);
                // Euler's equations: the rate itself changes by no more than this share of its square.
                let spread = (i.max_element() - i.min_element()) / i.min_element();
                sweep.acceleration *= 1.0 + (0.578 * spread).min(1.0);
                sweep
            }
        }
    }

    fn sweep_of_steady_turning(&self) -> Sweep {
        let (rate, radius) = (self.own_turning(), self.compound.bounding_radius());
        match self.compound.symmetry() {
            Symmetry::Axis => {
                Sweep::new(rate.y, (rate.x * rate.x + rate.z * rate.z).sqrt(), radius)
            }
            _ => Sweep::new(0.0, rate.length(), radius),
        }
    }

    /// Angular velocity that belongs to `momentum` [rad/s], body frame.
    fn own_turning(&self) -> DVec3 {
        self.rotation.conjugate() * self.momentum / self.mass.inertia
    }

    /// Recomputes reach and end pose up to `until`, after a change of velocity.
    pub(crate) fn look_ahead(&mut self) {
        let rest = self.until - self.clock;
        if (self.linear, self.momentum, self.turning, self.acceleration)
            == (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO)
        {
            self.reach = 0.0;
            self.end = self.pose();
            return;
        }
        let sweep = self.sweep();
        self.reach = (self.linear.length() + sweep.turning) * rest
            + 0.5 * self.acceleration.length() * rest * rest;
        self.end = self.pose_at(self.until);
    }

    /// Pose at time `t` [s] of the step, exact for free flight of an axisymmetric or a driven body.
    pub(crate) fn pose_at(&self, t: f64) -> Pose {
        let dt = t - self.clock;
        if dt == 0.0 || self.motion == Motion::Fixed || self.frozen {
            return self.pose();
        }
        let position = self.position + self.linear * dt + self.acceleration * (0.5 * dt * dt);
        let rotation = match self.motion {
            Motion::Driven => turn(self.turning * dt) * self.rotation,
            _ if self.momentum == DVec3::ZERO => self.rotation,
            _ => match self.spin {
                Spin::Never => self.rotation,
                Spin::Even => turn(self.momentum * (dt / self.mass.inertia.x)) * self.rotation,
                Spin::Free => self.tumbled(dt),
                Spin::Steady => self.rotation * turn(self.own_turning() * dt),
            },
        };
        Pose::new(position, rotation.normalize())
    }

    /// The same, with the end of the stretch at hand.
    pub(crate) fn pose_until(&self, t: f64) -> Pose {
        if t == self.until || self.reach == 0.0 {
            self.end
        } else {
            self.pose_at(t)
        }
    }

    /// Torque-free rotation for `dt` [s].
    fn tumbled(&self, dt: f64) -> DQuat {
        let i = self.mass.inertia;
        if let Some((axis, own, across)) = even_axis(i) {
            // Closed form: precession about the angular momentum, after a spin about the axis of the equal moments.
            let along = (self.rotation.conjugate() * self.momentum).dot(axis);
            let spin = along * (1.0 / own - 1.0 / across) * dt;
            let precession = turn(self.momentum * (dt / across));
            return precession * self.rotation * turn(axis * spin);
        }
        // Three exact turns about the principal axes, symmetric in time: keeps the momentum, energy to O(dt^2).
        let mut rotation = self.rotation;
        let order = [
            (DVec3::X, i.x, 0.5),
            (DVec3::Y, i.y, 0.5),
            (DVec3::Z, i.z, 1.0),
        ];
        for (axis, inertia, share) in order.into_iter().chain([order[1], order[0]]) {
            let rate = (rotation.conjugate() * self.momentum).dot(axis) / inertia;
            rotation *= turn(axis * (rate * share * dt));
        }
        rotation
    }

    /// Takes a new orientation; what belongs to the motion in between goes with it.
    fn turn_to(&mut self, rotation: DQuat) {
        let before = std::mem::replace(&mut self.rotation, rotation);
        if self.spin != Spin::Steady || self.momentum == DVec3::ZERO {
            return;
        }
        // The angular velocity stays in the world and in the body, so the momentum goes round with the body.
        self.momentum = rotation * (before.conjugate() * self.momentum);
        // What contacts add stays a change of the angular velocity in the world.
        let i = self.mass.inertia;
        for bend in self.bend.iter_mut().filter(|b| b.torque != DVec3::ZERO) {
            let change = before * (before.conjugate() * bend.torque / i);
            bend.torque = rotation * (rotation.conjugate() * change * i);
        }
    }

    /// Brings the state to time `t` [s] of the step.
    pub(crate) fn advance(&mut self, t: f64) {
        if t <= self.clock {
            return;
        }
        if self.reach > 0.0 {
            let elapsed = t - self.clock;
            let speed = self.linear.length() + self.sweep().turning;
            self.path += elapsed * (speed + 0.5 * self.acceleration.length() * elapsed);
            let pose = self.pose_until(t);
            self.position = pose.position;
            self.turn_to(pose.rotation);
            self.linear += self.acceleration * (t - self.clock);
        }
        self.clock = t;
    }
}

/// The principal axis across which two moments of inertia are equal, with the moments about it and across it [kg m2].
fn even_axis(i: DVec3) -> Option<(DVec3, f64, f64)> {
    if i.x == i.z {
        Some((DVec3::Y, i.y, i.x))
    } else if i.x == i.y {
        Some((DVec3::Z, i.z, i.x))
    } else {
        (i.y == i.z).then_some((DVec3::X, i.x, i.y))
    }
}

/// Rotation by the vector `v` [rad].
///
/// Below 0.2 rad through the series of tan(|v|/2), right to 1e-10 relative: no sine, and any angle about the
/// angular momentum keeps momentum and energy exactly.
pub(crate) fn turn(v: DVec3) -> DQuat {
    let square = v.length_squared();
    if square > 0.04 {
        return DQuat::from_scaled_axis(v);
    }
    let series = 0.5 + square * (1.0 / 24.0 + square * (1.0 / 240.0 + square * (17.0 / 40320.0)));
    let h = v * series;
    DQuat::from_xyzw(h.x, h.y, h.z, 1.0).normalize()
}
