//! Settings of balls, pins and the hand.

use serde::{Deserialize, Serialize};

/// One ball.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BallConfig {
    /// Diameter [m].
    pub diameter_m: f64,
    /// Mass [kg].
    pub mass_kg: f64,
    /// Radius of gyration about every axis [m].
    pub rg_m: f64,
    /// Drag coefficient times cross-section, read with the effect `drag` [m2].
    pub drag_area_m2: f64,
}

impl BallConfig {
    /// Radius [m].
    pub fn radius_m(&self) -> f64 {
        self.diameter_m / 2.0
    }
}

/// The pins: what they weigh is the same for both shapes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PinConfig {
    /// Mass [kg].
    pub mass_kg: f64,
    /// Height of the whole pin [m].
    pub height_m: f64,
    /// Centre of gravity above the base [m].
    pub cg_height_m: f64,
    /// Moment of inertia about the long axis [kg m2].
    pub i_axial_kgm2: f64,
    /// Moment of inertia about any axis across it, through the centre of gravity [kg m2].
    pub i_transverse_kgm2: f64,
    /// Drag coefficient times cross-section, read with the effect `drag` [m2].
    pub drag_area_m2: f64,
    /// The composite of the true shape.
    pub parts: PinPartsConfig,
    /// The single ellipsoid.
    pub ellipsoid: PinEllipsoidConfig,
}

/// The primitives of a pin's true shape; heights above the base.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PinPartsConfig {
    /// Radius of the flat base [m].
    pub base_radius_m: f64,
    /// Height at which the foot's cone ends [m].
    pub foot_height_m: f64,
    /// Radius of the foot's cone there [m].
    pub foot_radius_m: f64,
    /// Height of the belly ellipsoid's middle [m].
    pub belly_height_m: f64,
    /// Semi-axis of the belly across [m].
    pub belly_radius_m: f64,
    /// Semi-axis of the belly along the pin [m].
    pub belly_half_length_m: f64,
    /// Height at which the shoulder's cone begins [m].
    pub shoulder_height_m: f64,
    /// Radius of the shoulder's cone there [m].
    pub shoulder_radius_m: f64,
    /// Height of the narrowest place [m].
    pub neck_height_m: f64,
    /// Radius there [m].
    pub neck_radius_m: f64,
    /// Height at which the throat's cone ends, within the head [m].
    pub throat_height_m: f64,
    /// Radius of the throat's cone there [m].
    pub throat_radius_m: f64,
    /// Height of the head's middle [m].
    pub head_height_m: f64,
    /// Radius of the head [m].
    pub head_radius_m: f64,
}

/// The single ellipsoid, cut flat at the base so that it stands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PinEllipsoidConfig {
    /// Semi-axis across [m].
    pub radius_m: f64,
    /// Semi-axis along the pin; the top of the ellipsoid is the top of the pin [m].
    pub half_length_m: f64,
}

/// The hand: a sphere that pushes what it touches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HandConfig {
    /// Radius [m].
    pub radius_m: f64,
    /// Farthest distance from the hand's middle to the surface of what it grabs [m].
    pub reach_m: f64,
    /// Trigger at which an open hand closes, from 0 to 1.
    pub trigger_close: f64,
    /// Trigger at which a closed hand opens, from 0 to 1.
    pub trigger_open: f64,
    /// Faster than this between two frames, the tracker has jumped and pushes nothing [m/s].
    pub jump_speed_mps: f64,
    /// How long a hand that is no longer tracked holds what it held [s].
    pub lost_grip_s: f64,
}

/// Walking with the thumb buttons.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WalkingConfig {
    /// Full speed [m/s].
    pub speed_mps: f64,
    /// Time from standing to full speed, and back [s].
    pub ramp_s: f64,
    /// How close the head may walk to the rack and the desk [m].
    pub furniture_margin_m: f64,
}

/// How a release velocity is estimated from poses alone, and whether a throw is helped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReleaseConfig {
    /// Poses no older than this at the release are fitted [s].
    pub window_s: f64,
    /// The curve that is fitted.
    pub fit: ReleaseFit,
    /// Share of a ball's angle to the lane's axis, seen from above, that a release takes away, up to 5 degrees; 0 helps nobody,
    /// and is not written down, so that settings without it are what they were.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub assist_share: f64,
}

fn is_zero(share: &f64) -> bool {
    *share == 0.0
}

/// The curve that is fitted to the last poses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ReleaseFit {
    /// A straight line: robust against noise, late by half the window.
    Linear,
    /// A parabola: follows a swing that gathers speed.
    Quadratic,
    /// A cubic: follows a swing past its fastest place.
    Cubic,
}
