//! What the runtime has of one eye: images for its picture and, where it wants it, its depth; and what its lens hides.

use openxr as xr;

use super::HeadsetError;
use super::images::Images;
use super::mask::Mask;
use super::runtime::Runtime;
use crate::{FAR_M, Gpu, NEAR_M};

/// One eye's images.
pub(super) struct Eye {
    pub color: Images,
    /// `None` where the runtime has no use for it.
    pub depth: Option<Images>,
    /// `None` where the whole picture is seen.
    pub mask: Option<Mask>,
}

impl Eye {
    /// Makes images for the eye number `index`, as large as the runtime recommends.
    pub fn new(
        runtime: &Runtime,
        session: &xr::Session<xr::Vulkan>,
        gpu: &Gpu,
        index: usize,
    ) -> Result<Self, HeadsetError> {
        let size = runtime.headset.eye_size;
        Ok(Self {
            mask: Mask::of(runtime, session, index),
            color: Images::color(runtime, session, gpu, size)?,
            depth: Images::depth(runtime, session, gpu, size)?,
        })
    }

    /// Its swapchains.
    pub fn images(&self) -> impl Iterator<Item = &Images> {
        std::iter::once(&self.color).chain(&self.depth)
    }

    /// Takes the images to draw into next.
    pub fn acquire(&mut self) -> Result<(), HeadsetError> {
        self.color.acquire()?;
        self.depth.as_mut().map_or(Ok(()), Images::acquire)
    }

    /// Gives the images to the compositor; their drawing must have been submitted.
    pub fn release(&mut self) -> Result<(), HeadsetError> {
        self.color.release()?;
        self.depth.as_mut().map_or(Ok(()), Images::release)
    }

    /// What is said of the depth: 0 lies at the near plane and 1 at the far one, as [`crate::View::clip_from_world`] has it.
    fn depth_info(&self) -> Option<xr::sys::CompositionLayerDepthInfoKHR> {
        self.depth
            .as_ref()
            .map(|depth| xr::sys::CompositionLayerDepthInfoKHR {
                ty: xr::sys::CompositionLayerDepthInfoKHR::TYPE,
                next: std::ptr::null(),
                sub_image: depth.sub_image().into_raw(),
                min_depth: 0.0,
                max_depth: 1.0,
                near_z: NEAR_M,
                far_z: FAR_M,
            })
    }
}

/// The layer of both eyes' pictures, as they were located, handed to `submit` while all that it points to lives.
#[expect(
    unsafe_code,
    reason = "the depth is chained to the picture by a pointer"
)]
pub(super) fn with_layer<T>(
    eyes: &[Eye; 2],
    located: [&xr::View; 2],
    base: &xr::Space,
    submit: impl FnOnce(&xr::CompositionLayerProjection<'_, xr::Vulkan>) -> T,
) -> T {
    let depths = eyes.each_ref().map(Eye::depth_info);
    let projections = [0, 1].map(|index| {
        let projection = xr::CompositionLayerProjectionView::<xr::Vulkan>::new()
            .pose(located[index].pose)
            .fov(located[index].fov)
            .sub_image(eyes[index].color.sub_image());
        let mut raw = projection.into_raw();
        if let Some(depth) = &depths[index] {
            raw.next = std::ptr::from_ref(depth).cast();
        }
        // SAFETY: the swapchains and what is chained live until `submit` has returned.
        unsafe { xr::CompositionLayerProjectionView::from_raw(raw) }
    });
    let layer = xr::CompositionLayerProjection::new()
        .space(base)
        .views(&projections);
    submit(&layer)
}
