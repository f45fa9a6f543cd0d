//! What the scripted participant does next: press a button, fetch a ball, throw it.

use game::{BallSeen, Button, Observation, ParticipantConfig};
use glam::{DQuat, DVec2, DVec3};

use super::action::{Action, HandGoal};
use super::body::yaw_towards;
use super::swing::{Swing, fingers_along_arm};
use experiment::random::SplitMix64;

/// From the middle of the hand to the ball's surface when it closes [m]: beyond the sphere that
/// pushes what it touches, within the hand's reach.
const GRAB_GAP: f64 = 0.06;
/// Where the arrows on the lane are [m].
const ARROWS_Z: f64 = -4.3;
/// How far the body stands from what it reaches for [m].
const REACH_DISTANCE: f64 = 0.55;
/// Angle of the arm to the vertical when the hand closes on a ball [rad].
const GRAB_ANGLE: f64 = 0.6;
/// How far the knees bend for a reach and for a throw [m].
const BEND: f64 = 0.25;
/// How high a ball is lifted before it is carried off, clear of rims and of its neighbours [m].
const LIFT: f64 = 0.3;
/// Angle of the arm in front when the ball is carried and the swing starts [rad].
const CARRY_ANGLE: f64 = 0.5;
/// Time for the backswing [s].
const BACK_TIME: f64 = 0.9;
/// The hand hovers this far from a button or a ball before it comes on [m].
const HOVER: f64 = 0.12;
/// Distance from the head pin's spot at which a target off the centre counts as the head pin [m].
const PIN_SPOT: f64 = 0.1;

/// The hand hanging relaxed at the side, fingers ahead and down.
pub fn relaxed_hand(person: &ParticipantConfig) -> HandGoal {
    let elbow_height = person.shoulder_height_m + BEND - 0.45;
    HandGoal::Body(
        DVec3::new(person.shoulder_offset_m + 0.08, elbow_height, -0.25),
        DQuat::from_rotation_x(-0.4),
    )
}

/// Walk to the desk and press a button with the palm.
pub fn press(
    button: Button,
    alley: &Observation,
    person: &ParticipantConfig,
    from: DVec2,
) -> Vec<Action> {
    let middle = alley.buttons[button as usize].top;
    let spot = DVec2::new(middle.x, middle.z);
    let flat = DQuat::IDENTITY;
    let above = middle + DVec3::Y * HOVER;
    vec![
        Action::Look(middle),
        Action::Walk(stand_before(spot, from)),
        Action::Stand(stand_before(spot, from), yaw_towards(spot - from)),
        Action::Reach(HandGoal::World(above, flat), 0.8),
        Action::Reach(HandGoal::World(middle, flat), 0.3),
        Action::Reach(HandGoal::World(above, flat), 0.3),
        Action::Reach(relaxed_hand(person), 0.5),
    ]
}

/// Walk to a ball, close the hand on it from above as the arm comes, and lift it off the rack.
pub fn fetch(ball: BallSeen, from: DVec2) -> Vec<Action> {
    let spot = DVec2::new(ball.position.x, ball.position.z);
    // Straight across from the lane's middle: between the balls' neighbours nothing is in the way.
    let side = DVec2::new(spot.x - REACH_DISTANCE.copysign(spot.x), spot.y);
    let ahead = (spot - side).normalize();
    let fingers = DVec3::new(ahead.x, 0.0, ahead.y) * libm::sin(GRAB_ANGLE)
        - DVec3::Y * libm::cos(GRAB_ANGLE);
    let down = fingers_along_arm(GRAB_ANGLE);
    let grip = ball.position - fingers * (ball.radius + GRAB_GAP);
    vec![
        Action::Look(ball.position),
        Action::Walk(side),
        Action::Stand(side, yaw_towards(spot - side)),
        Action::Bend(BEND * 0.6),
        Action::Reach(HandGoal::World(grip - fingers * HOVER, down), 0.8),
        Action::Reach(HandGoal::World(grip, down), 0.4),
        Action::Trigger(1.0, 0.12),
        Action::Wait(0.1),
        Action::Reach(HandGoal::World(grip + DVec3::Y * LIFT, down), 0.7),
        Action::BackOff(0.35_f64.min((spot - from).length().max(0.2))),
    ]
}

/// Carry the ball to the approach and throw it at what stands.
///
/// The game sees the trigger open `lateness` [s] after it does, in the mean: half a frame.
pub fn deliver(
    alley: &Observation,
    ball: BallSeen,
    person: &ParticipantConfig,
    lateness: f64,
    random: &mut SplitMix64,
) -> Vec<Action> {
    let target = target(alley, person);
    let place = person.place_scatter_m * random.normal();
    let start = DVec2::new(target.x + place, person.stand_behind_foul_line_m);
    let yaw = yaw_towards(target - start) + (person.aim_scatter_deg * random.normal()).to_radians();
    let to_right = DQuat::from_rotation_y(yaw) * DVec3::X * person.shoulder_offset_m;
    let stand = start - DVec2::new(to_right.x, to_right.z);
    let speed = (person.ball_speed_mps + person.ball_speed_scatter_mps * random.normal()).max(1.0);
    let swing = Swing {
        shoulder: DVec3::new(person.shoulder_offset_m, person.shoulder_height_m, 0.0),
        arm_length: person.arm_length_m,
        start_angle: CARRY_ANGLE,
        backswing: person.backswing_deg.to_radians(),
        peak_rate: speed / (person.arm_length_m + GRAB_GAP + ball.radius),
        back_time: BACK_TIME,
        ball_distance: GRAB_GAP + ball.radius,
        wrist: DVec3::new(
            0.0,
            radps(person.tilt_spin_scatter_rpm) * random.normal(),
            radps(person.side_spin_scatter_rpm) * random.normal(),
        ),
    };
    let release =
        swing.time_of_lowest_point() - lateness + person.timing_scatter_s * random.normal();
    let ready = swing.hand(0.0);
    let carry = HandGoal::Body(ready.position + DVec3::Y * BEND, ready.rotation);
    vec![
        Action::Bend(0.0),
        Action::Reach(carry, 0.8),
        Action::Look(DVec3::new(target.x, 0.0, 0.5 * target.y)),
        Action::Walk(stand + DVec2::new(0.0, 0.1)),
        Action::Stand(stand, yaw),
        // Bowlers look at the arrows, not at the pins.
        Action::Look(DVec3::new(target.x, 0.0, ARROWS_Z)),
        Action::Wait(0.5),
        Action::Bend(BEND),
        Action::Reach(HandGoal::Body(ready.position, ready.rotation), 0.6),
        Action::Throw(Box::new(swing), release),
        Action::Wait(0.3),
        Action::Look(DVec3::new(target.x, 0.2, target.y)),
        Action::Bend(0.0),
        Action::Reach(relaxed_hand(person), 0.8),
    ]
}

/// Revolutions per minute in [rad/s].
fn radps(rpm: f64) -> f64 {
    rpm * std::f64::consts::TAU / 60.0
}

/// The point of the deck (x, z) that the ball is sent to.
fn target(alley: &Observation, person: &ParticipantConfig) -> DVec2 {
    let standing: Vec<DVec2> = alley
        .pins
        .iter()
        .filter(|pin| pin.is_standing)
        .map(|pin| DVec2::new(pin.position.x, pin.position.z))
        .collect();
    let head_pin = DVec2::new(alley.head_pin.x, alley.head_pin.z);
    if standing.is_empty() || standing.iter().any(|pin| pin.distance(head_pin) < PIN_SPOT) {
        return head_pin + DVec2::X * person.target_x_m;
    }
    // Without the head pin: the foremost of what is left, which may take others with it.
    let foremost = standing.iter().copied().max_by(|a, b| a.y.total_cmp(&b.y));
    foremost.unwrap_or(head_pin)
}

/// A point on the way from `from` to `spot`, within reach of it.
fn stand_before(spot: DVec2, from: DVec2) -> DVec2 {
    let way = (spot - from).try_normalize().unwrap_or(DVec2::NEG_Y);
    spot - way * REACH_DISTANCE
}
