//! When will two parts touch: conservative advancement along the separating normal.
//!
//! For a fixed normal n the gap `s_n(t)` between the tangent planes is a lower bound of the distance at every time.
//! Each point of a body moves with an acceleration of at most c, so between two times with `s_n = s0, s1`
//! `s_n >= lerp(s0, s1) - c (t - t0) (t1 - t) / 2`, kinks of the shape included. Two evaluations so prove most pairs
//! apart for the whole step; otherwise the root of `s_n` is the next time to look, with a new n.

use glam::DVec3;

use super::pairs::{Key, PartPair};
use super::touch::{Frame, place};
use super::{CONTACT, SINK};
use crate::body::Body;
use crate::compound::Part;
use crate::pose::Pose;
use crate::query::{Placed, distance_to_point, gap_along};
use crate::world::World;

/// Most searches for one pair of parts in a step.
const SEARCHES: usize = 40;
/// A dip between two times that is no deeper than this is not looked for [m].
const DIP: f64 = 2e-6;
/// Bodies that overlap and part slower than this are in contact [m/s].
const PARTING: f64 = 5e-3;
/// Slower approach than this is none [m/s].
const APPROACH: f64 = 1e-9;

/// A future contact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Event {
    pub time: f64,
    pub key: Key,
}

/// What the search learnt about a pair of parts.
struct Found {
    time: Option<f64>,
    normal: DVec3,
    /// Proven gap at the start of the search.
    gap: f64,
    /// Times looked at.
    looks: u32,
}

impl World {
    /// Earliest contact of two bodies after `t0`, both states standing at or before it.
    pub(crate) fn first_contact(&mut self, a: usize, b: usize, t0: f64, dt: f64) -> Option<Event> {
        let (a, b) = (a.min(b), a.max(b));
        let (body_a, body_b) = (&self.bodies[a], &self.bodies[b]);
        if !may_collide(body_a, body_b) {
            return None;
        }
        let (ways, reach) = (body_a.path + body_b.path, body_a.reach + body_b.reach);
        if self.pairs.get(a, b).clearance - ways > reach {
            return None;
        }
        let (pose_a, pose_b) = (body_a.pose_at(t0), body_b.pose_at(t0));
        let rough = rough_gap(body_a, &pose_a, body_b, &pose_b);
        if rough > reach {
            self.pairs.get_mut(a, b).clearance = rough + ways;
            return None;
        }
        if self.pairs.get(a, b).parts.is_empty() {
            self.pairs.get_mut(a, b).parts = part_pairs(body_a, body_b, ways);
        }
        let (body_a, body_b) = (&self.bodies[a], &self.bodies[b]);
        let starts = (Frame::new(&pose_a), Frame::new(&pose_b));
        let ends = (Frame::new(&body_a.end), Frame::new(&body_b.end));
        let mut first: Option<Event> = None;
        let mut clearance = f64::INFINITY;
        for part in 0..self.pairs.get(a, b).parts.len() {
            let key = Key {
                a: a as u32,
                b: b as u32,
                part: part as u32,
            };
            let known = self.pairs.part(key);
            if known.clearance - ways > reach {
                clearance = clearance.min(known.clearance);
                continue;
            }
            let found = self.part_contact(known, (a, b), (t0, dt), (&starts, &ends));
            self.effort.looks += u64::from(found.looks);
            let entry = self.pairs.part_mut(key);
            entry.normal = found.normal;
            entry.clearance = if entry.touching {
                ways
            } else {
                found.gap + ways
            };
            clearance = clearance.min(entry.clearance);
            if let Some(time) = found.time
                && first.is_none_or(|f| time < f.time)
            {
                first = Some(Event { time, key });
            }
        }
        self.pairs.get_mut(a, b).clearance = clearance;
        first
    }

    /// The same for one pair of parts.
    fn part_contact(
        &self,
        known: &PartPair,
        (a, b): (usize, usize),
        (t0, dt): (f64, f64),
        (starts, ends): (&(Frame, Frame), &(Frame, Frame)),
    ) -> Found {
        let (body_a, body_b) = (&self.bodies[a], &self.bodies[b]);
        let part_a = &body_a.compound.parts()[known.part_a as usize];
        let part_b = &body_b.compound.parts()[known.part_b as usize];
        let mut placed = (starts.0.place(part_a), starts.1.place(part_b));
        let reach = body_a.reach + body_b.reach;
        if !known.touching {
            let rough = part_gap(&placed.0, part_a, &placed.1, part_b);
            if rough > reach {
                return Found {
                    time: None,
                    normal: known.normal,
                    gap: rough,
                    looks: 1,
                };
            }
        }
        let bend = body_a.sweep().acceleration + body_b.sweep().acceleration;
        let ends = (ends.0.place(part_a), ends.1.place(part_b));
        let mut normal = known.normal;
        let mut gap = if normal == DVec3::ZERO {
            0.0
        } else {
            gap_along(&placed.0, &placed.1, normal)
        };
        let mut first_gap = gap;
        let mut searched = false;
        let (mut time, mut end) = (t0, dt);
        let mut looks = 0;
        for _ in 0..SEARCHES {
            looks += 1;
            let stale = gap <= CONTACT && !known.touching;
            if !searched && (stale || normal == DVec3::ZERO) {
                let found = self.search(&placed.0, &placed.1, normal);
                (normal, gap, searched) = (found.normal, found.gap, true);
                if time == t0 {
                    first_gap = first_gap.max(gap);
                }
                if gap <= CONTACT && !known.touching {
                    let point = (found.point_a + found.point_b) * 0.5;
                    if closing(body_a, body_b, time, point, normal, gap) {
                        return Found {
                            time: Some(time),
                            normal,
                            gap: first_gap,
                            looks,
                        };
                    }
                }
            }
            // A lasting contact may sink a little; one that just separated starts from where it is.
            let floor = if known.touching || gap <= CONTACT {
                gap.min(0.0) - SINK
            } else {
                0.0
            };
            let at = |t: f64| {
                let (x, y) = if t == dt {
                    ends
                } else {
                    (
                        place(part_a, &body_a.pose_at(t)),
                        place(part_b, &body_b.pose_at(t)),
                    )
                };
                gap_along(&x, &y, normal) - floor
            };
            let (s0, s1) = (gap - floor, at(end));
            let span = end - time;
            let dip = 0.125 * bend * span * span - s0.min(s1);
            if s1 > 0.0 && dip < DIP {
                if end == dt {
                    return Found {
                        time: None,
                        normal,
                        gap: first_gap,
                        looks,
                    };
                }
                time = end;
                end = dt;
            } else if s1 > 0.0 {
                end = 0.5 * (time + end);
                continue;
            } else {
                let root = last_apart(&at, (time, s0), (end, s1));
                if !searched || floor == 0.0 {
                    if root <= time {
                        // The bound itself starts at contact: look again with a fresh normal.
                        if searched {
                            return Found {
                                time: Some(time),
                                normal,
                                gap: first_gap,
                                looks,
                            };
                        }
                    }
                } else {
                    return Found {
                        time: Some(root),
                        normal,
                        gap: first_gap,
                        looks,
                    };
                }
                time = root;
                end = dt;
            }
            placed = (
                place(part_a, &body_a.pose_at(time)),
                place(part_b, &body_b.pose_at(time)),
            );
            let found = self.search(&placed.0, &placed.1, normal);
            (normal, gap, searched) = (found.normal, found.gap, true);
            if gap <= CONTACT {
                let point = (found.point_a + found.point_b) * 0.5;
                if known.touching || closing(body_a, body_b, time, point, normal, gap) {
                    return Found {
                        time: Some(time),
                        normal,
                        gap: first_gap,
                        looks,
                    };
                }
            }
        }
        Found {
            time: Some(time),
            normal,
            gap: first_gap,
            looks,
        }
    }
}

/// Whether the pair is looked at: one moves, and one can be moved.
fn may_collide(a: &Body, b: &Body) -> bool {
    a.collides
        && b.collides
        && (a.is_dynamic() || b.is_dynamic())
        && !(a.is_still() && b.is_still())
}

fn part_pairs(a: &Body, b: &Body, ways: f64) -> Vec<PartPair> {
    let (count_a, count_b) = (a.compound.parts().len(), b.compound.parts().len());
    let mut list = Vec::with_capacity(count_a * count_b);
    for part_a in 0..count_a as u8 {
        for part_b in 0..count_b as u8 {
            list.push(PartPair {
                part_a,
                part_b,
                normal: DVec3::ZERO,
                clearance: ways + f64::MIN_POSITIVE - 1.0,
                touching: false,
                seen: None,
            });
        }
    }
    list
}

/// Lower bound of the gap between two bodies: one's bounding ball against the other's parts.
fn rough_gap(a: &Body, pose_a: &Pose, b: &Body, pose_b: &Pose) -> f64 {
    let (radius_a, radius_b) = (a.compound.bounding_radius(), b.compound.bounding_radius());
    let apart = (pose_b.position - pose_a.position).length() - radius_a - radius_b;
    if apart > 0.0 {
        return apart;
    }
    let (ball, radius, other, pose) = if radius_a <= radius_b {
        (pose_a.position, radius_a, b, pose_b)
    } else {
        (pose_b.position, radius_b, a, pose_a)
    };
    let bound = |part: &Part| {
        let placed = place(part, pose);
        distance_to_point(&placed, ball)
            .unwrap_or_else(|| (ball - placed.position).length() - part.radius)
    };
    other
        .compound
        .parts()
        .iter()
        .map(bound)
        .fold(f64::INFINITY, f64::min)
        - radius
}

/// Lower bound of the gap between two parts.
fn part_gap(a: &Placed, part_a: &Part, b: &Placed, part_b: &Part) -> f64 {
    let apart = (b.position - a.position).length() - part_a.radius - part_b.radius;
    if apart > 0.0 {
        return apart;
    }
    if part_a.radius <= part_b.radius {
        distance_to_point(b, a.position).map_or(apart, |d| d - part_a.radius)
    } else {
        distance_to_point(a, b.position).map_or(apart, |d| d - part_b.radius)
    }
}

/// Whether the bodies approach along `normal` at a point at time `t`, or begin to, or overlap and do not part.
fn closing(a: &Body, b: &Body, t: f64, point: DVec3, normal: DVec3, gap: f64) -> bool {
    let velocity = |body: &Body| {
        let pose = body.pose_at(t);
        let linear =
            body.linear + body.acceleration * (t - body.clock) + body.bend.0 * (t - body.middle);
        linear + body.angular_velocity().cross(point - pose.position)
    };
    let speed = normal.dot(velocity(a) - velocity(b));
    let bend = a.acceleration + a.bend.0 - b.acceleration - b.bend.0;
    speed > APPROACH
        || (speed > -1e3 * APPROACH && normal.dot(bend) > 0.0)
        || (gap < -SINK && speed > -PARTING)
}

/// Latest time found before the gap `at` falls to zero between `low` (apart) and `high` (not), by regula falsi.
fn last_apart(at: &impl Fn(f64) -> f64, low: (f64, f64), high: (f64, f64)) -> f64 {
    let ((mut t0, mut s0), (mut t1, mut s1)) = (low, high);
    if s0 <= 0.0 {
        return t0;
    }
    let mut weight = (s0, s1);
    for i in 0..40 {
        if s0 <= 0.5 * CONTACT || t1 - t0 < 1e-12 {
            break;
        }
        let mut t = t0 + (t1 - t0) * weight.0 / (weight.0 - weight.1);
        if i % 4 == 3 || !(t > t0 && t < t1) {
            t = 0.5 * (t0 + t1);
        }
        let s = at(t);
        if s > 0.0 {
            (t0, s0) = (t, s);
            weight = (s0, 0.5 * weight.1);
        } else {
            (t1, s1) = (t, s);
            weight = (0.5 * weight.0, s1);
        }
    }
    t0
}
