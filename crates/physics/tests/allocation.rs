//! Steps work in room that is kept: a throw that was thrown before allocates nothing, and a new one hardly anything.

mod support;

use std::sync::Arc;

use allocation_counter::measure;
use glam::DVec3;
use physics::{BodyId, Compound, Effect, Effects, OilPattern, Pose, Response, Settings, World};
use support::*;

/// Steps of a throw: two seconds.
const STEPS: u32 = 1440;

/// An oiled lane with a rack, a ball, and a hand that sweeps over the deck.
struct Alley {
    world: World,
    pins: Vec<BodyId>,
    ball: BodyId,
    hand: BodyId,
}

impl Alley {
    fn new(settings: Settings, shape: &Arc<Compound>) -> Alley {
        let m = material(0.7, 0.7);
        let mut world = World::new(settings).expect("these settings run");
        let lane = add_building(&mut world, m)[0];
        let factors = vec![0.2, 0.3, 1.0, 0.9];
        let oil = OilPattern::new([-1.0, 12.0], [1.0, -12.0], [2, 2], factors);
        world.set_oil(lane, oil.expect("four factors for four nodes"));
        let mut add = |mut def: physics::BodyDef| {
            def.drag_area_m2 = 0.03;
            world.add(def)
        };
        let pins = spots().into_iter().map(|spot| add(pin(shape, m, spot)));
        let pins = pins.collect();
        let ball = add(ball(m, DVec3::Y));
        let hand = add(hand(m, DVec3::Y * 2.0));
        Alley {
            world,
            pins,
            ball,
            hand,
        }
    }

    /// Puts rack, ball and hand back to where a shot begins.
    fn reset(&mut self, offset: f64) {
        let world = &mut self.world;
        for (id, spot) in self.pins.iter().zip(spots()) {
            world.set_pose(*id, Pose::from_position(spot + DVec3::Y * PIN_CG));
            world.set_velocity(*id, DVec3::ZERO, DVec3::ZERO);
        }
        let at = DVec3::new(offset, BALL_RADIUS, -17.0);
        world.set_pose(self.ball, Pose::from_position(at));
        let spin = DVec3::X * (-8.0 / BALL_RADIUS);
        world.set_velocity(self.ball, DVec3::NEG_Z * 8.0, spin);
        world.set_pose(self.hand, Pose::from_position(hand_at(0)));
    }

    /// Allocations of a throw, and where the pins are at its end.
    fn shot(&mut self, offset: f64) -> (u64, Vec<Pose>) {
        self.reset(offset);
        let made = measure(|| {
            for i in 1..=STEPS {
                let target = Pose::from_position(hand_at(i));
                self.world.drive_to(self.hand, target);
                self.world.step();
            }
        });
        let pose = |id: &BodyId| self.world.body(*id).pose();
        (made.count_total, self.pins.iter().map(pose).collect())
    }
}

/// Where the hand is at a step of a throw [m]: it sweeps through the last row.
fn hand_at(step: u32) -> DVec3 {
    let share = f64::from(step) / f64::from(STEPS);
    DVec3::new(0.6 * share - 0.6, 0.3, -19.0)
}

/// The same throws twice, and then others.
fn check(settings: Settings, shape: &Arc<Compound>) {
    let what = format!("{:?} {:?}", settings.response, settings.effects);
    let mut alley = Alley::new(settings, shape);
    let offsets = (0..6).map(|i| 0.02 * f64::from(i) - 0.05);
    let warm_up: Vec<_> = offsets.map(|x| (x, alley.shot(x))).collect();
    for (offset, (made, before)) in &warm_up {
        println!("{made} allocations in the warm-up at {offset}, {what}");
        let (made, after) = alley.shot(*offset);
        assert_eq!(before, &after, "the same throw at {offset} falls otherwise");
        assert_eq!(made, 0, "allocations in the same throw at {offset}, {what}");
    }
    // Another throw may need more room than any before, and gets it by doubling: hardly ever.
    let others: Vec<u64> = (0..8)
        .map(|i| alley.shot(0.013 * f64::from(i) - 0.06).0)
        .collect();
    println!("{others:?} in other throws, {what}");
    assert!(others.iter().all(|made| *made <= 50));
}

#[test]
fn a_throw_that_was_thrown_before_allocates_nothing_and_another_hardly_anything() {
    for (shape, sleeping) in [(composite_pin(), false), (ellipsoid_pin(), true)] {
        let effects = Effects::default().set(Effect::Sleeping, sleeping);
        let settings = Settings {
            effects,
            ..Settings::default()
        };
        check(settings, &shape);
    }
    for response in [Response::UnoSlater, Response::Guarded, Response::Coulomb] {
        check(every_effect(response), &composite_pin());
    }
}
