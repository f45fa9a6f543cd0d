//! What can go wrong with a headset, each in one sentence that says what to do.

use openxr::sys::Result as Answer;

/// Why no headset can be used, or can no longer be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HeadsetError {
    /// The OpenXR loader library is not installed.
    #[error("no OpenXR loader is installed: on Debian or Ubuntu, install libopenxr-loader1")]
    NoLoader,
    /// The loader found no active runtime.
    #[error(
        "no OpenXR runtime is active: start SteamVR, Monado or WiVRn once and make it the active runtime, or set XR_RUNTIME_JSON"
    )]
    NoRuntime,
    /// The runtime is installed, but what it talks to does not run.
    #[error(
        "the OpenXR runtime is installed but does not answer: start its service (SteamVR, or monado-service)"
    )]
    NoService,
    /// The runtime was asked and says nothing.
    #[error("the OpenXR runtime does not answer: end it and start it again")]
    Silent,
    /// The runtime runs and sees no headset.
    #[error("the OpenXR runtime {0} runs but sees no headset: connect one and switch it on")]
    NotConnected(String),
    /// The runtime cannot show two eyes with Vulkan.
    #[error("the OpenXR runtime {runtime} cannot be used: it lacks {what}")]
    Lacks {
        /// The runtime's name and version.
        runtime: String,
        /// What it does not offer.
        what: &'static str,
    },
    /// The display has no such refresh rate.
    #[error("the headset has no refresh rate of {wanted} Hz: it offers {offered}")]
    NoSuchRate {
        /// What was asked for [Hz].
        wanted: String,
        /// What it offers [Hz].
        offered: String,
    },
    /// Vulkan, as the runtime offers it, cannot be used.
    #[error("the headset's graphics device cannot be used: {0}")]
    Graphics(String),
    /// The runtime ended the session or the connection to it broke; a new session may be opened.
    #[error(
        "the OpenXR runtime ended the session ({0}): it was stopped, or the headset was unplugged"
    )]
    Lost(String),
    /// What is to be shown cannot be drawn.
    #[error("the headset's picture cannot be drawn: {0}")]
    Drawing(String),
    /// Anything else, as the runtime names it.
    #[error("the OpenXR runtime reported {0} while it was asked for a headset")]
    Other(String),
}

impl HeadsetError {
    pub(super) fn no_such_rate(wanted: f32, offered: &[f32]) -> Self {
        let rates: Vec<String> = offered.iter().map(f32::to_string).collect();
        Self::NoSuchRate {
            wanted: wanted.to_string(),
            offered: match rates.as_slice() {
                [] => "none to choose from, leave --refresh-rate out".to_owned(),
                rates => rates.join(", "),
            },
        }
    }

    /// Errors before there is an instance: the loader and the runtime's service speak.
    pub(super) fn at_start(error: Answer) -> Self {
        match error {
            Answer::ERROR_RUNTIME_UNAVAILABLE | Answer::ERROR_FILE_ACCESS_ERROR => Self::NoRuntime,
            Answer::ERROR_RUNTIME_FAILURE
            | Answer::ERROR_INITIALIZATION_FAILED
            | Answer::ERROR_INSTANCE_LOST => Self::NoService,
            error => Self::from(error),
        }
    }

    /// Errors of the question for a headset.
    pub(super) fn at_system(error: Answer, runtime: &str) -> Self {
        match error {
            Answer::ERROR_FORM_FACTOR_UNAVAILABLE | Answer::ERROR_FORM_FACTOR_UNSUPPORTED => {
                Self::NotConnected(runtime.to_owned())
            }
            error => Self::from(error),
        }
    }
}

impl From<crate::RenderError> for HeadsetError {
    fn from(error: crate::RenderError) -> Self {
        Self::Drawing(error.to_string())
    }
}

impl From<Answer> for HeadsetError {
    fn from(answer: Answer) -> Self {
        match answer {
            Answer::ERROR_INSTANCE_LOST
            | Answer::ERROR_SESSION_LOST
            | Answer::ERROR_RUNTIME_FAILURE => Self::Lost(format!("{answer:?}")),
            answer => Self::Other(format!("{answer:?}")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runtime_answers_become_the_four_sentences() {
        assert_eq!(
            HeadsetError::at_start(Answer::ERROR_RUNTIME_UNAVAILABLE),
            HeadsetError::NoRuntime
        );
        assert_eq!(
            HeadsetError::at_start(Answer::ERROR_RUNTIME_FAILURE),
            HeadsetError::NoService
        );
        assert_eq!(
            HeadsetError::at_system(Answer::ERROR_FORM_FACTOR_UNAVAILABLE, "Monado"),
            HeadsetError::NotConnected("Monado".to_owned())
        );
        let lost = HeadsetError::at_system(Answer::ERROR_INSTANCE_LOST, "Monado");
        assert!(matches!(lost, HeadsetError::Lost(_)), "{lost}");
        let other = HeadsetError::from(Answer::ERROR_PATH_UNSUPPORTED);
        assert!(!matches!(other, HeadsetError::Lost(_)), "{other}");
    }

    #[test]
    fn every_sentence_is_one_line() {
        for error in [
            HeadsetError::NoLoader,
            HeadsetError::NoRuntime,
            HeadsetError::NoService,
            HeadsetError::NotConnected("Monado".to_owned()),
            HeadsetError::Lost("ERROR_SESSION_LOST".to_owned()),
            HeadsetError::Other("ERROR_X".to_owned()),
        ] {
            let text = error.to_string();
            assert!(!text.contains('\n') && text.len() > 20, "{text}");
        }
    }
}
