//! Balls that slide, hook and roll on a lane, under Coulomb's law.

use glam::DVec3;
use physics::{
    Effect, Effects, MassProperties, OilPattern, PairContact, Response, Settings, Shape, World,
};

use crate::support::{BALL_MASS, BALL_RADIUS, ball, block, material};

/// Steps per second.
const RATE: f64 = 720.0;
/// Metres per second in a mile per hour.
const MPH: f64 = 0.44704;
/// Metres in a foot.
const FOOT: f64 = 0.3048;
/// Distance from the foul line to the head pin [m].
const HEAD_PIN: f64 = 18.288;
/// What slips more slowly rolls [m/s].
const ROLLS: f64 = 1e-6;

/// A ball as it leaves the hand, aimed along -z.
struct Throw {
    mass: MassProperties,
    radius: f64,
    /// [m/s]
    speed: f64,
    /// To the bowler's right [rad].
    launch: f64,
    /// Rate of turning [rad/s].
    revs: f64,
    /// Axis rotation and tilt [rad]; rotation 0 rolls ahead, positive hooks to the left.
    axis: (f64, f64),
}

/// Friction down the lane.
struct Lane {
    /// Coefficient where there is no oil.
    dry: f64,
    /// Coefficient under the oil, where that ends [m], and over how long an end it thins out [m].
    oil: Option<(f64, f64, f64)>,
}

impl Lane {
    fn even(mu: f64) -> Lane {
        Lane { dry: mu, oil: None }
    }
}

/// State at the end of a step.
#[derive(Clone, Copy)]
struct Moment {
    time: f64,
    at: DVec3,
    velocity: DVec3,
    slip: f64,
}

/// The whole way of a ball, for `seconds`.
fn path(throw: &Throw, lane: &Lane, seconds: f64) -> Vec<Moment> {
    let settings = Settings {
        step_hz: RATE,
        response: Response::Coulomb,
        effects: Effects::default().with(Effect::Oil),
        contact: PairContact {
            restitution: 0.0,
            friction: lane.dry,
        },
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("these settings can run");
    let m = material(0.0, 0.0);
    let corner = DVec3::new(30.0, 0.0, 80.0);
    let floor = world.add(block(m, -corner - DVec3::Y, corner));
    if let Some((mu, end, thinning)) = lane.oil {
        let nodes = 200;
        let factor = |i: usize| {
            let z = end * i as f64 / (nodes - 1) as f64;
            let share = ((z - (end - thinning)) / thinning.max(1e-9)).clamp(0.0, 1.0);
            (mu + (lane.dry - mu) * share) / lane.dry
        };
        let factors = (0..nodes).flat_map(|i| [factor(i); 2]).collect();
        // The floor's frame lies half its thickness below the world's, at the same x and z.
        let pattern = OilPattern::new([-30.0, 0.0], [30.0, -end], [2, nodes], factors);
        world.set_oil(floor, pattern.expect("two factors for each of the nodes"));
    }
    let (rotation, tilt) = throw.axis;
    let turn = glam::DQuat::from_rotation_y(-throw.launch);
    let level = DVec3::new(-rotation.cos(), 0.0, rotation.sin()) * tilt.cos();
    let mut def = ball(m, DVec3::Y * throw.radius);
    def.compound =
        physics::Compound::single(Shape::sphere(throw.radius).expect("a ball has a radius")).into();
    def.mass = throw.mass;
    def.linear_velocity = turn * DVec3::NEG_Z * throw.speed;
    def.angular_velocity = turn * (level + DVec3::Y * tilt.sin()) * throw.revs;
    let id = world.add(def);
    let mut moments = Vec::new();
    for _ in 0..(seconds * RATE) as u32 {
        let body = world.body(id);
        let at = body.pose().position;
        moments.push(Moment {
            time: world.time(),
            at,
            velocity: body.linear_velocity(),
            slip: body.velocity_at(at - DVec3::Y * throw.radius).length(),
        });
        world.step();
    }
    moments
}

/// The first moment in which the ball rolls.
fn rolling(path: &[Moment]) -> Moment {
    *path
        .iter()
        .find(|m| m.slip < ROLLS)
        .expect("it comes to roll")
}

/// The first moment beyond a distance down the lane [m].
fn beyond(path: &[Moment], distance: f64) -> Moment {
    *path
        .iter()
        .find(|m| m.at.z < -distance)
        .expect("it comes so far")
}

/// Direction to the bowler's left [degrees].
fn left(velocity: DVec3) -> f64 {
    (-velocity.x).atan2(-velocity.z).to_degrees()
}

fn sliding(mass: f64, k2_over_r2: f64) -> Throw {
    Throw {
        mass: MassProperties {
            mass,
            inertia: DVec3::splat(mass * k2_over_r2 * BALL_RADIUS * BALL_RADIUS),
        },
        radius: BALL_RADIUS,
        speed: 8.0,
        launch: 0.0,
        revs: 0.0,
        axis: (0.0, 0.0),
    }
}

fn a1() -> Moment {
    rolling(&path(&sliding(6.8, 0.4), &Lane::even(0.12), 3.0))
}

pub fn a1_slide() -> Vec<f64> {
    vec![-a1().at.z]
}

pub fn a1_time() -> Vec<f64> {
    vec![a1().time]
}

pub fn a1_speed() -> Vec<f64> {
    vec![a1().velocity.length()]
}

fn a2() -> Moment {
    rolling(&path(&sliding(6.8, 0.34199), &Lane::even(0.10), 3.0))
}

pub fn a2_slide() -> Vec<f64> {
    vec![-a2().at.z]
}

pub fn a2_speed() -> Vec<f64> {
    vec![a2().velocity.length()]
}

/// The throw of USBC's robot, with the reference ball.
fn harry(mph: f64, launch_degrees: f64) -> Throw {
    Throw {
        mass: BALL_MASS,
        radius: BALL_RADIUS,
        speed: mph * MPH,
        launch: launch_degrees.to_radians(),
        revs: 275.0 * std::f64::consts::TAU / 60.0,
        axis: (55f64.to_radians(), 13f64.to_radians()),
    }
}

/// Robot's throws that roll out, on little and much friction and over oil.
fn a3() -> Vec<Moment> {
    let oiled = Lane {
        dry: 0.20,
        oil: Some((0.04, 40.0 * FOOT, 8.0 * FOOT)),
    };
    let lanes = [Lane::even(0.04), Lane::even(0.20), oiled];
    let ends = lanes.map(|lane| rolling(&path(&harry(17.0, 0.0), &lane, 8.0)));
    ends.to_vec()
}

pub fn a3_speed() -> Vec<f64> {
    a3().iter().map(|end| end.velocity.length() / MPH).collect()
}

pub fn a3_angle() -> Vec<f64> {
    a3().iter().map(|end| left(end.velocity)).collect()
}

pub fn a11_entry() -> Vec<f64> {
    let edge: f64 = 0.52705;
    let throw = Throw {
        launch: -(edge / HEAD_PIN).atan(),
        revs: 8.0 / BALL_RADIUS,
        ..sliding(6.8, 0.4)
    };
    let end = beyond(&path(&throw, &Lane::even(0.12), 3.0), HEAD_PIN);
    // It begins on the edge and has to arrive on the spot.
    assert!((edge + end.at.x).abs() < 1e-3, "{} m", end.at.x);
    vec![left(end.velocity)]
}

/// The throw of B1 and B3.
fn published() -> Throw {
    Throw {
        mass: MassProperties {
            mass: 7.0,
            inertia: DVec3::splat(0.032),
        },
        radius: 0.1085,
        speed: 8.0,
        launch: 0.0,
        revs: 30.0,
        axis: (21.5f64.to_radians(), 0.0),
    }
}

fn b1() -> Vec<Moment> {
    path(&published(), &Lane::even(0.12), 4.0)
}

pub fn b1_slide() -> Vec<f64> {
    vec![-rolling(&b1()).at.z]
}

pub fn b1_hook() -> Vec<f64> {
    vec![-beyond(&b1(), 18.29).at.x]
}

fn b3() -> Vec<Moment> {
    let lane = Lane {
        dry: 0.20,
        oil: Some((0.04, 40.0 * FOOT, 0.0)),
    };
    path(&published(), &lane, 4.0)
}

pub fn b3_slide() -> Vec<f64> {
    vec![-rolling(&b3()).at.z]
}

pub fn b3_hook() -> Vec<f64> {
    vec![-beyond(&b3(), 18.29).at.x]
}

/// Friction under the oil and on dry boards, with which an integrator of the source keeps to the ranges of B4.
const OILED: [(f64, f64); 2] = [(0.03, 0.20), (0.02, 0.15)];

/// Oil that ends at 41 ft.
fn oiled((oil, dry): (f64, f64)) -> Lane {
    Lane {
        dry,
        oil: Some((oil, 41.0 * FOOT, 0.0)),
    }
}

/// Speed lost [mph] and change of direction [degrees] of the robot's throw over 49 ft.
fn b4(oil: (f64, f64)) -> (f64, f64) {
    let path = path(&harry(17.0, 0.0), &oiled(oil), 3.0);
    let (begin, end) = (path[0].velocity, beyond(&path, 49.0 * FOOT).velocity);
    (
        (begin.length() - end.length()) / MPH,
        left(end) - left(begin),
    )
}

pub fn b4_speed() -> Vec<f64> {
    OILED.map(|oil| b4(oil).0).to_vec()
}

pub fn b4_angle() -> Vec<f64> {
    OILED.map(|oil| b4(oil).1).to_vec()
}

/// The same on one lane.
pub fn b4_speed_on(oil: f64, dry: f64) -> Vec<f64> {
    vec![b4((oil, dry)).0]
}

/// The same on one lane.
pub fn b4_angle_on(oil: f64, dry: f64) -> Vec<f64> {
    vec![b4((oil, dry)).1]
}

/// The source names no launch; from 1.2 to 1.5 degrees the ball turns where it says.
pub fn b4_breakpoint() -> Vec<f64> {
    let outermost = |launch| {
        let path = path(&harry(17.0, launch), &oiled(OILED[0]), 3.0);
        let outermost = path.iter().max_by(|a, b| a.at.x.total_cmp(&b.at.x));
        -outermost.expect("the path is not empty").at.z / FOOT
    };
    [1.2, 1.5].map(outermost).to_vec()
}

/// Time to the pins of the robot's throw at another speed [mph].
pub fn c8(mph: f64) -> Vec<f64> {
    vec![beyond(&path(&harry(mph, 1.5), &oiled(OILED[0]), 4.0), HEAD_PIN).time]
}
