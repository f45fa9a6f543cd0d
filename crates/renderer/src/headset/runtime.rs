//! The OpenXR instance, and the headset that its runtime has.

use openxr as xr;

use super::profiles::PROFILES;
use super::{Headset, HeadsetError};

/// Two eyes, which is what is drawn for.
pub(super) const STEREO: xr::ViewConfigurationType = xr::ViewConfigurationType::PRIMARY_STEREO;

/// An instance and its headset.
pub(super) struct Runtime {
    pub instance: xr::Instance,
    pub system: xr::SystemId,
    /// What was enabled, which is what was offered of what can be used.
    pub enabled: xr::ExtensionSet,
    pub headset: Headset,
}

/// A headset that was found, with the connection to its runtime.
pub struct Found(pub(super) Runtime);

impl Found {
    /// Asks the OpenXR runtime for a headset with two eyes that Vulkan can draw for. A runtime that hangs does so here.
    ///
    /// # Errors
    /// One sentence: no loader, no runtime, a runtime without its service, no headset connected.
    pub fn look() -> Result<Self, HeadsetError> {
        Runtime::find().map(Self)
    }

    /// What was found.
    pub fn headset(&self) -> &Headset {
        &self.0.headset
    }
}

impl Runtime {
    pub fn find() -> Result<Self, HeadsetError> {
        let entry = load()?;
        let offered = entry
            .enumerate_extensions()
            .map_err(HeadsetError::at_start)?;
        let enabled = usable(&offered);
        let application = xr::ApplicationInfo {
            application_name: "bowling",
            application_version: 1,
            ..Default::default()
        };
        let instance = entry
            .create_instance(&application, &enabled, &[], &())
            .map_err(HeadsetError::at_start)?;
        let properties = instance.properties()?;
        let runtime = format!("{} {}", properties.runtime_name, properties.runtime_version);
        let lacks = |what| HeadsetError::Lacks {
            runtime: runtime.clone(),
            what,
        };
        if !enabled.khr_vulkan_enable2 {
            return Err(lacks("the extension XR_KHR_vulkan_enable2"));
        }
        let system = instance
            .system(xr::FormFactor::HEAD_MOUNTED_DISPLAY)
            .map_err(|error| HeadsetError::at_system(error, &runtime))?;
        let eyes = instance
            .enumerate_view_configuration_views(system, STEREO)
            .map_err(|_| lacks("a view for each of two eyes"))?;
        let [eye, _] = eyes.as_slice() else {
            return Err(lacks("a view for each of two eyes"));
        };
        let eye_size = [
            eye.recommended_image_rect_width,
            eye.recommended_image_rect_height,
        ];
        let properties = instance.system_properties(system)?;
        Ok(Self {
            headset: Headset {
                system: properties.system_name,
                vendor_id: properties.vendor_id,
                runtime,
                eye_size,
            },
            instance,
            system,
            enabled,
        })
    }
}

impl Runtime {
    /// Whether an extension of a controller's profile was enabled.
    pub fn has_profile(&self, extension: &str) -> bool {
        self.enabled.other.contains(&ended(extension))
    }

    /// The names of what was enabled.
    pub fn extensions(&self) -> Vec<String> {
        let names = self.enabled.names();
        let text = |name: &[u8]| {
            let name = name.strip_suffix(b"\0").unwrap_or(name);
            String::from_utf8_lossy(name).into_owned()
        };
        names.iter().map(|name| text(name)).collect()
    }

    /// The runtime's clock; `None` where it cannot be read.
    pub fn now(&self) -> Option<xr::Time> {
        #[cfg(unix)]
        let is_offered = self.enabled.khr_convert_timespec_time;
        #[cfg(windows)]
        let is_offered = self.enabled.khr_win32_convert_performance_counter_time;
        is_offered.then(|| self.instance.now().ok()).flatten()
    }
}

/// A name as OpenXR lists it, with its end.
fn ended(name: &str) -> Vec<u8> {
    [name.as_bytes(), b"\0"].concat()
}

/// Of what is offered, what the program has a use for.
fn usable(offered: &xr::ExtensionSet) -> xr::ExtensionSet {
    let mut wanted = xr::ExtensionSet::default();
    // Asked for only where it is offered, so that a lack of it is told from a lack of a runtime.
    wanted.khr_vulkan_enable2 = offered.khr_vulkan_enable2;
    #[cfg(unix)]
    {
        wanted.khr_convert_timespec_time = offered.khr_convert_timespec_time;
    }
    #[cfg(windows)]
    {
        wanted.khr_win32_convert_performance_counter_time =
            offered.khr_win32_convert_performance_counter_time;
    }
    wanted.khr_composition_layer_depth = offered.khr_composition_layer_depth;
    wanted.khr_visibility_mask = offered.khr_visibility_mask;
    wanted.ext_hand_tracking = offered.ext_hand_tracking;
    wanted.ext_local_floor = offered.ext_local_floor;
    wanted.ext_user_presence = offered.ext_user_presence;
    wanted.fb_display_refresh_rate = offered.fb_display_refresh_rate;
    let names = offered.names();
    let profiles = PROFILES.iter().filter_map(|profile| profile.extension);
    for extension in profiles {
        let name = ended(extension);
        // By name: their functions are none, so the typed flags would add nothing but a line each.
        if names.contains(&name.as_slice()) && !wanted.other.contains(&name) {
            wanted.other.push(name);
        }
    }
    wanted
}

#[expect(unsafe_code, reason = "the loader is a foreign library")]
fn load() -> Result<xr::Entry, HeadsetError> {
    // SAFETY: the library has the standard loader's name, so it conforms to OpenXR unless the system is broken.
    let entry = unsafe { xr::Entry::load(&()) };
    entry.map_err(|_| HeadsetError::NoLoader)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn look_answers_without_a_panic() {
        // What it answers depends on the machine; that it answers in a sentence does not.
        match Found::look() {
            Ok(found) => assert!(!found.headset().system.is_empty()),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
}
