//! Walking with the two thumb buttons: the tracking space moves through the room along the head's heading.

use glam::{DVec2, DVec3};
use physics::Pose;

use crate::Game;
use crate::alley::{self, Footprint};
use crate::config::Config;
use crate::input::Input;

/// A head that is no deeper than this in a margin stands at its edge [m]: rounding puts it on either side.
const GRAZE: f64 = 1e-9;

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
        let way = around_furniture(&self.room.config, head.position, way);
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
pub(crate) fn heading(head: Pose) -> DVec3 {
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

/// The part of a way that keeps the head from walking through rack and desk: it slides along them.
fn around_furniture(config: &Config, head: DVec3, way: DVec3) -> DVec3 {
    let margin = DVec2::splat(config.walking.furniture_margin_m);
    let mut step = DVec2::new(way.x, way.z);
    for Footprint { low, high } in alley::footprints(config) {
        step = beside(
            low - margin,
            high + margin,
            DVec2::new(head.x, head.z),
            step,
        );
    }
    DVec3::new(step.x, way.y, step.y)
}

/// The part of a step from `at` that does not enter a rectangle; one axis after the other, so that it slides.
///
/// Who has really leaned or stepped inside gets no deeper by walking: only the way to the nearest side is one-way.
fn beside(low: DVec2, high: DVec2, at: DVec2, step: DVec2) -> DVec2 {
    let inside = (at - low).min(high - at);
    if inside.min_element() > GRAZE {
        let axis = if inside.x < inside.y { 0 } else { 1 };
        let mut step = step;
        if (at[axis] - 0.5 * (low[axis] + high[axis])) * step[axis] < 0.0 {
            step[axis] = 0.0;
        }
        return step;
    }
    let mut at = at;
    let mut taken = DVec2::ZERO;
    for (axis, other) in [(0, 1), (1, 0)] {
        let is_abreast = at[other] > low[other] + GRAZE && at[other] < high[other] - GRAZE;
        let (mut least, mut most) = (f64::NEG_INFINITY, f64::INFINITY);
        if is_abreast && at[axis] <= low[axis] + GRAZE {
            most = (low[axis] - at[axis]).max(0.0);
        } else if is_abreast {
            least = (high[axis] - at[axis]).min(0.0);
        }
        taken[axis] = step[axis].clamp(least, most);
        at[axis] += taken[axis];
    }
    taken
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
        let at = DVec3::new(config.room.half_width_m - 0.1, 1.6, 2.0);
        assert_eq!(within_walls(&config, at, DVec3::X), DVec3::ZERO);
        assert_eq!(
            within_walls(&config, at, DVec3::new(-0.1, 0.0, 0.1)),
            DVec3::new(-0.1, 0.0, 0.1)
        );
        let way = within_walls(&config, DVec3::new(0.0, 1.6, 5.0), DVec3::Z * 3.0);
        assert!((way.z - 0.5).abs() < 1e-12);
    }

    /// Walks straight on from a point for some frames; returns where it ends.
    fn walked(config: &Config, from: DVec2, way: DVec2, frames: u32) -> DVec2 {
        let mut at = DVec3::new(from.x, 1.6, from.y);
        for _ in 0..frames {
            at += around_furniture(config, at, DVec3::new(way.x, 0.0, way.y));
        }
        DVec2::new(at.x, at.z)
    }

    #[test]
    fn furniture_stops_who_walks_at_it_from_any_side_at_any_speed() {
        let config = default_config();
        let margin = config.walking.furniture_margin_m;
        for Footprint { low, high } in alley::footprints(&config) {
            let middle = (low + high) / 2.0;
            for way in [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y] {
                let half = 0.5 * (high - low).dot(way.abs()) + margin;
                for pace in [0.013, 0.4, 5.0] {
                    let end = walked(&config, middle - way * 2.0, way * pace, 200);
                    let gap = (middle - end).dot(way) - half;
                    assert!(gap.abs() < 1e-9, "{way} at {pace}: {gap}");
                }
            }
        }
    }

    #[test]
    fn who_walks_at_furniture_askew_slides_along_it_and_past() {
        let config = default_config();
        let margin = config.walking.furniture_margin_m;
        for Footprint { low, high } in alley::footprints(&config) {
            let beside = DVec2::new(low.x - margin - 0.3, high.y + 0.05);
            let end = walked(&config, beside, DVec2::new(0.01, -0.01), 50);
            assert!((end.x - (low.x - margin)).abs() < 1e-9, "{end}");
            assert!((end.y - (beside.y - 0.5)).abs() < 1e-9, "{end}");
            // Past its end the way is free again.
            let end = walked(&config, end, DVec2::new(0.01, -0.01), 150);
            assert!(end.x > high.x, "{end}");
        }
    }

    #[test]
    fn who_leans_into_furniture_gets_no_deeper_and_always_out() {
        let config = default_config();
        let margin = DVec2::splat(config.walking.furniture_margin_m);
        for Footprint { low, high } in alley::footprints(&config) {
            let (low, high) = (low - margin, high + margin);
            for share in [0.02, 0.3, 0.5, 0.9] {
                let at = low + (high - low) * DVec2::new(share, 0.37);
                let depth = |at: DVec2| (at - low).min(high - at).min_element();
                let mut ways_out = 0;
                for turn in 0..16 {
                    let way = DVec2::from_angle(f64::from(turn) * std::f64::consts::PI / 8.0);
                    let mut end = at;
                    for _ in 0..400 {
                        let next = walked(&config, end, way * 0.01, 1);
                        let no_deeper = depth(next) <= depth(end).max(0.0) + 1e-9;
                        assert!(no_deeper, "{at} by {way}: {end} to {next}");
                        end = next;
                    }
                    ways_out += u32::from(depth(end) <= 1e-9);
                }
                assert!(ways_out >= 7, "{at}: {ways_out} of 16 ways lead out");
            }
        }
    }
}
