//! The images that the runtime shows: a swapchain for each eye, wrapped as textures.
//!
//! One single-layer swapchain per eye instead of one with two layers: what draws into layers is not right on every driver
//! (see the decision on two passes).

use ash::vk::{self, Handle};
use openxr as xr;
use wgpu::hal;

use super::HeadsetError;
use super::runtime::Runtime;
use crate::Gpu;
use crate::passes::lit::COLOR_FORMAT;

/// One eye's swapchain. The textures go before it, because they are views into its images.
pub(super) struct Eye {
    textures: Vec<wgpu::Texture>,
    swapchain: xr::Swapchain<xr::Vulkan>,
    acquired: Option<usize>,
}

impl Eye {
    /// Makes a swapchain of `size` pixels.
    pub fn new(
        runtime: &Runtime,
        session: &xr::Session<xr::Vulkan>,
        gpu: &Gpu,
        size: [u32; 2],
    ) -> Result<Self, HeadsetError> {
        let format = vk::Format::R8G8B8A8_SRGB.as_raw() as u32;
        if !session.enumerate_swapchain_formats()?.contains(&format) {
            return Err(HeadsetError::Lacks {
                runtime: runtime.headset.runtime.clone(),
                what: "images of the format R8G8B8A8_SRGB",
            });
        }
        let swapchain = session.create_swapchain(&xr::SwapchainCreateInfo {
            create_flags: xr::SwapchainCreateFlags::EMPTY,
            usage_flags: xr::SwapchainUsageFlags::COLOR_ATTACHMENT
                | xr::SwapchainUsageFlags::TRANSFER_SRC,
            format,
            sample_count: 1,
            width: size[0],
            height: size[1],
            face_count: 1,
            array_size: 1,
            mip_count: 1,
        })?;
        let images = swapchain.enumerate_images()?;
        let textures = images
            .into_iter()
            .map(|image| wrap(gpu, image, size))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            textures,
            swapchain,
            acquired: None,
        })
    }

    /// Takes the image to draw into next; waits until the compositor has done with it.
    pub fn acquire(&mut self) -> Result<(), HeadsetError> {
        self.acquired = Some(self.swapchain.acquire_image()? as usize);
        Ok(self.swapchain.wait_image(xr::Duration::INFINITE)?)
    }

    /// The image that is being drawn into.
    pub fn current(&self) -> Option<&wgpu::Texture> {
        self.acquired.map(|index| &self.textures[index])
    }

    /// Gives the image to the compositor; its drawing must have been submitted.
    pub fn release(&mut self) -> Result<(), HeadsetError> {
        self.acquired = None;
        Ok(self.swapchain.release_image()?)
    }

    /// What the compositor shows of it: the whole image.
    pub fn sub_image(&self) -> xr::SwapchainSubImage<'_, xr::Vulkan> {
        let [width, height] = self.size().map(|side| side as i32);
        xr::SwapchainSubImage::new()
            .swapchain(&self.swapchain)
            .image_array_index(0)
            .image_rect(xr::Rect2Di {
                offset: xr::Offset2Di { x: 0, y: 0 },
                extent: xr::Extent2Di { width, height },
            })
    }

    /// Width and height [pixels].
    pub fn size(&self) -> [u32; 2] {
        let texture = &self.textures[0];
        [texture.width(), texture.height()]
    }
}

/// A swapchain's image as a texture that wgpu draws into and never frees.
#[expect(unsafe_code, reason = "images of the runtime become textures of wgpu")]
fn wrap(gpu: &Gpu, image: u64, size: [u32; 2]) -> Result<wgpu::Texture, HeadsetError> {
    let outer = wgpu::TextureDescriptor {
        label: Some("headset eye"),
        size: wgpu::Extent3d {
            width: size[0],
            height: size[1],
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: COLOR_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    };
    // SAFETY: the guard is dropped before the device is.
    let device = unsafe { gpu.device.as_hal::<hal::api::Vulkan>() }
        .ok_or_else(|| HeadsetError::Graphics("its device is not Vulkan's".to_owned()))?;
    let inner = hal::TextureDescriptor {
        label: outer.label,
        size: outer.size,
        mip_level_count: outer.mip_level_count,
        sample_count: outer.sample_count,
        dimension: outer.dimension,
        format: outer.format,
        usage: wgpu::TextureUses::COLOR_TARGET | wgpu::TextureUses::COPY_SRC,
        memory_flags: hal::MemoryFlags::empty(),
        view_formats: Vec::new(),
    };
    // SAFETY: the image is the swapchain's, made with this size, format and use. The callback says that it is not wgpu's:
    // without one the image would be freed a second time.
    let texture = unsafe {
        device.texture_from_raw(
            vk::Image::from_raw(image),
            &inner,
            Some(Box::new(|| {})),
            hal::vulkan::TextureMemory::External,
        )
    };
    // SAFETY: one descriptor is made from the other, and a swapchain's image is handed out as a colour target.
    Ok(unsafe {
        gpu.device.create_texture_from_hal::<hal::api::Vulkan>(
            texture,
            &outer,
            wgpu::TextureUses::COLOR_TARGET,
        )
    })
}
