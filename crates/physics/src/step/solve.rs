//! Lasting contacts as rows of a small velocity problem, group by group.
//!
//! Under the paper's laws each row takes the e = 0 blend of Eq. (9)
//! once; then the normal impulses alone are iterated until no contact approaches. Iterating the blend itself
//! never settles when a body has two contacts. With friction the order of the rows on one body matters a little:
//! they are taken in the order in which the contacts formed. In Coulomb's cone normals and friction are iterated together.

use glam::DVec3;

use super::grip::Friction;
use super::row::{Mover, Row};
use super::scratch::Carry;
use super::touch::Touch;
use crate::body::Body;

/// Most passes over the normals of a group, and over normals and friction in a cone.
///
/// Passes that begin with nothing may end early, those that begin with loads must not: these may hold energy until the
/// passes have come to terms. Stacks take a few hundred when something has changed, and then one or two a step.
const PASSES: u32 = 40;
const CONE_PASSES: u32 = 1000;

/// Answers a group of rows that share bodies, until no pass changes a velocity by more than `enough` [m/s].
///
/// In a cone the passes begin with what the contacts carried last. Friction at a rate is given once and not corrected:
/// there they begin with nothing, for what is given to wrong velocities could add energy.
fn answer_group(rows: &mut [Row], all: &mut [Mover], bodies: &[Body], enough: f64) -> u32 {
    let in_cone = matches!(rows[0].friction, Friction::Cone(_));
    let expects = in_cone && rows.len() > 1;
    for row in rows.iter_mut() {
        row.begin(all, expects && row.touch.base.is_none());
        if row.touch.base.is_none() && !in_cone {
            row.rub(all);
        }
    }
    match rows {
        [row] if !in_cone => {
            if let Some(base) = row.touch.base {
                row.stand(&base, all, bodies);
            }
            1
        }
        _ if in_cone => settle(rows, all, bodies, enough, CONE_PASSES),
        _ => settle(rows, all, bodies, enough, PASSES),
    }
}

/// Passes over all rows until they come to terms; returns how many rows that took.
fn settle(rows: &mut [Row], all: &mut [Mover], bodies: &[Body], enough: f64, most: u32) -> u32 {
    for pass in 0..most {
        let mut worst: f64 = 0.0;
        for row in rows.iter_mut() {
            worst = worst.max(match row.touch.base {
                Some(base) => row.stand(&base, all, bodies),
                None => row.press(all).max(row.grip(all)),
            });
        }
        if worst <= enough {
            return (pass + 1) * rows.len() as u32;
        }
    }
    most * rows.len() as u32
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
