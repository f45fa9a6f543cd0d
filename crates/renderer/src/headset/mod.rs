//! Headsets. Today: whether one is there, and if not, what is missing.

mod openxr;

pub use self::openxr::probe;

/// A headset that an OpenXR runtime offers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Headset {
    /// The runtime's name and version.
    pub runtime: String,
    /// The system's own name.
    pub system: String,
    /// Pixels that the runtime recommends per eye, width and height.
    pub eye_size: [u32; 2],
}

/// Why no headset can be used, each in one sentence that says what to do.
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
    /// Anything else, as the runtime names it.
    #[error("the OpenXR runtime reported {0} while it was asked for a headset")]
    Other(String),
}
