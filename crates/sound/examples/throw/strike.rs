//! A strike as a script of contacts: what a throw of the game sends, in round numbers and without a game.

use glam::DVec3;
use sound::{Event, Impact, Listener, Material, Rolling, Sounding};

/// Time at which the ball lands on the lane [s].
pub const LANDING_S: f64 = 0.4;
/// Time at which it meets the head pin [s].
pub const CRASH_S: f64 = 2.75;
/// Length of the whole [s].
pub const LENGTH_S: f64 = 7.0;

const BALL_KG: f64 = 6.8;
const PIN_KG: f64 = 1.59;

/// All contacts of the throw, rolling and machine included, not in order.
pub fn strike() -> Vec<Event> {
    let mut events = vec![at(0.0, Sounding::Listener(bowler()))];
    events.push(landing());
    events.extend(rolling());
    events.extend(crash());
    let point = DVec3::new(0.0, 1.0, -19.5);
    for (time, is_running) in [(4.2, true), (6.0, false)] {
        events.push(at(time, Sounding::Machine { is_running, point }));
    }
    events
}

/// A bowler who stands at the foul line.
pub fn bowler() -> Listener {
    Listener {
        position: DVec3::new(-0.3, 1.6, 0.3),
        ..Listener::default()
    }
}

fn at(time_s: f64, sounding: Sounding) -> Event {
    Event { time_s, sounding }
}

fn landing() -> Event {
    let impact = Impact {
        point: DVec3::new(0.2, 0.0, -0.4),
        materials: [Material::Ball, Material::Lane],
        masses: [BALL_KG, f64::INFINITY],
        impulse: 8.0,
        approach_speed: 0.8,
    };
    at(LANDING_S, Sounding::Impact(impact))
}

/// The ball's way to the pins, 72 times a second: 18 m in 2.35 s, a little slower at the end.
fn rolling() -> impl Iterator<Item = Event> {
    let steps = ((CRASH_S - LANDING_S + 0.3) * 72.0) as u32;
    (0..steps).map(|step| {
        let t = f64::from(step) / 72.0;
        let rolling = Rolling {
            body: 0,
            point: DVec3::new(0.2, 0.0, -0.4 - 7.9 * t + 0.16 * t * t),
            speed: 7.9 - 0.32 * t,
            surface: Material::Lane,
        };
        at(LANDING_S + t, Sounding::Rolling(rolling))
    })
}

/// The ball drives into the rack; the pins strike each other, kickbacks, deck and cushion for a second and a half.
pub fn crash() -> Vec<Event> {
    let mut events: Vec<Event> = [(0.0, 13.0), (0.045, 8.0), (0.09, 6.0), (0.13, 4.0)]
        .into_iter()
        .map(|(late, impulse)| contact(late, [Material::Ball, Material::Pin], impulse))
        .collect();
    events.extend((0..90).map(|i| {
        // The golden ratio scatters without a random number; ever later, ever weaker.
        let scatter = (f64::from(i) * 0.618_034).fract();
        let late = 0.01 + 1.4 * (f64::from(i) / 90.0).powi(2) + 0.02 * scatter;
        let materials = match i % 9 {
            0..4 => [Material::Pin, Material::Pin],
            4 | 5 => [Material::Pin, Material::Kickback],
            6 | 7 => [Material::Pin, Material::Lane],
            _ => [Material::Pin, Material::Cushion],
        };
        let impulse = (1.0 + 5.0 * scatter) * (1.0 - 0.85 * f64::from(i) / 90.0);
        contact(late, materials, impulse)
    }));
    events
}

fn contact(late: f64, materials: [Material; 2], impulse: f64) -> Event {
    let masses = materials.map(|material| match material {
        Material::Ball => BALL_KG,
        Material::Pin => PIN_KG,
        _ => f64::INFINITY,
    });
    let reduced = 1.0 / (1.0 / masses[0] + 1.0 / masses[1]);
    let side = (late * 37.0).sin() * 0.5;
    let impact = Impact {
        point: DVec3::new(side, 0.15, -18.3 - 0.8 * (late * 11.0).sin().abs()),
        materials,
        masses,
        impulse,
        // A pin answers with two thirds of the speed that it is met with.
        approach_speed: impulse / reduced / 1.65,
    };
    at(CRASH_S + late, Sounding::Impact(impact))
}
