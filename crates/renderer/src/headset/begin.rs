//! What is decided once when a session begins.

use openxr as xr;

use super::HeadsetError;
use super::runtime::Runtime;

/// Makes the session, what waits for its frames, and what takes them.
#[expect(unsafe_code, reason = "the session is bound to handles of Vulkan")]
pub(super) fn create(
    runtime: &Runtime,
    binding: &xr::vulkan::SessionCreateInfo,
) -> Result<
    (
        xr::Session<xr::Vulkan>,
        xr::FrameWaiter,
        xr::FrameStream<xr::Vulkan>,
    ),
    HeadsetError,
> {
    // SAFETY: the handles are those that this runtime made for this system, and its owner drops the session first.
    Ok(unsafe {
        runtime
            .instance
            .create_session::<xr::Vulkan>(runtime.system, binding)
    }?)
}

/// The space whose origin is on the floor: the recentred one where there is one.
pub(super) fn floor(
    runtime: &Runtime,
    session: &xr::Session<xr::Vulkan>,
) -> Result<xr::ReferenceSpaceType, HeadsetError> {
    let offered = session.enumerate_reference_spaces()?;
    let local_floor = xr::ReferenceSpaceType::LOCAL_FLOOR_EXT;
    if runtime.enabled.ext_local_floor && offered.contains(&local_floor) {
        Ok(local_floor)
    } else if offered.contains(&xr::ReferenceSpaceType::STAGE) {
        Ok(xr::ReferenceSpaceType::STAGE)
    } else {
        Err(HeadsetError::Lacks {
            runtime: runtime.headset.runtime.clone(),
            what: "a space with its origin on the floor",
        })
    }
}

/// Asks for a rate: the wanted one, or the highest. Returns the rate that the display has.
pub(super) fn choose_rate(
    session: &xr::Session<xr::Vulkan>,
    wanted: Option<f32>,
) -> Result<f32, HeadsetError> {
    let offered = session.enumerate_display_refresh_rates()?;
    let rate = match wanted {
        Some(wanted) => match offered.iter().find(|rate| (*rate - wanted).abs() < 0.5) {
            Some(rate) => *rate,
            None => return Err(HeadsetError::no_such_rate(wanted, &offered)),
        },
        None => offered.iter().copied().fold(0.0, f32::max),
    };
    if rate > 0.0 {
        session.request_display_refresh_rate(rate)?;
    }
    Ok(session.get_display_refresh_rate()?)
}
