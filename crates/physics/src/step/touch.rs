//! Geometry of one contact at the bodies' current poses, and impulses at it.

use glam::{DMat3, DVec3};

use super::base::{Base, base, chord};
use super::pairs::Key;
use super::patch::{Patch, patch};
use crate::body::Body;
use crate::compound::Part;
use crate::effects::Effect;
use crate::pose::Pose;
use crate::query::{self, Limits, Placed, Separation};
use crate::response::compliance;
use crate::world::World;

/// Overlap in which the way out is looked for again, and not where it was last [m].
const DEEP: f64 = 1e-3;

/// Turning of a base that rocks and does not fall [rad/s]: a pin tips at 1.2 about its edge.
const ROCKING: f64 = 2.0;

/// A contact between two parts at the bodies' current poses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    pub key: Key,
    pub a: usize,
    pub b: usize,
    /// Unit normal from a to b.
    pub normal: DVec3,
    pub gap: f64,
    pub point: DVec3,
    pub arm_a: DVec3,
    pub arm_b: DVec3,
    pub base: Option<Base>,
    /// The face or line that the two share, if it is no such base.
    pub patch: Option<Patch>,
    /// Whether it is a flat base, lying or a little tilted, on a flat face: friction then also takes the turn on it.
    pub on_base: bool,
    /// Half the chord on which a tilted base presses [m], as a vector along the face to where it stands.
    pub chord: DVec3,
}

/// A pose with its rotation as a matrix, from which parts are placed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    rotation: DMat3,
    position: DVec3,
}

impl Frame {
    pub fn new(pose: &Pose) -> Frame {
        Frame {
            rotation: DMat3::from_quat(pose.rotation),
            position: pose.position,
        }
    }

    /// A part of the body whose pose this is.
    pub fn place<'a>(&self, part: &'a Part) -> Placed<'a> {
        Placed {
            shape: &part.shape,
            rotation: if part.is_square {
                self.rotation
            } else {
                self.rotation * part.rotation
            },
            position: self.position + self.rotation * part.pose.position,
        }
    }
}

/// A part of a body at a pose.
pub(crate) fn place<'a>(part: &'a Part, pose: &Pose) -> Placed<'a> {
    Frame::new(pose).place(part)
}

impl Touch {
    pub fn set_point(&mut self, point: DVec3, bodies: &[Body]) {
        self.point = point;
        self.arm_a = point - bodies[self.a].position;
        self.arm_b = point - bodies[self.b].position;
    }

    /// Velocity of a's contact point relative to b's, Eq. (8) [m/s].
    pub fn slip(&self, bodies: &[Body]) -> DVec3 {
        let (a, b) = (&bodies[self.a], &bodies[self.b]);
        a.linear_now() + a.angular_velocity().cross(self.arm_a)
            - b.linear_now()
            - b.angular_velocity().cross(self.arm_b)
    }

    /// `K`, the change of the slip per impulse.
    pub fn compliance(&self, bodies: &[Body]) -> DMat3 {
        let (a, b) = (&bodies[self.a], &bodies[self.b]);
        let mut k = DMat3::ZERO;
        if a.is_dynamic() {
            k += compliance(a.inv_mass(), &a.inv_inertia(), self.arm_a);
        }
        if b.is_dynamic() {
            k += compliance(b.inv_mass(), &b.inv_inertia(), self.arm_b);
        }
        k
    }

    /// Applies `impulse` to a and its opposite to b.
    pub fn push(&self, bodies: &mut [Body], impulse: DVec3) {
        bodies[self.a].push(self.arm_a, impulse);
        bodies[self.b].push(self.arm_b, -impulse);
    }
}

impl World {
    pub(crate) fn limits(&self) -> Limits {
        Limits {
            iteration_cap: self.settings.iteration_cap,
            ..Limits::default()
        }
    }

    /// Whether a body turns slower than a pin that tips over, and no hand pushes it.
    fn rocks(&self, slot: usize) -> bool {
        let body = &self.bodies[slot];
        let most = ROCKING * body.mass.inertia.max_element();
        body.momentum.length_squared() < most * most
            && !(self.plan.has(Effect::Hand) && self.is_held(slot))
    }

    /// Exact search between two parts at given poses, `normal` being that of the last look.
    ///
    /// What has passed over a box since then still finds the old face there: s has a maximum on each, however deep below
    /// it lies. A way out that is the old one and deep is not believed.
    pub(crate) fn search(&self, a: &Placed, b: &Placed, normal: DVec3) -> Separation {
        if let Some(answer) = query::on_face(a, b, normal)
            && answer.gap > -DEEP
        {
            return answer;
        }
        let start = (normal != DVec3::ZERO).then_some(normal);
        let answer = query::separation_placed(a, b, start, self.limits());
        if answer.local && answer.gap < -DEEP {
            return query::separation_placed(a, b, None, self.limits());
        }
        answer
    }

    /// The contact `key` at the bodies' current poses; remembers its normal.
    pub(crate) fn touch(&mut self, key: Key) -> Touch {
        let (a, b) = (key.a as usize, key.b as usize);
        let (body_a, body_b) = (&self.bodies[a], &self.bodies[b]);
        let ways = (body_a.path, body_b.path);
        if let Some(touch) = self.pairs.seen(key, ways) {
            return touch;
        }
        let known = self.pairs.part(key);
        let part_a = &body_a.compound.parts()[known.part_a as usize];
        let part_b = &body_b.compound.parts()[known.part_b as usize];
        let (placed_a, placed_b) = (place(part_a, &body_a.pose()), place(part_b, &body_b.pose()));
        let found = self.search(&placed_a, &placed_b, known.normal);
        let both_move = body_a.is_dynamic() && body_b.is_dynamic();
        let base = base(&placed_a, &placed_b, found.normal).filter(|_| !both_move);
        let chord = match base {
            None if !both_move => chord(&placed_a, &placed_b, found.normal),
            _ => None,
        };
        let on_base = base.is_some() || chord.is_some();
        // What is all but level carries at corners of its base: those that are not down yet come down in the stretch.
        let patch = match base {
            Some(_) => None,
            None => patch(&placed_a, &placed_b, &found),
        };
        let mut touch = Touch {
            key,
            a,
            b,
            normal: found.normal,
            gap: found.gap,
            point: DVec3::ZERO,
            arm_a: DVec3::ZERO,
            arm_b: DVec3::ZERO,
            base,
            patch,
            on_base,
            chord: chord.unwrap_or(DVec3::ZERO),
        };
        touch.set_point((found.point_a + found.point_b) * 0.5, &self.bodies);
        let rocks = on_base && self.rocks(a) && self.rocks(b);
        let known = self.pairs.part_mut(key);
        (known.normal, known.rocks) = (found.normal, rocks);
        self.pairs.remember(key, ways, touch);
        touch
    }
}
