//! The screen over the lane while it shows the last throw again, from behind the pins.

use std::path::Path;
use std::sync::Arc;

use anyhow::Result;
use game::{Config, ShowsConfig};
use glam::{Mat4, Vec3};
use renderer::{Canvas, Fov, Instance, Material, Renderer, View};

use super::{HandLook, HandShape, Stock, scene, settings};
use crate::again::Moment;
use crate::scenery;

/// Size of its picture [pixels]; its shape is the screen's.
const SIZE: [u32; 2] = [768, 340];
/// Vertical field of view [rad].
const FIELD: f32 = 0.98;
/// Where its camera is: so far behind the deck and above the lane [m], in front of the cushion; and how far before the head pin's spot
/// it looks at the lane. All pins are in the picture, and the ball's last three metres.
const BEHIND_M: f32 = 0.8;
const ABOVE_M: f32 = 1.2;
const AHEAD_M: f32 = 0.25;

/// A small renderer of its own, whose pictures are shown on the screen: one colour a face and few corners, or a throw would be
/// drawn thrice in full.
#[derive(Debug)]
pub(super) struct Screen {
    renderer: Renderer,
    stock: Box<Stock>,
    canvas: Canvas,
    view: View,
    instance: Instance,
    shown: Option<Moment>,
}

impl Screen {
    /// A screen that shows nothing yet, in the room of `renderer`.
    pub fn new(renderer: &mut Renderer, root: &Path, config: &Config) -> Result<Self> {
        let (texture, canvas) = renderer.add_canvas(SIZE)?;
        let mesh = renderer.add_mesh(&scenery::screen_mesh(config).to_data())?;
        let plain = Config {
            shows: ShowsConfig {
                shadows: false,
                reflection: false,
                ambient_occlusion: false,
                neighbouring_lanes: false,
                furnishings: false,
                materials: false,
                smooth_edges: false,
                low_polygon: true,
                replay: false,
                sound: false,
            },
            ..config.clone()
        };
        let mut own = Renderer::new(renderer.gpu(), settings(&plain.shows))?;
        let stock = Box::new(Stock::load(&mut own, root, &plain)?);
        let deck = config.lane.deck_end_z_m as f32 - BEHIND_M;
        let head_pin = config.lane.headpin_z_m as f32;
        let view = View::looking_at(
            Vec3::new(0.0, ABOVE_M, deck),
            Vec3::new(0.0, 0.0, head_pin + AHEAD_M),
            Fov::from_aspect(FIELD, canvas.aspect()),
        );
        let instance = Instance {
            mesh,
            material: Material {
                texture: Some(texture),
                is_mirrored: true,
                casts_shadows: false,
                ..Material::unlit([1.0; 3])
            },
            world_from_mesh: Mat4::IDENTITY,
        };
        Ok(Self {
            renderer: own,
            stock,
            canvas,
            view,
            instance,
            shown: None,
        })
    }

    /// Shows a moment, drawn only if it is another than before, or nothing.
    pub fn show(&mut self, moment: Option<Moment>) -> Result<()> {
        let is_same = |a: &Moment| self.shown.as_ref().is_some_and(|b| Arc::ptr_eq(a, b));
        if let Some(things) = moment.as_ref().filter(|things| !is_same(things)) {
            let look = HandLook::right(HandShape::Closing(0.0));
            let scene = scene(things.iter(), &self.stock, look);
            self.canvas.paint(&mut self.renderer, &scene, self.view)?;
        }
        self.shown = moment;
        Ok(())
    }

    /// The screen, while it shows something.
    pub fn instance(&self) -> Option<Instance> {
        self.shown.is_some().then_some(self.instance)
    }
}
