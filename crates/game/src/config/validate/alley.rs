//! Which buildings are possible.

use super::{Invalid, limited, ranges, relation};
use crate::config::Config;

/// Lane, gutters, kickbacks and pit.
pub(super) fn building(config: &Config) -> Result<(), Invalid> {
    lane(config)?;
    markings(config)?;
    gutter(config)?;
    pit(config)
}

/// Boards that the rule book counts across a lane.
const RULE_BOARDS: u32 = 39;

fn markings(config: &Config) -> Result<(), Invalid> {
    let paint = &config.markings;
    let boards = [
        ("arrow_boards", &paint.arrow_boards),
        ("lane_dot_boards", &paint.lane_dot_boards),
        ("approach_dot_boards", &paint.approach_dot_boards),
    ];
    for (key, boards) in boards {
        for board in boards {
            let range = (key, f64::from(*board), 1.0, f64::from(RULE_BOARDS));
            limited("markings", range, &[])?;
        }
    }
    relation(
        "markings",
        "arrow_z_m",
        &["markings.arrow_boards"],
        paint.arrow_z_m.len() == paint.arrow_boards.len(),
        "must have as many numbers as markings.arrow_boards",
    )?;
    for z in &paint.arrow_z_m {
        limited("markings", ("arrow_z_m", *z, -60.0, 0.0), &[])?;
    }
    for z in &paint.approach_dots_z_m {
        limited("markings", ("approach_dots_z_m", *z, 0.0, 30.0), &[])?;
    }
    let row = ("lane_dots_z_m", paint.lane_dots_z_m, -60.0, 0.0);
    limited("markings", row, &[])
}

fn lane(config: &Config) -> Result<(), Invalid> {
    let lane = &config.lane;
    ranges(
        "lane",
        &[
            ("width_m", lane.width_m, 0.5, 3.0),
            ("boards", f64::from(lane.boards), 1.0, 200.0),
            ("thickness_m", lane.thickness_m, 0.1, 1.0),
            ("headpin_z_m", lane.headpin_z_m, -60.0, -3.0),
            ("deck_end_z_m", lane.deck_end_z_m, -62.0, -3.0),
            ("pin_spacing_m", lane.pin_spacing_m, 0.15, 1.0),
            ("row_pitch_m", lane.row_pitch_m, 0.13, 1.0),
        ],
    )?;
    relation(
        "lane",
        "deck_end_z_m",
        &["lane.headpin_z_m", "lane.row_pitch_m"],
        lane.deck_end_z_m < lane.headpin_z_m - 3.0 * lane.row_pitch_m,
        "must lie behind the last row of pins, three times lane.row_pitch_m behind lane.headpin_z_m",
    )?;
    relation(
        "lane",
        "width_m",
        &["lane.pin_spacing_m"],
        lane.width_m > 3.0 * lane.pin_spacing_m,
        "must be more than three times lane.pin_spacing_m",
    )
}

fn gutter(config: &Config) -> Result<(), Invalid> {
    let gutter = &config.gutter;
    let flat_starts = gutter.flat_starts_before_headpin_m;
    ranges(
        "gutter",
        &[
            ("width_m", gutter.width_m, 0.1, 1.0),
            ("facets", f64::from(gutter.facets), 3.0, 32.0),
            ("depth_at_deck_m", gutter.depth_at_deck_m, 0.01, 0.5),
            ("flat_starts_before_headpin_m", flat_starts, 0.0, 2.0),
        ],
    )?;
    let depth = ("depth_m", gutter.depth_m, 0.01, gutter.width_m / 2.0);
    limited("gutter", depth, &["gutter.width_m"])
}

/// Pit and kickbacks.
fn pit(config: &Config) -> Result<(), Invalid> {
    let (kickback, pit) = (&config.kickback, &config.pit);
    let starts = kickback.starts_before_headpin_m;
    ranges(
        "kickback",
        &[
            ("height_m", kickback.height_m, 0.05, 2.0),
            ("thickness_m", kickback.thickness_m, 0.01, 0.3),
            ("starts_before_headpin_m", starts, 0.0, 2.0),
        ],
    )?;
    ranges(
        "pit",
        &[
            ("floor_below_deck_m", pit.floor_below_deck_m, 0.0, 1.0),
            ("cushion_behind_deck_m", pit.cushion_behind_deck_m, 0.4, 5.0),
            ("cushion_thickness_m", pit.cushion_thickness_m, 0.05, 1.0),
            ("cushion_height_m", pit.cushion_height_m, 0.2, 3.0),
        ],
    )
}

/// The room, and where one starts in it.
pub(super) fn room(config: &Config) -> Result<(), Invalid> {
    let room = &config.room;
    ranges(
        "room",
        &[
            ("depth_m", room.depth_m, 2.0, 30.0),
            ("height_m", room.height_m, 2.0, 20.0),
            ("walk_margin_m", room.walk_margin_m, 0.05, 1.0),
            ("foul_line_width_m", room.foul_line_width_m, 0.002, 0.1),
        ],
    )?;
    let beside = config.lane.width_m / 2.0 + config.gutter.width_m + 0.2;
    limited(
        "room",
        ("half_width_m", room.half_width_m, beside, 20.0),
        &["lane.width_m", "gutter.width_m"],
    )?;
    let lane = config.lane.width_m + 2.0 * config.gutter.width_m;
    limited(
        "room",
        ("lane_pitch_m", room.lane_pitch_m, lane, 20.0),
        &["lane.width_m", "gutter.width_m"],
    )?;
    limited(
        "room",
        (
            "approach_length_m",
            room.approach_length_m,
            1.0,
            room.depth_m,
        ),
        &["room.depth_m"],
    )?;
    let (side, depth) = walkable(config);
    let start = &config.start;
    limited("start", ("x_m", start.x_m, -side, side), &SIDE)?;
    limited("start", ("z_m", start.z_m, 0.0, depth), &DEPTH)
}

/// Rack and desk.
pub(super) fn furniture(config: &Config) -> Result<(), Invalid> {
    let (side, depth) = walkable(config);
    let (rack, desk) = (&config.rack, &config.desk);
    for (table, x, z) in [("rack", rack.x_m, rack.z_m), ("desk", desk.x_m, desk.z_m)] {
        limited(table, ("x_m", x, -side, side), &SIDE)?;
        limited(table, ("z_m", z, 0.3, depth), &DEPTH)?;
    }
    ranges(
        "rack",
        &[
            ("tray_height_m", rack.tray_height_m, 0.1, 1.5),
            ("rim_height_m", rack.rim_height_m, 0.005, 0.1),
            ("rim_thickness_m", rack.rim_thickness_m, 0.005, 0.1),
            ("clearance_m", rack.clearance_m, 0.001, 0.05),
        ],
    )?;
    ranges(
        "desk",
        &[
            ("height_m", desk.height_m, 0.3, 1.6),
            ("width_m", desk.width_m, 0.2, 3.0),
            ("depth_m", desk.depth_m, 0.1, 2.0),
            ("button_radius_m", desk.button_radius_m, 0.01, 0.3),
            ("button_travel_m", desk.button_travel_m, 0.005, 0.2),
            ("button_press_at", desk.button_press_at, 0.1, 0.9),
        ],
    )?;
    let nearest = 2.0 * desk.button_radius_m;
    limited(
        "desk",
        ("button_spacing_m", desk.button_spacing_m, nearest, 2.0),
        &["desk.button_radius_m"],
    )
}

/// What limits a place across the room.
const SIDE: [&str; 2] = ["room.half_width_m", "room.walk_margin_m"];
/// What limits a place along the room.
const DEPTH: [&str; 2] = ["room.depth_m", "room.walk_margin_m"];

/// How far to each side and how far back a head may be [m].
fn walkable(config: &Config) -> (f64, f64) {
    let (room, margin) = (&config.room, config.room.walk_margin_m);
    (room.half_width_m - margin, room.depth_m - margin)
}
