//! A scene's building, pins and ball without a participant, a machine or a score: what comparisons and sweeps throw at.

use std::sync::Arc;

use glam::DVec3;
use physics::query::{Limits, separation};
use physics::{BodyId, Compound, Motion, Pose, Shape, World};

use crate::config::{Config, coulomb};
use crate::pin_shape::pin_compound;
use crate::throw::body_is_down;
use crate::{GameError, PINS, alley, bodies};

/// What is deeper in another body than this cannot begin there [m].
const OVERLAP: f64 = 1e-6;

/// Building and pins of a scene. A clone is a snapshot.
#[derive(Clone, Debug)]
pub struct BareAlley {
    /// Everything that moves and everything that it meets.
    pub world: World,
    config: Config,
    pins: Vec<(u8, BodyId)>,
}

/// Why an alley cannot be built, or a ball not be put into it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BareAlleyError {
    /// There is no such pin, or it is named twice.
    #[error("a rack has pins 1 to {PINS}, each once; {0} does not fit")]
    Pin(u8),
    /// The ball would begin inside something.
    #[error("the ball would begin inside {0}; let it go elsewhere")]
    Occupied(String),
    /// The scene has no ball.
    #[error("the scene has no ball; give it one in [[balls]]")]
    NoBall,
    /// The scene cannot be built.
    #[error(transparent)]
    Scene(#[from] GameError),
}

impl BareAlley {
    /// The building of a scene, and those pins of its rack that are named, on their spots.
    ///
    /// # Errors
    /// On a pin that there is not or that is named twice, and on settings that physics refuses.
    pub fn new(config: &Config, numbers: &[u8]) -> Result<Self, BareAlleyError> {
        let mut world = bodies::world(config).map_err(GameError::from)?;
        for part in alley::parts(config).iter().filter(|part| part.is_solid) {
            bodies::add_part(&mut world, config, part)?;
        }
        let compound =
            Arc::new(pin_compound(&config.pin, config.objects.shape).map_err(GameError::from)?);
        let spots = alley::pin_spots(&config.lane);
        let mut pins: Vec<(u8, BodyId)> = Vec::new();
        for &number in numbers {
            let place = usize::from(number).checked_sub(1);
            let is_new = pins.iter().all(|(other, _)| *other != number);
            let spot = place.and_then(|place| spots.get(place)).filter(|_| is_new);
            let spot = *spot.ok_or(BareAlleyError::Pin(number))?;
            let id = world.add(bodies::pin(config, compound.clone(), spot));
            pins.push((number, id));
        }
        Ok(Self {
            world,
            config: config.clone(),
            pins,
        })
    }

    /// The settings that it was built from.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// The pins with their numbers, in the order in which they were named.
    pub fn pins(&self) -> &[(u8, BodyId)] {
        &self.pins
    }

    /// Puts the scene's first ball on the floor at `(x, z)` [m], world frame, with its velocities [m/s], [rad/s].
    ///
    /// # Errors
    /// When the scene has no ball, or the place is not free.
    pub fn add_ball(
        &mut self,
        (x, z): (f64, f64),
        linear: DVec3,
        angular: DVec3,
    ) -> Result<BodyId, BareAlleyError> {
        let ball = self.config.balls.first().ok_or(BareAlleyError::NoBall)?;
        let centre = DVec3::new(x, ball.radius_m(), z);
        let mut def = bodies::ball(&self.config, ball, centre).map_err(GameError::from)?;
        if let Some(name) = self.occupant(&def.compound, def.pose) {
            return Err(BareAlleyError::Occupied(name));
        }
        (def.linear_velocity, def.angular_velocity) = (linear, angular);
        Ok(self.world.add(def))
    }

    /// Puts the scene's hand at a place [m], world frame: a body that goes where it is driven.
    ///
    /// # Errors
    /// On a hand that physics refuses.
    pub fn add_hand(&mut self, at: DVec3) -> Result<BodyId, BareAlleyError> {
        let shape = Shape::sphere(self.config.hand.radius_m).map_err(GameError::from)?;
        let compound = Arc::new(Compound::single(shape));
        let (motion, mass) = (Motion::Driven, bodies::immovable());
        let pose = Pose::from_position(at);
        let def = bodies::body(&self.config, coulomb::REST, compound, motion, mass, pose);
        Ok(self.world.add(def))
    }

    /// What a ball would overlap at a pose.
    fn occupant(&self, ball: &Compound, pose: Pose) -> Option<String> {
        let overlaps = |id: &BodyId| {
            let body = self.world.body(*id);
            let pairs = ball
                .parts()
                .iter()
                .flat_map(|ours| body.compound().parts().iter().map(move |part| (ours, part)));
            pairs.into_iter().any(|(ours, theirs)| {
                let a = (&ours.shape, &(pose * ours.pose));
                let b = (&theirs.shape, &(body.pose() * theirs.pose));
                separation(a, b, None, Limits::default()).gap < -OVERLAP
            })
        };
        let id = self.world.ids().find(overlaps)?;
        let pin = self.pins.iter().find(|(_, pin)| *pin == id);
        Some(match pin {
            Some((number, _)) => format!("pin {number}"),
            None if self.world.body(id).motion() == Motion::Fixed => "the building".to_owned(),
            None => "another ball".to_owned(),
        })
    }

    /// Numbers of the pins that count as fallen now, by the rules of the scene.
    pub fn fallen(&self) -> Vec<u8> {
        let is_down = |id| body_is_down(&self.config, self.world.body(id));
        let pins = self.pins.iter();
        pins.filter(|(_, id)| is_down(*id))
            .map(|(number, _)| *number)
            .collect()
    }
}
