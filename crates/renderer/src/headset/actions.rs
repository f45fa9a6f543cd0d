//! What hands and buttons do: actions, bound to controllers by the table in `profiles.rs`.

use openxr as xr;

use super::HeadsetError;
use super::joints::BareHand;
use super::note::Note;
use super::profiles::{Asked, PROFILES, Profile};
use super::runtime::Runtime;
use super::space::{self, TrackedPose};

/// Left or right hand; also its index in arrays of two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The left hand.
    Left,
    /// The right hand.
    Right,
}

impl Side {
    /// Both, in the order of arrays of two.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// The hand on the other side.
    pub fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }

    fn path(self) -> &'static str {
        match self {
            Self::Left => "/user/hand/left",
            Self::Right => "/user/hand/right",
        }
    }
}

/// The last change of a hand's trigger or squeeze: of a value that moves through several readings, its last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// When it happened, on the runtime's clock [ns].
    pub time_ns: i64,
    /// Where the grip was then.
    pub grip: Option<TrackedPose>,
}

/// What one hand does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HandReading {
    /// The grip at the time of display; `None` while it is not tracked.
    pub grip: Option<TrackedPose>,
    /// The hand itself, where it has no controller and its joints are tracked: it then takes the place of grip, trigger and
    /// squeeze.
    pub bare: Option<BareHand>,
    /// Trigger, from 0 (open) to 1 (closed).
    pub trigger: f64,
    /// Squeeze, from 0 (open) to 1 (closed).
    pub squeeze: f64,
    /// The last change of the trigger and of the squeeze, if there was one since the reading before.
    pub changes: [Option<Change>; 2],
    /// Lower thumb button, or the upper half of a trackpad.
    pub forward: bool,
    /// Upper thumb button, or the lower half of a trackpad.
    pub back: bool,
    /// Upper thumb button, in a set of its own beside walking.
    pub red: bool,
    /// Lower thumb button, in the same set.
    pub blue: bool,
    /// Menu button.
    pub menu: bool,
}

/// Between its halves a trackpad that is pressed means neither; its height goes from -1 to 1.
const PAD_EDGE: f32 = 0.2;

/// Head and hands at one time of display.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Readings {
    /// The head; `None` while it is not tracked.
    pub head: Option<TrackedPose>,
    /// Left and right hand.
    pub hands: [HandReading; 2],
}

/// The session's actions.
pub(super) struct Actions {
    play: xr::ActionSet,
    choose: xr::ActionSet,
    hands: [xr::Path; 2],
    grips: [xr::Space; 2],
    trigger: xr::Action<f32>,
    squeeze: xr::Action<f32>,
    pad: xr::Action<xr::Vector2f>,
    forward: xr::Action<bool>,
    back: xr::Action<bool>,
    pad_click: xr::Action<bool>,
    menu: xr::Action<bool>,
    red: xr::Action<bool>,
    blue: xr::Action<bool>,
    haptic: xr::Action<xr::Haptic>,
}

impl Actions {
    /// Makes the actions, suggests every profile's bindings and attaches them; `notes` names what the runtime rejects.
    pub fn attach(
        runtime: &Runtime,
        session: &xr::Session<xr::Vulkan>,
        notes: &mut Vec<Note>,
    ) -> Result<Self, HeadsetError> {
        let instance = &runtime.instance;
        let play = instance.create_action_set("play", "Play", 0)?;
        let choose = instance.create_action_set("choose", "Choose a game", 0)?;
        let [left, right] = Side::BOTH.map(|side| instance.string_to_path(side.path()));
        let hands = [left?, right?];
        let grip = play.create_action::<xr::Posef>("grip_pose", "Hand", &hands)?;
        let button = |set: &xr::ActionSet, name, shown| set.create_action(name, shown, &hands);
        let actions = Self {
            trigger: play.create_action("trigger", "Hold the ball", &hands)?,
            squeeze: play.create_action("squeeze", "Hold the ball (squeeze)", &hands)?,
            pad: play.create_action("pad", "Walk (trackpad)", &hands)?,
            forward: button(&play, "forward", "Walk forward")?,
            back: button(&play, "back", "Walk back")?,
            pad_click: button(&play, "pad_click", "Walk (press the trackpad)")?,
            menu: button(&play, "menu", "Menu")?,
            red: button(&choose, "red", "Red game")?,
            blue: button(&choose, "blue", "Blue game")?,
            haptic: play.create_action("haptic", "Feel the ball", &hands)?,
            grips: [
                grip.create_space(session, hands[0], xr::Posef::IDENTITY)?,
                grip.create_space(session, hands[1], xr::Posef::IDENTITY)?,
            ],
            play,
            choose,
            hands,
        };
        for profile in &PROFILES {
            if profile
                .extension
                .is_some_and(|name| !runtime.has_profile(name))
            {
                continue;
            }
            notes.extend(actions.suggest(instance, profile, &grip)?);
        }
        session.attach_action_sets(&[&actions.play, &actions.choose])?;
        Ok(actions)
    }

    /// Suggests what a profile binds; names what the runtime rejects of it, and leaves the rest in force.
    fn suggest(
        &self,
        instance: &xr::Instance,
        profile: &Profile,
        grip: &xr::Action<xr::Posef>,
    ) -> xr::Result<Option<Note>> {
        let bind = |asked: Asked, path: &str| -> xr::Result<xr::Binding<'_>> {
            let path = instance.string_to_path(path)?;
            Ok(match asked {
                Asked::GripPose => xr::Binding::new(grip, path),
                Asked::Trigger => xr::Binding::new(&self.trigger, path),
                Asked::Squeeze => xr::Binding::new(&self.squeeze, path),
                Asked::Pad => xr::Binding::new(&self.pad, path),
                Asked::Forward => xr::Binding::new(&self.forward, path),
                Asked::Back => xr::Binding::new(&self.back, path),
                Asked::PadClick => xr::Binding::new(&self.pad_click, path),
                Asked::Menu => xr::Binding::new(&self.menu, path),
                Asked::Red => xr::Binding::new(&self.red, path),
                Asked::Blue => xr::Binding::new(&self.blue, path),
                Asked::Haptic => xr::Binding::new(&self.haptic, path),
            })
        };
        let path = instance.string_to_path(profile.path)?;
        let asked: Vec<(Asked, String)> = profile.bindings().collect();
        let rejected = sift(&asked, |some| {
            let bindings: xr::Result<Vec<_>> = some
                .iter()
                .map(|(asked, path)| bind(*asked, path))
                .collect();
            instance.suggest_interaction_profile_bindings(path, &bindings?)
        });
        Ok(rejected.map(|(answer, refused)| Note::BindingsRejected {
            profile: profile.name,
            paths: refused.into_iter().map(|(_, path)| path).collect(),
            answer: format!("{answer:?}"),
        }))
    }

    /// Brings the actions up to date, once a frame.
    pub fn sync(&self, session: &xr::Session<xr::Vulkan>) -> Result<(), HeadsetError> {
        let sets = [
            xr::ActiveActionSet::new(&self.play),
            xr::ActiveActionSet::new(&self.choose),
        ];
        Ok(session.sync_actions(&sets)?)
    }

    /// One hand as of the last [`Actions::sync`], its grip at `time`.
    pub fn read(
        &self,
        session: &xr::Session<xr::Vulkan>,
        side: Side,
        (base, time): (&xr::Space, xr::Time),
    ) -> Result<HandReading, HeadsetError> {
        let hand = self.hands[side as usize];
        let grip = &self.grips[side as usize];
        let trigger = self.trigger.state(session, hand)?;
        let squeeze = self.squeeze.state(session, hand)?;
        let changed = |state: &xr::ActionState<f32>| -> Option<Change> {
            let at = state.last_change_time;
            (state.is_active && state.changed_since_last_sync).then(|| Change {
                time_ns: at.as_nanos(),
                // A time that the runtime no longer knows has no place; the game then takes the frame's own.
                grip: space::locate(grip, base, at).ok().flatten(),
            })
        };
        let is_down = |action: &xr::Action<bool>| -> Result<bool, HeadsetError> {
            let state = action.state(session, hand)?;
            Ok(state.is_active && state.current_state)
        };
        let pad_y = self.pad.state(session, hand)?.current_state.y;
        let is_pressed = is_down(&self.pad_click)?;
        let (upper, lower) = (
            is_pressed && pad_y > PAD_EDGE,
            is_pressed && pad_y < -PAD_EDGE,
        );
        Ok(HandReading {
            grip: space::locate(grip, base, time)?,
            bare: None,
            trigger: trigger.current_state.into(),
            squeeze: squeeze.current_state.into(),
            changes: [changed(&trigger), changed(&squeeze)],
            forward: is_down(&self.forward)? || upper,
            back: is_down(&self.back)? || lower,
            red: is_down(&self.red)? || upper,
            blue: is_down(&self.blue)? || lower,
            menu: is_down(&self.menu)?,
        })
    }

    /// Lets a hand feel a pulse; a controller that cannot is no error.
    pub fn pulse(
        &self,
        session: &xr::Session<xr::Vulkan>,
        side: Side,
        amplitude: f32,
        duration: xr::Duration,
    ) -> Result<(), HeadsetError> {
        let vibration = xr::HapticVibration::new()
            .amplitude(amplitude.clamp(0.0, 1.0))
            .frequency(xr::FREQUENCY_UNSPECIFIED)
            .duration(duration);
        let hand = self.hands[side as usize];
        Ok(self.haptic.apply_feedback(session, hand, &vibration)?)
    }

    /// The profile that the runtime has chosen for a hand, as its path; `None` without a controller.
    pub fn profile(
        &self,
        session: &xr::Session<xr::Vulkan>,
        side: Side,
    ) -> Result<Option<String>, HeadsetError> {
        let path = session.current_interaction_profile(self.hands[side as usize])?;
        if path == xr::Path::NULL {
            return Ok(None);
        }
        Ok(Some(session.instance().path_to_string(path)?))
    }
}

/// Suggests all of `items`, or, where the runtime rejects them together, all that it accepts one by one: its first answer and
/// what it rejects. A later suggestion takes the place of an earlier one.
fn sift<T: Clone>(
    items: &[T],
    mut suggest: impl FnMut(&[T]) -> xr::Result<()>,
) -> Option<(xr::sys::Result, Vec<T>)> {
    let answer = suggest(items).err()?;
    let (good, bad): (Vec<T>, Vec<T>) = items
        .iter()
        .cloned()
        .partition(|item| suggest(std::slice::from_ref(item)).is_ok());
    // What was suggested last alone is all that is in force.
    if !good.is_empty() && suggest(&good).is_err() {
        return Some((answer, items.to_vec()));
    }
    Some((answer, bad))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A runtime that knows all numbers but some: what it was told last and has taken, and what it says of `items`.
    fn sifted(items: &[u32], unknown: &[u32]) -> (Vec<u32>, Option<Vec<u32>>) {
        let mut in_force = Vec::new();
        let rejected = sift(items, |some| {
            if some.iter().any(|item| unknown.contains(item)) {
                return Err(xr::sys::Result::ERROR_PATH_UNSUPPORTED);
            }
            in_force = some.to_vec();
            Ok(())
        });
        let rejected = rejected.map(|(answer, items)| {
            assert_eq!(answer, xr::sys::Result::ERROR_PATH_UNSUPPORTED);
            items
        });
        (in_force, rejected)
    }

    #[test]
    fn sift_leaves_in_force_what_the_runtime_accepts_and_names_the_rest() {
        assert_eq!(sifted(&[1, 2, 3], &[]), (vec![1, 2, 3], None));
        assert_eq!(sifted(&[1, 2, 3], &[2]), (vec![1, 3], Some(vec![2])));
        assert_eq!(sifted(&[1, 2], &[1, 2]), (vec![], Some(vec![1, 2])));
    }
}
