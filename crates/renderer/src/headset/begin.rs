//! What is decided once when a session begins.

use openxr as xr;

use super::note::Note;
use super::runtime::Runtime;
use super::{HeadsetError, HeadsetSettings};

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

/// Asks for a rate: the wanted one, or the highest, and says what the display has, or why it cannot be asked. A runtime that refuses
/// its own offer shows pictures all the same.
pub(super) fn choose_rate(
    session: &xr::Session<xr::Vulkan>,
    settings: HeadsetSettings,
) -> Result<Note, HeadsetError> {
    let Ok(offered) = session.enumerate_display_refresh_rates() else {
        return Ok(Note::RateRefused("its rates are not told".to_owned()));
    };
    let rate = match settings.refresh_rate_hz {
        Some(wanted) => match offered.iter().find(|rate| (*rate - wanted).abs() < 0.5) {
            Some(rate) => *rate,
            None => return Err(HeadsetError::no_such_rate(wanted, &offered)),
        },
        None => highest_rate(&offered, settings.highest_rate_hz),
    };
    if rate > 0.0
        && let Err(answer) = session.request_display_refresh_rate(rate)
    {
        return Ok(Note::RateRefused(format!("{rate} Hz: {answer:?}")));
    }
    Ok(match session.get_display_refresh_rate() {
        Ok(rate) => Note::RefreshRate(rate),
        Err(answer) => Note::RateRefused(format!("{answer:?}")),
    })
}

/// The highest of the offered rates that is not above a limit; the lowest, where all are; 0 where none is offered [Hz].
fn highest_rate(offered: &[f32], limit: Option<f32>) -> f32 {
    let below = lower_rate(offered, limit.map_or(f32::INFINITY, |limit| limit + 1.0));
    let lowest = offered.iter().copied().min_by(f32::total_cmp);
    below.or(lowest).unwrap_or(0.0)
}

/// The highest of the offered rates that is below another [Hz].
pub(super) fn lower_rate(offered: &[f32], than: f32) -> Option<f32> {
    let lower = offered.iter().copied().filter(|rate| *rate < than - 0.5);
    lower.max_by(f32::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_next_lower_rate_is_the_highest_below() {
        let offered = [72.0, 120.0, 80.0, 90.0];
        assert_eq!(lower_rate(&offered, 120.0), Some(90.0));
        assert_eq!(
            lower_rate(&offered, 89.9),
            Some(80.0),
            "90 Hz by another name"
        );
        assert_eq!(lower_rate(&offered, 72.0), None);
        assert_eq!(lower_rate(&[], 90.0), None);
    }

    #[test]
    fn the_highest_rate_is_taken_up_to_a_limit() {
        let offered = [72.0, 120.0, 80.0, 90.0];
        assert_eq!(highest_rate(&offered, None), 120.0);
        assert_eq!(highest_rate(&offered, Some(90.0)), 90.0);
        assert_eq!(highest_rate(&offered, Some(60.0)), 72.0);
        assert_eq!(highest_rate(&[], None), 0.0);
    }
}
