//! When will two bodies touch: which of their parts are worth a look, and which of those comes first.

use std::cmp::Ordering;

use super::approach::Approach;
use super::pairs::Key;
use super::touch::{Frame, place};
use crate::body::Body;
use crate::compound::Part;
use crate::effects::Effect;
use crate::pose::Pose;
use crate::query::distance_to_point;
use crate::world::World;

/// Something that will happen in the step, as long as nothing changes the motion of its bodies before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Event {
    pub time: f64,
    /// Place in the order in which events were foreseen; of two at the same time the first comes first.
    pub number: u64,
    pub what: What,
}

/// What will happen, and how often the bodies had changed their motion when it was foreseen; see `Body::changes`.
#[derive(Clone, Copy, Debug)]
pub(crate) enum What {
    /// Two parts touch.
    Meet { key: Key, changes: (u32, u32) },
    /// Two bodies are to be looked at again: they are proven apart no further than to this time.
    Look {
        pair: u32,
        bodies: (u32, u32),
        changes: (u32, u32),
    },
    /// The stretch ends in which an island is carried, `slot` being one of its bodies.
    StretchEnds { slot: u32, changes: u32 },
}

/// The earliest is the greatest, so that a heap gives it first.
impl Ord for Event {
    fn cmp(&self, other: &Event) -> Ordering {
        // Adding zero makes one of the two zeros.
        let time = (other.time + 0.0).total_cmp(&(self.time + 0.0));
        time.then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for Event {
    fn partial_cmp(&self, other: &Event) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Event {
    fn eq(&self, other: &Event) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Event {}

/// What comes next between two bodies.
pub(crate) enum Next {
    Contact(Key),
    Look,
}

impl World {
    /// Earliest contact of two bodies after `t0`, both states standing at or before it, as far as their motion is known; or
    /// when they are to be looked at again, if that is before.
    pub(crate) fn first_contact(&mut self, pair: u32, t0: f64, dt: f64) -> Option<(f64, Next)> {
        let entry = self.pairs.get(pair);
        let (a, b) = (entry.a as usize, entry.b as usize);
        let (pose_a, pose_b) = self.near(pair, t0)?;
        let (body_a, body_b) = (&self.bodies[a], &self.bodies[b]);
        let starts = (Frame::new(&pose_a), Frame::new(&pose_b));
        let until = horizon(body_a, dt).min(horizon(body_b, dt));
        if until <= t0 {
            // One of them is about to be set off anew, and will look then.
            return None;
        }
        let ends = (
            Frame::new(&body_a.pose_until(until)),
            Frame::new(&body_b.pose_until(until)),
        );
        let (ways, reach) = (body_a.path + body_b.path, body_a.reach + body_b.reach);
        let mut first: Option<(f64, Next)> = None;
        let mut clearance = f64::INFINITY;
        for part in 0..self.pairs.get(pair).parts.clearances.len() {
            let known = self.pairs.get(pair).parts.clearances[part];
            if known - ways > reach {
                clearance = clearance.min(known);
                self.effort.spared += 1;
                continue;
            }
            let key = Key {
                a: a as u32,
                b: b as u32,
                pair,
                part: part as u32,
            };
            let found = Approach::search(self, key, (t0, until), &starts, &ends);
            self.effort.looks += u64::from(found.looks);
            self.effort.iterations += u64::from(found.iterations);
            if self.plan.has(Effect::Continuous) {
                self.effort.work.add(Effect::Continuous, 1);
            }
            let entry = self.pairs.part_mut(key);
            entry.normal = found.normal;
            let gap = if entry.touching { 0.0 } else { found.gap };
            self.pairs.get_mut(pair).parts.clearances[part] = gap + ways;
            clearance = clearance.min(gap + ways);
            self.effort.capped += u64::from(found.again.is_some());
            let next = match (found.time, found.again) {
                (Some(time), _) => Some((time, Next::Contact(key))),
                (None, again) => again.map(|time| (time, Next::Look)),
            };
            if let Some((time, _)) = next
                && first.as_ref().is_none_or(|f| time < f.0)
            {
                first = next;
            }
        }
        self.pairs.get_mut(pair).clearance = clearance;
        first
    }

    /// Poses of two bodies at `t0` if their parts have to be looked at; then the pairs of parts are listed.
    fn near(&mut self, pair: u32, t0: f64) -> Option<(Pose, Pose)> {
        let entry = self.pairs.get_mut(pair);
        let (body_a, body_b) = (
            &self.bodies[entry.a as usize],
            &self.bodies[entry.b as usize],
        );
        if !may_collide(body_a, body_b) {
            return None;
        }
        let (ways, reach) = (body_a.path + body_b.path, body_a.reach + body_b.reach);
        if entry.clearance - ways > reach {
            return None;
        }
        let (pose_a, pose_b) = (body_a.pose_at(t0), body_b.pose_at(t0));
        let rough = rough_gap(body_a, &pose_a, body_b, &pose_b);
        if rough > reach {
            entry.clearance = rough + ways;
            return None;
        }
        if entry.parts.is_empty() {
            let count = |body: &Body| body.compound.parts().len();
            let counts = (count(body_a), count(body_b));
            self.pairs.list_parts(pair, counts, ways);
        }
        Some((pose_a, pose_b))
    }
}

/// Time up to which a body's motion in a step of `dt` is known [s].
fn horizon(body: &Body, dt: f64) -> f64 {
    if body.reach == 0.0 { dt } else { body.until }
}

/// Whether the pair is looked at: one moves, and one can be moved.
fn may_collide(a: &Body, b: &Body) -> bool {
    a.meets && b.meets && (a.is_dynamic() || b.is_dynamic()) && !(a.is_still() && b.is_still())
}

/// Lower bound of the gap between two bodies: one's bounding ball against the other's parts.
pub(crate) fn rough_gap(a: &Body, pose_a: &Pose, b: &Body, pose_b: &Pose) -> f64 {
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
