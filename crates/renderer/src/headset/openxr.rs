//! The question to the OpenXR runtime.

use openxr as xr;

use super::{Headset, HeadsetError};

/// Asks the OpenXR runtime for a headset with two eyes that Vulkan can draw for.
///
/// # Errors
/// One sentence: no loader, no runtime, a runtime without its service, no headset connected.
pub fn probe() -> Result<Headset, HeadsetError> {
    let entry = load()?;
    let offered = entry.enumerate_extensions().map_err(at_start)?;
    let mut wanted = xr::ExtensionSet::default();
    // Asked for only where it is offered, so that a lack of it is told from a lack of a runtime.
    wanted.khr_vulkan_enable2 = offered.khr_vulkan_enable2;
    let application = xr::ApplicationInfo {
        application_name: "bowling",
        ..Default::default()
    };
    let instance = entry
        .create_instance(&application, &wanted, &[], &())
        .map_err(at_start)?;
    let properties = instance.properties().map_err(other)?;
    let runtime = format!("{} {}", properties.runtime_name, properties.runtime_version);
    let lacks = |what| HeadsetError::Lacks {
        runtime: runtime.clone(),
        what,
    };
    if !offered.khr_vulkan_enable2 {
        return Err(lacks("the extension XR_KHR_vulkan_enable2"));
    }
    let system = instance
        .system(xr::FormFactor::HEAD_MOUNTED_DISPLAY)
        .map_err(|error| at_system(error, &runtime))?;
    let eyes = instance
        .enumerate_view_configuration_views(system, xr::ViewConfigurationType::PRIMARY_STEREO)
        .map_err(|_| lacks("a view for each of two eyes"))?;
    let eye = eyes
        .first()
        .ok_or_else(|| lacks("a view for each of two eyes"))?;
    let eye_size = [
        eye.recommended_image_rect_width,
        eye.recommended_image_rect_height,
    ];
    let system = instance.system_properties(system).map_err(other)?;
    Ok(Headset {
        system: system.system_name,
        runtime,
        eye_size,
    })
}

#[expect(unsafe_code, reason = "the loader is a foreign library")]
fn load() -> Result<xr::Entry, HeadsetError> {
    // SAFETY: the library has the standard loader's name, so it conforms to OpenXR unless the system is broken.
    let entry = unsafe { xr::Entry::load(&()) };
    entry.map_err(|_| HeadsetError::NoLoader)
}

/// Errors before there is an instance: the loader and the runtime's service speak.
fn at_start(error: xr::sys::Result) -> HeadsetError {
    match error {
        xr::sys::Result::ERROR_RUNTIME_UNAVAILABLE | xr::sys::Result::ERROR_FILE_ACCESS_ERROR => {
            HeadsetError::NoRuntime
        }
        xr::sys::Result::ERROR_RUNTIME_FAILURE
        | xr::sys::Result::ERROR_INITIALIZATION_FAILED
        | xr::sys::Result::ERROR_INSTANCE_LOST => HeadsetError::NoService,
        error => other(error),
    }
}

fn at_system(error: xr::sys::Result, runtime: &str) -> HeadsetError {
    match error {
        xr::sys::Result::ERROR_FORM_FACTOR_UNAVAILABLE
        | xr::sys::Result::ERROR_FORM_FACTOR_UNSUPPORTED => {
            HeadsetError::NotConnected(runtime.to_owned())
        }
        error => other(error),
    }
}

fn other(error: xr::sys::Result) -> HeadsetError {
    HeadsetError::Other(format!("{error:?}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runtime_answers_become_the_four_sentences() {
        use xr::sys::Result as Answer;
        assert_eq!(
            at_start(Answer::ERROR_RUNTIME_UNAVAILABLE),
            HeadsetError::NoRuntime
        );
        assert_eq!(
            at_start(Answer::ERROR_RUNTIME_FAILURE),
            HeadsetError::NoService
        );
        assert_eq!(
            at_system(Answer::ERROR_FORM_FACTOR_UNAVAILABLE, "Monado"),
            HeadsetError::NotConnected("Monado".to_owned())
        );
        assert!(matches!(
            at_system(Answer::ERROR_INSTANCE_LOST, "Monado"),
            HeadsetError::Other(_)
        ));
    }

    #[test]
    fn every_sentence_is_one_line() {
        for error in [
            HeadsetError::NoLoader,
            HeadsetError::NoRuntime,
            HeadsetError::NoService,
            HeadsetError::NotConnected("Monado".to_owned()),
            HeadsetError::Other("ERROR_X".to_owned()),
        ] {
            let text = error.to_string();
            assert!(!text.contains('\n') && text.len() > 20, "{text}");
        }
    }

    #[test]
    fn probe_answers_without_a_panic() {
        // What it answers depends on the machine; that it answers in a sentence does not.
        match probe() {
            Ok(headset) => assert!(!headset.system.is_empty()),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
}
