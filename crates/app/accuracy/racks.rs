//! Jittered throws at a rack, and how far two distributions of fallen pins are apart.
//!
//! A rack is chaotic: one set of fallen pins says nothing, so only distributions are compared.

use std::sync::Arc;

use glam::DVec3;
use physics::{BodyId, Compound, Response, World};

use super::report::{Reference, p95};
use super::timing::Time;
use crate::hard_cases::scene::{
    BALL_RADIUS, Setup, add_alley, add_rack, between, run, throw, tilt,
};
use crate::shot::clock::thread_seconds;
use crate::shot::series;
use experiment::random::SplitMix64;

/// Simulated time of a throw [s]: what falls has begun to.
const DURATION: f64 = 1.2;
/// Draws that tell how far two samples of one distribution are apart.
const DRAWS: u64 = 400;

/// A setting under which racks are thrown at.
#[derive(Clone)]
pub struct Rack {
    /// Law of impacts.
    pub response: Response,
    /// Steps a second [1/s].
    pub step_hz: f64,
    /// Elasticity and friction of every pair.
    pub contact: (f64, f64),
    /// The pin's shape.
    pub pin: Arc<Compound>,
    /// Seed of the jitter.
    pub seed: u64,
}

/// Fallen pins of many throws of one setting.
#[derive(Clone, Debug)]
pub struct Fallen {
    /// Throws by the number of pins that fell.
    counts: [u64; 11],
    /// Processor time per simulated second [ns].
    pub time: Time,
}

impl Rack {
    fn prepared(&self) -> (Setup, World, Vec<BodyId>) {
        let setup = Setup {
            sleeping: true,
            ..Setup::new(self.response).rate(self.step_hz)
        };
        let setup = setup.contact(self.contact.0, self.contact.1);
        let mut world = setup.world();
        add_alley(&mut world, &setup);
        let pins = add_rack(&mut world, &setup, &self.pin);
        (setup, world, pins)
    }
}

/// Distributions of several settings beside a reference that is itself compared with other throws.
pub struct Comparison {
    /// One for each setting, in their order.
    pub samples: Vec<Fallen>,
    /// What they are compared with.
    pub reference: Fallen,
    /// What 95 of 100 pairs of such samples stay below [pins].
    pub noise: f64,
    /// The reference beside other throws of the same setting.
    pub check: Reference,
}

/// Throws at every setting, and twice at the `reference`, which `name` names, with seeds of their own.
pub fn compare(
    mut racks: Vec<Rack>,
    reference: &Rack,
    name: &str,
    throws: u64,
    noise_seed: u64,
) -> Comparison {
    racks.extend([2, 3].map(|seed| Rack {
        seed,
        ..reference.clone()
    }));
    let mut samples = fallen(&racks, throws);
    let other = samples.pop().expect("it was put in");
    let reference = samples.pop().expect("it was put in");
    let noise = reference.noise(noise_seed);
    let check = Reference {
        truth: format!("fallen pins of {throws} throws {name}"),
        other: "as many other throws".to_owned(),
        difference: reference.distance(&other),
        allowed: 2.0 * noise,
        unit: "pins",
    };
    Comparison {
        samples,
        reference,
        noise,
        check,
    }
}

/// Throws at every setting, all settings in turns on all cores.
fn fallen(racks: &[Rack], throws: u64) -> Vec<Fallen> {
    let prepared: Vec<(Setup, World, Vec<BodyId>)> = racks.iter().map(Rack::prepared).collect();
    let settings = racks.len() as u64;
    let work = |piece: u64| {
        let index = (piece % settings) as usize;
        let (setup, world, pins) = &prepared[index];
        let mut random = SplitMix64::for_index(racks[index].seed, piece / settings);
        one(setup, world, pins, &mut random)
    };
    let mut counts = vec![[0; 11]; racks.len()];
    let mut times = vec![Vec::new(); racks.len()];
    let mut piece = 0;
    let taken = series::run(
        throws * settings,
        series::threads(None),
        work,
        |(pins, time)| {
            counts[piece % racks.len()][pins] += 1;
            times[piece % racks.len()].push(time);
            piece += 1;
            Ok::<(), std::convert::Infallible>(())
        },
    );
    taken.expect("nothing refuses a result");
    let both = counts.into_iter().zip(times);
    both.map(|(counts, times)| Fallen {
        counts,
        time: Time::of(times),
    })
    .collect()
}

/// Pins that fell in one throw, and its processor time per simulated second [ns].
fn one(setup: &Setup, rack: &World, pins: &[BodyId], random: &mut SplitMix64) -> (usize, f64) {
    let mut world = rack.clone();
    let aside = 0.06 + between(random, -0.06, 0.06);
    let speed = 8.0 + between(random, -0.5, 0.5);
    let ball = throw(&mut world, setup, aside, 0.3, speed);
    let across = between(random, -0.4, 0.2);
    let body = world.body(ball);
    let (linear, angular) = (body.linear_velocity(), body.angular_velocity());
    let (linear, angular) = (
        linear + DVec3::X * across,
        angular - DVec3::Z * (across / BALL_RADIUS),
    );
    world.set_velocity(ball, linear, angular);
    let begun = thread_seconds();
    run(&mut world, DURATION);
    let time = 1e9 * (thread_seconds() - begun) / DURATION;
    let is_down = |id: &&BodyId| {
        let body = world.body(**id);
        // Leaning, or off the deck.
        tilt(body) > 30.0 || body.pose().position.y < 0.1
    };
    (pins.iter().filter(is_down).count(), time)
}

impl Fallen {
    /// Mean number of pins.
    pub fn mean(&self) -> f64 {
        let pins = self.counts.iter().enumerate();
        pins.map(|(pins, count)| (pins as u64 * count) as f64)
            .sum::<f64>()
            / self.throws() as f64
    }

    fn throws(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Area between the two cumulative distributions [pins]: the work of turning one into the other.
    pub fn distance(&self, other: &Fallen) -> f64 {
        apart(&self.counts, &other.counts)
    }

    /// What 95 of 100 pairs of samples as large as this of one distribution stay below [pins].
    pub fn noise(&self, seed: u64) -> f64 {
        let drawn = |random: &mut SplitMix64| {
            let mut counts = [0; 11];
            for _ in 0..self.throws() {
                let mut left = (random.uniform() * self.throws() as f64) as u64;
                let pins = self.counts.iter().position(|count| {
                    let is_it = left < *count;
                    left = left.saturating_sub(*count);
                    is_it
                });
                counts[pins.unwrap_or(10)] += 1;
            }
            counts
        };
        let draws = (0..DRAWS).map(|draw| {
            let mut random = SplitMix64::for_index(seed, draw);
            apart(&drawn(&mut random), &drawn(&mut random))
        });
        p95(draws.collect())
    }
}

fn apart(a: &[u64; 11], b: &[u64; 11]) -> f64 {
    let all = |counts: &[u64; 11]| counts.iter().sum::<u64>() as f64;
    let (all_a, all_b) = (all(a), all(b));
    let (mut below, mut area) = (0.0, 0.0_f64);
    for (x, y) in a.iter().zip(b) {
        below += *x as f64 / all_a - *y as f64 / all_b;
        area += below.abs();
    }
    area
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn apart_is_the_shift_of_a_shifted_distribution() {
        let mut a = [0; 11];
        let mut b = [0; 11];
        (a[3], a[5], b[5], b[7]) = (10, 30, 20, 60);
        assert!((apart(&a, &b) - 2.0).abs() < 1e-12);
        assert_eq!(apart(&a, &a), 0.0);
    }
}
