//! What readings of a headset become.

use super::*;
use glam::{DQuat, DVec3};
use renderer::headset::BareHand;

fn grip(x: f64) -> Option<TrackedPose> {
    Some(TrackedPose {
        position: DVec3::new(x, 1.0, 0.0),
        rotation: DQuat::IDENTITY,
        velocity: None,
    })
}

fn readings(left: f64, right: f64) -> Readings {
    let mut readings = Readings::default();
    for (hand, (x, trigger)) in readings.hands.iter_mut().zip([(-0.3, left), (0.3, right)]) {
        hand.grip = grip(x);
        hand.trigger = trigger;
    }
    readings
}

#[test]
fn input_follows_the_hand_that_closes_and_stays_with_what_it_holds() {
    let mut participant = Participant::new(720.0);
    let mut x = |left, right, holding| {
        let input = participant.input(&readings(left, right), 0, 0.01, holding);
        input.hand.map(|hand| hand.pose.position.x)
    };
    assert_eq!(x(0.0, 0.0, false), Some(0.3));
    assert_eq!(x(0.9, 0.0, false), None, "no hand moves from right to left");
    assert_eq!(x(0.9, 0.0, false), Some(-0.3));
    assert_eq!(
        x(0.9, 0.9, true),
        Some(-0.3),
        "the ball is in the left hand"
    );
    assert_eq!(x(0.0, 0.9, true), Some(-0.3), "until it is let go");
    assert_eq!(x(0.0, 0.9, false), None);
    assert_eq!(x(0.0, 0.9, false), Some(0.3));
}

#[test]
fn the_game_is_told_which_hand_plays() {
    let mut participant = Participant::new(720.0);
    let mut is_left = |left, right| {
        let input = participant.input(&readings(left, right), 0, 0.01, false);
        input.is_left
    };
    assert!(!is_left(0.0, 0.0));
    is_left(0.9, 0.0);
    assert!(is_left(0.9, 0.0) && is_left(0.0, 0.0));
    is_left(0.0, 0.9);
    assert!(!is_left(0.0, 0.9));
    participant.input(&readings(0.9, 0.0), 0, 0.01, false);
    assert!(participant.pause(&readings(0.9, 0.0)).is_left);
}

#[test]
fn buttons_of_the_other_hand_choose_and_those_of_the_throwing_hand_walk() {
    let mut participant = Participant::new(720.0);
    let mut both = readings(0.0, 0.0);
    for hand in &mut both.hands {
        (hand.forward, hand.red) = (true, true);
    }
    both.hands[0].forward = false;
    let input = participant.input(&both, 0, 0.01, false);
    assert!(input.walk_forward && input.press_red && !input.press_blue);
    both.hands[0].red = false;
    assert!(!participant.input(&both, 0, 0.01, false).press_red);
}

/// A thumb that walks while the other hand takes over must not choose a game.
#[test]
fn buttons_that_are_down_when_hands_change_roles_mean_nothing() {
    let mut participant = Participant::new(720.0);
    let mut both = readings(0.9, 0.0);
    (both.hands[1].forward, both.hands[1].blue) = (true, true);
    for _ in 0..3 {
        assert!(!participant.input(&both, 0, 0.01, false).press_blue);
    }
    (both.hands[1].forward, both.hands[1].blue) = (false, false);
    participant.input(&both, 0, 0.01, false);
    (both.hands[1].forward, both.hands[1].blue) = (true, true);
    assert!(participant.input(&both, 0, 0.01, false).press_blue);
}

/// 75 Hz does not divide 720: the steps of any stretch of frames are those of its time, to one.
#[test]
fn steps_follow_the_clock_at_any_rate() {
    for hz in [45.0, 72.0, 75.0, 90.0, 120.0] {
        let mut participant = Participant::new(720.0);
        let (mut steps, mut longest) = (0, 0);
        for frame in 0..1000 {
            let display_ns = (f64::from(frame) / hz * 1e9) as i64;
            let input = participant.input(&readings(0.0, 0.0), display_ns, 1.0 / hz, false);
            longest = longest.max(input.steps);
            steps += input.steps;
        }
        let exact = 1000.0 / hz * 720.0;
        assert!(
            (f64::from(steps) - exact).abs() <= 1.0,
            "{hz} Hz: {steps}, not {exact}"
        );
        assert!(f64::from(longest) < 720.0 / hz + 1.0);
    }
}

#[test]
fn a_pause_stops_time_and_hides_the_hand() {
    let mut participant = Participant::new(720.0);
    participant.input(&readings(0.0, 0.0), 0, 0.01, false);
    let paused = participant.pause(&readings(0.0, 0.0));
    assert_eq!((paused.steps, paused.hand), (0, None));
    let ten_seconds = 10_000_000_000;
    let input = participant.input(&readings(0.0, 0.0), ten_seconds, 1.0 / 90.0, false);
    assert_eq!(input.steps, 8, "what passed meanwhile is not made up for");
}

/// The runtime tells of a new space ahead of its first frame; the game must hear of it in that frame, and once.
#[test]
fn a_new_space_is_told_with_the_first_frame_in_it() {
    let mut participant = Participant::new(720.0);
    let mut with_change = readings(0.0, 0.0);
    with_change.hands[1].changes[0] = Some(Change {
        time_ns: 1_000_000_000,
        grip: grip(0.1),
    });
    participant.recentre(1_020_000_000);
    let mut told = |milliseconds: i64| {
        let input = participant.input(&with_change, milliseconds * 1_000_000, 0.01, true);
        (input.recentred, input.trigger_change.is_some())
    };
    assert_eq!(told(1_010), (false, true));
    assert_eq!(
        told(1_020),
        (true, false),
        "the old pose is of the old space"
    );
    assert_eq!(told(1_030), (false, true));
}

/// Nothing is played in a pause: the first frame behind it hears of what happened meanwhile.
#[test]
fn a_new_space_in_a_pause_is_told_behind_it() {
    let mut participant = Participant::new(720.0);
    participant.recentre(5);
    assert!(!participant.pause(&readings(0.0, 0.0)).recentred);
    assert!(
        participant
            .input(&readings(0.0, 0.0), 10, 0.01, false)
            .recentred
    );
}

fn bare(x: f64, grasp: f64, pinch: f64) -> HandReading {
    HandReading {
        bare: Some(BareHand {
            palm: grip(x).expect("a pose"),
            bends: [[0.25; 3]; 5],
            grasp,
            pinch,
        }),
        // What the runtime makes of the hand by itself, under a profile for bare hands.
        grip: grip(x + 0.05),
        trigger: 0.5,
        ..HandReading::default()
    }
}

#[test]
fn a_bare_hand_holds_by_its_fist_or_by_a_pinch() {
    let mut participant = Participant::new(720.0);
    let mut readings = readings(0.0, 0.0);
    let mut closed = |grasp, pinch| {
        readings.hands[1] = bare(0.25, grasp, pinch);
        let input = participant.input(&readings, 0, 0.01, false);
        let x = input.hand.map(|hand| hand.pose.position.x);
        (x, input.trigger, input.trigger_change)
    };
    assert_eq!(closed(0.0, 0.0).0, None, "a controller was put away");
    assert_eq!(closed(0.1, 0.0), (Some(0.25), 0.1, None));
    assert_eq!(closed(0.9, 0.0), (Some(0.25), 0.9, None));
    assert_eq!(closed(0.2, 0.8), (Some(0.25), 0.8, None));
    let fingers = participant.fingers(&readings).expect("it is bare");
    assert_eq!(fingers, Fingers::tracked(&[[0.25; 3]; 5]));
}

/// A hand that is lost for a while and comes back as what it was has not changed.
#[test]
fn a_hand_is_gone_for_one_frame_when_it_takes_up_a_controller() {
    let mut participant = Participant::new(720.0);
    let with = readings(0.0, 0.0);
    let (mut without, mut lost) = (with, with);
    without.hands[1] = bare(0.3, 0.0, 0.0);
    lost.hands[1] = HandReading::default();
    let mut is_seen = |readings: &Readings| {
        let input = participant.input(readings, 0, 0.01, false);
        input.hand.is_some()
    };
    let seen = [
        &with, &without, &without, &lost, &without, &with, &lost, &with,
    ];
    let expected = [true, false, true, false, true, false, false, true];
    assert_eq!(seen.map(&mut is_seen), expected);
}

/// A controller is switched off with a ball in the hand, and the runtime sees the hand: it neither holds on nor throws.
#[test]
fn what_a_controller_held_a_bare_hand_does_not_take_over() {
    let mut participant = Participant::new(720.0);
    let mut input = |readings: &Readings, is_holding| {
        let input = participant.input(readings, 0, 0.01, is_holding);
        input.hand.map(|_| input.trigger)
    };
    let with = readings(0.0, 0.9);
    let mut without = with;
    without.hands[1] = bare(0.3, 1.0, 0.0);
    assert_eq!(input(&with, true), Some(0.9));
    for _ in 0..5 {
        assert_eq!(input(&without, true), None, "it is lost");
    }
    assert_eq!(input(&without, false), None, "the ball has fallen");
    assert_eq!(input(&without, false), Some(1.0));
}

#[test]
fn a_change_is_aged_from_the_time_of_display() {
    let mut participant = Participant::new(720.0);
    let mut with_change = readings(0.0, 0.0);
    with_change.hands[1].changes[0] = Some(Change {
        time_ns: 1_000_000_000,
        grip: grip(0.1),
    });
    let mut age = |display_ns| {
        let input = participant.input(&with_change, display_ns, 0.01, true);
        input.trigger_change.map(|change| change.age_s)
    };
    assert!((age(1_030_000_000).expect("a recent change") - 0.03).abs() < 1e-12);
    assert_eq!(age(2_000_000_000), None, "too old to be believed");
}

/// The panel hangs at the hand that does not play, whichever that is.
#[test]
fn the_wrist_is_that_of_the_hand_that_does_not_play() {
    let mut participant = Participant::new(720.0);
    let mut both = readings(0.0, 0.0);
    both.head = grip(0.0);
    let rig = Pose::from_position(DVec3::new(10.0, 0.0, 0.0));
    let x = |participant: &Participant, readings: &Readings| {
        let arms = participant.arms(readings, rig).expect("a head and a hand");
        let pointer = arms.pointer.map(|(hand, _)| hand.position.x);
        (arms.wrist.position.x, pointer)
    };
    assert_eq!(x(&participant, &both), (9.7, Some(10.3)));
    let mut left = readings(0.9, 0.0);
    left.head = grip(0.0);
    participant.input(&left, 0, 0.01, false);
    assert_eq!(x(&participant, &left), (10.3, Some(9.7)), "left-handed");
    left.hands[1].grip = None;
    assert_eq!(x(&participant, &left), (9.7, None), "one hand alone");
    left.head = None;
    assert!(participant.arms(&left, rig).is_none());
}

/// A fist round an upright stick, thumb up, as one holds a glass before oneself: the fingers would point ahead, the palms at each other.
#[test]
fn a_controller_is_held_by_a_hand_whose_fingers_go_round_it() {
    // -z of both grips is up, and x, which is into the right palm and out of the left one, is to the right.
    let grip = TrackedPose {
        position: DVec3::ZERO,
        rotation: DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2),
        velocity: None,
    };
    assert!((grip.rotation * DVec3::NEG_Z).distance(DVec3::Y) < 1e-12);
    for (side, out_of_palm, thumb) in [
        (Side::Left, DVec3::X, DVec3::X),
        (Side::Right, DVec3::NEG_X, DVec3::NEG_X),
    ] {
        let mut readings = Readings::default();
        readings.hands[side as usize].grip = Some(grip);
        let palm = in_use(&readings)[side as usize].grip.expect("tracked");
        let of = |axis: DVec3| palm.rotation * axis;
        assert!(
            of(DVec3::NEG_Z).distance(DVec3::NEG_Z) < 1e-12,
            "{side:?}: fingers"
        );
        assert!(
            of(DVec3::NEG_Y).distance(out_of_palm) < 1e-12,
            "{side:?}: palm"
        );
        // A right hand's thumb is at its left, a left one's at its right.
        assert!(of(thumb).distance(DVec3::Y) < 1e-12, "{side:?}: thumb");
    }
}
