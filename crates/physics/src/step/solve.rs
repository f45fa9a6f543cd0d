//! Lasting contacts as rows of a small velocity problem, group by group.
//!
//! Under the paper's laws the normal impulses of several rows are iterated until no contact approaches, each row takes
//! the e = 0 blend of Eq. (9) once, and the normal impulses alone are iterated again. Iterating the blend itself
//! never settles when a body has two contacts. With friction the order of the rows on one body matters a little:
//! they are taken in the order in which the contacts formed. In Coulomb's cone normals and friction are iterated together.

use glam::DVec3;

use super::grip::Friction;
use super::mover::Mover;
use super::row::Row;
use super::scratch::Carry;
use super::touch::Touch;
use crate::body::Body;
use crate::response::Response;
use crate::settings::Settings;

/// Most passes over the normals of a group that slips; in a cone, and where a group creeps, the settings say.
///
/// Passes that begin with nothing may end early, those that begin with loads must not: these may hold energy until the
/// passes have come to terms. Stacks take a few hundred when something has changed, and then one or two a step.
const PASSES: u32 = 40;
/// What a pass may leave of the normals of a group that creeps [m/s], per gravity's kick.
const CREEP: f64 = 1e-7;
/// Passes after which the others make longer strides, and how long: the changes of the first fall quickly or not at all.
const LONG: u32 = 32;
const STRIDE: f64 = 1.8;
/// Changes that fall from pass to pass by less than this ratio says are taken to fall so.
const SLOWEST: f64 = 0.9999;

/// What both halves of a stretch are answered with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Halves {
    /// What gravity adds in a half [m/s], where there is gravity.
    pub kick: Option<DVec3>,
    /// Whether friction has a cone, and whether there is friction at all.
    pub is_cone: bool,
    pub is_rough: bool,
    /// Arm of the rolling resistance [m], where there is any.
    pub rolling: Option<f64>,
    /// Slip below which a contact with friction at a rate is slow [m/s]; see `press_first`.
    pub slow: f64,
    /// Change of a velocity that ends the passes [m/s], and their number.
    pub enough: f64,
    pub passes: u32,
    /// Most passes in a cone, and over a group that creeps.
    pub sweep_cap: u32,
}

impl Halves {
    /// The same for a group that creeps: what is left of its normals would add up.
    fn of_creep(&self) -> Halves {
        Halves {
            enough: CREEP * self.slow + 1e-15,
            passes: self.sweep_cap,
            ..*self
        }
    }
}

/// What the answer of a half took.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    /// Answers of single rows.
    pub passes: u32,
    /// Contacts whose rolling was braked, and tilted bases whose circling was.
    pub braked: usize,
    pub circled: usize,
}

/// Answers a group of rows that share bodies, until no pass changes a velocity by more than enough.
///
/// In a cone, and where a group creeps and no hand is part of it, the passes begin with what the contacts carried last.
/// Elsewhere friction at a rate is given once and not corrected: there they begin with nothing, for what is given to
/// wrong velocities could add energy.
fn answer_group(rows: &mut [Row], all: &mut [Mover], bodies: &[Body], halves: &Halves) -> Work {
    let creeps = rows.len() > 1 && rows.iter().any(|row| row.creeps(all, halves.slow));
    let is_free = creeps && !rows.iter().any(|row| row.is_driven(all));
    let expects = is_free || halves.is_cone && rows.len() > 1;
    if creeps {
        rows.iter_mut().for_each(|row| row.note_approach(all));
    }
    for row in rows.iter_mut() {
        row.begin(all, expects && row.touch.base.is_none());
    }
    let exact = halves.of_creep();
    // What is left over in a cone moves a body that is about to come to rest, by a micrometre in twenty seconds.
    let rests = halves.is_cone
        && rows.len() > 1
        && rows
            .iter()
            .all(|row| row.is_slow(all, halves.slow) && !row.is_driven(all));
    let halves = if is_free || rests { &exact } else { halves };
    let mut work = Work::default();
    if creeps {
        work.passes = press_first(rows, all, bodies, halves);
    }
    for row in rows.iter_mut() {
        match (row.touch.base, row.friction) {
            _ if halves.is_cone => break,
            (Some(_), _) => {}
            (None, Friction::None) => _ = row.press(all, 1.0),
            (None, _) => row.rub(all),
        }
    }
    match rows {
        [row] if !halves.is_cone => {
            if let Some(base) = row.touch.base {
                row.stand(&base, all, bodies);
            }
            work.passes += 1;
        }
        _ => work.passes += settle(rows, all, bodies, halves).0,
    }
    if rows.iter().any(|row| row.resists(halves.rolling)) {
        let braked = brake_group(rows, all, bodies, halves);
        work.passes += braked.passes;
        (work.braked, work.circled) = (braked.braked, braked.circled);
    }
    work
}

/// Lets a group press before it rubs; returns the passes.
///
/// What one contact presses turns the body and lets it slip at the others until they press too. Rubbed against before,
/// such slips add up to a creep of 0.3 mm/s of a pin that has stopped rolling. They are smaller than gravity's kick, and
/// what slips faster need not wait. Under a heavy body on a light one the passes may take several stretches, each
/// beginning where the last one ended. What is squeezed so that no impulses suit all its contacts would gain energy from
/// where it began, and begins anew.
fn press_first(rows: &mut [Row], all: &mut [Mover], bodies: &[Body], halves: &Halves) -> u32 {
    let (passes, missing) = settle(rows, all, bodies, halves);
    let is_settled = missing <= halves.enough;
    if !is_settled && rows.iter().map(|row| row.gained(all)).sum::<f64>() > 0.0 {
        for row in rows.iter_mut() {
            row.take_back(all);
        }
    }
    passes
}

/// What resists rolling at all contacts of a group, once their normal impulses are known; returns what that took.
///
/// What turns less may approach, part or slip at its contacts: the group then has to come to terms again.
fn brake_group(rows: &mut [Row], all: &mut [Mover], bodies: &[Body], halves: &Halves) -> Work {
    let (mut work, mut worst) = (Work::default(), 0.0_f64);
    for row in rows.iter() {
        if let Some(change) = row.circle(all) {
            (work.circled, worst) = (work.circled + 1, worst.max(change));
        }
        if let Some(change) = halves.rolling.and_then(|arm| row.brake(arm, all)) {
            (work.braked, worst) = (work.braked + 1, worst.max(change));
        }
    }
    if worst > halves.enough {
        work.passes = settle(rows, all, bodies, halves).0;
    }
    work
}

/// Passes over all rows until they come to terms; returns how many rows that took, and what is missing [m/s].
///
/// What is still missing follows from how fast the changes fall from pass to pass: under a heavy body on a light one they
/// are small and fall slowly, and add up to much.
fn settle(rows: &mut [Row], all: &mut [Mover], bodies: &[Body], halves: &Halves) -> (u32, f64) {
    let grips = halves.is_cone && halves.is_rough;
    let (mut last, mut ratio, mut missing) = (f64::INFINITY, 0.0, 0.0);
    for pass in 0..halves.passes {
        let stride = if pass >= LONG && halves.passes > PASSES {
            STRIDE
        } else {
            1.0
        };
        let mut worst: f64 = 0.0;
        for row in rows.iter_mut() {
            worst = worst.max(match row.touch.base {
                Some(base) => row.stand(&base, all, bodies),
                None if grips => row.press(all, stride).max(row.grip(all)),
                None => row.press(all, stride),
            });
        }
        let now = (worst / last).min(SLOWEST);
        missing = worst * (now.max(ratio) / (1.0 - now.max(ratio))).max(1.0);
        if missing <= halves.enough {
            return ((pass + 1) * rows.len() as u32, missing);
        }
        (last, ratio) = (worst, now);
    }
    (halves.passes * rows.len() as u32, missing)
}

/// Passes that a half may take, over normals and friction in cones or over normals alone.
pub(crate) fn most_passes(settings: &Settings) -> u32 {
    match settings.response {
        Response::Coulomb => settings.sweep_cap,
        _ => PASSES,
    }
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

    /// Half of gravity's kick for the first `carried` movers, then an answer of all rows.
    pub fn answer(&mut self, bodies: &[Body], carried: usize, halves: &Halves) -> Work {
        if let Some(kick) = halves.kick {
            for mover in &mut self.movers[..carried] {
                mover.linear += kick;
            }
        }
        let (mut start, mut work) = (0, Work::default());
        for end in &self.ends {
            let rows = &mut self.rows[start..*end];
            let group = answer_group(rows, &mut self.movers, bodies, halves);
            work.passes += group.passes;
            work.braked += group.braked;
            work.circled += group.circled;
            start = *end;
        }
        work
    }

    /// Notes how the torques of the last half, the first or the second, change as bodies drift past each other.
    ///
    /// The rows act where bodies touched when the stretch began, and opposite impulses at two places turn a pair by
    /// itself. What touches the ground has no angular momentum to keep: there the arms stay those at which no contact
    /// approaches, and energy is kept better.
    pub fn note_drift(&mut self, second: bool, half: f64) {
        self.drifts.resize(self.slots.len(), [DVec3::ZERO; 2]);
        let mut start = 0;
        for end in &self.ends {
            let rows = &self.rows[start..*end];
            start = *end;
            if !rows.iter().all(|row| row.is_free(&self.middle)) {
                continue;
            }
            for row in rows {
                let (a, b) = row.drift(&self.middle);
                self.drifts[row.movers.0][usize::from(second)] += a / half;
                self.drifts[row.movers.1][usize::from(second)] += b / half;
            }
        }
    }

    /// Empties all lists for the next stretch.
    pub fn clear(&mut self) {
        for slot in self.slots.drain(..) {
            self.numbers[slot] = NONE;
        }
        self.movers.clear();
        self.before.clear();
        self.middle.clear();
        self.drifts.clear();
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
