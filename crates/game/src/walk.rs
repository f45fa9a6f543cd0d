//! Walking with the two thumb buttons: the tracking space moves through the room along the head's heading.

use glam::DVec3;
use physics::Pose;

use crate::Game;
use crate::alley;
use crate::config::Config;
use crate::input::Input;

/// A heading shorter than this [1] comes from a head that looks straight up or down.
const LEVEL: f64 = 0.1;

impl Game {
    /// Moves the tracking space for this frame. Without a tracked head there is no heading and nobody walks.
    pub(crate) fn walk(&mut self, input: &Input) {
        let seconds = f64::from(input.steps) / self.room.config.physics.step_hz;
        let Some(head) = self.head.filter(|_| input.steps > 0) else {
            self.walking_speed = 0.0;
            self.rig_velocity = DVec3::ZERO;
            return;
        };
        let wanted = f64::from(input.walk_forward) - f64::from(input.walk_back);
        self.walking_speed = ramp(&self.room.config, self.walking_speed, wanted, seconds);
        let head = self.world_from_tracking * head.pose;
        let way = heading(head) * self.walking_speed * seconds;
        let way = within_walls(&self.room.config, head.position, way);
        self.world_from_tracking.position += way;
        self.rig_velocity = way / seconds;
    }
}

/// Speed [m/s] after `seconds`: `wanted` is -1, 0 or 1.
fn ramp(config: &Config, speed: f64, wanted: f64, seconds: f64) -> f64 {
    let walking = &config.walking;
    let target = wanted * walking.speed_mps;
    if walking.ramp_s == 0.0 {
        return target;
    }
    let change = walking.speed_mps / walking.ramp_s * seconds;
    speed + (target - speed).clamp(-change, change)
}

/// Horizontal unit vector that the head faces along; a head that looks at its feet faces where its crown points.
fn heading(head: Pose) -> DVec3 {
    let level = |axis: DVec3| {
        let axis = head.rotation * axis;
        DVec3::new(axis.x, 0.0, axis.z)
    };
    let forward = level(DVec3::NEG_Z);
    let down = (head.rotation * DVec3::NEG_Z).y < 0.0;
    let crown = level(if down { DVec3::Y } else { DVec3::NEG_Y });
    let way = if forward.length() > LEVEL {
        forward
    } else {
        crown
    };
    way.try_normalize().unwrap_or(DVec3::NEG_Z)
}

/// The part of a way that keeps the head off the walls. Who has really walked beyond them can still walk back.
fn within_walls(config: &Config, head: DVec3, way: DVec3) -> DVec3 {
    let margin = config.room.walk_margin_m;
    let side = config.room.half_width_m - margin;
    let (front, back) = (
        alley::cushion_z(config) + margin,
        config.room.depth_m - margin,
    );
    let axis = |at: f64, step: f64, low: f64, high: f64| {
        if step > 0.0 {
            step.min((high - at).max(0.0))
        } else {
            step.max((low - at).min(0.0))
        }
    };
    DVec3::new(
        axis(head.x, way.x, -side, side),
        0.0,
        axis(head.z, way.z, front, back),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::tests::default_config;
    use glam::DQuat;

    #[test]
    fn heading_ignores_where_the_head_nods() {
        for pitch in [-1.5, -0.7, 0.0, 0.7, 1.5] {
            let head = Pose::new(
                DVec3::Y,
                DQuat::from_rotation_y(0.5) * DQuat::from_rotation_x(pitch),
            );
            let expected = DQuat::from_rotation_y(0.5) * DVec3::NEG_Z;
            assert!((heading(head) - expected).length() < 1e-9, "{pitch}");
        }
    }

    #[test]
    fn ramp_reaches_full_speed_in_the_time_given() {
        let config = default_config();
        let mut speed = 0.0;
        for _ in 0..27 {
            speed = ramp(&config, speed, 1.0, 1.0 / 90.0);
            assert!(speed <= config.walking.speed_mps);
        }
        assert!((speed - config.walking.speed_mps).abs() < 1e-9);
        assert!(ramp(&config, speed, 0.0, 1.0 / 90.0) > 0.9 * speed);
    }

    #[test]
    fn walls_stop_only_what_goes_towards_them() {
        let config = default_config();
        let at = DVec3::new(2.4, 1.6, 2.0);
        assert_eq!(within_walls(&config, at, DVec3::X), DVec3::ZERO);
        assert_eq!(
            within_walls(&config, at, DVec3::new(-0.1, 0.0, 0.1)),
            DVec3::new(-0.1, 0.0, 0.1)
        );
        let way = within_walls(&config, DVec3::new(0.0, 1.6, 5.0), DVec3::Z * 3.0);
        assert!((way.z - 0.7).abs() < 1e-12);
    }
}
