//! Time of impact of two bodies that move and turn steadily.

use glam::DVec3;

use super::certificate::time_to_close;
use super::stretch::{Grade, Held, hold};
use crate::body::{Sweep, turn};
use crate::compound::{Compound, Part, Symmetry};
use crate::pose::Pose;
use crate::query::{Limits, gap_along, separation_placed};
use crate::step::{part_gap, place};

/// A time is right when the fastest point moves no more than this from then until the touch [m].
const ACCURACY: f64 = 2e-7;
/// Overlap between two times that may go unseen [m].
const DIP: f64 = 1e-7;
/// Gap that counts as none, as a share of the sizes.
const NOTHING: f64 = 1e-13;
/// Most normals for a pair of parts.
const SEARCHES: u32 = 500;

/// A body on its way: its velocity and its angular velocity stay as they are.
#[derive(Clone, Copy, Debug)]
pub struct Travel<'a> {
    /// Surface, in the body frame.
    pub compound: &'a Compound,
    /// `world_from_body` at time zero.
    pub pose: Pose,
    /// Velocity of the body frame's origin [m/s], world frame.
    pub linear_velocity: DVec3,
    /// Angular velocity [rad/s], world frame.
    pub angular_velocity: DVec3,
}

impl Travel<'_> {
    /// Where the body is after `t` [s].
    pub fn pose_at(&self, t: f64) -> Pose {
        let rotation = turn(self.angular_velocity * t) * self.pose.rotation;
        let position = self.pose.position + self.linear_velocity * t;
        Pose::new(position, rotation.normalize())
    }

    fn velocity_at(&self, t: f64, point: DVec3) -> DVec3 {
        let arm = point - self.pose.position - self.linear_velocity * t;
        self.linear_velocity + self.angular_velocity.cross(arm)
    }

    fn sweep(&self) -> Sweep {
        let rate = self.angular_velocity;
        let axis = self.pose.rotation * DVec3::Y;
        let (along, across) = match self.compound.symmetry() {
            Symmetry::Full => (0.0, 0.0),
            Symmetry::Axis => {
                let along = axis.dot(rate);
                (along, (rate - axis * along).length())
            }
            Symmetry::None => (0.0, rate.length()),
        };
        Sweep::new(along, across, self.compound.bounding_radius())
    }
}

/// When, where and how two bodies touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeOfImpact {
    /// Time [s]; they are proven apart before it, and touch within 2e-7 m of the faster one's way after it.
    pub time: f64,
    /// Unit normal from a to b at that time, world frame.
    pub normal: DVec3,
    /// Half way between the closest points [m], world frame.
    pub point: DVec3,
    /// What is left of the gap [m]; negative when they overlap at time zero.
    pub gap: f64,
    /// The parts that touch, of a and of b.
    pub parts: (usize, usize),
    /// Normals that were searched for, over all pairs of parts.
    pub searches: u32,
    /// New normals tried in those searches (§2.1); closed forms count none.
    pub iterations: u32,
    /// Whether the search was given up: they are apart until `time`, but need not touch then.
    pub capped: bool,
}

/// First touch of two bodies within `duration` [s], by conservative advancement; none if they stay apart.
///
/// Rotation is part of it, so that nothing passes anything at any speed; only a touch that ends again before it is
/// 1e-7 m deep may go unseen. What overlaps or touches at time zero answers with zero. Numbers that are none, or a
/// duration that is not positive, answer `None`.
pub fn time_of_impact(a: &Travel, b: &Travel, duration: f64) -> Option<TimeOfImpact> {
    let finite = |travel: &Travel| {
        let rates = [travel.linear_velocity, travel.angular_velocity];
        travel.pose.is_finite() && rates.iter().all(|v| v.is_finite())
    };
    if !(finite(a) && finite(b) && duration > 0.0 && duration.is_finite()) {
        return None;
    }
    let (sweep_a, sweep_b) = (a.sweep(), b.sweep());
    let linear = a.linear_velocity - b.linear_velocity;
    let radii = a.compound.bounding_radius() + b.compound.bounding_radius();
    let start = balls_touch(b.pose.position - a.pose.position, -linear, radii)?;
    let mut run = Run {
        travels: (a, b),
        bend: sweep_a.acceleration + sweep_b.acceleration,
        speed: linear.length() + sweep_a.turning + sweep_b.turning,
        start,
        duration,
        searches: 0,
        iterations: 0,
    };
    if start > duration {
        return None;
    }
    let mut first: Option<TimeOfImpact> = None;
    for (i, part_a) in a.compound.parts().iter().enumerate() {
        for (j, part_b) in b.compound.parts().iter().enumerate() {
            if let Some(found) = run.parts((part_a, part_b), (i, j)) {
                // A later touch of other parts is of no interest.
                run.duration = found.time;
                if first.is_none_or(|f| found.time < f.time) {
                    first = Some(found);
                }
            }
        }
    }
    let (searches, iterations) = (run.searches, run.iterations);
    first.map(|found| TimeOfImpact {
        searches,
        iterations,
        ..found
    })
}

/// Time [s], not after the first touch, at which two balls touch whose centres are `apart` [m] and move against each
/// other at `velocity` [m/s]; zero when they overlap, none when they never touch.
fn balls_touch(apart: DVec3, velocity: DVec3, radii: f64) -> Option<f64> {
    let excess = apart.length_squared() - radii * radii;
    // Half-spaces are in no ball.
    if excess <= 0.0 || radii == f64::INFINITY {
        return Some(0.0);
    }
    let closing = -apart.dot(velocity);
    let root = closing * closing - velocity.length_squared() * excess;
    // A little before, for rounding; a graze is left to the search.
    let slack = 1e-12 * closing * closing;
    (closing > 0.0 && root > -slack)
        .then(|| excess / (closing + (root + slack).sqrt()) * (1.0 - 1e-15))
}

/// What is the same for all pairs of parts.
struct Run<'a> {
    travels: (&'a Travel<'a>, &'a Travel<'a>),
    /// Bound of the acceleration of one surface against the other [m/s2].
    bend: f64,
    /// Bound of the speed of one surface against the other [m/s].
    speed: f64,
    /// Time before which not even the balls around the bodies touch [s].
    start: f64,
    /// Time after which nothing is of interest [s].
    duration: f64,
    searches: u32,
    iterations: u32,
}

impl Run<'_> {
    fn parts(&mut self, parts: (&Part, &Part), numbers: (usize, usize)) -> Option<TimeOfImpact> {
        let (a, b) = self.travels;
        let placed = |t: f64| (place(parts.0, &a.pose_at(t)), place(parts.1, &b.pose_at(t)));
        let (mut time, mut span) = (self.start, self.duration - self.start);
        let start = placed(time);
        let rough = part_gap(&start.0, parts.0, &start.1, parts.1);
        if time_to_close(rough, self.speed, 0.0) > span {
            return None;
        }
        let size = parts.0.shape.size() + parts.1.shape.size();
        let mut known: Option<DVec3> = None;
        for search in 0.. {
            let (x, y) = placed(time);
            let found = separation_placed(&x, &y, known, Limits::default());
            self.searches += 1;
            self.iterations += found.iterations;
            let point = (found.point_a + found.point_b) * 0.5;
            let slip = a.velocity_at(time, point) - b.velocity_at(time, point);
            let closing = found.normal.dot(slip);
            let answer = TimeOfImpact {
                time,
                normal: found.normal,
                point,
                gap: found.gap,
                parts: numbers,
                searches: 0,
                iterations: 0,
                capped: search == SEARCHES,
            };
            let near = found.gap <= NOTHING * size || found.gap * self.speed <= ACCURACY * closing;
            if found.gap <= 0.0 || (near && closing > 0.0) || answer.capped {
                return Some(answer);
            }
            known = Some(found.normal);
            // Halved until the normal tells something, and doubled again where it does.
            loop {
                let end = (time + span).min(self.duration);
                let grade = Grade {
                    bend: self.bend,
                    dip: DIP,
                    enough: self.enough(found.gap, closing).max(0.5 * NOTHING * size),
                };
                let at = |t: f64| {
                    let (x, y) = placed(t);
                    gap_along(&x, &y, found.normal)
                };
                match hold(&at, (time, found.gap), end, &grade) {
                    Held::Through if end == self.duration => return None,
                    Held::Through => (time, span) = (end, 2.0 * span),
                    Held::Unclear => {
                        span = 0.5 * (end - time);
                        continue;
                    }
                    Held::Until(root) => time = root,
                }
                break;
            }
        }
        None
    }

    /// Gap [m] with which the advance along one normal ends: what decides is that of the next.
    fn enough(&self, gap: f64, closing: f64) -> f64 {
        let share = if self.speed > 0.0 {
            (closing / self.speed).max(0.0)
        } else {
            0.0
        };
        (0.5 * ACCURACY * share).min(0.5 * gap)
    }
}
