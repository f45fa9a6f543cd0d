//! When will two parts touch: conservative advancement along the separating normal.
//!
//! What a normal proves over a stretch of time is in `advance/stretch.rs`; here are the motions of a step, and what a
//! lasting contact makes different.

use glam::DVec3;

use super::pairs::Key;
use super::touch::{Frame, place};
use super::{CONTACT, PARTING, SINK, sink};
use crate::advance::{Grade, Held, hold};
use crate::body::Body;
use crate::compound::Part;
use crate::effects::Effect;
use crate::query::{Placed, distance_to_point, gap_along};
use crate::world::World;

/// Most searches for one pair of parts before other pairs have their turn.
const SEARCHES: u32 = 40;
/// Searches after which a part of the step that was short enough decides how long the next one is, and not the whole step.
const PATIENCE: u32 = 20;
/// Gap below which the two count as touching when the searches end [m]: what creeps along a surface so near is on it.
const CLOSE: f64 = 1e-4;
/// Share of the step that so many searches must win for the two to be looked at again; otherwise they count as touching.
const PROGRESS: f64 = 1e-4;
/// A dip between two times that is no deeper than this is not looked for [m].
const DIP: f64 = 2e-6;
/// Slower approach than this is none [m/s].
const APPROACH: f64 = 1e-9;

/// What the search learnt about a pair of parts.
pub(crate) struct Found {
    /// When they touch, if they do before the end of the step [s].
    pub time: Option<f64>,
    /// When they are to be looked at again, the searches having ended before the step: they are apart until then [s].
    pub again: Option<f64>,
    pub normal: DVec3,
    /// Proven gap at the start of the search [m].
    pub gap: f64,
    /// Times looked at.
    pub looks: u32,
    /// Iterations of the detection in all searches for a normal.
    pub iterations: u32,
}

/// Two parts on their way through a step: proven apart until `time`.
pub(crate) struct Approach<'a> {
    world: &'a World,
    bodies: (&'a Body, &'a Body),
    parts: (&'a Part, &'a Part),
    /// Whether a contact of the two lasts: it then may sink a little.
    touching: bool,
    /// How far it may [m].
    sink: f64,
    /// Length of the step [s].
    dt: f64,
    /// Where the parts are at the end of the step.
    ends: (Placed<'a>, Placed<'a>),
    /// Bound c of the acceleration of one surface against the other [m/s2].
    bend: f64,
    time: f64,
    /// Time up to which the gap along `normal` is examined next [s].
    end: f64,
    /// Where the parts are at `time`.
    placed: (Placed<'a>, Placed<'a>),
    normal: DVec3,
    /// Gap along `normal` at `time` [m].
    gap: f64,
    /// Largest gap that was found where the search began [m].
    proven: f64,
    /// Whether `normal` was found at `time`, and is not an earlier one.
    fresh: bool,
    iterations: u32,
}

/// What the gap along one normal tells.
enum Bound {
    /// They are apart to the end of the step.
    Apart,
    /// Nothing; half the time may tell more.
    Unclear,
    /// They are apart until this time, when a new normal is needed [s].
    Until(f64),
    /// They touch at this time [s].
    Contact(f64),
}

impl<'a> Approach<'a> {
    /// Earliest contact after `t0` of the two parts that `key` names, in a step of `dt` [s].
    pub(crate) fn search(
        world: &'a World,
        key: Key,
        (t0, dt): (f64, f64),
        starts: &(Frame, Frame),
        ends: &(Frame, Frame),
    ) -> Found {
        let known = world.pairs.part(key);
        let bodies = (&world.bodies[key.a as usize], &world.bodies[key.b as usize]);
        let parts = (
            &bodies.0.compound.parts()[known.part_a as usize],
            &bodies.1.compound.parts()[known.part_b as usize],
        );
        let placed = (starts.0.place(parts.0), starts.1.place(parts.1));
        if !known.touching {
            let rough = part_gap(&placed.0, parts.0, &placed.1, parts.1);
            if rough > bodies.0.reach + bodies.1.reach {
                return Found {
                    time: None,
                    again: None,
                    normal: known.normal,
                    gap: rough,
                    looks: 1,
                    iterations: 0,
                };
            }
        }
        let gap = if known.normal == DVec3::ZERO {
            0.0
        } else {
            gap_along(&placed.0, &placed.1, known.normal)
        };
        let approach = Approach {
            world,
            bodies,
            parts,
            touching: known.touching,
            sink: sink(known.rocks),
            dt,
            ends: (ends.0.place(parts.0), ends.1.place(parts.1)),
            bend: bodies.0.sweep().acceleration + bodies.1.sweep().acceleration,
            time: t0,
            end: dt,
            placed,
            normal: known.normal,
            gap,
            proven: gap,
            fresh: false,
            iterations: 0,
        };
        approach.advance()
    }

    /// Goes from one time at which the parts are proven apart to the next.
    fn advance(mut self) -> Found {
        let stale = self.gap <= CONTACT && !self.touching;
        if stale || self.normal == DVec3::ZERO {
            let point = self.look();
            self.proven = self.proven.max(self.gap);
            if self.gap <= CONTACT && !self.touching && self.closing(point) {
                return self.found(Some(self.time), 1);
            }
        }
        if !self.world.plan.has(Effect::Continuous) {
            return self.found(None, 1);
        }
        let start = self.time;
        for looks in 1..=SEARCHES {
            match self.bound() {
                Bound::Apart => return self.found(None, looks),
                Bound::Contact(time) => return self.found(Some(time), looks),
                Bound::Unclear => self.end = 0.5 * (self.time + self.end),
                Bound::Until(time) => {
                    let span = 2.0 * (self.end - self.time);
                    (self.time, self.end) = (time, self.dt);
                    if looks > PATIENCE && self.gap > CLOSE {
                        self.end = self.dt.min(time + span);
                    }
                    self.placed = self.placed_at(time);
                    let point = self.look();
                    if self.gap <= CONTACT && (self.touching || self.closing(point)) {
                        return self.found(Some(time), looks);
                    }
                }
            }
        }
        // What turns many times in a step beside something is apart all the while, and the searches end before the step.
        if self.gap > CLOSE && self.time - start > PROGRESS * self.dt {
            let found = self.found(None, SEARCHES);
            return Found {
                again: Some(self.time),
                ..found
            };
        }
        self.found(Some(self.time), SEARCHES)
    }

    fn found(&self, time: Option<f64>, looks: u32) -> Found {
        Found {
            time,
            again: None,
            normal: self.normal,
            gap: self.proven,
            looks,
            iterations: self.iterations,
        }
    }

    /// What the gap along `normal` between `time` and `end` proves.
    fn bound(&self) -> Bound {
        // A lasting contact may sink a little; one that just separated starts from where it is.
        let floor = if self.touching || self.gap <= CONTACT {
            self.gap.min(0.0) - self.sink
        } else {
            0.0
        };
        let at = |t: f64| {
            let (a, b) = if t == self.dt {
                self.ends
            } else {
                self.placed_at(t)
            };
            gap_along(&a, &b, self.normal) - floor
        };
        let start = (self.time, self.gap - floor);
        let grade = Grade {
            bend: self.bend,
            dip: DIP,
            enough: 0.5 * CONTACT,
        };
        let root = match hold(&at, start, self.end, &grade) {
            Held::Through if self.end == self.dt => return Bound::Apart,
            Held::Through => return Bound::Until(self.end),
            Held::Unclear => return Bound::Unclear,
            Held::Until(root) => root,
        };
        if self.fresh && floor != 0.0 {
            Bound::Contact(root)
        } else if self.fresh && root <= self.time {
            // The bound itself starts at contact, and a new normal would be the same.
            Bound::Contact(self.time)
        } else {
            Bound::Until(root)
        }
    }

    /// Finds normal and gap at `time`; returns the point between the surfaces [m].
    fn look(&mut self) -> DVec3 {
        let found = self
            .world
            .search(&self.placed.0, &self.placed.1, self.normal);
        (self.normal, self.gap, self.fresh) = (found.normal, found.gap, true);
        self.iterations += found.iterations;
        (found.point_a + found.point_b) * 0.5
    }

    fn placed_at(&self, t: f64) -> (Placed<'a>, Placed<'a>) {
        (
            place(self.parts.0, &self.bodies.0.pose_at(t)),
            place(self.parts.1, &self.bodies.1.pose_at(t)),
        )
    }

    /// Whether the bodies, at `time`, approach along `normal` at `point`, or begin to, or overlap and do not part.
    ///
    /// They turn as at their clocks: by how much that differs at `time` decides only where they graze, and the answer, which
    /// brings both there first, strikes nothing that does not approach.
    fn closing(&self, point: DVec3) -> bool {
        let (a, b) = self.bodies;
        let t = self.time;
        let velocity = |body: &Body| {
            let pose = body.pose_at(t);
            let linear = body.linear
                + body.acceleration * (t - body.clock)
                + body.bend_at(t).linear * (t - body.middle);
            linear + body.angular_velocity().cross(point - pose.position)
        };
        let speed = self.normal.dot(velocity(a) - velocity(b));
        let bend = a.acceleration + a.bend_at(t).linear - b.acceleration - b.bend_at(t).linear;
        speed > APPROACH
            || (speed > -1e3 * APPROACH && self.normal.dot(bend) > 0.0)
            || (self.gap < -SINK && speed > -PARTING)
    }
}

/// Lower bound of the gap between two parts.
pub(crate) fn part_gap(a: &Placed, part_a: &Part, b: &Placed, part_b: &Part) -> f64 {
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
