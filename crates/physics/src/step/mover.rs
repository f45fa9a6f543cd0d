//! A body as lasting contacts see it: velocities and inverse masses, nothing else.

use glam::{DMat3, DVec3};

use crate::body::{Body, Motion};

/// A body as the rows see it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mover {
    pub linear: DVec3,
    pub angular: DVec3,
    pub inv_mass: f64,
    pub inv_inertia: DMat3,
    pub is_driven: bool,
}

impl Mover {
    pub fn new(body: &Body) -> Mover {
        Mover {
            linear: body.linear_now(),
            angular: body.angular_velocity(),
            inv_mass: body.inv_mass(),
            inv_inertia: body.inv_inertia(),
            is_driven: body.motion == Motion::Driven,
        }
    }

    pub fn velocity(&self, arm: DVec3) -> DVec3 {
        self.linear + self.angular.cross(arm)
    }

    pub fn push(&mut self, arm: DVec3, impulse: DVec3) {
        if self.inv_mass > 0.0 {
            self.linear += impulse * self.inv_mass;
            self.angular += self.inv_inertia * arm.cross(impulse);
        }
    }

    /// How easily the body turns, in the mean over all axes [1/(kg m2)], times three.
    pub fn ease(&self) -> f64 {
        let i = &self.inv_inertia;
        i.x_axis.x + i.y_axis.y + i.z_axis.z
    }

    /// Change of the angular velocity [rad/s] that an angular impulse makes [N m s].
    pub fn turn_by(&self, angular_impulse: DVec3) -> DVec3 {
        self.inv_inertia * angular_impulse
    }

    pub fn is_moved(&self) -> bool {
        self.inv_mass > 0.0
    }
}
