//! One game's pictures: what all of them are made from, and with whose eyes they are seen.

use anyhow::Result;
use game::{Model, Visible};
use image::RgbaImage;
use renderer::View;
use sound::Listener;

use super::Painter;
use super::film::{Film, Shot};
use super::layout::eye_size;
use crate::convert;
use crate::output::OutputFolder;

/// Whose eyes a moment is seen with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Eyes {
    /// The participant's; the spectator's while the head is not tracked.
    Own,
    /// A spectator's beside the pin deck, as far apart as the participant's.
    Spectator,
}

/// What the pictures of one game are made from, and where they go.
pub struct Album<'a> {
    /// Draws and writes captions.
    pub painter: &'a mut Painter,
    /// The things that never move.
    pub still: &'a [Visible],
    /// The game.
    pub film: &'a Film,
    /// Where the files go.
    pub folder: &'a OutputFolder,
    /// Told how far the work is, in a few words.
    pub progress: &'a mut dyn FnMut(&str),
}

impl Album<'_> {
    /// Width and height of one eye's picture of about `area` pixels.
    pub fn size(&self, area: f32) -> (u32, u32) {
        let [left, _] = convert::spectator_eyes(self.painter.headpin_z, &self.painter.display);
        eye_size(area, left.fov.aspect())
    }

    /// Both eyes' pictures of one snapshot, left first, each of `size` pixels.
    ///
    /// # Errors
    /// When they cannot be drawn, or drawing was stopped.
    pub fn draw(&mut self, shot: &Shot, eyes: Eyes, size: (u32, u32)) -> Result<[RgbaImage; 2]> {
        let views = self.views(shot, eyes);
        self.painter.draw(self.still, shot, &views, size)
    }

    /// Whether the middle of a ball lies in what the eyes see, whatever stands before it.
    pub fn shows_a_ball(&self, shot: &Shot, eyes: Eyes) -> bool {
        let [left, right] = self.views(shot, eyes);
        let balls = shot
            .moving
            .iter()
            .filter(|visible| matches!(visible.model, Model::Ball(_)));
        balls.into_iter().any(|ball| {
            let middle = ball.pose.position.as_vec3();
            [left, right].iter().any(|view| {
                let place = view.pixel_of(middle, 1, 1);
                place.is_some_and(|[x, y]| (0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y))
            })
        })
    }

    /// Where the ears are while a moment is seen.
    pub fn listener(&self, shot: &Shot, eyes: Eyes) -> Listener {
        let [left, right] = self.views(shot, eyes);
        Listener {
            position: (0.5 * (left.position + right.position)).as_dvec3(),
            orientation: left.rotation.as_dquat(),
        }
    }

    fn views(&self, shot: &Shot, eyes: Eyes) -> [View; 2] {
        let display = &self.painter.display;
        match (eyes, shot.head) {
            (Eyes::Own, Some(head)) => convert::eyes(&head, display),
            _ => convert::spectator_eyes(self.painter.headpin_z, display),
        }
    }
}
