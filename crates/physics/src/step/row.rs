//! One lasting contact as a row of a small velocity problem.

use glam::{DMat2, DMat3, DVec2, DVec3};

use super::base::Base;
use super::grip::{Friction, Hold};
use super::mover::Mover;
use super::pairs::Load;
use super::touch::Touch;
use crate::body::Body;
use crate::response::{compliance, rate_without_pull};

/// Approach that a contact has to stop for friction to act there [m/s]: of several contacts that share a load in no
/// definite way one may carry all, and another a rounding error.
const NOTHING: f64 = 1e-12;

/// Most passes over normal and friction of a base on its edge.
const EDGE_PASSES: u32 = 8;

/// Directions across a normal, and the inverse of `K` in their plane [kg].
#[derive(Clone, Copy, Debug, Default)]
struct Plane {
    u: DVec3,
    w: DVec3,
    inverse: DMat2,
    /// Largest change of the slip per impulse [1/kg].
    stiffest: f64,
}

/// A lasting contact while it is being answered.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub touch: Touch,
    /// Numbers of the movers of a and b.
    pub movers: (usize, usize),
    /// Approach that is allowed [m/s]: a gap may close in the stretch, an overlap must open.
    pub allowed: f64,
    pub friction: Friction,
    /// `K`, and how a normal impulse of 1 N s turns the two bodies.
    k: DMat3,
    stiffness: f64,
    levers: (DVec3, DVec3),
    turns: (DVec3, DVec3),
    /// Normal impulse so far [N s].
    pressed: f64,
    /// Normal impulse on the way to which the passes ended [N s]: where they begin next time.
    hoped: f64,
    /// How fast the contact closed before it was answered [m/s].
    approach: f64,
    /// Tangential impulse on a so far [N s].
    rubbed: DVec3,
    plane: Plane,
    /// Change of velocities that a base gave so far, for undoing.
    given: (DVec3, DVec3),
    /// Group that it belongs to, and its place in the order in which the contacts formed.
    pub group: usize,
    pub rank: usize,
}

impl Row {
    pub fn new(
        touch: Touch,
        movers: (usize, usize),
        all: &[Mover],
        allowed: f64,
        friction: Friction,
    ) -> Row {
        let zero = (DVec3::ZERO, DVec3::ZERO);
        let mut row = Row {
            touch,
            movers,
            allowed,
            friction,
            k: DMat3::ZERO,
            stiffness: 0.0,
            levers: zero,
            turns: zero,
            pressed: 0.0,
            hoped: 0.0,
            approach: 0.0,
            rubbed: DVec3::ZERO,
            plane: Plane::default(),
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

    /// Starts again for the second half of the stretch, from what the first half took.
    ///
    /// What closes a gap or opens an overlap on the way must not be left over at the end.
    pub fn renew(&mut self) {
        self.allowed = 0.0;
        self.given = (DVec3::ZERO, DVec3::ZERO);
    }

    /// Whether impulses move and turn both bodies.
    pub fn is_free(&self, all: &[Mover]) -> bool {
        [self.movers.0, self.movers.1].map(|i| all[i].ease() > 0.0) == [true; 2]
    }

    /// How the torques of its impulses on a and on b change, per second, as the two drift apart [N m].
    ///
    /// What the arms of opposite impulses at one place gain goes for the most part to the body that is harder to turn: that
    /// changes the turning of both the least.
    pub fn drift(&self, middle: &[Mover]) -> (DVec3, DVec3) {
        let (a, b) = (&middle[self.movers.0], &middle[self.movers.1]);
        let impulse = self.rubbed - self.touch.normal * self.pressed;
        let change = (b.linear - a.linear).cross(impulse);
        let share = b.ease() / (a.ease() + b.ease());
        (change * share, change * (1.0 - share))
    }

    /// Takes a load for `span` [s] for granted until the passes know better.
    pub fn expect(&mut self, load: Load, span: f64) {
        self.pressed = load.pressed * span;
        if let Friction::Cone(mu) = self.friction {
            self.rubbed = (load.rubbed * span).clamp_length_max(mu * self.pressed);
        }
    }

    /// What it carries over `span` [s].
    pub fn load(&self, span: f64) -> Load {
        Load {
            point: self.touch.point,
            pressed: self.pressed.max(self.hoped) / span,
            rubbed: self.rubbed / span,
        }
    }

    /// Gives the bodies what it took for granted, which the passes correct; or takes nothing for granted.
    pub fn begin(&mut self, all: &mut [Mover], expects: bool) {
        if !expects || !matches!(self.friction, Friction::Cone(_)) {
            self.rubbed = DVec3::ZERO;
        }
        if !expects {
            self.pressed = 0.0;
            return;
        }
        self.pressed = self.pressed.max(self.hoped);
        let impulse = self.rubbed - self.touch.normal * self.pressed;
        all[self.movers.0].push(self.touch.arm_a, impulse);
        all[self.movers.1].push(self.touch.arm_b, -impulse);
    }

    /// Normal impulse so far [N s].
    pub fn pressed(&self) -> f64 {
        self.pressed
    }

    /// Notes how fast the contact closes before it is answered.
    pub fn note_approach(&mut self, all: &[Mover]) {
        self.approach = self.approach_now(all);
    }

    /// Energy that the normal impulse so far has given to the bodies [J].
    ///
    /// Endless for a base, which does not add up so, and for a driven body, which gives whatever its way takes.
    pub fn gained(&self, all: &[Mover]) -> f64 {
        if self.touch.base.is_some() || self.is_driven(all) {
            return f64::INFINITY;
        }
        -0.5 * self.pressed * (self.approach + self.approach_now(all))
    }

    fn approach_now(&self, all: &[Mover]) -> f64 {
        let (a, b) = (&all[self.movers.0], &all[self.movers.1]);
        self.touch.normal.dot(a.linear - b.linear) + self.levers.0.dot(a.angular)
            - self.levers.1.dot(b.angular)
    }

    /// Takes back all that it gave along the normal, or as a base.
    pub fn take_back(&mut self, all: &mut [Mover]) {
        let (a, b) = self.movers;
        let on_ground = !(all[a].is_moved() && all[b].is_moved());
        if let Some(base) = self.touch.base.filter(|_| on_ground) {
            let own = if base.of_a { a } else { b };
            all[own].linear -= self.given.0;
            all[own].angular -= self.given.1;
            self.given = (DVec3::ZERO, DVec3::ZERO);
        } else {
            let impulse = self.touch.normal * self.pressed;
            all[self.movers.0].push(self.touch.arm_a, impulse);
            all[self.movers.1].push(self.touch.arm_b, -impulse);
        }
        (self.hoped, self.pressed) = (self.pressed, 0.0);
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
        if matches!(self.friction, Friction::Cone(_)) {
            let (u, w) = n.any_orthonormal_pair();
            let (ku, kw) = (self.k * u, self.k * w);
            let mixed = u.dot(kw);
            let k = DMat2::from_cols_array(&[u.dot(ku), mixed, mixed, w.dot(kw)]);
            let (half, bias) = (
                0.5 * (k.x_axis.x + k.y_axis.y),
                0.5 * (k.x_axis.x - k.y_axis.y),
            );
            self.plane = Plane {
                u,
                w,
                inverse: k.inverse(),
                stiffest: half + (bias * bias + mixed * mixed).sqrt(),
            };
        }
    }

    /// Whether a driven body is part of the contact.
    pub fn is_driven(&self, all: &[Mover]) -> bool {
        all[self.movers.0].is_driven || all[self.movers.1].is_driven
    }

    /// Whether friction at a rate acts on a slip below `slow` [m/s].
    pub fn creeps(&self, all: &[Mover], slow: f64) -> bool {
        matches!(self.friction, Friction::Rate(_)) && self.is_slow(all, slow)
    }

    /// Whether it slips at less than `slow` [m/s].
    pub fn is_slow(&self, all: &[Mover], slow: f64) -> bool {
        let (a, b) = (&all[self.movers.0], &all[self.movers.1]);
        let slip = a.velocity(self.touch.arm_a) - b.velocity(self.touch.arm_b);
        let n = self.touch.normal;
        (slip - n * n.dot(slip)).length_squared() < slow * slow
    }

    /// The e = 0 blend of Eq. (9) at a point: `F00 + mu (F01 - F00)`.
    pub fn rub(&mut self, all: &mut [Mover]) {
        let n = self.touch.normal;
        let (arm_a, arm_b) = (self.touch.arm_a, self.touch.arm_b);
        let slip_of =
            |all: &[Mover]| all[self.movers.0].velocity(arm_a) - all[self.movers.1].velocity(arm_b);
        if n.dot(slip_of(all)) - self.allowed + self.pressed * self.stiffness <= NOTHING {
            self.press(all, 1.0);
            return;
        }
        self.twist(all);
        let slip = slip_of(all);
        // No more is taken back than was pressed.
        let approach = (n.dot(slip) - self.allowed).max(-self.pressed * self.stiffness);
        if approach <= 0.0 && self.pressed == 0.0 {
            return;
        }
        let f00 = n * (-approach / self.stiffness);
        let mut impulse = f00;
        if let Friction::Rate(rate) = self.friction {
            let f01 = self.k.inverse() * (n * self.allowed - slip);
            // Every blend stops the approach, so the largest rate that does not pull does too.
            let (smooth, rough) = (f00.dot(n) - self.pressed, f01.dot(n) - self.pressed);
            let rate = rate_without_pull(rate, smooth, rough);
            impulse = f00 + (f01 - f00) * rate;
        }
        self.pressed = (self.pressed - impulse.dot(n)).max(0.0);
        self.rubbed += impulse - n * n.dot(impulse);
        all[self.movers.0].push(arm_a, impulse);
        all[self.movers.1].push(arm_b, -impulse);
    }

    /// Friction of a tilted base against turning on its edge, at the rate that the whole base has.
    ///
    /// A point would take nothing of a spin about the normal, and a pin would circle on its edge for ever.
    fn twist(&self, all: &mut [Mover]) {
        let Friction::Rate(rate) = self.friction else {
            return;
        };
        if !self.touch.on_base {
            return;
        }
        let n = self.touch.normal;
        let (a, b) = (&all[self.movers.0], &all[self.movers.1]);
        let (turn_a, turn_b) = (a.inv_inertia * n, b.inv_inertia * n);
        let ease = n.dot(turn_a + turn_b);
        if ease <= 0.0 {
            return;
        }
        let impulse = rate * n.dot(a.angular - b.angular) / ease;
        all[self.movers.0].angular -= turn_a * impulse;
        all[self.movers.1].angular += turn_b * impulse;
    }

    /// One pass at a point: the normal impulse that stops the approach, or less of it if it pulls.
    ///
    /// A `stride` above 1 and below 2 goes beyond, which brings slow passes forward.
    pub fn press(&mut self, all: &mut [Mover], stride: f64) -> f64 {
        let n = self.touch.normal;
        let approach = self.approach_now(all);
        let step = stride * (approach - self.allowed) / self.stiffness;
        let pressed = (self.pressed + step).max(0.0);
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

    /// One pass of friction in the cone: the tangential impulse that stops the slip, or as much as the cone holds.
    pub fn grip(&mut self, all: &mut [Mover]) -> f64 {
        let Friction::Cone(mu) = self.friction else {
            return 0.0;
        };
        let (arm_a, arm_b) = (self.touch.arm_a, self.touch.arm_b);
        let slip = all[self.movers.0].velocity(arm_a) - all[self.movers.1].velocity(arm_b);
        let Plane {
            u,
            w,
            inverse,
            stiffest,
        } = self.plane;
        let most = mu * self.pressed;
        let slip = DVec2::new(u.dot(slip), w.dot(slip));
        let stop = inverse * slip;
        let mut rubbed = self.rubbed - u * stop.x - w * stop.y;
        if rubbed.length_squared() > most * most {
            // A step that is the same in all directions: what is cut off then points against the slip that is left.
            let step = slip / stiffest;
            rubbed = (self.rubbed - u * step.x - w * step.y).clamp_length_max(most);
        }
        let change = rubbed - self.rubbed;
        self.rubbed = rubbed;
        if change == DVec3::ZERO {
            return 0.0;
        }
        all[self.movers.0].push(arm_a, change);
        all[self.movers.1].push(arm_b, -change);
        (self.k * change).length()
    }

    /// One pass at a flat base: takes back what it gave and answers anew.
    ///
    /// The impulse `J` along the normal stops the base. It acts at the centre of pressure, where its torque takes
    /// what is left of the angular momentum across the normal. Inside the patch both stop *exactly*, which is why a
    /// standing pin does not drift; outside the body tips about the nearest point of the patch.
    pub fn stand(&mut self, base: &Base, all: &mut [Mover], bodies: &[Body]) -> f64 {
        let (own, other, slot) = if base.of_a {
            (self.movers.0, self.movers.1, self.touch.a)
        } else {
            (self.movers.1, self.movers.0, self.touch.b)
        };
        if !all[own].is_moved() || all[other].is_moved() {
            return self.press(all, 1.0).max(self.grip(all));
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
        let hold = Hold::new(self.friction, m, (along, spin), load, base.radius);
        let tilt = momentum - spin + arm.cross(hold.impulse + up * load);
        let pressure = base.centre - up.cross(tilt) / load;
        let old = (mover.linear, mover.angular);
        if base.holds(pressure) {
            // Set, not added up: a rounding error left over would move the body for ever.
            mover.linear = ground - up * self.allowed + hold.along;
            mover.angular = mover.inv_inertia * hold.spin;
        } else {
            self.touch.set_point(base.clamp(pressure), bodies);
            self.prepare(all);
            self.pressed = 0.0;
            self.rubbed = DVec3::ZERO;
            self.rub(all);
            for _ in 0..EDGE_PASSES {
                self.press(all, 1.0);
                if self.grip(all) == 0.0 {
                    break;
                }
            }
        }
        self.given = (all[own].linear - old.0, all[own].angular - old.1);
        (self.given.0 - before.0).length()
    }
}
