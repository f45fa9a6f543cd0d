//! The one place that says which settings are possible.

use super::{BallConfig, Config, DisplayProfile, PinPartsConfig};

/// A key whose value is impossible.
#[derive(Debug)]
pub(super) struct Invalid {
    pub key: String,
    pub problem: String,
}

/// Range checks of one table, each under its key.
struct Table<'a> {
    name: &'a str,
}

impl Table<'_> {
    /// `value` lies from `low` to `high`; NaN and infinity never do.
    fn within(&self, key: &str, value: f64, low: f64, high: f64) -> Result<(), Invalid> {
        if (low..=high).contains(&value) {
            return Ok(());
        }
        Err(self.invalid(
            key,
            format!("{value} is out of range; give a number from {low} to {high}"),
        ))
    }

    /// As `within`, for several keys with one range.
    fn all_within(&self, values: &[(&str, f64)], low: f64, high: f64) -> Result<(), Invalid> {
        values
            .iter()
            .try_for_each(|(key, value)| self.within(key, *value, low, high))
    }

    /// `holds`, a relation between keys.
    fn ensure(&self, key: &str, holds: bool, problem: &str) -> Result<(), Invalid> {
        if holds {
            Ok(())
        } else {
            Err(self.invalid(key, problem.to_owned()))
        }
    }

    fn invalid(&self, key: &str, problem: String) -> Invalid {
        Invalid {
            key: format!("{}.{key}", self.name),
            problem,
        }
    }
}

/// Checks every value, and the relations between them.
pub(super) fn validate(config: &Config) -> Result<(), Invalid> {
    physics(config)?;
    alley(config)?;
    furniture(config)?;
    let names: Vec<String> = (0..config.balls.len())
        .map(|index| format!("balls[{index}]"))
        .collect();
    let count = Invalid {
        key: "balls".to_owned(),
        problem: format!("{} balls do not fit; give from 1 to 8", config.balls.len()),
    };
    if !(1..=8).contains(&config.balls.len()) {
        return Err(count);
    }
    names
        .iter()
        .zip(&config.balls)
        .try_for_each(|(name, ball)| self::ball(name, ball))?;
    pin(config)?;
    hand(config)?;
    rules(config)?;
    display(config)?;
    participant(config)
}

fn physics(config: &Config) -> Result<(), Invalid> {
    let table = Table { name: "physics" };
    let physics = &config.physics;
    table.within("step_hz", physics.step_hz, 60.0, 20_000.0)?;
    table.within("gravity_mps2", physics.gravity_mps2, 0.0, 100.0)?;
    table.within(
        "iteration_cap",
        f64::from(physics.iteration_cap),
        1.0,
        1000.0,
    )?;
    table.within(
        "friction_reference_s",
        physics.friction_reference_s,
        1e-5,
        10.0,
    )?;
    let table = Table { name: "objects" };
    table.within("elasticity", config.objects.elasticity, 0.0, 1.0)?;
    table.within("friction_rate", config.objects.friction_rate, 0.0, 1.0)?;
    let table = Table { name: "tracking" };
    table.within("rate_hz", config.tracking.rate_hz, 20.0, 1000.0)?;
    let steps = physics.step_hz / config.tracking.rate_hz;
    let whole = (steps - steps.round()).abs() < 1e-9 && steps >= 1.0;
    table.ensure(
        "rate_hz",
        whole,
        "must divide physics.step_hz, so that a frame is a whole number of steps",
    )
}

fn alley(config: &Config) -> Result<(), Invalid> {
    let table = Table { name: "lane" };
    let lane = &config.lane;
    table.within("width_m", lane.width_m, 0.5, 3.0)?;
    table.within("boards", f64::from(lane.boards), 1.0, 200.0)?;
    table.within("thickness_m", lane.thickness_m, 0.1, 1.0)?;
    table.within("headpin_z_m", lane.headpin_z_m, -60.0, -3.0)?;
    table.within("deck_end_z_m", lane.deck_end_z_m, -62.0, -3.0)?;
    table.within("pin_spacing_m", lane.pin_spacing_m, 0.15, 1.0)?;
    table.within("row_pitch_m", lane.row_pitch_m, 0.13, 1.0)?;
    let rear = lane.headpin_z_m - 3.0 * lane.row_pitch_m;
    table.ensure(
        "deck_end_z_m",
        lane.deck_end_z_m < rear,
        "must lie behind the last row of pins",
    )?;
    let rack = 3.0 * lane.pin_spacing_m;
    table.ensure(
        "width_m",
        lane.width_m > rack,
        "must be more than three times lane.pin_spacing_m",
    )?;

    let table = Table { name: "gutter" };
    table.within("width_m", config.gutter.width_m, 0.1, 1.0)?;
    table.within(
        "depth_m",
        config.gutter.depth_m,
        0.01,
        config.gutter.width_m / 2.0,
    )?;
    table.within("facets", f64::from(config.gutter.facets), 3.0, 32.0)?;
    table.within("depth_at_deck_m", config.gutter.depth_at_deck_m, 0.01, 0.5)?;
    table.within(
        "flat_starts_before_headpin_m",
        config.gutter.flat_starts_before_headpin_m,
        0.0,
        2.0,
    )?;

    let table = Table { name: "kickback" };
    table.within("height_m", config.kickback.height_m, 0.05, 2.0)?;
    table.within("thickness_m", config.kickback.thickness_m, 0.01, 0.3)?;
    table.within(
        "starts_before_headpin_m",
        config.kickback.starts_before_headpin_m,
        0.0,
        2.0,
    )?;

    let table = Table { name: "pit" };
    table.within(
        "floor_below_deck_m",
        config.pit.floor_below_deck_m,
        0.0,
        1.0,
    )?;
    table.within(
        "cushion_behind_deck_m",
        config.pit.cushion_behind_deck_m,
        0.4,
        5.0,
    )?;
    table.within(
        "cushion_thickness_m",
        config.pit.cushion_thickness_m,
        0.05,
        1.0,
    )?;
    table.within("cushion_height_m", config.pit.cushion_height_m, 0.2, 3.0)
}

fn furniture(config: &Config) -> Result<(), Invalid> {
    let room = &config.room;
    let table = Table { name: "room" };
    let beside = config.lane.width_m / 2.0 + config.gutter.width_m + 0.2;
    table.within("half_width_m", room.half_width_m, beside, 20.0)?;
    table.within("depth_m", room.depth_m, 2.0, 30.0)?;
    table.within("height_m", room.height_m, 2.0, 20.0)?;
    table.within("walk_margin_m", room.walk_margin_m, 0.05, 1.0)?;
    table.within(
        "approach_length_m",
        room.approach_length_m,
        1.0,
        room.depth_m,
    )?;
    table.within("foul_line_width_m", room.foul_line_width_m, 0.002, 0.1)?;

    let (side, depth) = (
        room.half_width_m - room.walk_margin_m,
        room.depth_m - room.walk_margin_m,
    );
    let start = Table { name: "start" };
    start.within("x_m", config.start.x_m, -side, side)?;
    start.within("z_m", config.start.z_m, 0.0, depth)?;

    let table = Table { name: "rack" };
    let rack = &config.rack;
    table.within("x_m", rack.x_m, -side, side)?;
    table.within("z_m", rack.z_m, 0.3, depth)?;
    table.within("tray_height_m", rack.tray_height_m, 0.1, 1.5)?;
    table.within("rim_height_m", rack.rim_height_m, 0.005, 0.1)?;
    table.within("rim_thickness_m", rack.rim_thickness_m, 0.005, 0.1)?;
    table.within("clearance_m", rack.clearance_m, 0.001, 0.05)?;

    let table = Table { name: "desk" };
    let desk = &config.desk;
    table.within("x_m", desk.x_m, -side, side)?;
    table.within("z_m", desk.z_m, 0.3, depth)?;
    table.within("height_m", desk.height_m, 0.3, 1.6)?;
    table.within("width_m", desk.width_m, 0.2, 3.0)?;
    table.within("depth_m", desk.depth_m, 0.1, 2.0)?;
    table.within("button_radius_m", desk.button_radius_m, 0.01, 0.3)?;
    table.within(
        "button_spacing_m",
        desk.button_spacing_m,
        2.0 * desk.button_radius_m,
        2.0,
    )?;
    table.within("button_travel_m", desk.button_travel_m, 0.005, 0.2)?;
    table.within("button_press_at", desk.button_press_at, 0.1, 0.9)
}

fn ball(name: &str, ball: &BallConfig) -> Result<(), Invalid> {
    let table = Table { name };
    table.within("diameter_m", ball.diameter_m, 0.05, 0.4)?;
    table.within("mass_kg", ball.mass_kg, 0.1, 50.0)?;
    // A hollow shell has sqrt(2/3) of the radius; no body of that size has more.
    table.within(
        "rg_m",
        ball.rg_m,
        0.05 * ball.diameter_m,
        0.41 * ball.diameter_m,
    )
}

fn pin(config: &Config) -> Result<(), Invalid> {
    let table = Table { name: "pin" };
    let pin = &config.pin;
    table.within("mass_kg", pin.mass_kg, 0.1, 20.0)?;
    table.within("height_m", pin.height_m, 0.1, 1.0)?;
    table.within(
        "cg_height_m",
        pin.cg_height_m,
        0.1 * pin.height_m,
        0.9 * pin.height_m,
    )?;
    table.all_within(
        &[
            ("i_axial_kgm2", pin.i_axial_kgm2),
            ("i_transverse_kgm2", pin.i_transverse_kgm2),
        ],
        1e-6,
        10.0,
    )?;
    let possible = pin.i_axial_kgm2 < 2.0 * pin.i_transverse_kgm2;
    table.ensure(
        "i_axial_kgm2",
        possible,
        "must be less than twice pin.i_transverse_kgm2, as in any solid",
    )?;
    pin_parts(&pin.parts, pin.height_m)?;
    let table = Table {
        name: "pin.ellipsoid",
    };
    table.within("radius_m", pin.ellipsoid.radius_m, 0.01, 0.5)?;
    // Its flat lies at the base, below its middle: so it is longer than half the pin and shorter than the pin.
    let (low, high) = (0.501 * pin.height_m, 0.999 * pin.height_m);
    table.within("half_length_m", pin.ellipsoid.half_length_m, low, high)
}

fn pin_parts(parts: &PinPartsConfig, height: f64) -> Result<(), Invalid> {
    let table = Table { name: "pin.parts" };
    let radii = [
        ("base_radius_m", parts.base_radius_m),
        ("foot_radius_m", parts.foot_radius_m),
        ("belly_radius_m", parts.belly_radius_m),
        ("belly_half_length_m", parts.belly_half_length_m),
        ("shoulder_radius_m", parts.shoulder_radius_m),
        ("neck_radius_m", parts.neck_radius_m),
        ("throat_radius_m", parts.throat_radius_m),
        ("head_radius_m", parts.head_radius_m),
    ];
    table.all_within(&radii, 0.001, height)?;
    let mut below = 0.0;
    for (key, value) in [
        ("foot_height_m", parts.foot_height_m),
        ("belly_height_m", parts.belly_height_m),
        ("shoulder_height_m", parts.shoulder_height_m),
        ("neck_height_m", parts.neck_height_m),
        ("throat_height_m", parts.throat_height_m),
    ] {
        table.within(key, value, 0.001, height)?;
        table.ensure(key, value > below, "must lie higher than the part below it")?;
        below = value;
    }
    let top = height - parts.head_radius_m;
    table.within(
        "head_height_m",
        parts.head_height_m,
        parts.neck_height_m,
        top + 0.01,
    )?;
    let lowest = parts.belly_height_m - parts.belly_half_length_m;
    table.ensure(
        "belly_half_length_m",
        lowest > 0.0,
        "must not let the belly reach below the base",
    )
}

fn hand(config: &Config) -> Result<(), Invalid> {
    let table = Table { name: "hand" };
    let hand = &config.hand;
    table.within("radius_m", hand.radius_m, 0.01, 0.2)?;
    table.within("reach_m", hand.reach_m, hand.radius_m, 1.0)?;
    table.within("trigger_close", hand.trigger_close, 0.05, 1.0)?;
    table.within("trigger_open", hand.trigger_open, 0.0, hand.trigger_close)?;
    let apart = hand.trigger_open < hand.trigger_close;
    table.ensure(
        "trigger_open",
        apart,
        "must be less than hand.trigger_close, or the grip chatters",
    )?;
    table.within("jump_speed_mps", hand.jump_speed_mps, 5.0, 1000.0)?;
    let table = Table { name: "walking" };
    table.within("speed_mps", config.walking.speed_mps, 0.1, 5.0)?;
    table.within("ramp_s", config.walking.ramp_s, 0.0, 5.0)?;
    let table = Table { name: "release" };
    table.within("window_s", config.release.window_s, 0.02, 0.5)
}

fn rules(config: &Config) -> Result<(), Invalid> {
    let table = Table { name: "rules" };
    let rules = &config.rules;
    table.within("down_lean_deg", rules.down_lean_deg, 5.0, 89.0)?;
    table.within("left_deck_below_m", rules.left_deck_below_m, 0.005, 0.5)?;
    table.within("against_kickback_m", rules.against_kickback_m, 0.0, 0.1)?;
    table.within("still_speed_mps", rules.still_speed_mps, 0.001, 1.0)?;
    table.within("rocking_lean_deg", rules.rocking_lean_deg, 0.0, 5.0)?;
    table.within("rocking_turn_radps", rules.rocking_turn_radps, 0.0, 0.6)?;
    table.within("still_for_s", rules.still_for_s, 0.0, 10.0)?;
    table.within("end_after_headpin_s", rules.end_after_headpin_s, 1.0, 120.0)?;
    table.within(
        "end_after_foul_line_s",
        rules.end_after_foul_line_s,
        2.0,
        600.0,
    )?;
    table.within("confirm_within_s", rules.confirm_within_s, 0.5, 60.0)?;
    table.within("disturbed_pin_m", rules.disturbed_pin_m, 0.001, 1.0)?;
    table.within("stray_ball_s", rules.stray_ball_s, 1.0, 600.0)?;
    table.within(
        "impact_reported_from_mps",
        rules.impact_reported_from_mps,
        0.0,
        100.0,
    )?;
    let table = Table { name: "pinsetter" };
    let machine = &config.pinsetter;
    let durations = [
        ("pause_s", machine.pause_s),
        ("lift_s", machine.lift_s),
        ("bar_drop_s", machine.bar_drop_s),
        ("sweep_s", machine.sweep_s),
        ("set_s", machine.set_s),
        ("pit_clears_after_s", machine.pit_clears_after_s),
        ("ball_return_s", machine.ball_return_s),
        ("ball_lift_s", machine.ball_lift_s),
    ];
    table.all_within(&durations, 0.05, 60.0)?;
    table.within(
        "lift_height_m",
        machine.lift_height_m,
        config.pin.height_m,
        2.0,
    )?;
    table.within("bar_height_m", machine.bar_height_m, 0.05, 0.6)?;
    let clear = config.pin.height_m;
    table.within("bar_rest_height_m", machine.bar_rest_height_m, clear, 2.0)?;
    let over = machine.lift_height_m > machine.bar_height_m;
    table.ensure(
        "bar_height_m",
        over,
        "must be less than pinsetter.lift_height_m, or the bar strikes lifted pins",
    )
}

fn display(config: &Config) -> Result<(), Invalid> {
    let table = Table { name: "display" };
    let display = &config.display;
    table.within("eye_distance_m", display.eye_distance_m, 0.0, 0.1)?;
    profile("display.modern", &display.modern)?;
    profile("display.1996", &display.of_1996)
}

fn profile(name: &str, profile: &DisplayProfile) -> Result<(), Invalid> {
    let table = Table { name };
    let angles = [
        ("outer_deg", profile.outer_deg),
        ("inner_deg", profile.inner_deg),
        ("up_deg", profile.up_deg),
        ("down_deg", profile.down_deg),
    ];
    table.all_within(&angles, 1.0, 80.0)?;
    let sizes = [
        ("width_px", profile.width_px),
        ("height_px", profile.height_px),
        ("relayed_width_px", profile.relayed_width_px),
        ("relayed_height_px", profile.relayed_height_px),
    ];
    sizes
        .iter()
        .try_for_each(|(key, value)| table.within(key, f64::from(*value), 16.0, 8192.0))
}

fn participant(config: &Config) -> Result<(), Invalid> {
    let table = Table {
        name: "participant",
    };
    let person = &config.participant;
    table.within("eye_height_m", person.eye_height_m, 0.8, 2.2)?;
    table.within("shoulder_height_m", person.shoulder_height_m, 0.5, 2.0)?;
    table.within("arm_length_m", person.arm_length_m, 0.3, 1.0)?;
    table.within("shoulder_offset_m", person.shoulder_offset_m, -0.5, 0.5)?;
    table.within("backswing_deg", person.backswing_deg, 5.0, 120.0)?;
    table.within("ball_speed_mps", person.ball_speed_mps, 1.0, 15.0)?;
    table.within(
        "ball_speed_scatter_mps",
        person.ball_speed_scatter_mps,
        0.0,
        5.0,
    )?;
    table.within("aim_scatter_deg", person.aim_scatter_deg, 0.0, 20.0)?;
    table.within("place_scatter_m", person.place_scatter_m, 0.0, 0.5)?;
    table.within("timing_scatter_s", person.timing_scatter_s, 0.0, 0.2)?;
    table.within(
        "stand_behind_foul_line_m",
        person.stand_behind_foul_line_m,
        0.0,
        3.0,
    )?;
    table.within("target_x_m", person.target_x_m, -1.0, 1.0)
}
