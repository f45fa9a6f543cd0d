//! Which button of which controller means what: the suggested bindings, as data.
//!
//! Component paths are those of OpenXR 1.0 with the profile's extension enabled (specification, section 6.4 and the
//! extensions named); profiles that OpenXR 1.1 renamed keep their extension's name.
//! One input serves two actions: the lower thumb button is Forward and Blue, the upper one Back and Red, and the
//! program reads the first pair from the throwing hand, the second from the other. Red and Blue belong to a set
//! of their own, which needs the same priority as the other set: a higher one would take the buttons from walking.

use self::Asked::*;

/// An input or output that the program asks of a controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Asked {
    /// Where the hand holds; the ball is located by it.
    GripPose,
    /// First way to hold the ball, 0 to 1: by value where there is one, so that hysteresis works.
    Trigger,
    /// Second way to hold the ball, 0 to 1; the program takes either.
    Squeeze,
    /// Walk forward.
    Forward,
    /// Walk back.
    Back,
    /// Thumb's place on a pad or stick, for controllers without two thumb buttons: y above or below 0.
    Pad,
    /// Press that makes the thumb's place count: a resting thumb must not walk.
    PadClick,
    /// Pause.
    Menu,
    /// Answer Red.
    Red,
    /// Answer Blue.
    Blue,
    /// Vibration.
    Haptic,
}

/// An input or output and its component path, relative to the hand: `input/trigger/value`.
type Bound = (Asked, &'static str);

/// What the program suggests for one kind of controller.
pub(super) struct Profile {
    /// Interaction profile path.
    pub path: &'static str,
    /// Name shown to people.
    pub name: &'static str,
    /// Extension that must be offered and enabled; without it the path is unknown to the runtime.
    pub extension: Option<&'static str>,
    /// Bindings of the left hand.
    pub left: &'static [Bound],
    /// Bindings of the right hand.
    pub right: &'static [Bound],
}

impl Profile {
    /// Every binding with its full path, `/user/hand/left/input/trigger/value`; left hand first.
    pub(super) fn bindings(&self) -> impl Iterator<Item = (Asked, String)> {
        self.hands().into_iter().flat_map(|(hand, bound)| {
            bound
                .iter()
                .map(move |(asked, component)| (*asked, format!("/user/hand/{hand}/{component}")))
        })
    }

    fn hands(&self) -> [(&'static str, &'static [Bound]); 2] {
        [("left", self.left), ("right", self.right)]
    }
}

/// The profile of a hand without a controller.
pub(super) const BARE_HAND: &str = "/interaction_profiles/ext/hand_interaction_ext";

/// Every controller that the program knows, those of one maker before those that runtimes map to any hardware.
#[rustfmt::skip] // tables: pose and vibration, holding and menu, thumb
pub(super) const PROFILES: [Profile; 14] = {
    /// Left hand of the controllers with x, y and a menu button.
    const XY_MENU: &[Bound] = &[
        (GripPose, "input/grip/pose"), (Haptic, "output/haptic"),
        (Trigger, "input/trigger/value"), (Squeeze, "input/squeeze/value"), (Menu, "input/menu/click"),
        (Forward, "input/x/click"), (Back, "input/y/click"), (Red, "input/y/click"), (Blue, "input/x/click"),
    ];
    /// Right hand of the controllers with a and b, whose third button is the system's.
    const AB: &[Bound] = &[
        (GripPose, "input/grip/pose"), (Haptic, "output/haptic"),
        (Trigger, "input/trigger/value"), (Squeeze, "input/squeeze/value"),
        (Forward, "input/a/click"), (Back, "input/b/click"), (Red, "input/b/click"), (Blue, "input/a/click"),
    ];
    /// Right hand of the controllers with a, b and a menu button.
    const AB_MENU: &[Bound] = &[
        (GripPose, "input/grip/pose"), (Haptic, "output/haptic"),
        (Trigger, "input/trigger/value"), (Squeeze, "input/squeeze/value"), (Menu, "input/menu/click"),
        (Forward, "input/a/click"), (Back, "input/b/click"), (Red, "input/b/click"), (Blue, "input/a/click"),
    ];
    /// The grip is a plain button.
    const COSMOS_LEFT: &[Bound] = &[
        (GripPose, "input/grip/pose"), (Haptic, "output/haptic"),
        (Trigger, "input/trigger/value"), (Squeeze, "input/squeeze/click"), (Menu, "input/menu/click"),
        (Forward, "input/x/click"), (Back, "input/y/click"), (Red, "input/y/click"), (Blue, "input/x/click"),
    ];
    const COSMOS_RIGHT: &[Bound] = &[
        (GripPose, "input/grip/pose"), (Haptic, "output/haptic"),
        (Trigger, "input/trigger/value"), (Squeeze, "input/squeeze/click"),
        (Forward, "input/a/click"), (Back, "input/b/click"), (Red, "input/b/click"), (Blue, "input/a/click"),
    ];
    /// Squeeze by force: the value rises already where fingers merely lie on the grip. No button is left for a menu.
    const INDEX: &[Bound] = &[
        (GripPose, "input/grip/pose"), (Haptic, "output/haptic"),
        (Trigger, "input/trigger/value"), (Squeeze, "input/squeeze/force"),
        (Forward, "input/a/click"), (Back, "input/b/click"), (Red, "input/b/click"), (Blue, "input/a/click"),
    ];
    /// No thumb buttons: the upper and the lower half of the pad take their place.
    const WAND: &[Bound] = &[
        (GripPose, "input/grip/pose"), (Haptic, "output/haptic"),
        (Trigger, "input/trigger/value"), (Squeeze, "input/squeeze/click"), (Menu, "input/menu/click"),
        (Pad, "input/trackpad"), (PadClick, "input/trackpad/click"),
    ];
    /// Pad or stick: a runtime reports the place farther from the middle, and the press of either.
    const MOTION: &[Bound] = &[
        (GripPose, "input/grip/pose"), (Haptic, "output/haptic"),
        (Trigger, "input/trigger/value"), (Squeeze, "input/squeeze/click"), (Menu, "input/menu/click"),
        (Pad, "input/trackpad"), (PadClick, "input/trackpad/click"),
        (Pad, "input/thumbstick"), (PadClick, "input/thumbstick/click"),
    ];
    /// Whatever has a trigger, a grip and two thumb buttons.
    const GENERIC: &[Bound] = &[
        (GripPose, "input/grip/pose"), (Haptic, "output/haptic"),
        (Trigger, "input/trigger/value"), (Squeeze, "input/squeeze/value"),
        (Forward, "input/primary/click"), (Back, "input/secondary/click"),
        (Red, "input/secondary/click"), (Blue, "input/primary/click"),
    ];
    /// Two buttons, the first turned into 0 or 1 by the runtime. Legs walk, the scene's own buttons take the answers.
    const SIMPLE: &[Bound] = &[
        (GripPose, "input/grip/pose"), (Haptic, "output/haptic"),
        (Trigger, "input/select/click"), (Menu, "input/menu/click"),
    ];
    /// A fist holds the ball, and a pinch too, since a tracker need not keep them apart; an open hand is neither.
    const HAND: &[Bound] = &[
        (GripPose, "input/grip/pose"),
        (Trigger, "input/grasp_ext/value"), (Squeeze, "input/pinch_ext/value"),
    ];
    [
        Profile { path: "/interaction_profiles/oculus/touch_controller", name: "Oculus Touch",
            extension: None, left: XY_MENU, right: AB },
        Profile { path: "/interaction_profiles/meta/touch_controller_plus", name: "Meta Quest Touch Plus",
            extension: Some("XR_META_touch_controller_plus"), left: XY_MENU, right: AB },
        Profile { path: "/interaction_profiles/facebook/touch_controller_pro", name: "Meta Quest Touch Pro",
            extension: Some("XR_FB_touch_controller_pro"), left: XY_MENU, right: AB },
        Profile { path: "/interaction_profiles/valve/index_controller", name: "Valve Index",
            extension: None, left: INDEX, right: INDEX },
        Profile { path: "/interaction_profiles/htc/vive_controller", name: "HTC Vive wand",
            extension: None, left: WAND, right: WAND },
        Profile { path: "/interaction_profiles/microsoft/motion_controller", name: "Windows Mixed Reality",
            extension: None, left: MOTION, right: MOTION },
        Profile { path: "/interaction_profiles/bytedance/pico4_controller", name: "PICO 4",
            extension: Some("XR_BD_controller_interaction"), left: XY_MENU, right: AB },
        Profile { path: "/interaction_profiles/bytedance/pico_neo3_controller", name: "PICO Neo3",
            extension: Some("XR_BD_controller_interaction"), left: XY_MENU, right: AB_MENU },
        Profile { path: "/interaction_profiles/htc/vive_focus3_controller", name: "HTC Vive Focus 3",
            extension: Some("XR_HTC_vive_focus3_controller_interaction"), left: XY_MENU, right: AB },
        Profile { path: "/interaction_profiles/htc/vive_cosmos_controller", name: "HTC Vive Cosmos",
            extension: Some("XR_HTC_vive_cosmos_controller_interaction"), left: COSMOS_LEFT, right: COSMOS_RIGHT },
        Profile { path: "/interaction_profiles/hp/mixed_reality_controller", name: "HP Mixed Reality",
            extension: Some("XR_EXT_hp_mixed_reality_controller"), left: XY_MENU, right: AB_MENU },
        Profile { path: "/interaction_profiles/khr/generic_controller", name: "generic controller",
            extension: Some("XR_KHR_generic_controller"), left: GENERIC, right: GENERIC },
        Profile { path: "/interaction_profiles/khr/simple_controller", name: "simple controller",
            extension: None, left: SIMPLE, right: SIMPLE },
        Profile { path: BARE_HAND, name: "bare hand",
            extension: Some("XR_EXT_hand_interaction"), left: HAND, right: HAND },
    ]
};

/// Whether a controller of this profile has a button that pauses, on either hand.
pub(super) fn has_menu(path: &str) -> bool {
    let profile = PROFILES.iter().find(|profile| profile.path == path);
    profile.is_some_and(|profile| profile.bindings().any(|(asked, _)| asked == Menu))
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    /// A profile as the specification lists it; of each component its hand, path and type.
    struct Listed {
        path: &'static str,
        extension: Option<&'static str>,
        components: Vec<[&'static str; 3]>,
    }

    impl Listed {
        fn kind(&self, hand: &str, component: &str) -> Option<&'static str> {
            let mut components = self.components.iter();
            let found = components
                .find(|[on, name, _]| (*on == hand || *on == "both") && *name == component);
            found.map(|[_, _, kind]| *kind)
        }
    }

    fn specification() -> Vec<Listed> {
        let text = include_str!("../../tests/data/openxr_profiles.txt");
        let mut listed: Vec<Listed> = Vec::new();
        for line in text.lines().filter(|line| !line.starts_with('#')) {
            match line.split_whitespace().collect::<Vec<_>>()[..] {
                [] => {}
                ["profile", path, extension] => listed.push(Listed {
                    path,
                    extension: Some(extension).filter(|&name| name != "core"),
                    components: Vec::new(),
                }),
                [hand @ ("left" | "right" | "both"), component, kind] => {
                    let profile = listed.last_mut().expect("a profile line comes first");
                    profile.components.push([hand, component, kind]);
                }
                _ => panic!("openxr_profiles.txt has a line of neither kind: {line}"),
            }
        }
        listed
    }

    fn suits(asked: Asked, kind: &str) -> bool {
        match asked {
            GripPose => kind == "pose",
            Trigger | Squeeze => matches!(kind, "float" | "boolean"),
            Forward | Back | PadClick | Menu | Red | Blue => kind == "boolean",
            Pad => kind == "vector2",
            Haptic => kind == "haptic",
        }
    }

    #[test]
    fn profiles_bind_what_the_specification_lists() {
        let specification = specification();
        assert_eq!(specification.len(), PROFILES.len());
        for listed in &specification {
            let path = listed.path;
            let profile = PROFILES.iter().find(|profile| profile.path == path);
            let profile = profile.unwrap_or_else(|| panic!("{path} has no bindings"));
            assert_eq!(profile.extension, listed.extension, "{path}");
            for (hand, bound) in profile.hands() {
                for &(asked, component) in bound {
                    let at = format!("{path}, {hand}: {asked:?} from {component}");
                    let kind = listed.kind(hand, component);
                    let kind = kind.unwrap_or_else(|| panic!("{at}, which is not listed"));
                    assert!(suits(asked, kind), "{at}, which is of type {kind}");
                }
            }
        }
    }

    #[test]
    fn profiles_bind_no_input_twice_to_one_action() {
        for profile in &PROFILES {
            let mut seen = HashSet::new();
            for binding in profile.bindings() {
                let at = format!("{}: {binding:?}", profile.path);
                assert!(seen.insert(binding), "{at}");
            }
        }
    }

    #[test]
    fn profiles_let_either_hand_throw_and_leave_no_pair_half() {
        for profile in &PROFILES {
            for (hand, bound) in profile.hands() {
                let at = format!("{}, {hand}", profile.path);
                let paths = |asked: Asked| -> Vec<&str> {
                    let of_asked = bound.iter().filter(|(action, _)| *action == asked);
                    of_asked.map(|(_, component)| *component).collect()
                };
                for asked in [GripPose, Trigger] {
                    assert_eq!(paths(asked).len(), 1, "{at}: {asked:?}");
                }
                assert_eq!(paths(Forward), paths(Blue), "{at}: lower button");
                assert_eq!(paths(Back), paths(Red), "{at}: upper button");
                assert_eq!(paths(Forward).len(), paths(Back).len(), "{at}");
                assert_eq!(paths(Pad).len(), paths(PadClick).len(), "{at}: pad");
            }
        }
    }

    /// Of those without one the system takes the button, or there is none.
    #[test]
    fn profiles_without_a_menu_button_are_known() {
        let without: Vec<&str> = PROFILES
            .iter()
            .filter(|profile| !has_menu(profile.path))
            .map(|profile| profile.name)
            .collect();
        assert_eq!(without, ["Valve Index", "generic controller", "bare hand"]);
        assert!(!has_menu("/interaction_profiles/unknown"));
    }

    #[test]
    fn bindings_name_the_hand() {
        let touch = &PROFILES[0];
        let bindings: Vec<_> = touch.bindings().collect();
        for path in [
            "/user/hand/left/input/x/click",
            "/user/hand/right/input/a/click",
        ] {
            assert!(bindings.contains(&(Forward, path.to_owned())), "{path}");
        }
        assert_eq!(bindings.len(), touch.left.len() + touch.right.len());
    }
}
