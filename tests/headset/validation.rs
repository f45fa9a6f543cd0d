//! The validation layers of OpenXR and Vulkan: every program of these tests runs under both, and neither may say a word.

use std::ffi::{OsStr, OsString};
use std::path::PathBuf;

use tempfile::TempDir;

/// The name of OpenXR's layer.
pub const CORE_VALIDATION: &str = "XR_APILAYER_LUNARG_core_validation";

/// The layers of one program.
pub struct Layers {
    folder: TempDir,
}

impl Layers {
    /// Layers that have said nothing yet.
    pub fn new() -> Self {
        Self {
            folder: tempfile::tempdir().expect("a temporary folder"),
        }
    }

    /// What a program's environment needs for both to be loaded.
    pub fn environment(&self) -> [(&'static str, OsString); 4] {
        let text = |text: &str| OsStr::new(text).to_owned();
        [
            ("XR_ENABLE_API_LAYERS", text(CORE_VALIDATION)),
            ("XR_CORE_VALIDATION_EXPORT_TYPE", text("text")),
            ("XR_CORE_VALIDATION_FILE_NAME", self.log().into_os_string()),
            ("VK_INSTANCE_LAYERS", text("VK_LAYER_KHRONOS_validation")),
        ]
    }

    fn log(&self) -> PathBuf {
        self.folder.path().join("openxr.txt")
    }

    /// What they found wrong: OpenXR's in its file, but for its own beginning and end, Vulkan's among what the program said.
    pub fn complaints(&self, said: &str) -> Vec<String> {
        // A program that asked no runtime for anything leaves no file.
        let log = std::fs::read_to_string(self.log()).unwrap_or_default();
        let of_openxr = log
            .lines()
            .filter(|line| !line.trim().is_empty() && !line.contains("VALID_DEBUG"));
        let of_vulkan = said
            .lines()
            .filter(|line| line.contains("VUID") || line.contains("Validation Error"));
        of_openxr.chain(of_vulkan).map(str::to_owned).collect()
    }

    /// Whether OpenXR's was loaded: Vulkan's says nothing of itself.
    pub fn have_begun(&self) -> bool {
        let log = std::fs::read_to_string(self.log());
        log.is_ok_and(|log| log.contains("Core Validation Layer is initialized"))
    }
}

#[cfg(test)]
mod tests {
    use crate::inside::{is_inside, run_watched};
    use crate::machine::runtime;
    use crate::service::{Compositor, Service};

    /// The layers are really there: each names a mistake that is made on purpose.
    #[test]
    fn the_layers_catch_a_planted_mistake() {
        if is_inside() {
            plant_in_openxr();
            plant_in_vulkan();
            return;
        }
        let Some(runtime) = runtime() else { return };
        let service = Service::start(&runtime, Compositor::Null);
        let name = "validation::tests::the_layers_catch_a_planted_mistake";
        let (said, layers) = run_watched(&service, name, &[]);
        assert!(layers.have_begun(), "{said}");
        let complaints = layers.complaints(&said);
        for mistake in [
            "VUID-XrSystemGetInfo-formFactor",
            "VUID-VkBufferCreateInfo-size",
        ] {
            let is_named = complaints.iter().any(|line| line.contains(mistake));
            assert!(is_named, "{mistake} is not in {complaints:?}");
        }
    }

    #[expect(unsafe_code, reason = "the loader is a foreign library")]
    fn plant_in_openxr() {
        use openxr as xr;
        // SAFETY: the loader of the runner.
        let entry = unsafe { xr::Entry::load(&()) }.expect("a loader");
        let application = xr::ApplicationInfo {
            application_name: "mistaken",
            ..Default::default()
        };
        let instance = entry
            .create_instance(&application, &xr::ExtensionSet::default(), &[], &())
            .expect("an instance");
        // No such form factor.
        let _ = instance.system(xr::FormFactor::from_raw(999));
    }

    #[expect(unsafe_code, reason = "a wrong call is what the layer must see")]
    fn plant_in_vulkan() {
        use ash::vk;
        // SAFETY: the calls but the last are right, and nothing outlives what it came from.
        unsafe {
            let entry = ash::Entry::load().expect("a loader");
            let instance = entry
                .create_instance(&vk::InstanceCreateInfo::default(), None)
                .expect("an instance");
            let physical = instance.enumerate_physical_devices().expect("a device")[0];
            let queue = [vk::DeviceQueueCreateInfo::default().queue_priorities(&[1.0])];
            let create = vk::DeviceCreateInfo::default().queue_create_infos(&queue);
            let device = instance
                .create_device(physical, &create, None)
                .expect("a device");
            // A buffer of no bytes.
            let wrong = vk::BufferCreateInfo::default().usage(vk::BufferUsageFlags::TRANSFER_SRC);
            if let Ok(buffer) = device.create_buffer(&wrong, None) {
                device.destroy_buffer(buffer, None);
            }
            device.destroy_device(None);
            instance.destroy_instance(None);
        }
    }
}
