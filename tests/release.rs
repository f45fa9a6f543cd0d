use std::path::Path;

use bowling_app::devices::script::Velocities;
use bowling_app::rehearsal::rehearse;
use game::{Button, Conditions, EventKind, Release, ReleaseSource};

/// The first release of a ball by a participant whose device measures velocities, or does not.
fn first_release(velocities: Velocities, seed: u64) -> Release {
    let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("config");
    let conditions = Conditions::load(&config, "alley", &[]).expect("the project's configuration");
    let mut first = None;
    rehearse(&conditions, 1, seed, velocities, &[Button::Red], |game| {
        for event in game.events() {
            if let EventKind::Released(release) = &event.kind {
                first.get_or_insert(*release);
            }
        }
    })
    .expect("a game");
    first.expect("a ball was thrown")
}

#[test]
fn poses_alone_give_the_release_that_measured_velocities_give() {
    for seed in 1..=3 {
        let measured = first_release(Velocities::Measured, seed);
        let fitted = first_release(Velocities::Missing, seed);
        assert_eq!(
            (measured.source, fitted.source),
            (ReleaseSource::Velocity, ReleaseSource::Poses)
        );
        let (a, b) = (measured.used.linear, fitted.used.linear);
        let speed = b.length() / a.length() - 1.0;
        let angle = a.angle_between(b).to_degrees();
        assert!(
            speed.abs() < 0.02,
            "seed {seed}: {:.1} % faster",
            100.0 * speed
        );
        assert!(angle < 1.0, "seed {seed}: {angle:.2} degrees apart");
        assert!(
            (4.0..10.0).contains(&a.length()),
            "seed {seed}: {} m/s is no throw",
            a.length()
        );
    }
}
