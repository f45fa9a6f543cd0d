//! Contacts for those who listen: blows with the step they fell in, and balls that roll.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::Game;
use crate::components::{Ball, Journey, Physical, Shown};
use crate::event::EventKind;
use crate::visible::Model;

/// Slower than this a ball lies [m/s].
const ROLLS_FROM: f64 = 0.02;

/// Two things struck each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Physics steps at the end of the one in which it happened.
    pub step: u64,
    /// One of them.
    pub a: Model,
    /// The other.
    pub b: Model,
    /// Where, world frame [m].
    pub point: DVec3,
    /// Speed of approach [m/s].
    pub approach_speed: f64,
    /// Size of the impulse [N s].
    pub impulse: f64,
}

/// A ball that rolls or slides on something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollingBall {
    /// Number of the ball, from 0.
    pub ball: u8,
    /// What it is on.
    pub surface: Model,
    /// Where it touches, world frame [m].
    pub point: DVec3,
    /// Speed of its centre [m/s].
    pub speed: f64,
}

impl Game {
    /// The blows of the last frame, the hardest of each pair: those of its [`EventKind::Impact`]s, with the step in which
    /// each fell.
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts
    }

    /// The balls that roll now, none in a pause; looks at every thing that could carry one, so ask only where somebody listens.
    pub fn rolling(&self) -> Vec<RollingBall> {
        if self.is_paused {
            return Vec::new();
        }
        let balls = self.room.balls.iter().filter_map(|entity| {
            let ball: Ball = self.room.get(*entity);
            let body = self.room.body(*entity);
            let speed = body.linear_velocity().length();
            if ball.journey != Journey::InRoom || speed < ROLLS_FROM {
                return None;
            }
            Some(RollingBall {
                ball: ball.index,
                surface: self.carrier(self.room.id(*entity))?,
                point: body.pose().position - DVec3::Y * ball.radius,
                speed,
            })
        });
        balls.collect()
    }

    /// What a ball lies on: a part of the building that it touches, a gutter before all others.
    fn carrier(&self, ball: physics::BodyId) -> Option<Model> {
        let mut carrier = None;
        for (shown, body) in &mut self.room.ecs.query::<(&Shown, &Physical)>() {
            if can_carry(shown.model) && self.room.world.touching(ball, body.0) {
                carrier = Some(shown.model);
                if shown.model == Model::Gutter {
                    break;
                }
            }
        }
        carrier
    }

    /// Keeps the impacts of a step, and what the hand struck.
    pub(crate) fn notice_impacts(&mut self) {
        self.head_was_beyond = self.head_is_beyond();
        let hand = self.room.id(self.room.hand);
        for impact in self.room.world.impacts() {
            let a = self.room.model(self.room.owner(impact.a));
            let b = self.room.model(self.room.owner(impact.b));
            if impact.a == hand || impact.b == hand {
                self.hand
                    .touching
                    .push(if impact.a == hand { b } else { a });
            }
            if impact.approach_speed < self.room.config.rules.impact_reported_from_mps {
                continue;
            }
            self.impacts.push(Contact {
                step: self.steps,
                a,
                b,
                point: impact.point,
                approach_speed: impact.approach_speed,
                impulse: impact.impulse.length(),
            });
        }
    }

    /// Reports the impacts of a frame, one for each pair.
    pub(crate) fn report_impacts(&mut self) {
        let mut hardest: BTreeMap<(Model, Model), Contact> = BTreeMap::new();
        for contact in self.impacts.drain(..) {
            let pair = (contact.a.min(contact.b), contact.a.max(contact.b));
            let known = hardest.entry(pair).or_insert(contact);
            if known.impulse < contact.impulse {
                *known = contact;
            }
        }
        self.contacts.clear();
        for contact in hardest.into_values() {
            self.contacts.push(contact);
            self.record(EventKind::Impact {
                a: contact.a,
                b: contact.b,
                point: contact.point,
                approach_speed: contact.approach_speed,
                impulse: contact.impulse,
            });
        }
    }
}

/// Whether a ball may roll on it.
fn can_carry(model: Model) -> bool {
    matches!(
        model,
        Model::Lane
            | Model::Approach
            | Model::Gutter
            | Model::Kickback
            | Model::Pit
            | Model::Cushion
            | Model::SideFloor
            | Model::Rack
            | Model::Desk
    )
}
