//! The graphics device, and which interface it is reached through.

use std::fmt;
use std::sync::Arc;

use winit::window::Window;

use crate::RenderError;

/// The interface through which the graphics device is reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BackendChoice {
    /// The system's first choice (Vulkan, Metal or Direct3D 12), then OpenGL.
    #[default]
    Auto,
    /// Vulkan and nothing else.
    Vulkan,
    /// OpenGL and nothing else; over EGL without a surface where there is no window.
    Gl,
    /// Nothing is drawn; shaders and bindings are still checked. For tests.
    Noop,
}

impl BackendChoice {
    /// The backends to try, in order.
    fn attempts(self) -> &'static [wgpu::Backends] {
        const NATIVE: wgpu::Backends = wgpu::Backends::VULKAN
            .union(wgpu::Backends::METAL)
            .union(wgpu::Backends::DX12);
        match self {
            Self::Auto => &[NATIVE, wgpu::Backends::GL],
            Self::Vulkan => &[wgpu::Backends::VULKAN],
            Self::Gl => &[wgpu::Backends::GL],
            Self::Noop => &[wgpu::Backends::NOOP],
        }
    }

    fn no_driver(self) -> RenderError {
        let (tried, packages) = match self {
            Self::Auto => (
                "Vulkan or OpenGL",
                "mesa-vulkan-drivers, or libgl1-mesa-dri and libegl1",
            ),
            Self::Vulkan => ("Vulkan", "mesa-vulkan-drivers and libvulkan1"),
            Self::Gl => ("OpenGL", "libgl1-mesa-dri and libegl1"),
            Self::Noop => ("tests", "nothing: this build lacks the test backend"),
        };
        RenderError::NoDriver { tried, packages }
    }
}

/// What a device must have that tells how long it drew.
pub(crate) const TIMESTAMPS: wgpu::Features =
    wgpu::Features::TIMESTAMP_QUERY.union(wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS);

/// A graphics device with the names that a log needs to tell one driver from another.
#[derive(Clone, Debug)]
pub struct Gpu {
    pub(crate) instance: wgpu::Instance,
    pub(crate) adapter: wgpu::Adapter,
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    info: wgpu::AdapterInfo,
}

impl Gpu {
    /// Opens a device for drawing into images; no display is needed.
    ///
    /// # Errors
    /// One sentence that names the packages to install when there is no driver.
    pub fn new(choice: BackendChoice) -> Result<Self, RenderError> {
        Self::open(choice, None).map(|(gpu, _)| gpu)
    }

    /// Tries the backends in order; with a window, only a device that can draw to it counts.
    pub(crate) fn open(
        choice: BackendChoice,
        window: Option<&Arc<Window>>,
    ) -> Result<(Self, Option<wgpu::Surface<'static>>), RenderError> {
        for &backends in choice.attempts() {
            if let Some((instance, adapter, surface)) = Self::attempt(backends, window) {
                return Ok((Self::on(instance, adapter)?, surface));
            }
        }
        Err(choice.no_driver())
    }

    /// The first device of these backends; what the others say is about libraries, and the packages are the remedy.
    fn attempt(
        backends: wgpu::Backends,
        window: Option<&Arc<Window>>,
    ) -> Option<(
        wgpu::Instance,
        wgpu::Adapter,
        Option<wgpu::Surface<'static>>,
    )> {
        let instance = wgpu::Instance::new(instance_descriptor(backends, window));
        let surface = window
            .map(|window| instance.create_surface(window.clone()))
            .transpose()
            .ok()?;
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: surface.as_ref(),
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options)).ok()?;
        Some((instance, adapter, surface))
    }

    fn on(instance: wgpu::Instance, adapter: wgpu::Adapter) -> Result<Self, RenderError> {
        let info = adapter.get_info();
        // What OpenGL ES 3.0 class devices offer is enough for every pass; only sizes follow the device.
        let limits = wgpu::Limits::downlevel_defaults().using_resolution(adapter.limits());
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("renderer"),
            required_limits: limits,
            // For benchmarks; no picture needs them.
            required_features: adapter.features() & TIMESTAMPS,
            ..Default::default()
        };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&descriptor)).map_err(|error| {
                RenderError::Device {
                    adapter: info.name.clone(),
                    reason: one_line(&error.to_string()),
                }
            })?;
        Ok(Self::from_parts(instance, adapter, device, queue))
    }

    /// A device that something else has opened, a headset's runtime for example.
    pub(crate) fn from_parts(
        instance: wgpu::Instance,
        adapter: wgpu::Adapter,
        device: wgpu::Device,
        queue: wgpu::Queue,
    ) -> Self {
        let info = adapter.get_info();
        Self {
            instance,
            adapter,
            device,
            queue,
            info,
        }
    }

    /// The device's own name, for example `llvmpipe (LLVM 15.0.6, 256 bits)`.
    pub fn name(&self) -> &str {
        &self.info.name
    }

    /// The driver's name and version, as the driver states them.
    pub fn driver(&self) -> String {
        format!("{} {}", self.info.driver, self.info.driver_info)
            .trim()
            .to_owned()
    }

    /// The interface in use: `vulkan`, `gl`, `metal`, `dx12` or `noop`.
    pub fn backend(&self) -> &'static str {
        self.info.backend.to_str()
    }

    /// Whether the processor draws, because no graphics hardware was found.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu || self.info.name.contains("llvmpipe")
    }

    pub(crate) fn max_side(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }

    /// Checks an image size against the device.
    pub(crate) fn check_size(&self, width: u32, height: u32) -> Result<(), RenderError> {
        let most = self.max_side();
        if width == 0 || height == 0 || width > most || height > most {
            return Err(RenderError::Unsupported(format!(
                "an image of {width} x {height} pixels cannot be drawn: each side must be 1 to {most}"
            )));
        }
        Ok(())
    }
}

impl fmt::Display for Gpu {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, driver, backend) = (self.name(), self.driver(), self.backend());
        write!(f, "{name} through {backend}, driver {driver}")?;
        if self.is_software() {
            f.write_str(" (software: the processor draws)")?;
        }
        Ok(())
    }
}

fn instance_descriptor(
    backends: wgpu::Backends,
    window: Option<&Arc<Window>>,
) -> wgpu::InstanceDescriptor {
    let mut descriptor = match window {
        Some(window) => wgpu::InstanceDescriptor::new_with_display_handle(Box::new(window.clone())),
        None => wgpu::InstanceDescriptor::new_without_display_handle(),
    };
    descriptor.backends = backends;
    descriptor.backend_options.noop.enable = backends.contains(wgpu::Backends::NOOP);
    descriptor
}

/// Driver messages come in several lines; an error here is one sentence.
fn one_line(message: &str) -> String {
    message
        .split('\n')
        .map(str::trim)
        .filter(|line| !line.is_empty())
        .collect::<Vec<_>>()
        .join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_driver_names_the_package() {
        let text = BackendChoice::Vulkan.no_driver().to_string();
        assert!(text.contains("mesa-vulkan-drivers"), "{text}");
        let text = BackendChoice::Gl.no_driver().to_string();
        assert!(text.contains("libegl1"), "{text}");
        assert!(!text.contains('\n'), "{text}");
    }

    #[test]
    fn noop_device_opens_and_is_named() {
        let gpu = Gpu::new(BackendChoice::Noop).expect("the test backend needs no driver");
        assert_eq!(gpu.backend(), "noop");
        assert!(gpu.check_size(0, 10).is_err());
        assert!(gpu.check_size(10, 10).is_ok());
    }

    #[test]
    fn one_line_joins_what_a_driver_wrote_in_several() {
        assert_eq!(one_line("a:\n  b\n\n c "), "a:, b, c");
    }
}
