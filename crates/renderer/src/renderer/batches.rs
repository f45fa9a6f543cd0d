//! The instances of a frame, sorted into batches.

use super::Renderer;
use crate::passes::Batch;
use crate::passes::lit::Shading;
use crate::scene::Scene;
use crate::uniforms::InstanceRaw;

/// What `prepare` found out about the current frame; kept to reuse its memory.
#[derive(Debug, Default)]
pub(super) struct Frame {
    /// Places in the scene, batch by batch.
    order: Vec<u32>,
    packed: Vec<InstanceRaw>,
    pub batches: Vec<Batch>,
    pub background: [f32; 3],
    /// How its surfaces are drawn.
    pub shading: Shading,
    /// Whether the picture's edge is dark.
    pub has_vignette: bool,
}

impl Renderer {
    /// Sorts instances into batches and sends them.
    pub(super) fn pack_instances(&mut self, scene: &Scene) {
        let frame = &mut self.frame;
        let batch = |at: u32, first| Batch::of(&scene.instances[at as usize], first);
        frame.order.clear();
        frame.order.extend(0..scene.instances.len() as u32);
        // By place in the scene last, so that the order is the same every time.
        frame
            .order
            .sort_unstable_by_key(|&at| (batch(at, 0).key(), at));
        frame.packed.clear();
        frame.batches.clear();
        for &at in &frame.order {
            let one = batch(at, frame.packed.len() as u32);
            frame
                .packed
                .push(InstanceRaw::new(&scene.instances[at as usize]));
            match frame.batches.last_mut() {
                Some(last) if last.key() == one.key() => last.count += 1,
                _ => frame.batches.push(one),
            }
        }
        let bytes: &[u8] = bytemuck::cast_slice(&frame.packed);
        if bytes.len() as u64 > self.instances.size() {
            let count = frame.packed.len().next_power_of_two();
            self.instances = instance_buffer(&self.gpu.device, count);
        }
        self.gpu.queue.write_buffer(&self.instances, 0, bytes);
    }
}

/// Room for `count` instances.
pub(super) fn instance_buffer(device: &wgpu::Device, count: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("instances"),
        size: (count * size_of::<InstanceRaw>()) as u64,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
