//! Images into rectangles of the window.

use crate::shaders;
use crate::uniforms::PictureRaw;

/// Draws pictures into a surface of one format.
#[derive(Debug)]
pub(crate) struct PresentPass {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    /// Whether the surface leaves the encoding of sRGB to the shader.
    encode: bool,
}

/// An image and the rectangle that it fills.
#[derive(Debug)]
pub(crate) struct Picture {
    bind_group: wgpu::BindGroup,
    uniform: wgpu::Buffer,
}

impl PresentPass {
    pub fn new(device: &wgpu::Device, surface_format: wgpu::TextureFormat) -> Self {
        let layout = layout(device);
        let target = wgpu::ColorTargetState {
            format: surface_format,
            blend: Some(wgpu::BlendState::ALPHA_BLENDING),
            write_mask: wgpu::ColorWrites::ALL,
        };
        let pipeline = super::Overlay {
            label: "present",
            shader: shaders::PRESENT.into(),
            layout: &layout,
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            target: Some(target),
            depth: None,
        }
        .pipeline(device);
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("present"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self {
            pipeline,
            layout,
            sampler,
            encode: !surface_format.is_srgb(),
        }
    }

    /// A picture of `texture`, which is kept alive by it; it fills nothing until it is placed.
    pub fn picture(&self, device: &wgpu::Device, texture: &wgpu::Texture) -> Picture {
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("picture"),
            size: size_of::<PictureRaw>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let view = texture.create_view(&Default::default());
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("picture"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: uniform.as_entire_binding(),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::TextureView(&view),
                },
                wgpu::BindGroupEntry {
                    binding: 2,
                    resource: wgpu::BindingResource::Sampler(&self.sampler),
                },
            ],
        });
        Picture {
            bind_group,
            uniform,
        }
    }

    /// Puts a picture at `place` in a window of `window` pixels.
    pub fn place(&self, queue: &wgpu::Queue, picture: &Picture, place: Place, window: [u32; 2]) {
        let raw = PictureRaw {
            rectangle: place.clip_corners(window),
            encode: u32::from(self.encode),
            padding: [0; 3],
        };
        queue.write_buffer(&picture.uniform, 0, bytemuck::bytes_of(&raw));
    }

    /// Clears `target` to black and draws the pictures over each other.
    pub fn record<'a>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        pictures: impl Iterator<Item = &'a Picture>,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("present"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        for picture in pictures {
            pass.set_bind_group(0, &picture.bind_group, &[]);
            pass.draw(0..4, 0..1);
        }
    }
}

/// A rectangle of a window [pixels], from its upper left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

impl Place {
    /// Left, bottom, right, top in clip space.
    fn clip_corners(&self, window: [u32; 2]) -> [f32; 4] {
        let across = |x: u32| 2.0 * x as f32 / window[0] as f32 - 1.0;
        let down = |y: u32| 1.0 - 2.0 * y as f32 / window[1] as f32;
        [
            across(self.x),
            down(self.y + self.height),
            across(self.x + self.width),
            down(self.y),
        ]
    }

    /// The largest rectangle of this aspect (width over height) within this one, in its middle.
    pub fn fit(&self, aspect: f32) -> Self {
        let width = (self.height as f32 * aspect).round() as u32;
        let height = (self.width as f32 / aspect).round() as u32;
        let (width, height) = if width <= self.width {
            (width.max(1), self.height)
        } else {
            (self.width, height.clamp(1, self.height))
        };
        Self {
            x: self.x + (self.width - width) / 2,
            y: self.y + (self.height - height) / 2,
            width,
            height,
        }
    }
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, visibility, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty,
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("present"),
        entries: &[
            entry(
                0,
                wgpu::ShaderStages::VERTEX_FRAGMENT,
                wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: wgpu::BufferSize::new(size_of::<PictureRaw>() as u64),
                },
            ),
            entry(
                1,
                wgpu::ShaderStages::FRAGMENT,
                wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: true },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
            ),
            entry(
                2,
                wgpu::ShaderStages::FRAGMENT,
                wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
            ),
        ],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fit_keeps_the_aspect_and_stays_inside() {
        let half = Place {
            x: 640,
            y: 0,
            width: 640,
            height: 480,
        };
        let wide = half.fit(2.0);
        assert_eq!(
            (wide.x, wide.y, wide.width, wide.height),
            (640, 80, 640, 320)
        );
        let tall = half.fit(0.5);
        assert_eq!(
            (tall.x, tall.y, tall.width, tall.height),
            (840, 0, 240, 480)
        );
    }

    #[test]
    fn clip_corners_of_the_upper_left_quarter() {
        let quarter = Place {
            x: 0,
            y: 0,
            width: 50,
            height: 20,
        };
        assert_eq!(quarter.clip_corners([100, 40]), [-1.0, 0.0, 0.0, 1.0]);
    }
}
