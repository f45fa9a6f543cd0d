//! Who is near whom, and which pairs are looked at in this step.
//!
//! Every body has a box in a tree that is larger than the body by a *margin*; only bodies whose boxes meet are a
//! pair. A body that is about to leave its box gets a new one around the place where it is, and then finds its new
//! neighbours. What is immovable never asks; it is found.
//!
//! Of a pair it is known up to which length of their ways its bodies are apart (`Pair::clearance`). Each body keeps to
//! a *pace*, a bound of its way in a step; so the pair waits for the step before which both paces cannot use the
//! clearance up. A body that exceeds its pace gets a new one, and all its pairs wait anew. The wait only decides when
//! the ways are compared with the clearance again: nothing depends on how tight the paces are.

use glam::DVec3;

use super::search::rough_gap;
use super::touch::place;
use super::tree::{Bounds, Tree};
use crate::advance::time_to_close;
use crate::body::{Body, Motion};
use crate::query::Placed;
use crate::world::World;

/// Margin of a box: that many of the ways of a step, and a least width [m].
const MARGIN: (f64, f64) = (8.0, 0.02);
/// Distance at which bodies that were within reach of each other are forgotten as a pair [m].
const FORGET: f64 = 1.0;
/// A new pace is that much more than what the body needs now.
const HEADROOM: f64 = 1.25;
/// Share of its pace that a body keeps from step to step while it needs less.
const EASE: f64 = 0.95;

/// Where the bodies are, roughly.
#[derive(Clone, Debug, Default)]
pub(crate) struct Broad {
    tree: Tree,
    /// Bodies without bounds, half-spaces; every body that gets a new box is held against them.
    unbounded: Vec<u32>,
}

impl World {
    /// Renews the boxes and paces of all that move, and serves the pairs whose time has come.
    ///
    /// They are put into `self.scratch.due` with the body that looks first, in the order of their numbers.
    pub(crate) fn gather_due(&mut self) {
        let awake = std::mem::take(&mut self.awake);
        for slot in &awake {
            self.stay_in_box(*slot as usize);
        }
        for slot in &awake {
            let slot = *slot as usize;
            let body = &mut self.bodies[slot];
            if body.reach > body.pace {
                self.quicken(slot);
                for i in 0..self.pairs.near(slot).len() {
                    self.wait(self.pairs.near(slot)[i].pair);
                }
            } else if EASE * body.pace >= HEADROOM * body.reach {
                body.pace *= EASE;
            }
        }
        self.awake = awake;
        let mut served = std::mem::take(&mut self.scratch.served);
        self.pairs.queue.serve(&mut served);
        for pair in served.drain(..) {
            let entry = self.pairs.get(pair);
            let (a, b) = (entry.a, entry.b);
            let still = |slot: u32| self.bodies[slot as usize].is_still();
            match (still(a), still(b)) {
                // Whoever moves first exceeds this pace, and then the pair waits again.
                (true, true) => {
                    self.bodies[a as usize].pace = 0.0;
                    self.bodies[b as usize].pace = 0.0;
                }
                (false, _) => self.scratch.due.push((a, b, pair)),
                (true, false) => self.scratch.due.push((b, a, pair)),
            }
        }
        self.scratch.served = served;
        self.effort.due += self.scratch.due.len() as u64;
        self.effort.near += self.pairs.count() as u64;
        self.scratch.due.sort_unstable();
    }

    /// Gives a body a pace that it can keep to.
    pub(crate) fn quicken(&mut self, slot: usize) {
        let body = &mut self.bodies[slot];
        body.pace = body.pace.max(HEADROOM * body.reach);
    }

    /// Lets a pair wait until its bodies may have used up what is known to part them.
    pub(crate) fn wait(&mut self, pair: u32) {
        let entry = self.pairs.get(pair);
        let (a, b) = (
            &self.bodies[entry.a as usize],
            &self.bodies[entry.b as usize],
        );
        let slack = entry.clearance - (a.path + b.path);
        let pace = a.pace + b.pace;
        if pace == 0.0 && slack > 0.0 {
            self.pairs.queue.take_out(pair);
            return;
        }
        // One step for what is left of this one, one for the step that is served, by then all may be used up.
        let steps = (time_to_close(slack, pace, 0.0) - 2.0).max(0.0);
        self.pairs.queue.put(pair, steps as u64);
    }

    /// Gives a body that may leave its box in this step a new one, and finds its neighbours.
    pub(crate) fn stay_in_box(&mut self, slot: usize) {
        let body = &mut self.bodies[slot];
        if body.path + body.reach <= body.box_until && body.meets {
            return;
        }
        let number = slot as u32;
        if !body.meets {
            self.broad.remove(number);
            self.pairs.forget(slot);
            return;
        }
        let margin = if body.motion == Motion::Fixed {
            0.0
        } else {
            MARGIN.0 * body.reach + MARGIN.1
        };
        body.box_until = body.path + margin;
        let bounds = bounds(body, margin);
        if bounds.low.is_nan() || bounds.high.is_nan() {
            self.broad.remove(number);
            self.pairs.forget(slot);
            return;
        }
        self.broad.put(number, bounds);
        for i in (0..self.pairs.near(slot).len()).rev() {
            let near = self.pairs.near(slot)[i];
            let has_parts = !self.pairs.get(near.pair).parts.is_empty();
            let keep = if has_parts { FORGET } else { 0.0 };
            if !self.within(slot, near.other as usize, keep) {
                self.pairs.separate(near.pair);
            }
        }
        let mut found = std::mem::take(&mut self.scratch.found);
        self.broad
            .find(&bounds, &mut self.scratch.stack, &mut found);
        for other in found.drain(..) {
            let other = other as usize;
            if other != slot
                && may_meet(&self.bodies[slot], &self.bodies[other])
                && !self.pairs.are_near(slot, other)
                && self.within(slot, other, 0.0)
            {
                let pair = self.pairs.meet(slot, other);
                self.pairs.queue.put(pair, 0);
            }
        }
        self.scratch.found = found;
    }

    /// Whether two bodies may come within `extra` [m] of each other before one of them leaves its box.
    fn within(&self, a: usize, b: usize, extra: f64) -> bool {
        let (a, b) = (&self.bodies[a], &self.bodies[b]);
        let room = |body: &Body| (body.box_until - body.path).max(0.0);
        rough_gap(a, &a.pose(), b, &b.pose()) <= room(a) + room(b) + extra
    }
}

impl Broad {
    fn put(&mut self, body: u32, bounds: Bounds) {
        self.tree.put(body, bounds);
        match (self.unbounded.binary_search(&body), bounds.is_finite()) {
            (Err(place), false) => self.unbounded.insert(place, body),
            (Ok(place), true) => {
                self.unbounded.remove(place);
            }
            _ => {}
        }
    }

    fn remove(&mut self, body: u32) {
        self.tree.remove(body);
        if let Ok(place) = self.unbounded.binary_search(&body) {
            self.unbounded.remove(place);
        }
    }

    /// Appends all bodies whose boxes meet `bounds`; infinite ones meet everything.
    fn find(&self, bounds: &Bounds, stack: &mut Vec<u32>, found: &mut Vec<u32>) {
        self.tree.find(bounds, stack, found);
        found.extend(&self.unbounded);
    }
}

/// Whether two bodies can ever be a pair: both collide, and something moves one of them.
fn may_meet(a: &Body, b: &Body) -> bool {
    let moved = a.motion == Motion::Dynamic || b.motion == Motion::Dynamic;
    a.meets && b.meets && moved
}

/// The box that holds a body while its surface moves by no more than `margin` [m].
fn bounds(body: &Body, margin: f64) -> Bounds {
    let radius = body.compound.bounding_radius();
    if body.motion != Motion::Fixed || radius == f64::INFINITY {
        return Bounds::around(body.position, radius + margin);
    }
    // A ball around a lane would hold its neighbours too.
    let parts = body.compound.parts().iter().map(|p| place(p, &body.pose()));
    parts
        .map(|part| tight(&part))
        .reduce(|x, y| x.with(&y))
        .expect("a compound has parts")
}

fn tight(part: &Placed) -> Bounds {
    let low = |n: DVec3| part.support(-n).dot(n);
    let high = |n: DVec3| part.support(n).dot(n);
    Bounds {
        low: DVec3::new(low(DVec3::X), low(DVec3::Y), low(DVec3::Z)),
        high: DVec3::new(high(DVec3::X), high(DVec3::Y), high(DVec3::Z)),
    }
}

#[cfg(test)]
mod tests;
