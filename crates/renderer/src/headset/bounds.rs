//! Where the tracked space ends, as far as the runtime tells.

use openxr as xr;

use super::frame::Frame;
use super::session::HeadsetSession;
use super::{HeadsetError, TrackedPose, space};

/// A rectangle on the floor that is free of obstacles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Its middle in tracking space, sides along x and z.
    pub pose: TrackedPose,
    /// Width along x and depth along z [m].
    pub size_m: [f64; 2],
}

/// The space about whose origin the runtime tells the bounds, where it has one.
pub(super) fn stage(session: &xr::Session<xr::Vulkan>) -> Result<Option<xr::Space>, HeadsetError> {
    let stage = xr::ReferenceSpaceType::STAGE;
    if !session.enumerate_reference_spaces()?.contains(&stage) {
        return Ok(None);
    }
    Ok(Some(
        session.create_reference_space(stage, xr::Posef::IDENTITY)?,
    ))
}

impl HeadsetSession {
    /// Where the tracked space ends at a frame's time of display; `None` where the runtime does not tell.
    ///
    /// # Errors
    /// When the session is lost.
    pub fn bounds(&self, frame: &Frame) -> Result<Option<Bounds>, HeadsetError> {
        let Some((session, stage, base)) = self.stage() else {
            return Ok(None);
        };
        let Some(size) = session.reference_space_bounds_rect(xr::ReferenceSpaceType::STAGE)? else {
            return Ok(None);
        };
        let pose = space::locate(stage, base, frame.time)?;
        Ok(pose.map(|pose| Bounds {
            pose,
            size_m: [size.width.into(), size.height.into()],
        }))
    }
}
