//! When will two bodies touch: which of their parts are worth a look, and which of those comes first.

use glam::DVec3;

use super::approach::Approach;
use super::pairs::{Key, PartPair};
use super::touch::{Frame, place};
use crate::body::Body;
use crate::compound::Part;
use crate::pose::Pose;
use crate::query::distance_to_point;
use crate::world::World;

/// A future contact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Event {
    pub time: f64,
    pub key: Key,
}

impl World {
    /// Earliest contact of two bodies after `t0`, both states standing at or before it.
    pub(crate) fn first_contact(&mut self, a: usize, b: usize, t0: f64, dt: f64) -> Option<Event> {
        let (a, b) = (a.min(b), a.max(b));
        let (pose_a, pose_b) = self.near(a, b, t0)?;
        let (body_a, body_b) = (&self.bodies[a], &self.bodies[b]);
        let starts = (Frame::new(&pose_a), Frame::new(&pose_b));
        let ends = (Frame::new(&body_a.end), Frame::new(&body_b.end));
        let (ways, reach) = (body_a.path + body_b.path, body_a.reach + body_b.reach);
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
            let found = Approach::search(self, key, (t0, dt), &starts, &ends);
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

    /// Poses of two bodies at `t0` if their parts have to be looked at; then the pairs of parts are listed.
    fn near(&mut self, a: usize, b: usize, t0: f64) -> Option<(Pose, Pose)> {
        let (body_a, body_b) = (&self.bodies[a], &self.bodies[b]);
        if !may_collide(body_a, body_b) {
            return None;
        }
        let (ways, reach) = (body_a.path + body_b.path, body_a.reach + body_b.reach);
        let pair = self.pairs.get_mut(a, b);
        if pair.clearance - ways > reach {
            return None;
        }
        let (pose_a, pose_b) = (body_a.pose_at(t0), body_b.pose_at(t0));
        let rough = rough_gap(body_a, &pose_a, body_b, &pose_b);
        if rough > reach {
            pair.clearance = rough + ways;
            return None;
        }
        if pair.parts.is_empty() {
            pair.parts = part_pairs(body_a, body_b, ways);
        }
        Some((pose_a, pose_b))
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
