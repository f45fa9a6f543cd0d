//! What the eyes are shown.

use glam::{Quat, Vec3};
use image::RgbaImage;
use openxr as xr;

use super::super::eyes::{Eye, with_layer};
use super::super::mask::Mask;
use super::super::runtime::STEREO;
use super::super::{Frame, HeadsetError, space};
use super::HeadsetSession;
use crate::offscreen::Readback;
use crate::passes::hidden::HiddenMesh;
use crate::renderer::EyeTarget;
use crate::{Fov, Renderer, Scene, View};

/// What a frame showed.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// The eyes, left first, world frame; empty where the runtime did not know where they are, and nothing was drawn.
    pub views: Vec<View>,
    /// What was handed to the runtime for each of them, where it was asked for.
    pub seen: Vec<Seen>,
}

/// What the runtime has of one eye.
#[derive(Clone, Debug)]
pub struct Seen {
    /// The picture.
    pub picture: RgbaImage,
    /// Depth of each pixel, row by row, from 0 at [`crate::NEAR_M`] to 1 at [`crate::FAR_M`]; `None` where the runtime takes none, or
    /// takes numbers that are not `f32`.
    pub depth: Option<Vec<f32>>,
}

impl HeadsetSession {
    /// Locates the eyes and draws the scene for them; `world_from_tracking` is where the participant's space lies in it.
    ///
    /// With `wanted` what the runtime gets is brought back too, which costs a wait for the device.
    ///
    /// # Errors
    /// When the session is lost or the scene cannot be drawn.
    pub fn show(
        &mut self,
        frame: Frame,
        renderer: &mut Renderer,
        scene: &Scene,
        world_from_tracking: (Vec3, Quat),
        wanted: bool,
    ) -> Result<Shown, HeadsetError> {
        self.stream.begin()?;
        for eye in &mut self.eyes {
            eye.acquire()?;
        }
        // Where the eyes are is asked last: the images may have been waited for.
        let (flags, located) = self.session.locate_views(STEREO, frame.time, &self.base)?;
        let known = xr::ViewStateFlags::POSITION_VALID | xr::ViewStateFlags::ORIENTATION_VALID;
        let [left, right] = located.as_slice() else {
            return Err(HeadsetError::Other("a view for one eye only".to_owned()));
        };
        // Numbers that are none are no place either, whatever the flags say: the runtime would refuse the picture's.
        if !flags.contains(known) || ![left, right].into_iter().all(is_somewhere) {
            self.release()?;
            self.stream.end(frame.time, self.blend, &[])?;
            return Ok(Shown::default());
        }
        let located = [left, right];
        let views = located.map(|eye| view(eye, world_from_tracking));
        let seen = self.draw(renderer, scene, views, wanted)?;
        self.release()?;
        with_layer(&self.eyes, located, &self.base, |layer| {
            self.stream.end(frame.time, self.blend, &[layer])
        })?;
        Ok(Shown {
            views: views.to_vec(),
            seen,
        })
    }

    fn draw(
        &mut self,
        renderer: &mut Renderer,
        scene: &Scene,
        views: [View; 2],
        wanted: bool,
    ) -> Result<Vec<Seen>, HeadsetError> {
        let device = &self.gpu.device;
        for (eye, view) in self.eyes.iter_mut().zip(&views) {
            if let Some(mask) = &mut eye.mask {
                mask.fit(device, view.fov);
            }
        }
        let targets: Vec<_> = self.eyes.iter().filter_map(Targets::of).collect();
        let eyes: Vec<_> = views
            .into_iter()
            .zip(targets.iter().map(Targets::borrowed))
            .collect();
        let size = self.eyes[0].color.size();
        let mut encoder = device.create_command_encoder(&Default::default());
        renderer.record_eyes(&mut encoder, scene, &eyes, size)?;
        let readbacks = if wanted {
            copies(device, &mut encoder, &self.eyes)
        } else {
            Vec::new()
        };
        self.gpu.queue.submit([encoder.finish()]);
        readbacks
            .into_iter()
            .map(|readback| readback.seen(device))
            .collect()
    }

    /// Gives the images back, drawn or not.
    fn release(&mut self) -> Result<(), HeadsetError> {
        self.eyes.iter_mut().try_for_each(Eye::release)
    }
}

/// Views into what an eye's images are now, and what is hidden of them.
struct Targets<'a> {
    color: wgpu::TextureView,
    depth: Option<wgpu::TextureView>,
    hidden: Option<&'a HiddenMesh>,
}

impl<'a> Targets<'a> {
    fn of(eye: &'a Eye) -> Option<Self> {
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        Some(Self {
            color: eye.color.current().map(view)?,
            depth: eye
                .depth
                .as_ref()
                .and_then(|depth| depth.current().map(view)),
            hidden: eye.mask.as_ref().and_then(Mask::mesh),
        })
    }

    fn borrowed(&self) -> EyeTarget<'_> {
        EyeTarget {
            color: &self.color,
            depth: self.depth.as_ref(),
            hidden: self.hidden,
        }
    }
}

/// One eye's images on their way back.
struct Copies {
    color: Readback,
    depth: Option<Readback>,
}

/// Records the copies of all eyes' images, which stay as the compositor expects them.
fn copies(device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder, eyes: &[Eye]) -> Vec<Copies> {
    let mut copy = |texture: &wgpu::Texture| {
        let readback = Readback::new(device, texture.width(), texture.height(), 1);
        readback.copy(encoder, texture, 0);
        readback
    };
    let copied = eyes.iter().filter_map(|eye| {
        let depth = eye.depth.as_ref().and_then(|depth| depth.current());
        // Four bytes a pixel, as colours have.
        let depth = depth.filter(|texture| texture.format() == wgpu::TextureFormat::Depth32Float);
        Some(Copies {
            color: copy(eye.color.current()?),
            depth: depth.map(&mut copy),
        })
    });
    let copied: Vec<_> = copied.collect();
    let back = eyes
        .iter()
        .flat_map(Eye::images)
        .filter_map(|images| images.back());
    encoder.transition_resources(std::iter::empty(), back);
    copied
}

impl Copies {
    fn seen(self, device: &wgpu::Device) -> Result<Seen, HeadsetError> {
        let image = |readback: Readback| {
            let images = readback.images(device)?.into_iter();
            images
                .last()
                .ok_or_else(|| HeadsetError::Drawing("no image came back".to_owned()))
        };
        let numbers = |image: RgbaImage| {
            let (numbers, _) = image.as_raw().as_chunks::<4>();
            numbers.iter().copied().map(f32::from_le_bytes).collect()
        };
        Ok(Seen {
            picture: image(self.color)?,
            depth: self.depth.map(image).transpose()?.map(numbers),
        })
    }
}

/// Whether where an eye is can be told in numbers.
fn is_somewhere(eye: &xr::View) -> bool {
    let turn = eye.pose.orientation;
    space::vector(eye.pose.position).is_finite()
        && [turn.x, turn.y, turn.z, turn.w]
            .iter()
            .all(|number| number.is_finite())
}

/// An eye in the world.
fn view(eye: &xr::View, (position, rotation): (Vec3, Quat)) -> View {
    View {
        position: position + rotation * space::vector(eye.pose.position).as_vec3(),
        rotation: (rotation * space::rotation(eye.pose.orientation).as_quat()).normalize(),
        fov: Fov {
            left: eye.fov.angle_left,
            right: eye.fov.angle_right,
            up: eye.fov.angle_up,
            down: eye.fov.angle_down,
        },
    }
}
