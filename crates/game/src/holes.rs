//! How a ball looks in the hand: its finger holes lie under the fingers. Of the picture alone: the body turns by nothing.

use glam::{DMat3, DQuat, DVec2, DVec3, Vec2Swizzles};
use physics::Pose;

/// Half the angle between the finger holes' middle and the thumb hole, seen from the ball's centre [rad]: a span of 88 mm on
/// the surface, that of a middling hand.
pub const HALF_SPAN: f64 = 0.4;

/// Where the fingers enter a ball under the palm, from the ball's centre, in a right hand's frame (x right, y from the palm's back,
/// -z along the fingers): between middle and ring finger, and at the thumb.
pub const FINGERS_IN_HAND: DVec3 = DVec3::new(0.0, 0.769, -0.639);
/// See [`FINGERS_IN_HAND`].
pub const THUMB_IN_HAND: DVec3 = DVec3::new(-0.438, 0.899, 0.0);

/// `world_from_hand` of the hand as it is drawn on a ball that it holds: its palm on the surface, at the side of the ball at which
/// the tracked hand is, its fingers as nearly along the tracked ones as that allows.
pub fn hand_on_ball(hand: &Pose, ball_centre: DVec3, ball_radius: f64, palm: f64) -> Pose {
    let away = (hand.position - ball_centre)
        .try_normalize()
        .unwrap_or(hand.rotation * DVec3::Y);
    let forward = hand.rotation * DVec3::NEG_Z;
    let along = (forward - away * forward.dot(away))
        .try_normalize()
        .unwrap_or_else(|| away.any_orthonormal_vector());
    let rotation = DQuat::from_mat3(&DMat3::from_cols(along.cross(away), away, -along));
    Pose::new(ball_centre + away * (ball_radius + palm), rotation)
}

/// Rotation of the ball's model, whose finger holes lie at `HALF_SPAN` above its +x and whose thumb hole at as much below, that
/// brings the holes under the fingers of the hand as [`hand_on_ball`] has it.
pub(crate) fn world_from_model(hand: &Pose, is_left: bool, ball_centre: DVec3) -> DQuat {
    let drawn = hand_on_ball(hand, ball_centre, 1.0, 0.0);
    drawn.rotation * hand_from_model(is_left)
}

/// A left hand is a right one's mirror image; the ball's holes are the same on both sides of the plane through fingers and thumb.
fn hand_from_model(is_left: bool) -> DQuat {
    let side = if is_left { -1.0 } else { 1.0 };
    let in_hand = |right: DVec3| DVec3::new(side * right.x, right.y, right.z);
    let frame = |fingers: DVec3, thumb: DVec3| {
        let out = (fingers + thumb).try_normalize().unwrap_or(DVec3::Y);
        let across = fingers.cross(thumb).try_normalize().unwrap_or(DVec3::X);
        DMat3::from_cols(out, across, out.cross(across))
    };
    let (sin, cos) = DVec2::from_angle(HALF_SPAN).yx().into();
    let model = frame(DVec3::new(cos, sin, 0.0), DVec3::new(cos, -sin, 0.0));
    let hand = frame(in_hand(FINGERS_IN_HAND), in_hand(THUMB_IN_HAND));
    DQuat::from_mat3(&(hand * model.transpose()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_come_to_lie_under_the_fingers() {
        let centre = DVec3::new(1.0, 0.8, 1.9);
        let hand = Pose::new(
            centre + DVec3::new(0.03, 0.16, 0.05),
            DQuat::from_rotation_y(0.4) * DQuat::from_rotation_x(-0.2),
        );
        let drawn = hand_on_ball(&hand, centre, 0.1085, 0.018);
        assert!(((drawn.position - centre).length() - 0.1265).abs() < 1e-12);
        let ahead = drawn.rotation * DVec3::NEG_Z;
        // As far as a palm on the ball's far side can point where the hand points: 25 degrees of it are the ball's slope.
        assert!(ahead.dot(hand.rotation * DVec3::NEG_Z) > 0.8, "{ahead}");
        let (sin, cos) = DVec2::from_angle(HALF_SPAN).yx().into();
        for (is_left, mirror) in [(false, DVec3::ONE), (true, DVec3::new(-1.0, 1.0, 1.0))] {
            let model = world_from_model(&hand, is_left, centre);
            for (hole, finger) in [(sin, FINGERS_IN_HAND), (-sin, THUMB_IN_HAND)] {
                let hole = model * DVec3::new(cos, hole, 0.0);
                let finger = drawn.rotation * (mirror * finger);
                // The fingers' span is that of the holes to a millimetre and a half on the surface.
                assert!(hole.distance(finger) < 0.014, "{is_left}: {hole} {finger}");
            }
        }
    }
}
