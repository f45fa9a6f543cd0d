//! One throw: from the ball's release to the count of the pins.

use game::{BareAlley, BareAlleyError};
use glam::{DQuat, DVec3};
use physics::{Body, BodyId, Effect, Impact, Motion, Pose, World};
use serde::{Deserialize, Serialize};

use super::clock::thread_seconds;

/// How a ball is let go.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Release {
    /// To the bowler's right of the lane's middle [m].
    pub offset: f64,
    /// Distance before the head pin's spot [m].
    pub start: f64,
    /// Speed [m/s].
    pub speed: f64,
    /// Direction, to the bowler's right [degrees].
    pub angle: f64,
    /// Revolutions a minute; 0 for a ball that rolls.
    pub revs: f64,
    /// Turn of the axis about the vertical [degrees]; 90 hooks to the left.
    pub axis_rotation: f64,
}

impl Release {
    /// Linear [m/s] and angular velocity [rad/s] of a ball of a radius [m], world frame.
    pub fn velocities(&self, radius: f64) -> (DVec3, DVec3) {
        let towards = |degrees: f64| DQuat::from_rotation_y(-degrees.to_radians());
        let direction = towards(self.angle) * DVec3::NEG_Z;
        let turning = if self.revs == 0.0 {
            self.speed / radius
        } else {
            self.revs * std::f64::consts::TAU / 60.0
        };
        // Rolling ahead turns about the axis to the left; a right-hander's ball has it turned towards the bowler.
        let axis = towards(self.angle - self.axis_rotation) * DVec3::NEG_X;
        (direction * self.speed, axis * turning)
    }

    /// Puts the scene's ball on the lane, let go like this.
    ///
    /// # Errors
    /// When its place is not free.
    pub fn put_into(&self, alley: &mut BareAlley) -> Result<BodyId, BareAlleyError> {
        let config = alley.config();
        let radius = config.balls.first().map_or(0.0, |ball| ball.radius_m());
        let z = config.lane.headpin_z_m + self.start;
        let (linear, angular) = self.velocities(radius);
        alley.add_ball((self.offset, z), linear, angular)
    }
}

/// Velocities of a body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Velocities {
    /// Of the centre of mass [m/s], world frame.
    pub linear: [f64; 3],
    /// [rad/s], world frame.
    pub angular: [f64; 3],
}

/// The first touch of ball and pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstHit {
    /// Number of the pin.
    pub pin: u8,
    /// Time since the release [s].
    pub seconds: f64,
    /// The ball just after.
    pub ball: Velocities,
    /// The pin just after.
    pub pin_after: Velocities,
}

/// What came of a throw.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Numbers of the fallen pins.
    pub fallen: Vec<u8>,
    /// `None` if the ball met no pin.
    pub first_hit: Option<FirstHit>,
    /// Kinetic and potential energy of all that moves at the release and at the end [J].
    pub energy: [f64; 2],
    /// Linear momentum of all that moves at the release and at the end [N s].
    pub momentum: [DVec3; 2],
    /// Hash of the last state.
    pub hash: u64,
    /// Processor time of one core per simulated time [ms/s].
    pub ms_per_second: f64,
}

/// A ball on its way.
pub struct Flight {
    /// The alley with the ball in it.
    pub alley: BareAlley,
    /// The ball.
    pub ball: BodyId,
    /// Number, body and first pose of every pin.
    stands: Vec<(u8, BodyId, Pose)>,
    first_hit: Option<FirstHit>,
    energy: f64,
    momentum: DVec3,
    cost: f64,
}

impl Flight {
    /// Puts the ball into a copy of the alley.
    ///
    /// # Errors
    /// When its place is not free.
    pub fn begin(alley: &BareAlley, release: &Release) -> Result<Self, BareAlleyError> {
        let mut alley = alley.clone();
        let ball = release.put_into(&mut alley)?;
        Ok(Self {
            energy: alley.world.energy(),
            momentum: momentum(&alley.world),
            stands: alley
                .pins()
                .iter()
                .map(|(number, id)| (*number, *id, alley.world.body(*id).pose()))
                .collect(),
            alley,
            ball,
            first_hit: None,
            cost: 0.0,
        })
    }

    /// Advances by so many steps of the scene.
    pub fn run(&mut self, steps: u64) {
        let started = thread_seconds();
        for _ in 0..steps {
            if self.first_hit.is_some() {
                self.alley.world.step();
            } else {
                self.step_towards_pins();
            }
        }
        self.cost += thread_seconds() - started;
    }

    /// One step, and what the first touch of ball and pin in it did.
    ///
    /// The impulses of the touch itself, not the state at the end of the step: so the numbers do not depend on what
    /// else happens in it.
    fn step_towards_pins(&mut self) {
        let world = &self.alley.world;
        let (before, time) = (world.body(self.ball).clone(), world.time());
        self.alley.world.step();
        let world = &self.alley.world;
        let touched = |impact: &Impact| {
            let other = partner(self.ball, impact)?;
            self.stands.iter().find(|(_, pin, _)| *pin == other)
        };
        let mut impacts = world.impacts().iter().enumerate();
        let hit = impacts.find_map(|(index, impact)| Some((index, impact, touched(impact)?)));
        let Some((index, impact, (number, pin, stood))) = hit else {
            return;
        };
        // At the touch the ball's centre is a radius behind the point, wherever the step began.
        let to_pin = if impact.a == self.ball { 1.0 } else { -1.0 };
        let radius = before.compound().parts()[0].shape.support(DVec3::Y).y;
        let centre = impact.point - impact.normal * (to_pin * radius);
        let linear = before.linear_velocity();
        let way = (centre - before.pose().position).dot(linear) / linear.length_squared();
        let impulses = &world.impacts()[..=index];
        let turns = world.settings().effects.contains(Effect::Rotation);
        let ball = State {
            body: &before,
            pose: Pose::new(centre, before.pose().rotation),
            linear,
            angular: before.angular_velocity(),
            turns,
        };
        // Nothing has met the pin yet: it stands.
        let standing = State {
            body: world.body(*pin),
            pose: *stood,
            linear: DVec3::ZERO,
            angular: DVec3::ZERO,
            turns,
        };
        self.first_hit = Some(FirstHit {
            pin: *number,
            seconds: time + way,
            ball: ball.after(self.ball, impulses),
            pin_after: standing.after(*pin, impulses),
        });
    }

    /// What came of it, as it is now.
    pub fn end(&self) -> Outcome {
        let world = &self.alley.world;
        Outcome {
            fallen: self.alley.fallen(),
            first_hit: self.first_hit,
            energy: [self.energy, world.energy()],
            momentum: [self.momentum, momentum(world)],
            hash: world.hash(),
            ms_per_second: 1e3 * self.cost / world.time(),
        }
    }
}

/// A body at the instant of a touch.
struct State<'a> {
    body: &'a Body,
    pose: Pose,
    linear: DVec3,
    angular: DVec3,
    /// Whether the scene has bodies turn.
    turns: bool,
}

impl State<'_> {
    /// Its velocities after its share of the impulses.
    fn after(&self, id: BodyId, impacts: &[Impact]) -> Velocities {
        let (mut linear, mut angular) = (self.linear, self.angular);
        let mass = self.body.mass();
        for impact in impacts.iter().filter(|i| partner(id, i).is_some()) {
            let impulse = if impact.a == id {
                impact.impulse
            } else {
                -impact.impulse
            };
            linear += impulse / mass.mass;
            if !self.turns {
                continue;
            }
            let turn = (impact.point - self.pose.position).cross(impulse);
            let local = self.pose.rotation.conjugate() * turn;
            angular += self.pose.rotation * (local / mass.inertia);
        }
        Velocities {
            linear: linear.to_array(),
            angular: angular.to_array(),
        }
    }
}

/// Whom a body met in an impact, if it took part.
fn partner(id: BodyId, impact: &Impact) -> Option<BodyId> {
    match id {
        id if id == impact.a => Some(impact.b),
        id if id == impact.b => Some(impact.a),
        _ => None,
    }
}

fn momentum(world: &World) -> DVec3 {
    let bodies = world.ids().map(|id| world.body(id));
    bodies
        .filter(|body| body.motion() == Motion::Dynamic)
        .map(|body| body.mass().mass * body.linear_velocity())
        .sum()
}
