//! A refused press: soft, low, short, and where the button is.

use glam::DVec3;
use sound::{Event, Material, Mixer, Sounding};

use crate::support::{at, ball_on_pin, centroid, decibels, dry, dry_pressure, peak, rms};

fn refusal(time_s: f64, point: DVec3) -> Event {
    Event {
        time_s,
        sounding: Sounding::Refusal { point },
    }
}

#[test]
fn a_refusal_is_soft_and_dull_beside_a_hand_on_a_button() {
    let point = DVec3::new(0.0, 0.0, -1.0);
    let [left, _] = dry_pressure(&[refusal(0.0, point)], 0.5);
    // 2e-5 Pa is the threshold of hearing: louder than a whisper (30 dB), softer than a shout at a metre (80 dB).
    let level = decibels(peak(&left) / 2e-5);
    assert!((55.0..75.0).contains(&level), "{level} dB");
    // Below a hand's clap and a pin's lowest mode (1278 Hz): not taken for either.
    let pitch = centroid(&left[..9600]);
    assert!((200.0..400.0).contains(&pitch), "{pitch} Hz");
    let [crash, _] = dry_pressure(&[at(0.0, ball_on_pin(point))], 0.5);
    assert!(peak(&crash) > 30.0 * peak(&left), "{}", peak(&crash));
    assert!(ball_on_pin(point).materials.contains(&Material::Pin));
}

#[test]
fn a_refusal_begins_at_once_and_is_over_within_half_a_second() {
    let [left, _] = dry_pressure(&[refusal(0.1, DVec3::NEG_Z)], 1.0);
    let loudest = peak(&left);
    let onset = left.iter().position(|x| x.abs() > 0.1 * loudest);
    let late = onset.expect("it is heard") as f64 / 48_000.0 - 0.1;
    assert!((0.0..0.005).contains(&late), "{late}");
    // 30 dB down 0.15 s after, and 60 dB in the end.
    let part = |from: usize| rms(&left[from..from + 480]);
    assert!(decibels(part(5040) / part(5040 + 7200)) > 25.0);
    assert!(decibels(part(5040) / part(5040 + 24_000)) > 60.0);
}

#[test]
fn a_refusal_is_heard_from_its_side_and_a_place_that_is_none_is_not() {
    let [left, right] = dry_pressure(&[refusal(0.0, DVec3::new(1.0, 0.0, 0.0))], 0.3);
    assert!(
        rms(&right) > 1.05 * rms(&left),
        "{} {}",
        rms(&right),
        rms(&left)
    );
    let mut mixer = Mixer::new(&dry());
    mixer.submit(refusal(0.0, DVec3::splat(f64::NAN)));
    let mut out = [[0.0; 2]; 4800];
    mixer.render(&mut out);
    assert!(out.iter().flatten().all(|x| *x == 0.0));
    assert_eq!(mixer.lost(), 1);
    mixer.submit(refusal(0.2, DVec3::X));
    let mut out = vec![[0.0; 2]; 96_000];
    mixer.render(&mut out);
    assert!(out.iter().flatten().any(|x| *x != 0.0));
    assert!(mixer.is_silent(), "it has died away within two seconds");
}
