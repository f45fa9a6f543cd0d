//! Images that eyes are drawn into and nobody reads: what a frame costs, on the processor and on the device.

use crate::offscreen::color_texture;
use crate::{Gpu, RenderError, Renderer, Scene, View};

/// Bytes of one timestamp.
const STAMP: u64 = size_of::<u64>() as u64;

/// One image for each eye, as a headset's swapchains are, and the device's clock where it has one.
#[derive(Debug)]
pub struct EyeTargets {
    gpu: Gpu,
    size: [u32; 2],
    targets: Vec<wgpu::TextureView>,
    clock: Option<Clock>,
}

impl EyeTargets {
    /// Makes images of `size` pixels for `eyes` eyes.
    ///
    /// # Errors
    /// If the device has no images of that size.
    pub fn new(gpu: &Gpu, size: [u32; 2], eyes: usize) -> Result<Self, RenderError> {
        gpu.check_size(size[0], size[1])?;
        let target = || color_texture(gpu, size[0], size[1]).create_view(&Default::default());
        Ok(Self {
            gpu: gpu.clone(),
            size,
            targets: (0..eyes).map(|_| target()).collect(),
            clock: Clock::new(gpu),
        })
    }

    /// Records and submits one frame, a view for each eye, and does not wait for it.
    ///
    /// # Errors
    /// If the scene or a view cannot be drawn.
    pub fn draw(
        &mut self,
        renderer: &mut Renderer,
        scene: &Scene,
        views: &[View],
    ) -> Result<(), RenderError> {
        let eyes: Vec<_> = views.iter().copied().zip(&self.targets).collect();
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        if let Some(clock) = &self.clock {
            encoder.write_timestamp(&clock.stamps, 0);
        }
        renderer.record(&mut encoder, scene, &eyes, self.size)?;
        if let Some(clock) = &self.clock {
            clock.stop(&mut encoder);
        }
        self.gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Waits until the device has drawn what was submitted, and returns how long it took for the last frame [s]; `None` where
    /// the device has no clock.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn wait(&self) -> Result<Option<f64>, RenderError> {
        let fail = |reason: String| RenderError::Readback(reason);
        let answer = self.clock.as_ref().map(|clock| {
            let (sender, receiver) = std::sync::mpsc::channel();
            clock
                .read
                .map_async(wgpu::MapMode::Read, .., move |mapped| {
                    // The receiver outlives the poll below; if that failed, its error is the one to report.
                    let _ = sender.send(mapped);
                });
            receiver
        });
        self.gpu
            .device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|error| fail(error.to_string()))?;
        let (Some(clock), Some(answer)) = (&self.clock, answer) else {
            return Ok(None);
        };
        answer
            .recv()
            .map_err(|error| fail(error.to_string()))?
            .map_err(|error| fail(error.to_string()))?;
        let ticks = {
            let bytes = clock
                .read
                .get_mapped_range(..)
                .map_err(|error| fail(error.to_string()))?;
            let stamps: &[u64] = bytemuck::cast_slice(&bytes);
            stamps[1].saturating_sub(stamps[0])
        };
        clock.read.unmap();
        let period_ns = f64::from(self.gpu.queue.get_timestamp_period());
        Ok(Some(ticks as f64 * period_ns * 1e-9))
    }
}

/// Two timestamps around a frame, on their way to the processor.
#[derive(Debug)]
struct Clock {
    stamps: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    read: wgpu::Buffer,
}

impl Clock {
    /// A clock, unless the device has none.
    fn new(gpu: &Gpu) -> Option<Self> {
        let device = &gpu.device;
        if !device.features().contains(crate::gpu::TIMESTAMPS) {
            return None;
        }
        let buffer = |usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("timestamps"),
                size: 2 * STAMP,
                usage,
                mapped_at_creation: false,
            })
        };
        Some(Self {
            stamps: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("timestamps"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            read: buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
        })
    }

    fn stop(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.write_timestamp(&self.stamps, 1);
        encoder.resolve_query_set(&self.stamps, 0..2, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.read, 0, 2 * STAMP);
    }
}
