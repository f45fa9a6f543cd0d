//! Room that steps work in, kept from step to step so that none has to allocate.

use std::collections::BinaryHeap;

use glam::DVec3;

use super::islands::Islands;
use super::mover::Mover;
use super::pairs::Contact;
use super::row::Row;
use super::search::Event;
use super::touch::Touch;

/// Lists that are empty between steps; only their room is kept.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// Pairs whose wait is over.
    pub served: Vec<u32>,
    /// The body that looks, the other, and their pair.
    pub due: Vec<(u32, u32, u32)>,
    /// Way through the tree of boxes, and what it leads to; before that, bodies that something carries.
    pub stack: Vec<u32>,
    pub found: Vec<u32>,
    pub events: BinaryHeap<Event>,
    /// Ends of stretches that have just begun [s], with a body of each.
    pub renewals: Vec<(f64, u32)>,
    pub answer: Answer,
    pub touches: Vec<Touch>,
    pub carried: Vec<usize>,
    pub carry: Carry,
    pub islands: Islands,
    /// Lasting contacts of the tick.
    pub lasting: Vec<Contact>,
    /// Contacts with their age, or bodies to go on with.
    pub aged: Vec<Contact>,
    pub restless: Vec<u32>,
}

/// Bodies and contacts that an impact involves.
#[derive(Debug, Default)]
pub(crate) struct Answer {
    pub bodies: Vec<usize>,
    pub struck: Vec<usize>,
    pub touches: Vec<Touch>,
}

/// Bodies and contacts of a stretch of time.
#[derive(Debug, Default)]
pub(crate) struct Carry {
    pub slots: Vec<usize>,
    /// Number among `slots` of every body that is one of them.
    pub numbers: Vec<u32>,
    pub movers: Vec<Mover>,
    pub before: Vec<Mover>,
    pub middle: Vec<Mover>,
    /// Of every body what each half of the stretch adds to its torque as those that touch it drift [N m/s].
    pub drifts: Vec<[DVec3; 2]>,
    pub rows: Vec<Row>,
    pub labels: Vec<usize>,
    pub ends: Vec<usize>,
}

impl Answer {
    /// Empties all lists for the next impact.
    pub fn clear(&mut self) {
        self.bodies.clear();
        self.struck.clear();
        self.touches.clear();
    }
}

impl Clone for Scratch {
    /// A copy works in room of its own.
    fn clone(&self) -> Scratch {
        Scratch::default()
    }
}
