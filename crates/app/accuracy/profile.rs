//! The pin by its specification profile, exact in a half-plane: the reference of the shape ladder and of first hits.

use glam::DVec3;
use physics::{Compound, Pose, Shape};

use crate::hard_cases::scene::PIN_CG;

/// Rows of height and radius [m] of the specification's outline, from the base to the crown.
const TABLE: &str = include_str!("../../game/tests/data/pin_profile.csv");

/// An outline that turns about the y axis: corners as radius and height above the pin's centre of mass [m].
#[derive(Clone, Debug)]
pub struct Profile {
    corners: Vec<(f64, f64)>,
}

/// Where a profile is nearest to a point.
#[derive(Clone, Copy, Debug)]
pub struct Nearest {
    /// Distance of a point outside [m].
    pub distance: f64,
    /// The nearest point of the surface [m].
    pub point: DVec3,
}

impl Profile {
    /// The specification's, 179 slices.
    pub fn specification() -> Profile {
        let number = |text: &str| text.trim().parse::<f64>().expect("the table holds numbers");
        let corners = TABLE.lines().skip(1).map(|line| {
            let (height, radius) = line.split_once(',').expect("the table has two columns");
            (number(radius), number(height) - PIN_CG)
        });
        let mut corners: Vec<(f64, f64)> = corners.collect();
        // Where two of the specification's arcs meet the table has a row of each.
        corners.dedup();
        Profile { corners }
    }

    /// The outline as a smooth curve through its corners, in so many slices for each of the table's.
    ///
    /// Cubics whose slopes are those of the parabola through three neighbours; the base's edge and its flat stay.
    pub fn smooth(&self, finer: usize) -> Profile {
        let wall = &self.corners[1..];
        let length = |i: usize| (wall[i + 1].0 - wall[i].0).hypot(wall[i + 1].1 - wall[i].1);
        let last = wall.len() - 1;
        let slope = |i: usize, of: fn(&(f64, f64)) -> f64| {
            let chord = |i: usize| (of(&wall[i + 1]) - of(&wall[i])) / length(i);
            match i {
                0 => chord(0),
                i if i == last => chord(last - 1),
                i => {
                    let (before, after) = (length(i - 1), length(i));
                    (chord(i - 1) * after + chord(i) * before) / (before + after)
                }
            }
        };
        let mut corners = vec![self.corners[0], wall[0]];
        for i in 0..last {
            for k in 1..=finer {
                let t = k as f64 / finer as f64;
                let at = |of: fn(&(f64, f64)) -> f64| {
                    let (p, q) = (of(&wall[i]), of(&wall[i + 1]));
                    let (u, v) = (slope(i, of) * length(i), slope(i + 1, of) * length(i));
                    let s = 1.0 - t;
                    p * s * s * (1.0 + 2.0 * t) + q * t * t * (3.0 - 2.0 * t) + u * t * s * s
                        - v * t * t * s
                };
                corners.push((at(|p| p.0).max(0.0), at(|p| p.1)));
            }
        }
        Profile { corners }
    }

    /// The same with corners on the outline at so many equal lengths along it, and at both ends of the base.
    pub fn slices(&self, count: usize) -> Profile {
        // The base's flat is kept: a pin stands on it.
        let wall = &self.corners[1..];
        let mut along = vec![0.0];
        for pair in wall.windows(2) {
            let step = (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1);
            along.push(along[along.len() - 1] + step);
        }
        let whole = along[along.len() - 1];
        let mut corners = vec![self.corners[0]];
        for k in 0..=count {
            let at = whole * k as f64 / count as f64;
            let i = along.partition_point(|s| *s <= at).clamp(1, wall.len() - 1);
            let share = ((at - along[i - 1]) / (along[i] - along[i - 1])).clamp(0.0, 1.0);
            let mix = |a: f64, b: f64| a + (b - a) * share;
            corners.push((mix(wall[i - 1].0, wall[i].0), mix(wall[i - 1].1, wall[i].1)));
        }
        Profile { corners }
    }

    /// How many slices the wall has.
    pub fn count(&self) -> usize {
        self.corners.len() - 2
    }

    /// A cone cut at both ends for each slice.
    pub fn compound(&self) -> Compound {
        let slices = self.corners[1..]
            .windows(2)
            .filter(|pair| pair[1].1 > pair[0].1);
        let parts = slices.map(|pair| {
            let half = 0.5 * (pair[1].1 - pair[0].1);
            let shape = Shape::frustum(pair[0].0, pair[1].0, half);
            let middle = Pose::from_position(DVec3::Y * (pair[0].1 + half));
            (middle, shape.expect("a slice has a height and a radius"))
        });
        Compound::new(parts.collect()).expect("at most 255 slices make a body")
    }

    /// The hull of corners on rings of so many points, of every `stride`-th corner.
    pub fn cloud(&self, around: u32, stride: usize) -> Compound {
        let wall = &self.corners[1..];
        let rings = wall.iter().enumerate();
        let kept = rings.filter(|(i, _)| i % stride == 0 || i + 1 == wall.len());
        let points: Vec<DVec3> = kept
            .flat_map(|(_, (radius, height))| {
                (0..around).map(move |k| {
                    let turn = std::f64::consts::TAU * f64::from(k) / f64::from(around);
                    DVec3::new(radius * libm::cos(turn), *height, radius * libm::sin(turn))
                })
            })
            .collect();
        Compound::single(Shape::cloud(&points).expect("finite points"))
    }

    /// The nearest point of the surface to a point outside, both in the pin's frame.
    pub fn nearest(&self, to: DVec3) -> Nearest {
        let across = to.x.hypot(to.z);
        let outward = if across > 0.0 {
            DVec3::new(to.x, 0.0, to.z) / across
        } else {
            DVec3::X
        };
        let places = self.corners.windows(2).map(|pair| {
            let ((r0, y0), (r1, y1)) = (pair[0], pair[1]);
            let (dr, dy) = (r1 - r0, y1 - y0);
            let square = dr * dr + dy * dy;
            let along = if square > 0.0 {
                (((across - r0) * dr + (to.y - y0) * dy) / square).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let (r, y) = (r0 + along * dr, y0 + along * dy);
            ((across - r).hypot(to.y - y), r, y)
        });
        let (distance, radius, height) = places
            .min_by(|x, y| x.0.total_cmp(&y.0))
            .expect("a profile has corners");
        Nearest {
            distance,
            point: outward * radius + DVec3::Y * height,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_is_on_the_belly_beside_it_and_on_the_crown_above() {
        let pin = Profile::specification();
        assert_eq!(pin.count(), 179);
        // Belly 121.056 mm wide at 114.3 mm (USBC specification); the outline is widest, 121.252 mm, 5.08 mm higher.
        let at_belly = |(r, y): &(f64, f64)| {
            (r - 0.060528).abs() < 1e-6 && (y - (0.1143 - PIN_CG)).abs() < 1e-6
        };
        assert!(pin.corners.iter().any(at_belly));
        let beside = pin.nearest(DVec3::new(1.0, 0.1143 - PIN_CG, 0.0));
        let widest = (1.0 - 0.060626_f64).hypot(0.00508);
        assert!((beside.distance - widest).abs() < 1e-9, "{beside:?}");
        // 381 mm tall.
        let above = pin.nearest(DVec3::Y);
        assert!((1.0 - above.distance - (0.381 - PIN_CG)).abs() < 1e-6);
    }

    #[test]
    fn slices_keep_base_and_height() {
        let pin = Profile::specification().slices(16);
        assert_eq!(pin.count(), 16);
        let base = pin.nearest(DVec3::NEG_Y);
        assert!((base.distance - (1.0 - PIN_CG)).abs() < 1e-12);
        assert_eq!(pin.compound().parts().len(), 16);
    }
}
