//! How long two bodies touch while they strike each other, and the force in that time.

use std::f64::consts::TAU;

use crate::event::Impact;

/// Shortest contact that is told apart [s]: a quarter of a hard billiard stroke.
const SHORTEST_S: f64 = 5e-5;
/// Longest [s]: beyond it a blow is a push, and makes no sound of its own.
const LONGEST_S: f64 = 0.02;
/// Part of the impulse that is passed on in the small contacts between rough surfaces, before the whole has yielded.
///
/// K. van den Doel, P. Kry, D. Pai, *FoleyAutomatic*, SIGGRAPH 2001, §3.1, describes such micro-collisions. [D] 8 % within
/// an eighth of the time: without them nothing above three times the reverse of the contact time is heard.
const ROUGH_SHARE: f64 = 0.08;
const ROUGH_SHORTER: f64 = 8.0;

/// Time that two bodies touch, after H. Hertz for elastic spheres [s].
///
/// `T = 2.87 (m^2 / (R E^2 v))^(1/5)` with the reduced mass m, radius R and modulus E (K. L. Johnson, *Contact Mechanics*,
/// 1985, (11.24)): a harder blow is shorter, and so brighter.
pub fn contact_time(impact: &Impact) -> f64 {
    let [a, b] = impact.materials.map(|material| material.firmness());
    let parallel = |x: f64, y: f64| 1.0 / (1.0 / x + 1.0 / y);
    let mass = parallel(impact.masses[0], impact.masses[1]);
    let radius = parallel(a.radius, b.radius);
    let modulus = parallel(a.plane_modulus, b.plane_modulus);
    // Two flat faces have no radius: that of a hand's breadth stands for their edges.
    let radius = if radius.is_finite() { radius } else { 0.1 };
    let speed = impact.approach_speed.max(1e-3);
    let time = 2.87 * libm::pow(mass * mass / (radius * modulus * modulus * speed), 0.2);
    // Two immovable bodies, or numbers that are none, have no time; such a blow is heard as a dull one.
    if time.is_finite() {
        time.clamp(SHORTEST_S, LONGEST_S)
    } else {
        LONGEST_S
    }
}

/// Force over one contact, sample by sample, in parts of the whole impulse.
///
/// A raised cosine: `force = (1 - cos(2 pi t / T)) / T`. Its samples have the same sum wherever between two samples the
/// contact began, so that the level does not depend on that.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pulse {
    /// Time since the contact began at the next sample [samples].
    time: f64,
    /// Both parts' lengths, whole numbers of samples; the first is the longer one.
    lengths: [f64; 2],
    shares: [f64; 2],
}

impl Pulse {
    /// A contact that is over.
    pub const DONE: Pulse = Pulse {
        time: 0.0,
        lengths: [0.0; 2],
        shares: [0.0; 2],
    };

    /// A contact of `duration` [samples] that begins `delay` [samples] after the next sample.
    pub fn new(delay: f64, duration: f64) -> Self {
        let whole = |length: f64| libm::round(length).max(2.0);
        Pulse {
            time: -delay,
            lengths: [whole(duration), whole(duration / ROUGH_SHORTER)],
            shares: [1.0 - ROUGH_SHARE, ROUGH_SHARE],
        }
    }

    /// True once the contact is over.
    pub fn is_over(&self) -> bool {
        self.time >= self.lengths[0]
    }

    /// The next sample of the force.
    pub fn next(&mut self) -> f32 {
        let mut force = 0.0;
        for (length, share) in self.lengths.into_iter().zip(self.shares) {
            if self.time > 0.0 && self.time < length {
                force += share * (1.0 - libm::cos(TAU * self.time / length)) / length;
            }
        }
        self.time += 1.0;
        force as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Material;
    use glam::DVec3;

    fn blow(speed: f64) -> Impact {
        Impact {
            point: DVec3::ZERO,
            materials: [Material::Ball, Material::Pin],
            masses: [6.8, 1.59],
            impulse: 1.0,
            approach_speed: speed,
        }
    }

    #[test]
    fn contact_time_shortens_with_the_fifth_root_of_speed() {
        let ratio = contact_time(&blow(1.0)) / contact_time(&blow(32.0));
        assert!((ratio - 2.0).abs() < 1e-9, "{ratio}");
        // A ball at 7 m/s and a pin: m 1.288 kg, R 38.9 mm, E 0.975 GPa, by hand 1.04 ms.
        let time = contact_time(&blow(7.0));
        assert!((time - 1.04e-3).abs() < 2e-5, "{time}");
    }

    #[test]
    fn contact_time_bears_numbers_that_are_none() {
        for speed in [f64::NAN, 0.0, f64::INFINITY] {
            let time = contact_time(&blow(speed));
            assert!((SHORTEST_S..=LONGEST_S).contains(&time), "{speed}: {time}");
        }
    }

    #[test]
    fn pulse_passes_on_the_whole_impulse_wherever_it_begins() {
        for (delay, duration) in [(0.0, 48.0), (0.3, 48.4), (31.9, 2.0), (7.5, 300.0)] {
            let mut pulse = Pulse::new(delay, duration);
            let mut sum = 0.0;
            while !pulse.is_over() {
                sum += f64::from(pulse.next());
            }
            assert!((sum - 1.0).abs() < 1e-5, "{delay} {duration}: {sum}");
        }
    }
}
