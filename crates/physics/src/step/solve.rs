//! Lasting contacts as rows of a small velocity problem.
//!
//! Rows see bodies as *movers*: velocities and inverse masses, nothing else. Each row takes the e = 0 blend of Eq. (9)
//! once; then the normal impulses alone are iterated until no contact approaches. Iterating the blend itself
//! never settles when a body has two contacts. With friction the order of the rows on one body matters a little:
//! they are taken in the order in which the contacts formed.

use glam::{DMat3, DVec3};

use super::scratch::Carry;
use super::touch::{Base, Touch};
use crate::body::Body;
use crate::response::{compliance, rate_without_pull};

/// Most passes over the normals of a group.
const PASSES: u32 = 40;

/// A body as the rows see it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mover {
    pub linear: DVec3,
    pub angular: DVec3,
    inv_mass: f64,
    inv_inertia: DMat3,
}

impl Mover {
    pub fn new(body: &Body) -> Mover {
        Mover {
            linear: body.linear_now(),
            angular: body.angular_velocity(),
            inv_mass: body.inv_mass(),
            inv_inertia: body.inv_inertia(),
        }
    }

    fn velocity(&self, arm: DVec3) -> DVec3 {
        self.linear + self.angular.cross(arm)
    }

    fn push(&mut self, arm: DVec3, impulse: DVec3) {
        if self.inv_mass > 0.0 {
            self.linear += impulse * self.inv_mass;
            self.angular += self.inv_inertia * arm.cross(impulse);
        }
    }

    fn is_moved(&self) -> bool {
        self.inv_mass > 0.0
    }
}

/// A lasting contact while it is being answered.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub touch: Touch,
    /// Numbers of the movers of a and b.
    pub movers: (usize, usize),
    /// Approach that is allowed [m/s]: a gap may close in the stretch, an overlap must open.
    pub allowed: f64,
    /// Friction rate of half a stretch.
    pub rate: f64,
    /// `K`, and how a normal impulse of 1 N s turns the two bodies.
    k: DMat3,
    stiffness: f64,
    levers: (DVec3, DVec3),
    turns: (DVec3, DVec3),
    /// Normal impulse so far [N s].
    pressed: f64,
    /// Change of velocities that a base gave so far, for undoing.
    given: (DVec3, DVec3),
    /// Group that it belongs to, and its place in the order in which the contacts formed.
    group: usize,
    rank: usize,
}

impl Row {
    pub fn new(
        touch: Touch,
        movers: (usize, usize),
        all: &[Mover],
        allowed: f64,
        rate: f64,
    ) -> Row {
        let zero = (DVec3::ZERO, DVec3::ZERO);
        let mut row = Row {
            touch,
            movers,
            allowed,
            rate,
            k: DMat3::ZERO,
            stiffness: 0.0,
            levers: zero,
            turns: zero,
            pressed: 0.0,
            given: zero,
            group: 0,
            rank: 0,
        };
        let rests_on_ground =
            touch.base.is_some() && !(all[movers.0].is_moved() && all[movers.1].is_moved());
        if !rests_on_ground {
            row.prepare(all);
        }
        row
    }

    /// Starts again for the second half of the stretch.
    ///
    /// What closes a gap or opens an overlap on the way must not be left over at the end.
    pub fn renew(&mut self) {
        self.allowed = 0.0;
        self.pressed = 0.0;
        self.given = (DVec3::ZERO, DVec3::ZERO);
    }

    fn prepare(&mut self, all: &[Mover]) {
        let (a, b) = (&all[self.movers.0], &all[self.movers.1]);
        let (n, arm_a, arm_b) = (self.touch.normal, self.touch.arm_a, self.touch.arm_b);
        self.k = DMat3::ZERO;
        if a.is_moved() {
            self.k += compliance(a.inv_mass, &a.inv_inertia, arm_a);
        }
        if b.is_moved() {
            self.k += compliance(b.inv_mass, &b.inv_inertia, arm_b);
        }
        self.levers = (arm_a.cross(n), arm_b.cross(n));
        self.turns = (a.inv_inertia * self.levers.0, b.inv_inertia * self.levers.1);
        self.stiffness = n.dot(self.k * n);
    }

    /// The e = 0 blend of Eq. (9) at a point: `F00 + mu (F01 - F00)`.
    fn rub(&mut self, all: &mut [Mover]) {
        let n = self.touch.normal;
        let (arm_a, arm_b) = (self.touch.arm_a, self.touch.arm_b);
        let slip_of =
            |all: &[Mover]| all[self.movers.0].velocity(arm_a) - all[self.movers.1].velocity(arm_b);
        if n.dot(slip_of(all)) <= self.allowed {
            return;
        }
        self.twist(all);
        let slip = slip_of(all);
        let approach = n.dot(slip) - self.allowed;
        if approach <= 0.0 {
            return;
        }
        let f00 = n * (-approach / self.stiffness);
        let mut impulse = f00;
        if self.rate > 0.0 {
            let f01 = self.k.inverse() * (n * self.allowed - slip);
            // Every blend stops the approach, so the largest rate that does not pull does too.
            let rate = rate_without_pull(self.rate, f00.dot(n), f01.dot(n));
            impulse = f00 + (f01 - f00) * rate;
        }
        self.pressed = (-impulse.dot(n)).max(0.0);
        all[self.movers.0].push(arm_a, impulse);
        all[self.movers.1].push(arm_b, -impulse);
    }

    /// Friction of a tilted base against turning on its edge, at the rate that the whole base has.
    ///
    /// A point would take nothing of a spin about the normal, and a pin would circle on its edge for ever.
    fn twist(&self, all: &mut [Mover]) {
        if !self.touch.on_base || self.rate == 0.0 {
            return;
        }
        let n = self.touch.normal;
        let (a, b) = (&all[self.movers.0], &all[self.movers.1]);
        let (turn_a, turn_b) = (a.inv_inertia * n, b.inv_inertia * n);
        let ease = n.dot(turn_a + turn_b);
        if ease <= 0.0 {
            return;
        }
        let impulse = self.rate * n.dot(a.angular - b.angular) / ease;
        all[self.movers.0].angular -= turn_a * impulse;
        all[self.movers.1].angular += turn_b * impulse;
    }

    /// One pass at a point: the normal impulse that stops the approach, or less of it if it pulls.
    fn press(&mut self, all: &mut [Mover]) -> f64 {
        let n = self.touch.normal;
        let (a, b) = (&all[self.movers.0], &all[self.movers.1]);
        let approach = n.dot(a.linear - b.linear) + self.levers.0.dot(a.angular)
            - self.levers.1.dot(b.angular);
        let pressed = (self.pressed + (approach - self.allowed) / self.stiffness).max(0.0);
        let change = pressed - self.pressed;
        self.pressed = pressed;
        if change == 0.0 {
            return 0.0;
        }
        let a = &mut all[self.movers.0];
        a.linear -= n * (change * a.inv_mass);
        a.angular -= self.turns.0 * change;
        let b = &mut all[self.movers.1];
        b.linear += n * (change * b.inv_mass);
        b.angular += self.turns.1 * change;
        (change * self.stiffness).abs()
    }

    /// One pass at a flat base: takes back what it gave and answers anew.
    ///
    /// The impulse `J` along the normal stops the base. It acts at the centre of pressure, where its torque takes
    /// what is left of the angular momentum across the normal. Inside the patch both stop *exactly*, which is why a
    /// standing pin does not drift; outside the body tips about the nearest point of the patch.
    fn stand(&mut self, base: &Base, all: &mut [Mover], bodies: &[Body]) -> f64 {
        let (own, other, slot) = if base.of_a {
            (self.movers.0, self.movers.1, self.touch.a)
        } else {
            (self.movers.1, self.movers.0, self.touch.b)
        };
        if !all[own].is_moved() || all[other].is_moved() {
            return self.press(all);
        }
        let other_arm = base.centre - bodies[self.touch.a + self.touch.b - slot].position;
        let ground = all[other].velocity(other_arm);
        let inertia = bodies[slot].inertia();
        let mover = &mut all[own];
        let (m, up) = (1.0 / mover.inv_mass, base.up);
        mover.linear -= self.given.0;
        mover.angular -= self.given.1;
        let before = self.given;
        self.given = (DVec3::ZERO, DVec3::ZERO);
        let velocity = mover.linear - ground;
        let load = -m * (up.dot(velocity) + self.allowed);
        if load <= 0.0 {
            return before.0.length();
        }
        let momentum = inertia * mover.angular;
        let spin = up * up.dot(momentum);
        let along = velocity - up * up.dot(velocity);
        let arm = base.centre - bodies[slot].position;
        let friction = along * (-m * self.rate);
        let tilt = momentum - spin + arm.cross(friction + up * load);
        let pressure = base.centre - up.cross(tilt) / load;
        let old = (mover.linear, mover.angular);
        if base.holds(pressure) {
            // Set, not added up: a rounding error left over would move the body for ever.
            mover.linear = ground - up * self.allowed + along * (1.0 - self.rate);
            mover.angular = mover.inv_inertia * (spin * (1.0 - self.rate));
        } else {
            self.touch.set_point(base.clamp(pressure), bodies);
            self.prepare(all);
            self.pressed = 0.0;
            self.rub(all);
            self.press(all);
        }
        self.given = (all[own].linear - old.0, all[own].angular - old.1);
        (self.given.0 - before.0).length()
    }
}

/// Answers a group of rows that share bodies, until no pass changes a velocity by more than `enough` [m/s].
fn answer_group(rows: &mut [Row], all: &mut [Mover], bodies: &[Body], enough: f64) -> u32 {
    for row in rows.iter_mut().filter(|r| r.touch.base.is_none()) {
        row.rub(all);
    }
    if let [row] = rows
        && row.touch.base.is_none()
    {
        return 1;
    }
    let passes = if rows.len() == 1 { 1 } else { PASSES };
    for pass in 0..passes {
        let mut worst: f64 = 0.0;
        for row in rows.iter_mut() {
            worst = worst.max(match row.touch.base {
                Some(base) => row.stand(&base, all, bodies),
                None => row.press(all),
            });
        }
        if worst <= enough {
            return (pass + 1) * rows.len() as u32;
        }
    }
    passes * rows.len() as u32
}

impl Carry {
    /// Numbers the bodies: those `carried` first, then all others of the `touches`.
    pub fn number(&mut self, count: usize, carried: &[usize], touches: &[Touch]) {
        self.numbers.resize(count, NONE);
        let others = touches.iter().flat_map(|t| [t.a, t.b]);
        for slot in carried.iter().copied().chain(others) {
            if self.numbers[slot] == NONE {
                self.numbers[slot] = self.slots.len() as u32;
                self.slots.push(slot);
            }
        }
    }

    /// Half of gravity's kick for the first `carried` movers, then an answer of all rows; returns the passes.
    pub fn answer(&mut self, bodies: &[Body], carried: usize, kick: DVec3, enough: f64) -> u32 {
        for mover in &mut self.movers[..carried] {
            mover.linear += kick;
        }
        let (mut start, mut passes) = (0, 0);
        for end in &self.ends {
            let rows = &mut self.rows[start..*end];
            passes += answer_group(rows, &mut self.movers, bodies, enough);
            start = *end;
        }
        passes
    }

    /// Empties all lists for the next stretch.
    pub fn clear(&mut self) {
        for slot in self.slots.drain(..) {
            self.numbers[slot] = NONE;
        }
        self.movers.clear();
        self.before.clear();
        self.middle.clear();
        self.rows.clear();
        self.labels.clear();
        self.ends.clear();
    }
}

/// No number.
const NONE: u32 = u32::MAX;

/// Sorts rows into groups that share no moved body, each in its old order, and notes the groups' ends.
pub(crate) fn group(room: &mut Carry) {
    let Carry {
        movers,
        rows,
        labels,
        ends,
        ..
    } = room;
    // Every body's label leads on to a smaller one of its group, down to the smallest.
    labels.extend(0..movers.len());
    for (i, row) in rows.iter_mut().enumerate() {
        row.rank = i;
        let (a, b) = row.movers;
        if movers[a].is_moved() && movers[b].is_moved() {
            let (a, b) = (least(labels, a), least(labels, b));
            labels[a.max(b)] = a.min(b);
        }
    }
    for row in rows.iter_mut() {
        let (a, b) = row.movers;
        row.group = least(labels, if movers[a].is_moved() { a } else { b });
    }
    rows.sort_unstable_by_key(|row| (row.group, row.rank));
    for i in 1..=rows.len() {
        if i == rows.len() || rows[i].group != rows[i - 1].group {
            ends.push(i);
        }
    }
}

/// The smallest label of a group; shortens the way to it.
fn least(labels: &mut [usize], mut i: usize) -> usize {
    while labels[i] != i {
        labels[i] = labels[labels[i]];
        i = labels[i];
    }
    i
}
