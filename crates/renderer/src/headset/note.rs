//! What the runtime says between frames.

use openxr as xr;

use super::actions::Side;

/// How much of the participant's attention the session has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Focus {
    /// The runtime does not want frames: the headset lies on a table, or the session has only just begun.
    Stopped,
    /// Frames are counted and not shown.
    Hidden,
    /// Frames are shown and something else has the hands: a menu of the system.
    Visible,
    /// The participant is here.
    Focused,
}

/// Something that the runtime said, for the journal and the screen.
#[derive(Clone, Debug, PartialEq)]
pub enum Note {
    /// The session began.
    Began {
        /// The extensions that it uses, of those that the runtime offers.
        extensions: Vec<String>,
        /// How many images each of its swapchains has: of each eye its picture's and, where the runtime takes it, its depth's.
        images: Vec<usize>,
    },
    /// The session's focus changed.
    Focus(Focus),
    /// The runtime asks the program to end.
    Exit,
    /// A hand's controller, as the path of its profile; `None` when it was switched off.
    Profile {
        /// Which hand.
        side: Side,
        /// The profile's path.
        profile: Option<String>,
    },
    /// The runtime refused some of a profile's bindings; the others are in force.
    BindingsRejected {
        /// The profile, as people call it.
        profile: &'static str,
        /// The paths of the inputs and outputs that it refused; all of them where it does not know the profile.
        paths: Vec<String>,
        /// The runtime's answer.
        answer: String,
    },
    /// The floor was measured anew, or the participant recentred: what is seen at this time or later is located in a new
    /// space [ns, the runtime's clock].
    Recentred(i64),
    /// The headset was put on or taken off.
    Worn(bool),
    /// The display's rate [Hz].
    RefreshRate(f32),
    /// The display's rate could not be chosen: why.
    RateRefused(String),
}

impl From<xr::SessionState> for Focus {
    fn from(state: xr::SessionState) -> Self {
        if state == xr::SessionState::FOCUSED {
            Self::Focused
        } else if state == xr::SessionState::VISIBLE {
            Self::Visible
        } else if state == xr::SessionState::SYNCHRONIZED {
            Self::Hidden
        } else {
            Self::Stopped
        }
    }
}
