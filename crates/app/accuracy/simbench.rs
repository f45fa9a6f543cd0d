//! The four scenarios of the public SimBenchmark as scenes of ours, against analysis, and beside rapier where it is built in.
//!
//! Figures of the scenarios: leggedrobotics/SimBenchmark (rolling, bouncing, 666, elastic 666). World frame: y is up
//! here, and "along x" is along x.

pub mod bouncing;
pub mod rolling;
pub mod spheres;

use std::sync::Arc;

use glam::DVec3;
use physics::{
    BodyDef, BodyId, Compound, Effect, Effects, MassProperties, Material, Motion, PairContact,
    Pose, Response, Settings, Shape, Surface, World,
};

use super::budget::Budget;
use super::report::{Line, Measure, Point};
use super::step::DEFAULT;
use super::timing::{Task, in_turns};

/// Steps per second [1/s], coarsest first.
const RATES: [f64; 5] = [60.0, 180.0, 720.0, 1440.0, 2880.0];
/// The same for a quick look.
const FEW: [f64; 3] = [60.0, 180.0, 720.0];
/// Acceleration of gravity in the scenarios [m/s2].
pub const GRAVITY: f64 = 9.81;

/// What a body of a scenario is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// A ball of this radius [m].
    Ball(f64),
    /// A box of these half extents [m].
    Cuboid(DVec3),
}

/// A body of a scenario.
#[derive(Clone, Copy, Debug)]
pub struct Thing {
    /// Its shape.
    pub form: Form,
    /// Mass [kg].
    pub mass: f64,
    /// Where it begins, at rest [m].
    pub at: DVec3,
}

/// A scene over a ground at y = 0 that every engine can build.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// Its bodies.
    pub things: Vec<Thing>,
    /// Coefficient of friction of balls and boxes, and of boxes and the ground; balls and balls have none.
    pub friction: [f64; 2],
    /// Restitution of every pair.
    pub restitution: f64,
    /// Force on the first body [N].
    pub force: DVec3,
    /// Simulated time [s].
    pub duration: f64,
}

/// A scenario in some engine.
pub trait Simulated {
    /// Takes one step.
    fn step(&mut self);
    /// Position [m] and velocity [m/s] of a body.
    fn state(&self, index: usize) -> (DVec3, DVec3);
    /// Kinetic and potential energy of all bodies [J].
    fn energy(&self) -> f64;
}

/// Who simulates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The program's own physics under Coulomb's law.
    Ours,
    /// rapier3d in single precision, with so many solver iterations.
    #[cfg(feature = "peers")]
    Rapier(usize),
}

/// All methods of this build.
fn methods() -> Vec<Method> {
    vec![
        Method::Ours,
        #[cfg(feature = "peers")]
        Method::Rapier(4),
        #[cfg(feature = "peers")]
        Method::Rapier(20),
    ]
}

impl Method {
    fn name(self) -> String {
        match self {
            Method::Ours => "coulomb".to_owned(),
            #[cfg(feature = "peers")]
            Method::Rapier(iterations) => format!("rapier, {iterations} iterations"),
        }
    }

    fn is_peer(self) -> bool {
        self != Method::Ours
    }

    /// The scenario, ready to run.
    fn build(self, scenario: &Scenario, hz: f64) -> Box<dyn Simulated> {
        match self {
            Method::Ours => Box::new(Ours::new(scenario, hz)),
            #[cfg(feature = "peers")]
            Method::Rapier(iterations) => {
                Box::new(super::peers::Rapier::new(scenario, hz, iterations))
            }
        }
    }
}

/// A scenario in the program's own physics.
struct Ours {
    world: World,
    ids: Vec<BodyId>,
    force: DVec3,
}

const GROUND: Surface = Surface(0);
const BALL: Surface = Surface(1);
const CUBOID: Surface = Surface(2);

impl Ours {
    fn new(scenario: &Scenario, hz: f64) -> Ours {
        let mut world = World::new(Settings {
            step_hz: hz,
            gravity: DVec3::NEG_Y * GRAVITY,
            response: Response::Coulomb,
            effects: Effects::default().without(Effect::Sleeping),
            ..Settings::default()
        })
        .expect("a scenario's settings can run");
        let [on_box, on_ground] = scenario.friction;
        for (a, b, friction) in [
            (GROUND, BALL, 0.0),
            (GROUND, CUBOID, on_ground),
            (BALL, BALL, 0.0),
            (BALL, CUBOID, on_box),
        ] {
            let restitution = scenario.restitution;
            let pair = PairContact {
                restitution,
                friction,
            };
            world
                .set_pair(a, b, pair)
                .expect("coefficients are in range");
        }
        let ground = Shape::half_space(DVec3::Y).expect("up is a direction");
        let ground = body(ground, GROUND, 1.0, DVec3::ONE, DVec3::ZERO);
        world.add(BodyDef {
            motion: Motion::Fixed,
            ..ground
        });
        let ids = scenario.things.iter().map(|thing| world.add(thing.body()));
        Ours {
            ids: ids.collect(),
            force: scenario.force,
            world,
        }
    }
}

impl Thing {
    /// Moments of inertia of a uniform body [kg m2].
    pub fn inertia(&self) -> DVec3 {
        match self.form {
            Form::Ball(radius) => DVec3::splat(0.4 * self.mass * radius * radius),
            Form::Cuboid(half) => {
                let square = half * half;
                (DVec3::splat(square.element_sum()) - square) * (self.mass / 3.0)
            }
        }
    }

    fn body(&self) -> BodyDef {
        let (shape, surface) = match self.form {
            Form::Ball(radius) => (Shape::sphere(radius), BALL),
            Form::Cuboid(half) => (Shape::cuboid(half), CUBOID),
        };
        let shape = shape.expect("a scenario's sizes are positive");
        body(shape, surface, self.mass, self.inertia(), self.at)
    }
}

fn body(shape: Shape, surface: Surface, mass: f64, inertia: DVec3, at: DVec3) -> BodyDef {
    BodyDef {
        compound: Arc::new(Compound::single(shape)),
        motion: Motion::Dynamic,
        mass: MassProperties { mass, inertia },
        material: Material {
            elasticity: 0.0,
            friction_rate: 0.0,
            surface,
        },
        pose: Pose::from_position(at),
        linear_velocity: DVec3::ZERO,
        angular_velocity: DVec3::ZERO,
        drag_area_m2: 0.0,
    }
}

impl Simulated for Ours {
    fn step(&mut self) {
        if self.force != DVec3::ZERO {
            let body = self.world.body(self.ids[0]);
            let gained = self.force * (self.world.dt() / body.mass().mass);
            let (linear, angular) = (body.linear_velocity() + gained, body.angular_velocity());
            self.world.set_velocity(self.ids[0], linear, angular);
        }
        self.world.step();
    }

    fn state(&self, index: usize) -> (DVec3, DVec3) {
        let body = self.world.body(self.ids[index]);
        (body.pose().position, body.linear_velocity())
    }

    fn energy(&self) -> f64 {
        self.world.energy()
    }
}

/// Rates of this run [1/s].
fn rates(budget: &Budget) -> &'static [f64] {
    if budget.share < 1.0 { &FEW } else { &RATES }
}

/// A line for each method over the rates; `error` runs a scene and says what was wrong.
fn lines(
    panel: &str,
    scenario: &Scenario,
    measures: &[Measure],
    budget: &Budget,
    error: impl Fn(&mut dyn Simulated, f64) -> Vec<f64>,
) -> Vec<Line> {
    let (rates, methods) = (rates(budget), methods());
    let steps = |hz: f64| (scenario.duration * hz).round() as u64;
    let all = || {
        methods
            .iter()
            .flat_map(|method| rates.iter().map(move |hz| (*method, *hz)))
    };
    // Methods and rates in the same rounds.
    let tasks = all().map(|(method, hz)| -> Task {
        Box::new(move || {
            let mut scene = method.build(scenario, hz);
            for _ in 0..steps(hz) {
                scene.step();
            }
            1
        })
    });
    let rounds = budget.scene_rounds.min(3);
    let times = in_turns(rounds, &mut tasks.collect::<Vec<_>>());
    let mut lines: Vec<Line> = Vec::new();
    for ((method, hz), time) in all().zip(times) {
        if lines.last().is_none_or(|line| line.name != method.name()) {
            let mut line = Line::new(method.name(), panel, measures.len(), "simulated second");
            line.is_peer = method.is_peer();
            lines.push(line);
        }
        let errors = error(&mut *method.build(scenario, hz), hz);
        let points = &mut lines.last_mut().expect("one was added").points;
        points.push(Point {
            setting: format!("1/{hz} s"),
            value: hz,
            is_default: !method.is_peer() && hz == DEFAULT,
            errors,
            time: time.per(scenario.duration),
            step_hz: Some(hz),
        });
    }
    lines
}
