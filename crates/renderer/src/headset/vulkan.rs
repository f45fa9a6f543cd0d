//! Vulkan as the runtime wants it, with wgpu on top.
//!
//! The runtime makes instance and device itself, from what wgpu would have asked for, so that the images of its swapchains
//! belong to the device that draws.

use std::ffi::{CStr, c_void};

use ash::vk::{self, Handle};
use openxr as xr;
use wgpu::hal;

use super::HeadsetError;
use super::runtime::Runtime;
use crate::Gpu;

/// Version that is asked for where the runtime wants none that is newer: what wgpu itself asks for.
const VERSION: u32 = vk::API_VERSION_1_3;

/// The device that draws for the headset, and the handles that the runtime's session is bound to.
pub(super) struct Vulkan {
    pub gpu: Gpu,
    pub binding: xr::vulkan::SessionCreateInfo,
}

fn refused(what: &str, error: impl std::fmt::Display) -> HeadsetError {
    HeadsetError::Graphics(format!("{what}: {error}"))
}

/// Lets the runtime make a Vulkan device, and wraps it.
#[expect(unsafe_code, reason = "handles of Vulkan go from the runtime to wgpu")]
pub(super) fn open(runtime: &Runtime) -> Result<Vulkan, HeadsetError> {
    let (xr_instance, system) = (&runtime.instance, runtime.system);
    // The specification asks for this call before any device is made.
    let version = version(&xr_instance.graphics_requirements::<xr::Vulkan>(system)?);
    // SAFETY: the loader has the standard name; what it is asked for below are the calls of Vulkan 1.0.
    let entry =
        unsafe { ash::Entry::load() }.map_err(|error| refused("no Vulkan loader", error))?;
    // SAFETY: both are the same function of Vulkan's loader, declared by two crates.
    let get_address: xr::sys::platform::VkGetInstanceProcAddr =
        unsafe { std::mem::transmute(entry.static_fn().get_instance_proc_addr) };
    let flags = wgpu::InstanceFlags::empty();
    let extensions = hal::vulkan::Instance::desired_extensions(&entry, version, flags)
        .map_err(|error| refused("Vulkan's extensions", error))?;
    let names = pointers(&extensions);
    let application = vk::ApplicationInfo::default()
        .application_name(c"bowling")
        .api_version(version);
    let create = vk::InstanceCreateInfo::default()
        .application_info(&application)
        .enabled_extension_names(&names);
    // SAFETY: the create info and all that it points to outlive the call.
    let raw_instance =
        unsafe { xr_instance.create_vulkan_instance(system, get_address, pointer(&create)) }?
            .map_err(|code| refused("no Vulkan instance", vk::Result::from_raw(code)))?;
    // SAFETY: the runtime has just made this instance with the loader's functions.
    let instance = unsafe {
        let handle = vk::Instance::from_raw(raw_instance as usize as u64);
        ash::Instance::load(entry.static_fn(), handle)
    };
    // SAFETY: the instance lives.
    let raw_physical = unsafe { xr_instance.vulkan_graphics_device(system, raw_instance) }?;
    let physical = vk::PhysicalDevice::from_raw(raw_physical as usize as u64);

    // SAFETY: instance, version and extensions are those that it was made with; with no callback wgpu destroys it, last of all.
    let hal_instance = unsafe {
        hal::vulkan::Instance::from_raw(
            entry.clone(),
            instance.clone(),
            version,
            0,
            None,
            extensions,
            flags,
            wgpu::MemoryBudgetThresholds::default(),
            false,
            None,
        )
    }
    .map_err(|error| refused("Vulkan's instance", error))?;
    let exposed = hal_instance
        .expose_adapter(physical)
        .ok_or_else(|| HeadsetError::Graphics("wgpu cannot use it".to_owned()))?;
    let features = wgpu::Features::empty();
    let limits =
        wgpu::Limits::downlevel_defaults().using_resolution(exposed.capabilities.limits.clone());
    let extensions = exposed.adapter.required_device_extensions(features);
    let names = pointers(&extensions);
    // SAFETY: the physical device belongs to the living instance.
    let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
    let family = families
        .iter()
        .position(|family| family.queue_flags.contains(vk::QueueFlags::GRAPHICS))
        .ok_or_else(|| HeadsetError::Graphics("it has no queue for graphics".to_owned()))?
        as u32;
    let queue = [vk::DeviceQueueCreateInfo::default()
        .queue_family_index(family)
        .queue_priorities(&[1.0])];
    let mut physical_features = exposed
        .adapter
        .physical_device_features(&extensions, features);
    let create = physical_features.add_to_device_create(
        vk::DeviceCreateInfo::default()
            .queue_create_infos(&queue)
            .enabled_extension_names(&names),
    );
    // SAFETY: as for the instance.
    let raw_device = unsafe {
        xr_instance.create_vulkan_device(system, get_address, raw_physical, pointer(&create))
    }?
    .map_err(|code| refused("no Vulkan device", vk::Result::from_raw(code)))?;
    // SAFETY: the runtime has just made this device from the living instance.
    let device = unsafe {
        let handle = vk::Device::from_raw(raw_device as usize as u64);
        ash::Device::load(instance.fp_v1_0(), handle)
    };
    // SAFETY: the device was made with these extensions, features and queue; with no callback wgpu destroys it.
    let open = unsafe {
        let hints = wgpu::MemoryHints::Performance;
        exposed.adapter.device_from_raw(
            device,
            None,
            &extensions,
            features,
            &limits,
            &hints,
            family,
            0,
        )
    }
    .map_err(|error| refused("Vulkan's device", error))?;
    Ok(Vulkan {
        gpu: wrap(hal_instance, exposed, open, limits)?,
        binding: xr::vulkan::SessionCreateInfo {
            instance: raw_instance,
            physical_device: raw_physical,
            device: raw_device,
            queue_family_index: family,
            queue_index: 0,
        },
    })
}

/// The version to ask for. The newest that a runtime names is the newest that it was tried with: others may work, and what
/// wgpu asks for does; below the oldest that it names nothing does.
fn version(range: &xr::vulkan::Requirements) -> u32 {
    let least = range.min_api_version_supported;
    let least = vk::make_api_version(0, least.major().into(), least.minor().into(), 0);
    VERSION.max(least)
}

#[expect(unsafe_code, reason = "wgpu takes over what was opened below it")]
fn wrap(
    instance: hal::vulkan::Instance,
    exposed: hal::ExposedAdapter<hal::api::Vulkan>,
    open: hal::OpenDevice<hal::api::Vulkan>,
    limits: wgpu::Limits,
) -> Result<Gpu, HeadsetError> {
    let descriptor = wgpu::DeviceDescriptor {
        label: Some("headset"),
        required_limits: limits,
        ..Default::default()
    };
    // SAFETY: instance, adapter and device belong together, and the device was opened with this descriptor's features.
    let (instance, adapter, (device, queue)) = unsafe {
        let instance = wgpu::Instance::from_hal::<hal::api::Vulkan>(instance);
        let adapter = instance.create_adapter_from_hal::<hal::api::Vulkan>(exposed);
        let opened = adapter
            .create_device_from_hal::<hal::api::Vulkan>(open, &descriptor)
            .map_err(|error| refused("wgpu's device", error))?;
        (instance, adapter, opened)
    };
    Ok(Gpu::from_parts(instance, adapter, device, queue))
}

fn pointers(names: &[&'static CStr]) -> Vec<*const std::ffi::c_char> {
    names.iter().map(|name| name.as_ptr()).collect()
}

fn pointer<T>(value: &T) -> *const c_void {
    std::ptr::from_ref(value).cast()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn version_is_never_below_what_the_runtime_needs() {
        let asked = |least, most| {
            version(&xr::vulkan::Requirements {
                min_api_version_supported: least,
                max_api_version_supported: most,
            })
        };
        let of = |minor| xr::Version::new(1, minor, 0);
        assert_eq!(asked(of(0), of(0)), vk::API_VERSION_1_3);
        assert_eq!(asked(of(1), of(3)), vk::API_VERSION_1_3);
        assert_eq!(asked(of(4), of(4)), vk::make_api_version(0, 1, 4, 0));
    }
}
