//! Which steps, rules, machines, displays and scripted participants are possible.

use super::{Invalid, limited, ranges, relation};
use crate::config::{
    Config, CoulombConfig, DisplayProfile, GuidanceConfig, PracticeConfig, SoundConfig,
};

/// How the world steps, of what it is made, and how often it is looked at.
pub(super) fn physics(config: &Config) -> Result<(), Invalid> {
    let (physics, rate) = (&config.physics, config.tracking.rate_hz);
    ranges(
        "physics",
        &[
            ("step_hz", physics.step_hz, 60.0, 20_000.0),
            ("gravity_mps2", physics.gravity_mps2, 0.0, 100.0),
            (
                "iteration_cap",
                f64::from(physics.iteration_cap),
                1.0,
                1000.0,
            ),
            (
                "rolling_resistance_m",
                physics.rolling_resistance_m,
                0.0,
                0.05,
            ),
            ("air_density_kgpm3", physics.air_density_kgpm3, 0.0, 10.0),
            (
                "friction_reference_s",
                physics.friction_reference_s,
                1e-5,
                10.0,
            ),
        ],
    )?;
    ranges(
        "objects",
        &[
            ("elasticity", config.objects.elasticity, 0.0, 1.0),
            ("friction_rate", config.objects.friction_rate, 0.0, 1.0),
        ],
    )?;
    coulomb(&config.coulomb)?;
    oil(config)?;
    ranges("tracking", &[("rate_hz", rate, 20.0, 1000.0)])?;
    let steps = physics.step_hz / rate;
    relation(
        "tracking",
        "rate_hz",
        &["physics.step_hz"],
        (steps - steps.round()).abs() < 1e-9 && steps >= 1.0,
        "must divide physics.step_hz, so that a frame is a whole number of steps",
    )
}

/// Halls that ring, and levels that a card can play.
pub(super) fn sound(sound: &SoundConfig) -> Result<(), Invalid> {
    ranges(
        "sound",
        &[
            ("full_scale_pa", sound.full_scale_pa, 0.01, 1000.0),
            ("hall_width_m", sound.hall_width_m, 2.0, 200.0),
            ("hall_height_m", sound.hall_height_m, 2.0, 30.0),
            ("hall_length_m", sound.hall_length_m, 5.0, 200.0),
            ("reverberation_s", sound.reverberation_s, 0.1, 5.0),
            ("lookahead_s", sound.lookahead_s, 0.0, 0.5),
        ],
    )
}

/// Words that can be looked for.
pub(super) fn guidance(guidance: &GuidanceConfig) -> Result<(), Invalid> {
    relation(
        "guidance",
        "words",
        &[],
        !guidance.words.trim().is_empty(),
        "must name a file of the folder config, such as \"words.toml\"",
    )
}

/// Gestures that can be made, fences that can be seen.
pub(super) fn comfort(config: &Config) -> Result<(), Invalid> {
    let (body, comfort) = (&config.calibration, &config.comfort);
    ranges(
        "calibration",
        &[
            ("hold_s", body.hold_s, 0.2, 10.0),
            ("still_m", body.still_m, 0.005, 0.5),
            ("seated_below_m", body.seated_below_m, 0.5, 2.0),
            ("eye_height_m", body.eye_height_m, 1.0, 2.2),
        ],
    )?;
    let [width, depth] = comfort.space_m;
    ranges(
        "comfort",
        &[
            ("fence_from_m", comfort.fence_from_m, 0.05, 2.0),
            ("space_m", width, 0.0, 100.0),
            ("space_m", depth, 0.0, 100.0),
            ("vignette_clear_deg", comfort.vignette_clear_deg, 5.0, 60.0),
        ],
    )
}

/// Leaves of pins that there are.
pub(super) fn practice(practice: &PracticeConfig) -> Result<(), Invalid> {
    let leave = &practice.leave;
    let is_leave = leave
        .iter()
        .enumerate()
        .all(|(at, pin)| (1..=crate::PINS).contains(pin) && !leave[..at].contains(pin));
    relation(
        "practice",
        "leave",
        &[],
        is_leave,
        "must list pins by their numbers from 1 to 10, each once",
    )
}

/// Physical coefficients of pairs.
fn coulomb(coulomb: &CoulombConfig) -> Result<(), Invalid> {
    let named = coulomb.pairs().map(|(key, _, _, pair)| (key, pair));
    for (key, pair) in named.into_iter().chain([("other", coulomb.other)]) {
        ranges(
            &format!("coulomb.{key}"),
            &[
                ("restitution", pair.restitution, 0.0, 1.0),
                ("friction", pair.friction, 0.0, 10.0),
            ],
        )?;
    }
    Ok(())
}

/// Oil on the lane.
fn oil(config: &Config) -> Result<(), Invalid> {
    let (oil, lane) = (&config.oil, &config.lane);
    let factor = |key, value| (key, value, 0.0, 10.0);
    let factors = [
        factor("middle_factor", oil.middle_factor),
        factor("edge_factor", oil.edge_factor),
    ];
    ranges("oil", &factors)?;
    let length = ("length_m", oil.length_m, 0.1, -lane.deck_end_z_m);
    limited("oil", length, &["lane.deck_end_z_m"])?;
    let taper = ("taper_m", oil.taper_m, 1e-3, oil.length_m);
    limited("oil", taper, &["oil.length_m"])?;
    let flat = ("flat_width_m", oil.flat_width_m, 0.0, 0.99 * lane.width_m);
    limited("oil", flat, &["lane.width_m"])
}

/// What is down, and when a throw ends.
pub(super) fn rules(config: &Config) -> Result<(), Invalid> {
    let rules = &config.rules;
    ranges(
        "rules",
        &[
            ("down_lean_deg", rules.down_lean_deg, 5.0, 89.0),
            ("left_deck_below_m", rules.left_deck_below_m, 0.005, 0.5),
            ("against_kickback_m", rules.against_kickback_m, 0.0, 0.1),
            ("still_speed_mps", rules.still_speed_mps, 0.001, 1.0),
            ("rocking_lean_deg", rules.rocking_lean_deg, 0.0, 5.0),
            ("rocking_turn_radps", rules.rocking_turn_radps, 0.0, 0.6),
            ("still_for_s", rules.still_for_s, 0.0, 10.0),
            ("end_after_headpin_s", rules.end_after_headpin_s, 1.0, 120.0),
            (
                "end_after_foul_line_s",
                rules.end_after_foul_line_s,
                2.0,
                600.0,
            ),
            ("confirm_within_s", rules.confirm_within_s, 0.5, 60.0),
            ("disturbed_pin_m", rules.disturbed_pin_m, 0.001, 1.0),
            ("stray_ball_s", rules.stray_ball_s, 1.0, 600.0),
            (
                "impact_reported_from_mps",
                rules.impact_reported_from_mps,
                0.0,
                100.0,
            ),
        ],
    )
}

/// The machine's movements.
pub(super) fn pinsetter(config: &Config) -> Result<(), Invalid> {
    let machine = &config.pinsetter;
    ranges(
        "pinsetter",
        &[
            ("pause_s", machine.pause_s, 0.05, 60.0),
            ("lift_s", machine.lift_s, 0.05, 60.0),
            ("bar_drop_s", machine.bar_drop_s, 0.05, 60.0),
            ("sweep_s", machine.sweep_s, 0.05, 60.0),
            ("set_s", machine.set_s, 0.05, 60.0),
            ("pit_clears_after_s", machine.pit_clears_after_s, 0.05, 60.0),
            ("ball_return_s", machine.ball_return_s, 0.05, 60.0),
            ("ball_lift_s", machine.ball_lift_s, 0.05, 60.0),
            ("bar_height_m", machine.bar_height_m, 0.05, 0.6),
        ],
    )?;
    for (key, height) in [
        ("lift_height_m", machine.lift_height_m),
        ("bar_rest_height_m", machine.bar_rest_height_m),
    ] {
        let range = (key, height, config.pin.height_m, 2.0);
        limited("pinsetter", range, &["pin.height_m"])?;
    }
    relation(
        "pinsetter",
        "bar_height_m",
        &["pinsetter.lift_height_m"],
        machine.lift_height_m > machine.bar_height_m,
        "must be less than pinsetter.lift_height_m, or the bar strikes lifted pins",
    )
}

/// The displays.
pub(super) fn display(config: &Config) -> Result<(), Invalid> {
    let display = &config.display;
    let distance = ("eye_distance_m", display.eye_distance_m, 0.0, 0.1);
    ranges("display", &[distance])?;
    profile("display.modern", &display.modern)?;
    profile("display.1996", &display.of_1996)
}

fn profile(table: &str, profile: &DisplayProfile) -> Result<(), Invalid> {
    let pixels = |key, count: u32| (key, f64::from(count), 16.0, 8192.0);
    ranges(
        table,
        &[
            ("outer_deg", profile.outer_deg, 1.0, 80.0),
            ("inner_deg", profile.inner_deg, 1.0, 80.0),
            ("up_deg", profile.up_deg, 1.0, 80.0),
            ("down_deg", profile.down_deg, 1.0, 80.0),
            pixels("width_px", profile.width_px),
            pixels("height_px", profile.height_px),
            pixels("relayed_width_px", profile.relayed_width_px),
            pixels("relayed_height_px", profile.relayed_height_px),
        ],
    )
}

/// The scripted participant.
pub(super) fn participant(config: &Config) -> Result<(), Invalid> {
    let person = &config.participant;
    let behind = person.stand_behind_foul_line_m;
    ranges(
        "participant",
        &[
            ("eye_height_m", person.eye_height_m, 0.8, 2.2),
            ("shoulder_height_m", person.shoulder_height_m, 0.5, 2.0),
            ("arm_length_m", person.arm_length_m, 0.3, 1.0),
            ("shoulder_offset_m", person.shoulder_offset_m, -0.5, 0.5),
            ("backswing_deg", person.backswing_deg, 5.0, 120.0),
            ("ball_speed_mps", person.ball_speed_mps, 1.0, 15.0),
            (
                "ball_speed_scatter_mps",
                person.ball_speed_scatter_mps,
                0.0,
                5.0,
            ),
            ("aim_scatter_deg", person.aim_scatter_deg, 0.0, 20.0),
            ("place_scatter_m", person.place_scatter_m, 0.0, 0.5),
            ("timing_scatter_s", person.timing_scatter_s, 0.0, 0.2),
            (
                "side_spin_scatter_rpm",
                person.side_spin_scatter_rpm,
                0.0,
                300.0,
            ),
            (
                "tilt_spin_scatter_rpm",
                person.tilt_spin_scatter_rpm,
                0.0,
                300.0,
            ),
            ("stand_behind_foul_line_m", behind, 0.0, 3.0),
            ("target_x_m", person.target_x_m, -1.0, 1.0),
        ],
    )
}
