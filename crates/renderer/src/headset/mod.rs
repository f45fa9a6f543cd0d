//! A headset through OpenXR: whether one is there, and a session that shows a [`crate::Scene`] in it.
//!
//! A [`HeadsetSession`] owns everything that the runtime gave: the instance, Vulkan through the runtime with wgpu on top, a
//! swapchain for each eye, the actions. Once a frame the caller asks it, in this order, to [`HeadsetSession::poll`] (what has
//! the runtime to say), [`HeadsetSession::wait`] (until the next frame may begin), [`HeadsetSession::read`] (head, hands and
//! buttons at the time of display) and [`HeadsetSession::show`] (locate the eyes as late as possible and draw).
//! Poses are in tracking space: metres, y up, -z forward, the floor at y = 0. Each optional extension is used only where the
//! runtime offers it.

mod actions;
mod begin;
mod bounds;
mod error;
mod eyes;
mod frame;
mod images;
mod joints;
mod mask;
mod note;
mod profiles;
mod runtime;
mod session;
mod space;
mod vulkan;

pub use self::actions::{Change, HandReading, Readings, Side};
pub use self::bounds::Bounds;
pub use self::error::HeadsetError;
pub use self::frame::Frame;
pub use self::joints::BareHand;
pub use self::note::{Focus, Note};
pub use self::runtime::Found;
pub use self::session::{HeadsetSession, HeadsetSettings, Seen, Shown};
pub use self::space::TrackedPose;

/// Whether a controller of the profile with this path has a button that pauses, on either hand.
pub fn has_menu_button(profile: &str) -> bool {
    profiles::has_menu(profile)
}

/// A headset that an OpenXR runtime offers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Headset {
    /// The runtime's name and version.
    pub runtime: String,
    /// The system's own name.
    pub system: String,
    /// Who made it: the number that its USB devices have.
    pub vendor_id: u32,
    /// Pixels that the runtime recommends per eye, width and height.
    pub eye_size: [u32; 2],
}
