//! When it begins and when it ends.

use glam::DVec3;
use sound::{Event, Impact, Material, Mixer, Settings, Sounding, offline};

use crate::strike;
use crate::support::{RATE, at, ball_on_pin, dry, head_at_origin, peak};

/// First sample that has a fiftieth of the loudest.
fn onset(samples: &[[f32; 2]]) -> f64 {
    let loud: Vec<f64> = samples
        .iter()
        .map(|[left, right]| f64::from(left.abs().max(right.abs())))
        .collect();
    let threshold = peak(&loud) / 50.0;
    let first = loud.iter().position(|x| *x > threshold).expect("a sound");
    first as f64 / RATE
}

#[test]
fn a_blow_is_heard_within_five_milliseconds_of_the_contact() {
    for material in Material::ALL {
        for (time, z) in [(0.1, -1.0), (0.123_456, -18.3), (0.2, 0.0)] {
            let blow = Impact {
                materials: [Material::Ball, material],
                masses: [6.8, f64::INFINITY],
                ..ball_on_pin(DVec3::new(0.4, 0.0, z))
            };
            let samples = offline::render(&Settings::default(), &[at(time, blow)], 0.5);
            let late = onset(&samples) - time;
            assert!(
                (0.0..0.005).contains(&late),
                "{material:?}, {z} m: {late} s"
            );
        }
    }
}

#[test]
fn where_distance_delays_a_blow_is_heard_when_its_sound_arrives() {
    let settings = Settings {
        is_delayed_by_distance: true,
        ..dry()
    };
    let events = [
        head_at_origin(),
        at(0.1, ball_on_pin(DVec3::new(0.0, 0.0, -18.3))),
    ];
    let late = onset(&offline::render(&settings, &events, 0.5)) - 0.1;
    // 18.3 m at 343.2 m/s.
    assert!((late - 0.0533).abs() < 0.001, "{late}");
}

#[test]
fn an_event_of_the_past_is_heard_at_once() {
    let mut mixer = Mixer::new(&dry());
    let mut out = vec![[0.0; 2]; 4800];
    mixer.render(&mut out);
    mixer.submit(at(0.0, ball_on_pin(DVec3::new(0.0, 0.0, -2.0))));
    mixer.render(&mut out);
    assert!(onset(&out) < 0.002);
}

#[test]
fn after_a_throw_there_is_silence_again_and_no_number_is_odd_on_the_way() {
    let mut mixer = Mixer::new(&Settings::default());
    for event in strike::strike() {
        mixer.submit(event);
    }
    let mut out = vec![[0.0; 2]; (strike::LENGTH_S * RATE) as usize];
    mixer.render(&mut out);
    // Denormal numbers would cost a processor a hundred times as much.
    for sample in out.iter().flatten() {
        assert!(*sample == 0.0 || sample.is_normal(), "{sample}");
    }
    let mut tail = vec![[0.0; 2]; (3.0 * RATE) as usize];
    mixer.render(&mut tail);
    assert!(mixer.is_silent());
    assert!(tail[96_000..].iter().flatten().all(|sample| *sample == 0.0));
}

#[test]
fn numbers_that_are_none_are_lost_and_counted() {
    let mut mixer = Mixer::new(&Settings::default());
    let mut odd = ball_on_pin(DVec3::NAN);
    mixer.submit(at(0.0, odd));
    odd = ball_on_pin(DVec3::ZERO);
    odd.impulse = f64::NAN;
    mixer.submit(at(0.0, odd));
    mixer.submit(at(f64::NAN, ball_on_pin(DVec3::ZERO)));
    mixer.submit(Event {
        time_s: 0.0,
        sounding: Sounding::Rolling(sound::Rolling {
            body: 200,
            point: DVec3::ZERO,
            speed: 1.0,
            surface: Material::Lane,
        }),
    });
    let mut out = [[0.0; 2]; 4800];
    mixer.render(&mut out);
    assert_eq!(mixer.lost(), 4);
    assert!(out.iter().flatten().all(|sample| *sample == 0.0));
}

#[test]
fn more_blows_than_voices_take_the_place_of_the_quietest() {
    let mut mixer = Mixer::new(&dry());
    for i in 0..200 {
        mixer.submit(at(
            f64::from(i) * 1e-4,
            ball_on_pin(DVec3::new(0.0, 0.0, -5.0)),
        ));
    }
    let mut out = [[0.0; 2]; 4800];
    mixer.render(&mut out);
    assert_eq!(mixer.lost(), 0);
    assert!(out.iter().flatten().all(|sample| sample.is_finite()));
}
