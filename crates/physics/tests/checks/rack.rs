//! Balls that hit the head pin.

use glam::DVec3;
use physics::{BodyId, PairContact, Response, Settings, Surface, World};

use crate::support::{BALL_RADIUS, alley, ball, composite_pin, material};

/// Surfaces of a rack's bodies.
const DECK: Surface = Surface(0);
const PIN: Surface = Surface(1);
const BALL: Surface = Surface(2);
/// Distance from the foul line to the head pin [m].
const HEAD_PIN: f64 = 18.288;
/// Where the deck ends [m], world frame.
const DECK_END: f64 = -19.156;

/// Reference coefficients of pairs: ball and pin, pin and pin, pin and deck, ball and lane.
const PAIRS: [(Surface, Surface, f64, f64); 4] = [
    (BALL, PIN, 0.65, 0.12),
    (PIN, PIN, 0.67, 0.15),
    (PIN, DECK, 0.35, 0.25),
    (BALL, DECK, 0.35, 0.20),
];

/// A rack under Coulomb's law with `friction` times the reference coefficients.
fn rack(friction: f64) -> (World, Vec<BodyId>) {
    let settings = Settings {
        response: Response::Coulomb,
        contact: PairContact {
            restitution: 0.45,
            friction: 0.2 * friction,
        },
        ..Settings::default()
    };
    let of = |surface| physics::Material {
        surface,
        ..material(0.0, 0.0)
    };
    let (mut world, mut pins) = alley(settings, &composite_pin(), of(DECK));
    // The pins of the fixture have the building's surface.
    for id in &mut pins {
        let body = world.body(*id);
        let mut def = crate::support::pin(&composite_pin(), of(PIN), DVec3::ZERO);
        def.pose = body.pose();
        world.remove(*id);
        *id = world.add(def);
    }
    for (a, b, restitution, mu) in PAIRS {
        let pair = PairContact {
            restitution,
            friction: mu * friction,
        };
        world.set_pair(a, b, pair).expect("they are coefficients");
    }
    (world, pins)
}

/// Direction in which the head pin leaves, to the left [degrees], after a hit `offset` metres beside its middle.
pub fn a9(offset: f64) -> Vec<f64> {
    let (mut world, pins) = rack(0.0);
    let surface = physics::Material {
        surface: BALL,
        ..material(0.0, 0.0)
    };
    let mut def = ball(surface, DVec3::new(offset, BALL_RADIUS, 0.5 - HEAD_PIN));
    def.linear_velocity = DVec3::NEG_Z * 8.0;
    let id = world.add(def);
    while !world.impacts().iter().any(|i| i.a == id || i.b == id) {
        world.step();
    }
    let velocity = world.body(pins[0]).linear_velocity();
    vec![(-velocity.x).atan2(-velocity.z).to_degrees()]
}

/// The pins that most balls touch which enter the pocket, at board 17.5 and up to 3 mm beside it, at 6 degrees.
///
/// Most, because a rack is chaotic: half a millimetre aside the ball may meet a pin that flies back.
pub fn c3_touched() -> Vec<f64> {
    let all: Vec<u64> = (-10..=10)
        .map(|i| touched(0.0676 + 3e-4 * f64::from(i)))
        .collect();
    let often = |digits: &&u64| all.iter().filter(|other| other == digits).count();
    let most = *all.iter().max_by_key(often).expect("balls were thrown");
    vec![most as f64]
}

/// Digits of the pins that a ball touches on its way over the deck, pin 10 as 0.
fn touched(offset: f64) -> u64 {
    let (mut world, pins) = rack(1.0);
    let surface = physics::Material {
        surface: BALL,
        ..material(0.0, 0.0)
    };
    let (entry, speed) = (6f64.to_radians(), 7.3);
    let direction = DVec3::new(-entry.sin(), 0.0, -entry.cos());
    let at = DVec3::new(offset, BALL_RADIUS, -HEAD_PIN) - direction * 0.5;
    let mut def = ball(surface, at);
    def.linear_velocity = direction * speed;
    def.angular_velocity = DVec3::Y.cross(direction) * (speed / BALL_RADIUS);
    let id = world.add(def);
    let mut touched = [false; 10];
    while world.body(id).pose().position.z > DECK_END {
        world.step();
        for (touched, pin) in touched.iter_mut().zip(&pins) {
            *touched |= world.touching(id, *pin);
        }
    }
    let digits = (1..=10).filter(|number| touched[*number as usize - 1]);
    digits.fold(0, |all, digit| 10 * all + digit % 10)
}
