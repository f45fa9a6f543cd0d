//! A ball that rolls.

use glam::DVec3;
use sound::{Event, Material, Rolling, Sounding};

use crate::support::{centroid, decibels, dry_pressure, peak, rms};

/// Left ear's pressure [Pa] of a ball that rolls 1 m ahead for a second, the start left out.
fn heard(speed: f64, surface: Material) -> Vec<f64> {
    dry_pressure(&told(speed, surface, 72), 1.0)[0][9600..].to_vec()
}

fn told(speed: f64, surface: Material, frames: u32) -> Vec<Event> {
    (0..frames)
        .map(|frame| Event {
            time_s: f64::from(frame) / 72.0,
            sounding: Sounding::Rolling(Rolling {
                body: 0,
                point: DVec3::new(0.0, 0.0, -1.0),
                speed,
                surface,
            }),
        })
        .collect()
}

#[test]
fn a_faster_ball_is_louder_by_thirty_decibels_a_decade_and_brighter() {
    let speeds = [1.0, 2.0, 4.0, 8.0];
    let heard = speeds.map(|speed| heard(speed, Material::Lane));
    for pair in heard.windows(2) {
        let grown = decibels(rms(&pair[1]) / rms(&pair[0]));
        // 30 lg 2 = 9.03 dB for each doubling; noise of 0.8 s and the lane's modes leave 3 dB.
        assert!((grown - 9.03).abs() < 3.0, "{grown}");
        assert!(centroid(&pair[1]) > centroid(&pair[0]));
    }
}

#[test]
fn a_ball_at_seven_metres_a_second_has_the_level_that_is_stated() {
    let level = decibels(rms(&heard(7.0, Material::Lane)) / 20e-6);
    assert!((level - 82.0).abs() < 2.0, "{level}");
}

#[test]
fn a_gutter_is_louder_than_a_lane_and_a_carpet_softer() {
    let level = |surface| rms(&heard(5.0, surface));
    assert!(level(Material::Gutter) > 1.2 * level(Material::Lane));
    assert!(level(Material::Pit) < 0.5 * level(Material::Lane));
}

#[test]
fn a_ball_that_is_not_told_of_fades_and_one_at_rest_is_silent() {
    let [left, _] = dry_pressure(&told(5.0, Material::Lane, 36), 1.5);
    assert!(peak(&left[12_000..24_000]) > 0.01);
    assert!(peak(&left[48_000..]) < 1e-4);
    let [still, _] = dry_pressure(&told(0.0, Material::Lane, 36), 0.5);
    assert!(peak(&still) < 1e-6);
}
