//! The largest gap over all normals, by sampling the sphere and refining the best samples.

use glam::{DMat3, DVec3};

use super::cases::Case;
use super::known::Known;
use super::line::lowest;

/// How precisely `Field::refine` places a normal [rad].
const PRECISION: f64 = 3e-10;

/// How hard the oracle looks.
pub struct Oracle {
    directions: Vec<DVec3>,
    starts: usize,
}

/// A normal and the gap between the tangent planes that it is square to [m].
#[derive(Clone, Copy, Debug)]
pub struct Best {
    /// The gap [m].
    pub gap: f64,
    /// Unit normal from a to b.
    pub normal: DVec3,
}

/// The gap of a case as a function of the normal, with the rotations as matrices.
pub struct Field<'a> {
    a: &'a Known,
    b: &'a Known,
    /// `local_from_world`.
    to_a: DMat3,
    to_b: DMat3,
    apart: DVec3,
}

impl<'a> Field<'a> {
    /// The field of a case.
    pub fn new(case: &'a Case) -> Field<'a> {
        Field {
            a: &case.a,
            b: &case.b,
            to_a: DMat3::from_quat(case.pose_a.rotation).transpose(),
            to_b: DMat3::from_quat(case.pose_b.rotation).transpose(),
            apart: case.pose_b.position - case.pose_a.position,
        }
    }

    /// Gap between the tangent planes with the unit normal `n` [m].
    pub fn gap(&self, n: DVec3) -> f64 {
        n.dot(self.apart) - self.a.height(self.to_a * n) - self.b.height(self.to_b * -n)
    }

    /// Normals at which gaps tend to be largest: along faces' normals, and square to two edges.
    fn special(&self) -> Vec<DVec3> {
        let (a, b) = (self.to_a.transpose(), self.to_b.transpose());
        let mut normals: Vec<DVec3> = self.apart.try_normalize().into_iter().collect();
        for (body, shape, sign) in [(&a, self.a, 1.0), (&b, self.b, -1.0)] {
            for axis in [body.x_axis, body.y_axis, body.z_axis] {
                normals.extend([axis, -axis]);
            }
            if let Known::Cloud(hull) = shape {
                normals.extend(hull.faces.iter().map(|face| *body * face.normal * sign));
            }
        }
        for u in [a.x_axis, a.y_axis, a.z_axis] {
            for v in [b.x_axis, b.y_axis, b.z_axis] {
                let square = u.cross(v).try_normalize();
                normals.extend(square.into_iter().flat_map(|n| [n, -n]));
            }
        }
        normals
    }

    /// Climbs from the unit normal `start`, with steps from `first` down to `last` [rad].
    ///
    /// Eight directions around, turned each time, and what has just led upwards once more: on a ridge, where most
    /// directions lead down, that finds the way along. After 500 steps it is left to `refine`.
    pub fn climb(&self, start: DVec3, first: f64, last: f64) -> Best {
        let mut best = Best {
            gap: self.gap(start),
            normal: start,
        };
        let (mut step, mut turn, mut misses, mut budget) = (first, 0.0f64, 0, 500);
        let mut lately = DVec3::ZERO;
        while step > last && budget > 0 {
            let mut better = None;
            if lately != DVec3::ZERO {
                budget -= 1;
                better = self.better(best, lately * 1.5);
            }
            if better.is_none() {
                let (u, v) = best.normal.any_orthonormal_pair();
                turn += 0.7;
                better = (0..8).find_map(|k| {
                    budget -= 1;
                    let (sin, cos) = (turn + f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
                    self.better(best, (u * cos + v * sin) * step)
                });
            }
            match better {
                Some(found) => {
                    lately = found.normal - best.normal;
                    best = found;
                    step *= 1.15;
                    misses = 0;
                }
                None => {
                    lately = DVec3::ZERO;
                    misses += 1;
                    if misses == 2 {
                        step *= 0.5;
                        misses = 0;
                    }
                }
            }
        }
        best
    }

    /// The best normal within about `window` [rad] of the unit normal `near`, by two nested line searches.
    ///
    /// On the plane that touches the sphere at `near`, where bodies are apart, gap over length rises to its maximum
    /// along every line and then falls, kinks and ridges included; where they overlap it does so near a maximum.
    pub fn refine(&self, near: DVec3, window: f64) -> Best {
        let (u, v) = near.any_orthonormal_pair();
        let at = |x: f64, y: f64| {
            let n = near + u * x + v * y;
            n / n.length()
        };
        let row = |x: f64| lowest(window, PRECISION, |y| -self.gap(at(x, y)));
        let (x, _) = lowest(window, PRECISION, |x| row(x).1);
        let normal = at(x, row(x).0);
        let found = Best {
            gap: self.gap(normal),
            normal,
        };
        let before = self.gap(near);
        if found.gap > before {
            found
        } else {
            Best {
                gap: before,
                normal: near,
            }
        }
    }

    /// Refines again and again, from wide to narrow, while that gains anything.
    fn settle(&self, near: DVec3) -> Best {
        let mut best = self.refine(near, 0.03);
        for _ in 0..4 {
            let next = self.refine(self.climb(best.normal, 3e-3, 1e-5).normal, 0.02);
            if next.gap <= best.gap + 1e-12 {
                break;
            }
            best = next;
        }
        best
    }

    fn better(&self, than: Best, by: DVec3) -> Option<Best> {
        let normal = (than.normal + by).try_normalize()?;
        let gap = self.gap(normal);
        (gap > than.gap).then_some(Best { gap, normal })
    }
}

impl Oracle {
    /// An oracle that samples `directions` normals and refines the `starts` best that are not close to each other.
    pub fn new(directions: u32, starts: usize) -> Oracle {
        let golden_angle = 2.399_963_229_728_653;
        let directions = (0..directions)
            .map(|i| {
                let y = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(directions);
                let (sin, cos) = (golden_angle * f64::from(i)).sin_cos();
                let across = (1.0 - y * y).sqrt();
                DVec3::new(across * cos, y, across * sin)
            })
            .collect();
        Oracle { directions, starts }
    }

    /// The largest gap found, and its normal. It is a lower bound of the truth, and nearly always the truth.
    pub fn best(&self, case: &Case) -> Best {
        let field = Field::new(case);
        if let Some(best) = against_half_space(case, &field) {
            return best;
        }
        self.tops(&field)
            .into_iter()
            .map(|top| field.settle(top.normal))
            .max_by(|x, y| x.gap.total_cmp(&y.gap))
            .expect("there is at least one start")
    }

    /// A larger gap than `known` elsewhere on the sphere, if there is one.
    pub fn better(&self, case: &Case, known: Best) -> Option<Best> {
        let field = Field::new(case);
        if let Some(best) = against_half_space(case, &field) {
            return (best.gap > known.gap).then_some(best);
        }
        // On a ridge a climb may stop this far below the top.
        let near = known.gap - 1e-3 * case.size();
        self.tops(&field)
            .into_iter()
            .filter(|top| top.gap > near && top.normal.dot(known.normal) < 0.9998)
            .map(|top| field.settle(top.normal))
            .filter(|top| top.gap > known.gap)
            .max_by(|x, y| x.gap.total_cmp(&y.gap))
    }

    /// The highest points of climbs from the best samples, the two best first.
    fn tops(&self, field: &Field) -> Vec<Best> {
        let mut samples: Vec<Best> = self
            .directions
            .iter()
            .copied()
            .chain(field.special())
            .map(|normal| Best {
                gap: field.gap(normal),
                normal,
            })
            .collect();
        let downwards = |x: &Best, y: &Best| y.gap.total_cmp(&x.gap);
        let kept = samples.len().min(60 * self.starts);
        samples.select_nth_unstable_by(kept - 1, downwards);
        samples.truncate(kept);
        samples.sort_by(downwards);
        let mut starts: Vec<Best> = Vec::new();
        for sample in samples {
            if starts.iter().all(|s| s.normal.dot(sample.normal) < 0.985) {
                starts.push(sample);
            }
            if starts.len() == self.starts {
                break;
            }
        }
        let mut tops: Vec<Best> = starts
            .into_iter()
            .map(|start| field.climb(start.normal, 0.03, 1e-5))
            .collect();
        tops.sort_by(downwards);
        tops.truncate(2);
        tops
    }
}

/// Half-spaces have one normal, and no search is needed.
fn against_half_space(case: &Case, field: &Field) -> Option<Best> {
    let normal = match (&case.a, &case.b) {
        (Known::HalfSpace(n), _) => case.pose_a.rotation * *n,
        (_, Known::HalfSpace(n)) => -(case.pose_b.rotation * *n),
        _ => return None,
    };
    let gap = field.gap(normal);
    Some(Best { gap, normal })
}
