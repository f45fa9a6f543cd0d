//! One pin: tipping, rocking, falling, and what a ball beside it touches.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use physics::query::{Limits, Separation, separation};
use physics::{BodyDef, Compound, PairContact, Pose, Response, Settings, Shape, World};

use crate::support::{
    BALL_RADIUS, BASE_RADIUS, PIN_CG, PIN_MASS, block, composite_pin, material, pin, tilt,
};

const MODELS: [Response; 3] = [Response::UnoSlater, Response::Guarded, Response::Coulomb];

/// Specification profile: heights and radii [m].
fn profile() -> Vec<(f64, f64)> {
    let rows = include_str!("../../../game/tests/data/pin_profile.csv").lines();
    let number = |text: &str| text.parse::<f64>().expect("the profile holds numbers");
    rows.skip(1)
        .map(|row| row.split_once(',').expect("the profile has two columns"))
        .map(|(height, radius)| (number(height), number(radius)))
        .collect()
}

/// A floor without bounce, on which nothing slides.
fn floor(response: Response, friction: f64) -> World {
    let settings = Settings {
        response,
        contact: PairContact {
            restitution: 0.0,
            friction,
        },
        ..Settings::default()
    };
    let mut world = World::new(settings).expect("these settings can run");
    let corner = DVec3::new(2.0, 0.0, 2.0);
    world.add(block(rough(), -corner - DVec3::Y, corner));
    world
}

fn rough() -> physics::Material {
    material(0.0, 1.0)
}

/// A pin on the edge of its base, leaning by `angle` [rad] towards +x.
fn leaning(compound: &Arc<Compound>, angle: f64) -> BodyDef {
    let mut def = pin(compound, rough(), DVec3::ZERO);
    let rotation = DQuat::from_rotation_z(-angle);
    let edge = rotation * DVec3::new(BASE_RADIUS, -PIN_CG, 0.0);
    def.pose = Pose::new(DVec3::Y * -edge.y, rotation);
    def
}

/// Whether the pin of a world lies or stands in the end.
fn falls(mut world: World, def: BodyDef) -> bool {
    let id = world.add(def);
    while world.time() < 3.0 {
        world.step();
        let lean = tilt(&world, id);
        if lean > 30.0 {
            return true;
        }
    }
    false
}

/// The value between `low` and `high` from which on something happens.
fn threshold(mut low: f64, mut high: f64, happens: impl Fn(f64) -> bool) -> f64 {
    assert!(!happens(low) && happens(high));
    for _ in 0..8 {
        let middle = 0.5 * (low + high);
        if happens(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

pub fn a4_sharp() -> Vec<f64> {
    let tips = |response| {
        let falls = |degrees: f64| {
            let def = leaning(&composite_pin(), degrees.to_radians());
            falls(floor(response, 1.0), def)
        };
        threshold(9.0, 11.0, falls)
    };
    MODELS.map(tips).to_vec()
}

/// The lean at which a base with a round edge lifts the centre highest: from there on it falls.
pub fn a4_fillet() -> Vec<f64> {
    let fillet: f64 = 0.003969;
    let arc = (0..=120).flat_map(|i| {
        let (sin, cos) = (0.25 * f64::from(i)).to_radians().sin_cos();
        let (radius, height) = (BASE_RADIUS + fillet * sin, fillet * (1.0 - cos) - PIN_CG);
        [-0.3f64, 0.0, 0.3].map(|turn| DVec3::new(radius * turn.cos(), height, radius * turn.sin()))
    });
    let foot = Shape::cloud(&arc.collect::<Vec<_>>()).expect("all points are finite");
    let height = |degrees: f64| {
        let down = DQuat::from_rotation_z(degrees.to_radians()) * DVec3::NEG_Y;
        foot.support(down).dot(down)
    };
    let leans = (0..4000).map(|i| 8.0 + 1e-3 * f64::from(i));
    let highest = leans.max_by(|a, b| height(*a).total_cmp(&height(*b)));
    vec![highest.expect("there are angles")]
}

/// Least energy of turning about its edge that tips a pin which stands flat.
pub fn a5_energy() -> Vec<f64> {
    let about_edge =
        PIN_MASS.inertia.x + PIN_MASS.mass * (PIN_CG * PIN_CG + BASE_RADIUS * BASE_RADIUS);
    let least = |response| {
        let falls = |energy: f64| {
            let mut def = pin(&composite_pin(), rough(), DVec3::ZERO);
            let rate = DVec3::NEG_Z * f64::sqrt(2.0 * energy / about_edge);
            def.angular_velocity = rate;
            def.linear_velocity = rate.cross(DVec3::new(-BASE_RADIUS, PIN_CG, 0.0));
            falls(floor(response, 1.0), def)
        };
        threshold(0.02, 0.05, falls)
    };
    MODELS.map(least).to_vec()
}

/// Period of a pin that is let go at a share of its tip angle: four times until it is upright.
pub fn a6(share: f64) -> Vec<f64> {
    let tip = (BASE_RADIUS / PIN_CG).atan();
    let period = |response| {
        let mut world = floor(response, 1.0);
        let id = world.add(leaning(&composite_pin(), share * tip));
        let lean = |world: &World| (world.body(id).pose().rotation * DVec3::Y).x;
        let mut before = lean(&world);
        loop {
            world.step();
            let now = lean(&world);
            if now <= 0.0 {
                return 4.0 * (world.time() + now / (before - now) * world.dt());
            }
            before = now;
        }
    };
    MODELS.map(period).to_vec()
}

/// A pin whose surface is the rim of its base alone, on a floor on which it cannot slide.
pub fn a7_fall() -> Vec<f64> {
    let thin = 1e-4;
    let rim = Shape::cylinder(BASE_RADIUS, thin).expect("a rim has a radius");
    let at = Pose::from_position(DVec3::Y * (thin - PIN_CG));
    let rim = Arc::new(Compound::new(vec![(at, rim)]).expect("it has a part"));
    let balance = (BASE_RADIUS / PIN_CG).atan();
    let mut world = floor(Response::Coulomb, 100.0);
    let id = world.add(leaning(&rim, balance + 5f64.to_radians()));
    let mut before = f64::NAN;
    loop {
        let height = world.body(id).pose().position.y;
        if height <= 0.0 {
            return vec![world.time() + height / (before - height) * world.dt()];
        }
        assert!(world.time() < 2.0, "it stays at {height} m");
        before = height;
        world.step();
    }
}

/// A pin's belly after the profile, as a cloud that is dense where the ball is.
fn belly() -> Shape {
    let profile = profile();
    let radius = |height: f64| {
        let after = profile
            .iter()
            .position(|p| p.0 > height)
            .expect("below the top");
        let (low, high) = (profile[after - 1], profile[after]);
        low.1 + (high.1 - low.1) * (height - low.0) / (high.0 - low.0)
    };
    let points = (0..=60).flat_map(|i| {
        let height = 0.1 + 5e-4 * f64::from(i);
        let radius = radius(height);
        (-2..=2).map(move |k| {
            let (sin, cos) = (0.1 * f64::from(k)).sin_cos();
            DVec3::new(radius * cos, height, radius * sin)
        })
    });
    let points: Vec<DVec3> = points.chain([DVec3::Y * 0.115]).collect();
    Shape::cloud(&points).expect("all points are finite")
}

/// The belly of the game's composite pin, upright on the lane: `pin.parts` of config/default.toml.
fn composite_belly() -> (Shape, Pose) {
    let (height, radius, half_length) = (0.11796, 0.06033, 0.10745);
    let belly = Shape::ellipsoid(DVec3::new(radius, half_length, radius));
    let up = Pose::from_position(DVec3::Y * height);
    (belly.expect("it has a size"), up)
}

/// Where a ball on the lane touches an upright pin's belly, and its distance from the pin's axis then.
fn touch((belly, pose): (Shape, Pose)) -> (Separation, f64) {
    let ball = Shape::sphere(BALL_RADIUS).expect("a ball has a radius");
    let ask = |x: f64| {
        let at = Pose::from_position(DVec3::new(x, BALL_RADIUS, 0.0));
        separation((&ball, &at), (&belly, &pose), None, Limits::default())
    };
    let mut x = 0.2;
    for _ in 0..50 {
        x -= ask(x).gap;
    }
    (ask(x), x)
}

fn height((touch, _): (Separation, f64)) -> Vec<f64> {
    vec![1e3 * touch.point_a.y]
}

fn distance((_, x): (Separation, f64)) -> Vec<f64> {
    vec![1e3 * x]
}

pub fn a8_height() -> Vec<f64> {
    height(touch((belly(), Pose::IDENTITY)))
}

pub fn a8_distance() -> Vec<f64> {
    distance(touch((belly(), Pose::IDENTITY)))
}

pub fn a8_composite_height() -> Vec<f64> {
    height(touch(composite_belly()))
}

pub fn a8_composite_distance() -> Vec<f64> {
    distance(touch(composite_belly()))
}

/// Slices of cones between neighbouring heights of the profile.
pub fn a12_height() -> Vec<f64> {
    let profile = profile();
    let (mut volume, mut moment) = (0.0, 0.0);
    for pair in profile.windows(2) {
        let ((h0, r0), (h1, r1)) = (pair[0], pair[1]);
        let height = h1 - h0;
        let sum = r0 * r0 + r0 * r1 + r1 * r1;
        volume += height * sum / 3.0;
        moment += h0 * height * sum / 3.0
            + height * height * (r0 * r0 + 2.0 * r0 * r1 + 3.0 * r1 * r1) / 12.0;
    }
    vec![1e3 * moment / volume]
}
