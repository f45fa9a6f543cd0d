//! Which balls, pins and hands are possible.

use super::{Invalid, limited, ranges, relation};
use crate::config::{BallConfig, Config, PinConfig};

/// The balls on the rack.
pub(super) fn balls(config: &Config) -> Result<(), Invalid> {
    let count = config.balls.len();
    if !(1..=8).contains(&count) {
        return Err(Invalid {
            key: "balls".to_owned(),
            related: Vec::new(),
            problem: format!("{count} balls do not fit; give from 1 to 8"),
        });
    }
    let mut numbered = config.balls.iter().enumerate();
    numbered.try_for_each(|(index, one)| ball(&format!("balls[{index}]"), one))
}

fn ball(table: &str, ball: &BallConfig) -> Result<(), Invalid> {
    // A hollow shell has sqrt(2/3) of the radius; no body of that size has more.
    let (least, most) = (0.05 * ball.diameter_m, 0.41 * ball.diameter_m);
    ranges(
        table,
        &[
            ("diameter_m", ball.diameter_m, 0.05, 0.4),
            ("mass_kg", ball.mass_kg, 0.1, 50.0),
            ("rg_m", ball.rg_m, least, most),
            ("drag_area_m2", ball.drag_area_m2, 0.0, 1.0),
        ],
    )
}

/// The pins, in both shapes.
pub(super) fn pin(pin: &PinConfig) -> Result<(), Invalid> {
    let height = pin.height_m;
    ranges(
        "pin",
        &[
            ("mass_kg", pin.mass_kg, 0.1, 20.0),
            ("height_m", height, 0.1, 1.0),
            ("drag_area_m2", pin.drag_area_m2, 0.0, 1.0),
            ("i_axial_kgm2", pin.i_axial_kgm2, 1e-6, 10.0),
            ("i_transverse_kgm2", pin.i_transverse_kgm2, 1e-6, 10.0),
        ],
    )?;
    let cg = ("cg_height_m", pin.cg_height_m, 0.1 * height, 0.9 * height);
    limited("pin", cg, &["pin.height_m"])?;
    relation(
        "pin",
        "i_axial_kgm2",
        &["pin.i_transverse_kgm2"],
        pin.i_axial_kgm2 < 2.0 * pin.i_transverse_kgm2,
        "must be less than twice pin.i_transverse_kgm2, as in any solid",
    )?;
    pin_parts(pin)?;
    let ellipsoid = &pin.ellipsoid;
    ranges(
        "pin.ellipsoid",
        &[("radius_m", ellipsoid.radius_m, 0.01, 0.5)],
    )?;
    // Its flat lies at the base, below its middle: so it is longer than half the pin and shorter than the pin.
    let (low, high) = (0.501 * height, 0.999 * height);
    limited(
        "pin.ellipsoid",
        ("half_length_m", ellipsoid.half_length_m, low, high),
        &["pin.height_m"],
    )
}

fn pin_parts(pin: &PinConfig) -> Result<(), Invalid> {
    let (parts, height) = (&pin.parts, pin.height_m);
    let table = "pin.parts";
    for (key, radius) in [
        ("base_radius_m", parts.base_radius_m),
        ("foot_radius_m", parts.foot_radius_m),
        ("belly_radius_m", parts.belly_radius_m),
        ("belly_half_length_m", parts.belly_half_length_m),
        ("shoulder_radius_m", parts.shoulder_radius_m),
        ("neck_radius_m", parts.neck_radius_m),
        ("throat_radius_m", parts.throat_radius_m),
        ("head_radius_m", parts.head_radius_m),
    ] {
        limited(table, (key, radius, 0.001, height), &["pin.height_m"])?;
    }
    part_heights(pin)?;
    let top = height - parts.head_radius_m + 0.01;
    limited(
        table,
        (
            "head_height_m",
            parts.head_height_m,
            parts.neck_height_m,
            top,
        ),
        &[
            "pin.parts.neck_height_m",
            "pin.parts.head_radius_m",
            "pin.height_m",
        ],
    )?;
    relation(
        table,
        "belly_half_length_m",
        &["pin.parts.belly_height_m"],
        parts.belly_height_m > parts.belly_half_length_m,
        "must not let the belly reach below the base",
    )
}

/// Each part begins higher than the one below it.
fn part_heights(pin: &PinConfig) -> Result<(), Invalid> {
    let (table, parts) = ("pin.parts", &pin.parts);
    let (mut below, mut lowest) = (None, 0.0);
    for (name, height) in [
        ("pin.parts.foot_height_m", parts.foot_height_m),
        ("pin.parts.belly_height_m", parts.belly_height_m),
        ("pin.parts.shoulder_height_m", parts.shoulder_height_m),
        ("pin.parts.neck_height_m", parts.neck_height_m),
        ("pin.parts.throat_height_m", parts.throat_height_m),
    ] {
        let key = name.trim_start_matches("pin.parts.");
        let range = (key, height, 0.001, pin.height_m);
        limited(table, range, &["pin.height_m"])?;
        let problem = "must lie higher than the part below it";
        relation(table, key, below.as_slice(), height > lowest, problem)?;
        (below, lowest) = (Some(name), height);
    }
    Ok(())
}

/// The hand, walking, and the estimate of a release.
pub(super) fn hand(config: &Config) -> Result<(), Invalid> {
    let (hand, walking) = (&config.hand, &config.walking);
    ranges(
        "hand",
        &[
            ("radius_m", hand.radius_m, 0.01, 0.2),
            ("trigger_close", hand.trigger_close, 0.05, 1.0),
            ("trigger_open", hand.trigger_open, 0.0, 1.0),
            ("jump_speed_mps", hand.jump_speed_mps, 5.0, 1000.0),
            ("lost_grip_s", hand.lost_grip_s, 0.0, 60.0),
        ],
    )?;
    let reach = ("reach_m", hand.reach_m, hand.radius_m, 1.0);
    limited("hand", reach, &["hand.radius_m"])?;
    relation(
        "hand",
        "trigger_open",
        &["hand.trigger_close"],
        hand.trigger_open < hand.trigger_close,
        "must be less than hand.trigger_close, or the grip chatters",
    )?;
    ranges(
        "walking",
        &[
            ("speed_mps", walking.speed_mps, 0.1, 5.0),
            ("ramp_s", walking.ramp_s, 0.0, 5.0),
            ("furniture_margin_m", walking.furniture_margin_m, 0.0, 0.5),
        ],
    )?;
    ranges(
        "release",
        &[
            ("window_s", config.release.window_s, 0.02, 0.5),
            ("assist_share", config.release.assist_share, 0.0, 1.0),
        ],
    )
}
