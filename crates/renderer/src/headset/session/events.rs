//! What the runtime says between frames, and the session's states that follow from it.

use openxr as xr;

use super::super::HeadsetError;
use super::super::actions::Side;
use super::super::mask::Mask;
use super::super::note::{Focus, Note};
use super::super::profiles::BARE_HAND;
use super::super::runtime::STEREO;
use super::HeadsetSession;

impl HeadsetSession {
    /// Hears what the runtime has to say, and follows the session's states.
    ///
    /// # Errors
    /// [`HeadsetError::Lost`] when the session cannot go on.
    pub fn poll(&mut self) -> Result<Vec<Note>, HeadsetError> {
        let mut buffer = xr::EventDataBuffer::new();
        // The event lives in the buffer and keeps nothing of the instance, which is the session's.
        let instance = self.runtime.instance.clone();
        while let Some(event) = instance.poll_event(&mut buffer)? {
            self.hear(event)?;
        }
        Ok(std::mem::take(&mut self.notes))
    }

    fn hear(&mut self, event: xr::Event<'_>) -> Result<(), HeadsetError> {
        use xr::Event;
        self.notes.extend(told(&event, self.floor));
        match event {
            Event::SessionStateChanged(change) => self.follow(change.state()),
            Event::InstanceLossPending(_) => {
                Err(HeadsetError::Lost("INSTANCE_LOSS_PENDING".to_owned()))
            }
            Event::InteractionProfileChanged(_) => {
                for side in Side::BOTH {
                    let profile = self.actions.profile(&self.session, side)?;
                    self.is_bare[side as usize] = profile.as_deref() == Some(BARE_HAND);
                    self.notes.push(Note::Profile { side, profile });
                }
                Ok(())
            }
            Event::VisibilityMaskChangedKHR(change) => {
                let index = change.view_index() as usize;
                if let Some(eye) = self.eyes.get_mut(index) {
                    eye.mask = Mask::of(&self.runtime, &self.session, index);
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn follow(&mut self, state: xr::SessionState) -> Result<(), HeadsetError> {
        if state == xr::SessionState::READY {
            self.session.begin(STEREO)?;
            self.is_running = true;
        } else if state == xr::SessionState::STOPPING {
            self.session.end()?;
            self.is_running = false;
        } else if state == xr::SessionState::LOSS_PENDING {
            return Err(HeadsetError::Lost("LOSS_PENDING".to_owned()));
        } else if state == xr::SessionState::EXITING {
            self.notes.push(Note::Exit);
        }
        let focus = Focus::from(state);
        if focus != self.focus {
            self.focus = focus;
            self.notes.push(Note::Focus(focus));
        }
        Ok(())
    }
}

/// What an event says by itself; `floor` is the space whose changes matter.
fn told(event: &xr::Event<'_>, floor: xr::ReferenceSpaceType) -> Option<Note> {
    use xr::Event;
    match event {
        Event::ReferenceSpaceChangePending(change) if change.reference_space_type() == floor => {
            Some(Note::Recentred(change.change_time().as_nanos()))
        }
        Event::UserPresenceChangedEXT(change) => Some(Note::Worn(change.is_user_present())),
        Event::DisplayRefreshRateChangedFB(change) => {
            Some(Note::RefreshRate(change.to_display_refresh_rate()))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use std::mem::MaybeUninit;

    use xr::sys::Handle;

    use super::*;

    /// What is told of an event whose bytes a runtime wrote into the buffer of `xrPollEvent`.
    #[expect(unsafe_code, reason = "a runtime's bytes are read as an event")]
    fn told_of<T: Copy>(event: T) -> Option<Note> {
        let mut buffer = MaybeUninit::<xr::sys::EventDataBuffer>::zeroed();
        assert!(size_of::<T>() <= size_of::<xr::sys::EventDataBuffer>());
        // SAFETY: the buffer has room for the event and is aligned for every one of them; it is not moved while it is read.
        unsafe {
            buffer.as_mut_ptr().cast::<T>().write(event);
            let event = xr::Event::from_raw(&buffer).expect("an event that is known");
            told(&event, xr::ReferenceSpaceType::LOCAL_FLOOR_EXT)
        }
    }

    /// No runtime of the tests sees who wears it; what one that does would write is heard.
    #[test]
    fn a_headset_that_is_put_on_or_taken_off_is_told_of() {
        for is_worn in [false, true] {
            let event = xr::sys::EventDataUserPresenceChangedEXT {
                ty: xr::sys::EventDataUserPresenceChangedEXT::TYPE,
                next: std::ptr::null(),
                session: xr::sys::Session::NULL,
                is_user_present: is_worn.into(),
            };
            assert_eq!(told_of(event), Some(Note::Worn(is_worn)));
        }
    }

    #[test]
    fn only_the_floor_s_new_place_is_told_of() {
        let moved = |space| xr::sys::EventDataReferenceSpaceChangePending {
            ty: xr::sys::EventDataReferenceSpaceChangePending::TYPE,
            next: std::ptr::null(),
            session: xr::sys::Session::NULL,
            reference_space_type: space,
            change_time: xr::Time::from_nanos(17),
            pose_valid: false.into(),
            pose_in_previous_space: xr::Posef::IDENTITY,
        };
        let floor = told_of(moved(xr::ReferenceSpaceType::LOCAL_FLOOR_EXT));
        assert_eq!(floor, Some(Note::Recentred(17)));
        assert_eq!(told_of(moved(xr::ReferenceSpaceType::STAGE)), None);
    }
}
