//! A scene's building, pins and ball without a participant, a machine or a score: what comparisons and sweeps throw at.

use std::sync::Arc;

use glam::DVec3;
use physics::query::{Limits, separation};
use physics::{BodyDef, BodyId, Compound, Motion, Pose, Shape, World};

use crate::components::Shown;
use crate::config::{BallConfig, Config, coulomb};
use crate::pin_shape::pin_compound;
use crate::throw::body_is_down;
use crate::visible::Visible;
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
    /// What each ball and pin looks like.
    shown: Vec<(BodyId, Shown)>,
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
    /// The scene has no such ball.
    #[error("the scene has no ball; give it one in [[balls]]")]
    NoBall,
    /// A pin would begin somewhere that no deck is.
    #[error("pin {0} does not stand on the deck; give a place on it")]
    OffDeck(u8),
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
        let spots = alley::pin_spots(&config.lane);
        let spot = |number: &u8| {
            let place = usize::from(*number).checked_sub(1);
            let spot = place.and_then(|place| spots.get(place));
            let spot = spot.ok_or(BareAlleyError::Pin(*number))?;
            Ok((*number, (spot.x, spot.z)))
        };
        let places: Result<Vec<_>, BareAlleyError> = numbers.iter().map(spot).collect();
        Self::with_pins(config, &places?, Self::pin_shape(config)?)
    }

    /// The building of a scene, and pins of a shape that stand at `(x, z)` [m], world frame: numbers and places.
    ///
    /// # Errors
    /// On a pin that there is not, that is named twice or off the deck, and on settings that physics refuses.
    pub fn with_pins(
        config: &Config,
        places: &[(u8, (f64, f64))],
        shape: Arc<Compound>,
    ) -> Result<Self, BareAlleyError> {
        let mut world = bodies::world(config).map_err(GameError::from)?;
        for part in alley::parts(config).iter().filter(|part| part.is_solid) {
            bodies::add_part(&mut world, config, part)?;
        }
        let mut alley = Self {
            world,
            config: config.clone(),
            pins: Vec::new(),
            shown: Vec::new(),
        };
        for &(number, (x, z)) in places {
            let is_known = (1..=PINS).contains(&number);
            if !is_known || alley.pins.iter().any(|(other, _)| *other == number) {
                return Err(BareAlleyError::Pin(number));
            }
            if !alley.is_on_deck(x, z) {
                return Err(BareAlleyError::OffDeck(number));
            }
            let pin = bodies::pin(config, shape.clone(), DVec3::new(x, 0.0, z));
            let id = alley.world.add(pin);
            alley.pins.push((number, id));
            alley.shown.push((id, bodies::shown_pin(config, number)));
        }
        Ok(alley)
    }

    /// What the pins of a scene collide with.
    ///
    /// # Errors
    /// On a length that is impossible, which a checked configuration has none of.
    pub fn pin_shape(config: &Config) -> Result<Arc<Compound>, BareAlleyError> {
        let shape = pin_compound(&config.pin, config.objects.shape).map_err(GameError::from)?;
        Ok(Arc::new(shape))
    }

    fn is_on_deck(&self, x: f64, z: f64) -> bool {
        let lane = &self.config.lane;
        let along = lane.deck_end_z_m..alley::deck_front_z(&self.config);
        x.abs() < lane.width_m / 2.0 && along.contains(&z)
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
        let radius = self.ball_config(0)?.radius_m();
        let pose = Pose::from_position(DVec3::new(x, radius, z));
        self.let_go(0, pose, linear, angular)
    }

    /// Puts a ball of the scene, by its number from 0, at a pose, with its velocities [m/s], [rad/s]; world frame.
    ///
    /// # Errors
    /// When the scene has no such ball, or the place is not free.
    pub fn let_go(
        &mut self,
        index: u8,
        pose: Pose,
        linear: DVec3,
        angular: DVec3,
    ) -> Result<BodyId, BareAlleyError> {
        let ball = self.ball_config(index)?;
        let def = bodies::ball(&self.config, ball, pose.position).map_err(GameError::from)?;
        if let Some(name) = self.occupant(&def.compound, pose) {
            return Err(BareAlleyError::Occupied(name));
        }
        let shown = bodies::shown_ball(ball, index);
        let id = self.world.add(BodyDef {
            pose,
            linear_velocity: linear,
            angular_velocity: angular,
            ..def
        });
        self.shown.push((id, shown));
        Ok(id)
    }

    fn ball_config(&self, index: u8) -> Result<&BallConfig, BareAlleyError> {
        let ball = self.config.balls.get(usize::from(index));
        ball.ok_or(BareAlleyError::NoBall)
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

    /// Pins and balls as they can be seen now.
    pub fn visible(&self) -> Vec<Visible> {
        let shown = self.shown.iter();
        shown
            .map(|(id, shown)| Visible {
                model: shown.model,
                pose: self.world.body(*id).pose() * shown.body_from_model,
                size: shown.size,
                is_highlighted: false,
            })
            .collect()
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
