//! Constants of a scene, and why a world cannot run with some.

use glam::DVec3;
use thiserror::Error;

use crate::effects::Effects;
use crate::response::Response;
use crate::surface::PairContact;

/// Constants of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Steps per simulated second [1/s]; independent of any display.
    pub step_hz: f64,
    /// Acceleration of gravity [m/s2], world frame.
    pub gravity: DVec3,
    /// Law of impacts.
    pub response: Response,
    /// Largest number of new normals per search (§2.1); 20 in the paper's experiment.
    pub iteration_cap: u32,
    /// Largest number of sweeps over a group of lasting contacts under `Response::Coulomb`, and of one that hardly moves
    /// under the paper's laws, which ends earlier where it has come to terms; what moves faster ends at 40 under these.
    pub sweep_cap: u32,
    /// Contact time after which a lasting contact has taken the share `friction_rate` of the slip [s].
    pub friction_reference_s: f64,
    /// What the steps compute; everything else executes nothing.
    pub effects: Effects,
    /// Arm at which a contact's normal force resists rolling [m]; read with `Effect::RollingResistance` alone.
    pub rolling_resistance_m: f64,
    /// Density of the air [kg/m3]; read with `Effect::Drag` alone.
    pub air_density_kgpm3: f64,
    /// Coefficients of pairs that [`World::set_pair`](crate::World::set_pair) has not named; `Response::Coulomb` alone reads them.
    pub contact: PairContact,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            step_hz: 720.0,
            gravity: DVec3::new(0.0, -9.81, 0.0),
            response: Response::Guarded,
            iteration_cap: 20,
            sweep_cap: 3000,
            friction_reference_s: 1.0 / 60.0,
            effects: Effects::default(),
            rolling_resistance_m: 0.0,
            air_density_kgpm3: 0.0,
            contact: PairContact {
                restitution: 0.5,
                friction: 0.2,
            },
        }
    }
}

/// Settings that no world can run with.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SettingsError {
    /// The step rate must be positive and finite.
    #[error("step_hz must be a positive number of steps per second, not {0}")]
    StepRate(f64),
    /// Gravity must be finite.
    #[error("gravity must be a finite acceleration in m/s2, not {0}")]
    Gravity(DVec3),
    /// At least one iteration is needed.
    #[error("iteration_cap must be at least 1")]
    IterationCap,
    /// At least one sweep is needed.
    #[error("sweep_cap must be at least 1")]
    SweepCap,
    /// The reference interval must be positive and finite.
    #[error("friction_reference_s must be a positive time in seconds, not {0}")]
    FrictionReference(f64),
    /// The arm of the rolling resistance is finite and not negative.
    #[error("rolling_resistance_m must be a length of 0 m or more, not {0}")]
    RollingResistance(f64),
    /// The density of the air is finite and not negative.
    #[error("air_density_kgpm3 must be a density of 0 kg/m3 or more, not {0}")]
    AirDensity(f64),
    /// Restitution lies between 0 and 1, friction is positive or zero.
    #[error("a pair needs a restitution from 0 to 1 and a friction coefficient of 0 or more, not {} and {}", .0.restitution, .0.friction)]
    Pair(PairContact),
}

impl Settings {
    /// Whether a world can run with these.
    pub(crate) fn check(&self) -> Result<(), SettingsError> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        if !positive(self.step_hz) {
            return Err(SettingsError::StepRate(self.step_hz));
        }
        if !self.gravity.is_finite() {
            return Err(SettingsError::Gravity(self.gravity));
        }
        if self.iteration_cap == 0 {
            return Err(SettingsError::IterationCap);
        }
        if self.sweep_cap == 0 {
            return Err(SettingsError::SweepCap);
        }
        if !positive(self.friction_reference_s) {
            return Err(SettingsError::FrictionReference(self.friction_reference_s));
        }
        let amount = |x: f64| x >= 0.0 && x.is_finite();
        if !amount(self.rolling_resistance_m) {
            return Err(SettingsError::RollingResistance(self.rolling_resistance_m));
        }
        if !amount(self.air_density_kgpm3) {
            return Err(SettingsError::AirDensity(self.air_density_kgpm3));
        }
        if !self.contact.is_valid() {
            return Err(SettingsError::Pair(self.contact));
        }
        Ok(())
    }
}
