//! Level against impulse, speed and distance.

use glam::DVec3;
use sound::{Impact, Material, Settings, offline};

use crate::strike;
use crate::support::{at, ball_on_pin, decibels, dry_pressure, peak, rms, spectrum};

const AHEAD: DVec3 = DVec3::new(0.0, 0.0, -2.0);

#[test]
fn pressure_is_proportional_to_the_impulse_of_a_blow_of_one_speed() {
    let level = |impulse| {
        let blow = Impact {
            impulse,
            ..ball_on_pin(AHEAD)
        };
        rms(&dry_pressure(&[at(0.0, blow)], 0.3)[0])
    };
    let one = level(1.0);
    for impulse in [0.01, 0.1, 3.0, 10.0, 30.0] {
        let ratio = level(impulse) / one / impulse;
        // Single precision, and the end of what is heard at a fixed pressure.
        assert!((ratio - 1.0).abs() < 2e-3, "{impulse} N s: {ratio}");
    }
}

/// A faster blow has more impulse and is shorter: pressure grows with the speed's power of 1 (impulse) to 1.5 (the click's
/// share above its corner grows with the shorter contact), never less. Brightness is the power above 1 kHz against that below.
#[test]
fn a_harder_blow_is_louder_and_brighter() {
    let heard = |other: Material, mass: f64, speed: f64| {
        let blow = Impact {
            materials: [Material::Ball, other],
            masses: [6.8, mass],
            impulse: 1.65 * speed / (1.0 / 6.8 + 1.0 / mass),
            approach_speed: speed,
            ..ball_on_pin(AHEAD)
        };
        let [left, _] = dry_pressure(&[at(0.0, blow)], 0.3);
        let power = spectrum(&left, 1 << 14);
        // Bins of 2.93 Hz: above and below 1 kHz.
        let high = power[341..].iter().sum::<f64>() / power[..341].iter().sum::<f64>();
        (rms(&left), high)
    };
    for (other, mass) in [(Material::Pin, 1.59), (Material::Lane, f64::INFINITY)] {
        // Below 0.5 m/s a pin's lowest mode lies in the gaps of the blow's spectrum.
        let heard = [0.5, 1.0, 2.0, 4.0, 8.0].map(|speed| heard(other, mass, speed));
        for pair in heard.windows(2) {
            let power = (pair[1].0 / pair[0].0).log2();
            assert!((1.0..1.5).contains(&power), "{other:?}, {power}: {heard:?}");
            assert!(pair[1].1 > pair[0].1, "{other:?}: {heard:?}");
        }
    }
}

#[test]
fn pressure_falls_with_the_reverse_of_the_distance() {
    let level = |distance: f64| {
        let blow = ball_on_pin(DVec3::new(0.0, 0.0, -distance));
        distance * peak(&dry_pressure(&[at(0.0, blow)], 0.3)[0])
    };
    let one = level(1.0);
    for distance in [0.5, 2.0, 5.0, 18.3, 30.0] {
        let off = decibels(level(distance) / one);
        assert!(off.abs() < 0.05, "{distance} m: {off} dB");
    }
}

/// A diffuse field is as loud as the source at the critical distance, 0.057 sqrt(V / T) = 3.12 m in 2400 m3 with 0.8 s
/// (Kuttruff), and so 10.1 dB louder than the source at 10 m, less 2.2 dB that Barron found missing there; of a source ahead the
/// head's shadow takes 1.1 dB at 1.3 kHz, where a pin is loudest.
#[test]
fn the_room_is_as_loud_as_a_diffuse_field() {
    let settings = Settings {
        full_scale_pa: 1000.0,
        ..Settings::default()
    };
    let bare = Settings {
        room: None,
        ..settings
    };
    let point = DVec3::new(0.0, 1.6, -10.0);
    let energy = |settings: &Settings| {
        let samples = offline::render(settings, &[at(0.0, ball_on_pin(point))], 2.0);
        let both: f64 = samples.iter().flatten().map(|x| f64::from(x * x)).sum();
        both
    };
    let room = 10.0 * (energy(&settings) / energy(&bare) - 1.0).log10();
    // First reflections come on top; a pin's few modes meet the network's own: 2 dB.
    assert!((room - 9.0).abs() < 2.0, "{room} dB");
}

/// 100 to 115 dB are given for a strike at 15 feet from the deck.
#[test]
fn a_strike_at_fifteen_feet_has_the_peak_level_of_a_real_one() {
    let settings = Settings {
        full_scale_pa: 1000.0,
        ..Settings::default()
    };
    let mut events = vec![sound::Event {
        time_s: 0.0,
        sounding: sound::Sounding::Listener(sound::Listener {
            position: DVec3::new(0.0, 1.2, -18.3 + 4.57),
            ..sound::Listener::default()
        }),
    }];
    events.extend(strike::crash());
    let samples = offline::render(&settings, &events, strike::CRASH_S + 0.5);
    let crash: Vec<f64> = samples[(strike::CRASH_S * 48_000.0) as usize..]
        .iter()
        .map(|[left, _]| f64::from(*left) * 1000.0)
        .collect();
    let level = decibels(peak(&crash) / 20e-6);
    // A sound level meter's slower reading lies up to 10 dB below the peak.
    assert!((100.0..125.0).contains(&level), "{level:.1} dB");
}

#[test]
fn a_crash_of_ten_pins_is_limited_without_clipping() {
    for full_scale_pa in [0.05, 0.5, 6.0] {
        let settings = Settings {
            full_scale_pa,
            ..Settings::default()
        };
        let samples = offline::render(&settings, &strike::strike(), strike::LENGTH_S);
        let loudest = samples.iter().flatten().fold(0.0f32, |a, b| a.max(b.abs()));
        assert!(loudest < 1.0, "{loudest}");
        // Samples that are cut off would all be as large as the loudest.
        let cut = samples
            .iter()
            .flatten()
            .filter(|x| x.abs() == loudest)
            .count();
        assert!(full_scale_pa < 0.1 || cut < 4, "{cut} samples of {loudest}");
    }
}

#[test]
fn two_materials_that_nothing_moves_are_heard_too() {
    let blow = Impact {
        materials: [Material::Metal, Material::Wall],
        masses: [f64::INFINITY; 2],
        ..ball_on_pin(AHEAD)
    };
    let [left, _] = dry_pressure(&[at(0.0, blow)], 0.3);
    assert!(peak(&left) > 0.01 && left.iter().all(|x| x.is_finite()));
}
