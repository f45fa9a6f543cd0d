//! What a real throw sounds like: the scripted participant's, from the physics to the file.

use std::path::Path;

use bowling_app::devices::Device;
use bowling_app::devices::script::{Script, Velocities};
use bowling_app::sound::{Reporter, settings};
use game::{Button, Conditions, EventKind, Game};
use sound::{Event, Impact, Listener, Material, Settings, Sounding, offline, wav};

/// What is heard before the ball meets the pins and after [s].
const BEFORE_S: f64 = 1.5;
const AFTER_S: f64 = 2.5;

/// The first throw of seed 5: what sounded from [`BEFORE_S`] before the first pin was struck, and how it is rendered.
fn throw() -> (Vec<Event>, Settings) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("config");
    let conditions = Conditions::load(&folder, "alley", &[]).expect("the scene");
    let mut game = Game::new(conditions.clone(), 1).expect("an alley");
    let mut script = Script::new(&conditions.lobby, 5, Velocities::Measured, &[Button::Red]);
    let mut reporter = Reporter::of(&conditions.lobby).expect("a scene with sound");
    let (mut sounded, mut hit) = (Vec::new(), None);
    while hit.is_none_or(|hit| game.time() < hit + AFTER_S) {
        let input = script.next(&game);
        game.step(&input);
        sounded.extend(reporter.report(&game));
        let is_hit = |event: &game::Event| matches!(event.kind, EventKind::FirstHit { .. });
        if game.events().iter().any(is_hit) {
            hit = hit.or(Some(game.time()));
        }
        assert!(game.time() < 120.0, "no pin is struck");
    }
    let zero = hit.expect("a hit") - BEFORE_S;
    let listener = Event {
        time_s: 0.0,
        sounding: Sounding::Listener(Listener::default()),
    };
    let within = sounded.into_iter().filter(|event| event.time_s > zero);
    let events = std::iter::once(listener).chain(within.map(|event| Event {
        time_s: (event.time_s - zero).max(0.0),
        ..event
    }));
    let settings = settings(&conditions.lobby).expect("a scene with sound");
    (events.collect(), settings)
}

/// The first blow of ball on pin.
fn first_hit(events: &[Event]) -> (f64, Impact) {
    let blows = events.iter().filter_map(|event| match event.sounding {
        Sounding::Impact(impact) => Some((event.time_s, impact)),
        _ => None,
    });
    let is_hit = |(_, impact): &(f64, Impact)| {
        let [a, b] = impact.materials;
        [a, b] == [Material::Ball, Material::Pin] || [b, a] == [Material::Ball, Material::Pin]
    };
    blows.into_iter().find(is_hit).expect("a hit")
}

#[test]
fn a_throw_is_heard_within_five_milliseconds_of_its_contact_and_the_same_twice() {
    let file = || {
        let (events, settings) = throw();
        let samples = offline::render(&settings, &events, BEFORE_S + AFTER_S);
        let mut file = Vec::new();
        wav::write_wav(&mut file, &samples, settings.sample_rate).expect("memory");
        (events, samples, file)
    };
    let (events, samples, bytes) = file();
    assert!(bytes == file().2, "the second time it sounds different");

    let (time, impact) = first_hit(&events);
    assert!((BEFORE_S - time).abs() < 0.02, "{time}");
    assert!((2.0..30.0).contains(&impact.impulse), "{impact:?}");
    let loudest = |from: f64, to: f64| {
        let range = (from * 48_000.0) as usize..(to * 48_000.0) as usize;
        let sizes = samples[range].iter().flatten().map(|x| x.abs());
        sizes.fold(0.0, f32::max)
    };
    // The ball rolls before; the blow is at least 12 dB louder, and begins within 5 ms and the step of 1.4 ms that it fell in.
    let (before, after) = (loudest(time - 0.1, time), loudest(time, time + 0.005));
    assert!(before > 1e-4, "the ball rolls without a sound");
    assert!(after > 4.0 * before, "{before} {after}");
    let crash = loudest(time, time + 0.5);
    assert!((0.05..1.0).contains(&crash), "{crash}");
}

#[test]
fn all_that_a_throw_consists_of_is_reported() {
    let (events, _) = throw();
    let has = |wanted: [Material; 2]| {
        events.iter().any(|event| match event.sounding {
            Sounding::Impact(impact) => {
                let [a, b] = impact.materials;
                [a, b] == wanted || [b, a] == wanted
            }
            _ => false,
        })
    };
    assert!(has([Material::Ball, Material::Pin]));
    assert!(has([Material::Pin, Material::Pin]));
    assert!(has([Material::Pin, Material::Lane]));
    let rolling = events.iter().filter(|event| {
        matches!(event.sounding, Sounding::Rolling(rolling) if rolling.surface == Material::Lane)
    });
    assert!(rolling.count() > 60);
}
