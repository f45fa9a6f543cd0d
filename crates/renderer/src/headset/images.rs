//! The images that the runtime shows: swapchains, wrapped as textures.
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

/// What images hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kind {
    vulkan: vk::Format,
    wgpu: wgpu::TextureFormat,
    attached: xr::SwapchainUsageFlags,
    /// How the runtime hands images out, and expects them back.
    state: wgpu::TextureUses,
}

impl Kind {
    /// What an eye sees.
    pub const COLOR: Self = Self {
        vulkan: vk::Format::R8G8B8A8_SRGB,
        wgpu: COLOR_FORMAT,
        attached: xr::SwapchainUsageFlags::COLOR_ATTACHMENT,
        state: wgpu::TextureUses::COLOR_TARGET,
    };
    /// How far it is, most exact first. Between them lie formats with a stencil, which wgpu lays out as it likes.
    pub const DEPTHS: [Self; 2] = [
        Self::depth(vk::Format::D32_SFLOAT, wgpu::TextureFormat::Depth32Float),
        Self::depth(vk::Format::D16_UNORM, wgpu::TextureFormat::Depth16Unorm),
    ];

    const fn depth(vulkan: vk::Format, wgpu: wgpu::TextureFormat) -> Self {
        Self {
            vulkan,
            wgpu,
            attached: xr::SwapchainUsageFlags::DEPTH_STENCIL_ATTACHMENT,
            state: wgpu::TextureUses::DEPTH_STENCIL_WRITE,
        }
    }

    /// Whether the runtime makes such images.
    pub fn is_offered(self, session: &xr::Session<xr::Vulkan>) -> Result<bool, HeadsetError> {
        let format = self.vulkan.as_raw() as u32;
        Ok(session.enumerate_swapchain_formats()?.contains(&format))
    }
}

/// A swapchain. The textures go before it, because they are views into its images.
pub(super) struct Images {
    kind: Kind,
    textures: Vec<wgpu::Texture>,
    swapchain: xr::Swapchain<xr::Vulkan>,
    acquired: Option<usize>,
}

impl Images {
    /// Images for an eye's picture, of `size` pixels.
    pub fn color(
        runtime: &Runtime,
        session: &xr::Session<xr::Vulkan>,
        gpu: &Gpu,
        size: [u32; 2],
    ) -> Result<Self, HeadsetError> {
        if !Kind::COLOR.is_offered(session)? {
            return Err(HeadsetError::Lacks {
                runtime: runtime.headset.runtime.clone(),
                what: "images of the format R8G8B8A8_SRGB",
            });
        }
        Self::new(session, gpu, size, Kind::COLOR)
    }

    /// Images for an eye's depth; `None` where the runtime takes none, or none that can be written.
    pub fn depth(
        runtime: &Runtime,
        session: &xr::Session<xr::Vulkan>,
        gpu: &Gpu,
        size: [u32; 2],
    ) -> Result<Option<Self>, HeadsetError> {
        if !runtime.enabled.khr_composition_layer_depth {
            return Ok(None);
        }
        for kind in Kind::DEPTHS {
            if kind.is_offered(session)? {
                return Self::new(session, gpu, size, kind).map(Some);
            }
        }
        Ok(None)
    }

    fn new(
        session: &xr::Session<xr::Vulkan>,
        gpu: &Gpu,
        size: [u32; 2],
        kind: Kind,
    ) -> Result<Self, HeadsetError> {
        let swapchain = session.create_swapchain(&xr::SwapchainCreateInfo {
            create_flags: xr::SwapchainCreateFlags::EMPTY,
            usage_flags: kind.attached | xr::SwapchainUsageFlags::TRANSFER_SRC,
            format: kind.vulkan.as_raw() as u32,
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
            .map(|image| wrap(gpu, image, size, kind))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            kind,
            textures,
            swapchain,
            acquired: None,
        })
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.textures.len()
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

    /// What a copy of the image leaves to be done before it is released: the compositor expects it as it handed it out.
    pub fn back(&self) -> Option<wgpu::TextureTransition<&wgpu::Texture>> {
        self.current().map(|texture| wgpu::TextureTransition {
            texture,
            selector: None,
            state: self.kind.state,
        })
    }

    /// Gives the image to the compositor; its drawing must have been submitted.
    pub fn release(&mut self) -> Result<(), HeadsetError> {
        self.acquired = None;
        Ok(self.swapchain.release_image()?)
    }

    /// What the compositor takes of it: the whole image.
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
fn wrap(gpu: &Gpu, image: u64, size: [u32; 2], kind: Kind) -> Result<wgpu::Texture, HeadsetError> {
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
        format: kind.wgpu,
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
        usage: kind.state | wgpu::TextureUses::COPY_SRC,
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
    // SAFETY: one descriptor is made from the other, and a swapchain's image is handed out as what it is attached as.
    Ok(unsafe {
        gpu.device
            .create_texture_from_hal::<hal::api::Vulkan>(texture, &outer, kind.state)
    })
}
