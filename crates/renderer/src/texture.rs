//! Pictures on surfaces: upload, smaller copies for the distance, and sampling.

use std::path::Path;

use image::RgbaImage;

use crate::{Gpu, RenderError};

/// Colours are stored as sRGB and read as linear.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Most samples along the longer axis of a pixel's footprint; the lane is seen at grazing angles.
const ANISOTROPY: u16 = 8;

/// An image with its smaller copies: whoever makes one elsewhere leaves nothing but the upload to the renderer.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Each half as large as the one before, down to one pixel.
    levels: Vec<RgbaImage>,
}

impl From<RgbaImage> for Picture {
    fn from(image: RgbaImage) -> Self {
        let (width, height) = image.dimensions();
        // An image without pixels has no smaller copies, and is refused by whoever is to take it.
        let copies = match width.min(height) {
            0 => 0,
            _ => width.max(height).ilog2(),
        };
        let mut levels = vec![image];
        for level in 0..copies as usize {
            levels.push(half(&levels[level]));
        }
        Self { levels }
    }
}

impl Picture {
    /// Width and height [pixels].
    pub fn size(&self) -> [u32; 2] {
        self.levels[0].dimensions().into()
    }
}

/// A texture on the device with the bindings that a pass reads it through.
#[derive(Debug)]
pub(crate) struct Texture {
    texture: wgpu::Texture,
    pub bind_group: wgpu::BindGroup,
}

impl Texture {
    pub fn new(
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        sampler: &wgpu::Sampler,
        picture: &Picture,
    ) -> Result<Self, RenderError> {
        let [width, height] = picture.size();
        let most = gpu.max_side();
        if width == 0 || height == 0 || width > most || height > most {
            return Err(RenderError::Texture(format!(
                "it has {width} x {height} pixels, each side must be 1 to {most}"
            )));
        }
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("picture"),
            size: extent(width, height),
            mip_level_count: picture.levels.len() as u32,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let texture = Self::bound(gpu, layout, sampler, texture);
        texture.write(gpu, picture);
        Ok(texture)
    }

    /// What another picture can be drawn on; black at first, and without smaller copies.
    pub fn canvas(
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        sampler: &wgpu::Sampler,
        size: [u32; 2],
    ) -> Self {
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT;
        let texture = single(&gpu.device, "canvas", size, 1, FORMAT, usage);
        Self::bound(gpu, layout, sampler, texture)
    }

    fn bound(
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        sampler: &wgpu::Sampler,
        texture: wgpu::Texture,
    ) -> Self {
        let view = texture.create_view(&Default::default());
        Self {
            bind_group: bind_group(&gpu.device, layout, &view, sampler),
            texture,
        }
    }

    /// The whole of a texture without smaller copies.
    pub fn view(&self) -> wgpu::TextureView {
        self.texture.create_view(&Default::default())
    }

    /// Replaces the picture by another of the same size; `false`, and nothing done, if the size differs.
    pub fn replace(&self, gpu: &Gpu, picture: &Picture) -> bool {
        let same = picture.size() == [self.texture.width(), self.texture.height()];
        if same {
            self.write(gpu, picture);
        }
        same
    }

    fn write(&self, gpu: &Gpu, picture: &Picture) {
        for (level, image) in picture.levels.iter().enumerate() {
            let (width, height) = image.dimensions();
            gpu.queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    texture: &self.texture,
                    mip_level: level as u32,
                    origin: wgpu::Origin3d::ZERO,
                    aspect: wgpu::TextureAspect::All,
                },
                image.as_raw(),
                wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(4 * width),
                    rows_per_image: None,
                },
                extent(width, height),
            );
        }
    }
}

/// A texture of one layer and one level, without contents.
pub(crate) fn single(
    device: &wgpu::Device,
    label: &str,
    size: [u32; 2],
    samples: u32,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: extent(size[0], size[1]),
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// A picture and its sampler, bound as [`bind_group_layout`] has them.
pub(crate) fn bind_group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    view: &wgpu::TextureView,
    sampler: &wgpu::Sampler,
) -> wgpu::BindGroup {
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("picture"),
        layout,
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(view),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::Sampler(sampler),
            },
        ],
    })
}

/// Bindings of one texture and its sampler.
pub(crate) fn bind_group_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("picture"),
        entries: &[
            wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: true },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            },
            wgpu::BindGroupLayoutEntry {
                binding: 1,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
                count: None,
            },
        ],
    })
}

/// Repeating, trilinear, anisotropic where a graphics card offers it.
///
/// Not on the processor: llvmpipe (Mesa 22.3) walks the whole footprint of a pixel texel by texel, and where a texture
/// wraps round a ball the footprint is the whole texture. Single pictures took seconds.
///
/// Without `smaller_copies` every distance shows the picture's own texels, which then sparkle.
pub(crate) fn sampler(gpu: &Gpu, smaller_copies: bool) -> wgpu::Sampler {
    let flags = gpu.adapter.get_downlevel_capabilities().flags;
    let offered = flags.contains(wgpu::DownlevelFlags::ANISOTROPIC_FILTERING) && !gpu.is_software();
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("picture"),
        address_mode_u: wgpu::AddressMode::Repeat,
        address_mode_v: wgpu::AddressMode::Repeat,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        anisotropy_clamp: if offered && smaller_copies {
            ANISOTROPY
        } else {
            1
        },
        lod_max_clamp: if smaller_copies { 32.0 } else { 0.0 },
        ..Default::default()
    })
}

/// Reads a PNG or JPEG file.
///
/// # Errors
/// One sentence with the file: missing, or not an image.
pub fn load_image(path: &Path) -> Result<RgbaImage, RenderError> {
    let fail = |reason: String| RenderError::TextureFile {
        path: path.to_owned(),
        reason,
    };
    let bytes = std::fs::read(path)
        .map_err(|error| fail(format!("the texture cannot be read: {error}")))?;
    image::load_from_memory(&bytes)
        .map(|image| image.to_rgba8())
        .map_err(|error| fail(format!("the texture is no usable image: {error}")))
}

fn half(image: &RgbaImage) -> RgbaImage {
    let (width, height) = image.dimensions();
    crate::relay(image, (width / 2).max(1), (height / 2).max(1))
}

fn extent(width: u32, height: u32) -> wgpu::Extent3d {
    wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pixels cannot tell on every driver: lavapipe's anisotropic filter averages a whole footprint even without.
    #[test]
    fn texture_has_smaller_copies_down_to_one_pixel() {
        let gpu = Gpu::new(crate::BackendChoice::Noop).expect("the test backend needs no driver");
        let (layout, sampler) = (bind_group_layout(&gpu.device), sampler(&gpu, true));
        for ((width, height), levels) in [((256, 100), 9), ((1, 1), 1), ((3, 5), 3)] {
            let picture = RgbaImage::new(width, height).into();
            let texture = Texture::new(&gpu, &layout, &sampler, &picture).expect("good");
            assert_eq!(texture.texture.mip_level_count(), levels);
        }
    }

    #[test]
    fn load_image_names_the_file() {
        let error = load_image(Path::new("no/such.png")).expect_err("there is none");
        assert!(error.to_string().starts_with("no/such.png: "), "{error}");
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("text.png");
        std::fs::write(&path, "not a picture").expect("the folder is writable");
        let text = load_image(&path).expect_err("no picture").to_string();
        assert!(
            text.contains("text.png: the texture is no usable image"),
            "{text}"
        );
    }
}
