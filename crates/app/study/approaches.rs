//! What came towards the participant's head in a run, gathered while it is played again.

use std::collections::BTreeMap;

use experiment::behaviour::{Body, BodySample, HeadSample, Settings, episodes};
use experiment::record::EventRow;
use game::{Game, Model};
use glam::DVec3;

/// Bodies farther from the head than this are not looked at [m]: at 30 m/s that is more than a third of a second away.
const NEAR_M: f64 = 12.0;

/// Tracks of the head and of what was near it.
#[derive(Debug, Default)]
pub struct Approaches {
    head: Vec<HeadSample>,
    /// By name: radius [m] and samples.
    bodies: BTreeMap<String, (f64, Vec<BodySample>)>,
}

impl Approaches {
    /// Takes down where head, balls and pins are in the frame that `game` has finished.
    pub fn frame(&mut self, game: &Game) {
        let time_s = game.time();
        let head = game.head_pose_world().map(|pose| pose.position);
        self.head.push(HeadSample {
            time_s,
            position: head.map(|position| position.to_array()),
        });
        let Some(head) = head else { return };
        let held = game.held();
        for visible in game.visible() {
            let name = match visible.model {
                model if held == Some(model) => continue,
                Model::Ball(number) => format!("ball {}", number + 1),
                Model::Pin(number) => format!("pin {number}"),
                _ => continue,
            };
            if visible.pose.position.distance(head) > NEAR_M {
                continue;
            }
            let radius = 0.5 * visible.size.max_element();
            let (_, samples) = self.bodies.entry(name).or_insert((radius, Vec::new()));
            // A pin's origin is the middle of its base.
            let up = match visible.model {
                Model::Pin(_) => 0.5 * visible.size.y,
                _ => 0.0,
            };
            let centre = visible.pose.transform_point(DVec3::Y * up);
            samples.push(BodySample {
                time_s,
                centre: centre.to_array(),
            });
        }
    }

    /// The run's rows, and an empty track for the next run.
    pub fn take(&mut self) -> Vec<EventRow> {
        let Self { head, bodies } = std::mem::take(self);
        let settings = Settings::default();
        let rows = bodies.iter().flat_map(|(name, (radius_m, samples))| {
            let body = Body {
                radius_m: *radius_m,
                samples,
            };
            let found = episodes(&head, &body, &settings).scored;
            found.into_iter().map(|episode| episode.event(name))
        });
        rows.collect()
    }
}
