//! Whether the participant is here: time passes in the alley, and their hand is in it, only then.

use renderer::headset::{Focus, Note, Readings, has_menu_button};

/// What keeps a participant from playing, besides the focus that the runtime's session has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attention {
    /// The headset is on somebody's head, as far as the runtime can tell.
    is_worn: bool,
    /// The participant paused by the menu button.
    is_paused: bool,
    /// Whether a menu button was down in the last frame.
    menu_was_down: bool,
    /// Whether the controller of each hand has a menu button.
    has_menu: [bool; 2],
}

impl Attention {
    /// Of somebody who has just begun: a runtime that sees who wears the headset tells only of changes.
    pub fn new() -> Self {
        Self {
            is_worn: true,
            is_paused: false,
            menu_was_down: false,
            has_menu: [false; 2],
        }
    }

    /// Hears what the runtime says: a headset that is taken off pauses until it is put on again.
    pub fn hear(&mut self, note: &Note) {
        match note {
            Note::Worn(is_worn) => self.is_worn = *is_worn,
            Note::Profile { side, profile } => {
                self.has_menu[*side as usize] = profile.as_deref().is_some_and(has_menu_button);
            }
            _ => {}
        }
    }

    /// Whether the participant needs a panel at the wrist: to pause where no controller has a button for it and nobody `is_busy` with
    /// a ball, and in a pause.
    pub fn needs_panel(&self, is_busy: bool) -> bool {
        self.is_paused || self.has_menu == [false; 2] && !is_busy
    }

    /// Whether somebody is there, paused or not, while the session has this focus.
    pub fn is_present(&self, focus: Focus) -> bool {
        focus == Focus::Focused && self.is_worn
    }

    /// The participant has paused by menu button or panel.
    pub fn is_paused(&self) -> bool {
        self.is_paused
    }

    /// Pauses or goes on: whether it is a pause now.
    pub fn toggle(&mut self) -> bool {
        self.is_paused ^= true;
        self.is_paused
    }

    /// Begins anew with another session of the runtime; a pause by the menu button lasts.
    pub fn reconnect(&mut self) {
        self.is_worn = true;
        self.menu_was_down = false;
    }

    /// The menu button pauses, and goes on: whether it is a pause now, when it has just changed.
    pub fn press_menu(&mut self, readings: &Readings) -> Option<bool> {
        let is_down = readings.hands.iter().any(|hand| hand.menu);
        let is_press = is_down && !self.menu_was_down;
        self.menu_was_down = is_down;
        is_press.then(|| self.toggle())
    }

    /// Whether the participant plays, while the session has this focus.
    pub fn is_here(&self, focus: Focus) -> bool {
        self.is_present(focus) && !self.is_paused
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use renderer::headset::Side;

    fn menu(is_down: bool) -> Readings {
        let mut readings = Readings::default();
        readings.hands[0].menu = is_down;
        readings
    }

    #[test]
    fn a_headset_that_is_taken_off_pauses_as_a_lost_focus_does() {
        let mut attention = Attention::new();
        let here = |attention: &Attention| {
            [Focus::Focused, Focus::Visible].map(|focus| attention.is_here(focus))
        };
        assert_eq!(here(&attention), [true, false]);
        attention.hear(&Note::Worn(false));
        assert_eq!(here(&attention), [false, false]);
        attention.hear(&Note::Recentred(1));
        assert_eq!(here(&attention), [false, false], "nobody has put it on");
        attention.hear(&Note::Worn(true));
        assert_eq!(here(&attention), [true, false]);
    }

    #[test]
    fn a_panel_is_needed_where_no_controller_has_a_menu_button_and_in_a_pause() {
        let mut attention = Attention::new();
        assert!(attention.needs_panel(false), "no controller yet");
        assert!(!attention.needs_panel(true), "a ball in the hand");
        let profile = |side, name: &str| Note::Profile {
            side,
            profile: Some(format!("/interaction_profiles/{name}")),
        };
        let index = "valve/index_controller";
        attention.hear(&profile(Side::Left, index));
        attention.hear(&profile(Side::Right, index));
        assert!(attention.needs_panel(false));
        attention.hear(&profile(Side::Left, "oculus/touch_controller"));
        assert!(!attention.needs_panel(false));
        assert!(attention.toggle() && attention.needs_panel(true), "paused");
        assert!(!attention.is_here(Focus::Focused) && attention.is_present(Focus::Focused));
        assert!(!attention.toggle() && !attention.needs_panel(false));
    }

    #[test]
    fn a_menu_button_pauses_on_its_way_down_and_lasts_through_a_loss() {
        let mut attention = Attention::new();
        assert_eq!(attention.press_menu(&menu(true)), Some(true));
        assert_eq!(attention.press_menu(&menu(true)), None, "it is held");
        assert_eq!(attention.press_menu(&menu(false)), None);
        attention.hear(&Note::Worn(false));
        attention.reconnect();
        assert!(!attention.is_here(Focus::Focused), "still paused");
        assert_eq!(attention.press_menu(&menu(true)), Some(false));
        assert!(
            attention.is_here(Focus::Focused),
            "a new session tells anew who wears it"
        );
    }
}
