//! Throws into a whole rack.

mod support;

use physics::Settings;
use support::*;

#[test]
fn a_shot_knocks_pins_down_and_stays_finite() {
    for pins in [composite_pin(), ellipsoid_pin()] {
        for (e, mu) in [
            (0.7, 0.7),
            (1.0, 0.7),
            (0.7, 0.0),
            (1.0, 0.0),
            (1.0, 1.0),
            (0.0, 0.0),
        ] {
            let (mut world, ids) = alley(Settings::default(), &pins, material(e, mu));
            let ball = throw(&mut world, material(e, mu), 0.05, 2.0, 8.0);
            let start = world.energy();
            let mut rise: f64 = 0.0;
            let mut before = start;
            for _ in 0..720 * 4 {
                world.step();
                let now = world.energy();
                rise = rise.max(now - before);
                before = now;
            }
            let fallen = ids.iter().filter(|id| tilt(&world, **id) > 30.0).count();
            assert!(
                rise < 1e-5 * start,
                "energy rose by {rise} J in a step at {e} {mu}"
            );
            assert!(before.is_finite());
            assert!(fallen > 2);
            assert!(world.body(ball).pose().is_finite());
        }
    }
}
