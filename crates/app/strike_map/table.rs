//! A strike map as a table.

use std::fmt::Write;

use super::StrikeMap;

/// Names of the columns; low and high are the ends of 95 % intervals.
const HEAD: &str = "model,entry_offset_m,entry_angle_deg,throws,strikes,strike_share,strike_share_low,strike_share_high,\
mean_pins,mean_pins_low,mean_pins_high,sd_pins";

/// The map as comma-separated values, a line a cell.
pub fn csv(map: &StrikeMap) -> String {
    let mut text = format!("{HEAD}\n");
    for (offset, angle, cell) in map.entries() {
        let (share, [low, high]) = cell.strike_share();
        let (mean, [few, many]) = (cell.mean(), cell.mean_interval());
        writeln!(
            text,
            "{},{offset:.6},{angle:.6},{},{},{share:.6},{low:.6},{high:.6},{mean:.4},{few:.4},{many:.4},{:.4}",
            map.model,
            cell.throws(),
            cell.strikes(),
            cell.deviation()
        )
        .expect("a string takes all text");
    }
    text
}

/// The cell with the largest share of strikes, in a sentence.
pub fn best(map: &StrikeMap) -> String {
    let cells = map.entries();
    let best = cells.max_by(|a, b| a.2.strikes().cmp(&b.2.strikes()));
    let (offset, angle, cell) = best.expect("a span has at least one value");
    let (share, [low, high]) = cell.strike_share();
    format!(
        "most strikes: {:.1} % ({:.1} to {:.1} %) at {:.1} cm and {angle:.2} degrees",
        1e2 * share,
        1e2 * low,
        1e2 * high,
        1e2 * offset
    )
}
