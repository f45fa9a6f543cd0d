//! Bodies between two things that nothing moves: the work stays bounded, and nothing is shot away.

mod support;

use glam::DVec3;
use physics::{BodyId, Motion, Pose, Settings, World};
use support::*;

/// Most events, and most impulses, that a step may have for each movable body.
const BLOWS: u64 = 64;

/// Steps with a hand driven from a place to another; returns the greatest speed that anything free had.
fn press(world: &mut World, hand: BodyId, from: DVec3, to: DVec3, steps: u32) -> f64 {
    let mut fastest: f64 = 0.0;
    for i in 1..=steps {
        let share = f64::from(i) / f64::from(steps);
        world.drive_to(hand, Pose::from_position(from.lerp(to, share)));
        fastest = fastest.max(step_within_bounds(world));
    }
    fastest
}

/// A step, with what must hold for each; returns the greatest speed.
fn step_within_bounds(world: &mut World) -> f64 {
    let before = world.effort();
    world.step();
    let (now, mut movable, mut fastest) = (world.effort(), 0, 0.0f64);
    for body in world.ids().map(|id| world.body(id)) {
        if body.motion() == Motion::Dynamic {
            movable += 1;
            fastest = fastest.max(body.linear_velocity().length());
            assert!(body.pose().is_finite() && !body.is_frozen());
        }
    }
    let (events, impulses) = (now.events - before.events, now.impulses - before.impulses);
    assert!(
        events <= BLOWS * movable && impulses <= BLOWS * movable,
        "{events} events and {impulses} impulses at step {} for {movable} bodies",
        world.steps()
    );
    fastest
}

fn room(elasticity: f64, friction_rate: f64) -> World {
    let m = material(elasticity, friction_rate);
    let mut world = World::new(Settings::default()).expect("default settings run");
    world.add(block(
        m,
        DVec3::new(-2.0, -0.5, -2.0),
        DVec3::new(2.0, 0.0, 2.0),
    ));
    world.add(block(
        m,
        DVec3::new(-2.5, -0.5, -2.0),
        DVec3::new(-2.0, 2.0, 2.0),
    ));
    world
}

const CORNERS: [(f64, f64); 5] = [(0.7, 0.7), (0.7, 0.0), (0.0, 0.7), (0.0, 0.0), (1.0, 1.0)];

#[test]
fn a_ball_pressed_into_the_floor_stays_and_is_let_go_gently() {
    for (elasticity, friction_rate) in CORNERS {
        let m = material(elasticity, friction_rate);
        let mut world = room(elasticity, friction_rate);
        let ball_id = world.add(ball(m, DVec3::Y * BALL_RADIUS));
        let (high, low) = (DVec3::Y * 0.4, DVec3::Y * 0.2);
        let hand_id = world.add(hand(m, high));
        press(&mut world, hand_id, high, low, 100);
        let at = world.body(ball_id).pose().position;
        assert!(
            at.length() < 1.5 * BALL_RADIUS,
            "{elasticity} {friction_rate}: the ball went to {at}"
        );
        for _ in 0..200 {
            step_within_bounds(&mut world);
        }
        press(&mut world, hand_id, low, high, 100);
        let fastest = world.body(ball_id).linear_velocity().length();
        assert!(
            fastest < 1.5,
            "{elasticity} {friction_rate}: left at {fastest} m/s"
        );
    }
}

#[test]
fn balls_and_a_pin_in_a_row_between_hand_and_wall_keep_the_work_bounded() {
    for (elasticity, friction_rate) in CORNERS {
        let m = material(elasticity, friction_rate);
        let mut world = room(elasticity, friction_rate);
        for i in 0..3 {
            let x = -2.0 + BALL_RADIUS * (1.0 + 2.0 * f64::from(i));
            world.add(ball(m, DVec3::new(x, BALL_RADIUS, 0.0)));
        }
        world.add(pin(&composite_pin(), m, DVec3::new(-1.2, 0.0, 0.0)));
        let (far, near) = (DVec3::new(0.0, 0.11, 0.0), DVec3::new(-1.9, 0.11, 0.0));
        let hand_id = world.add(hand(m, far));
        for steps in [1000, 200, 70] {
            let speed = 1.9 / f64::from(steps) * 720.0;
            let fastest = press(&mut world, hand_id, far, near, steps);
            // A hand that claps a light pin against heavy balls that it has just struck.
            let most = 12.0 * speed + 3.0;
            assert!(
                fastest < most,
                "{elasticity} {friction_rate}: {fastest} m/s from a hand at {speed} m/s"
            );
            press(&mut world, hand_id, near, far, steps);
        }
        let before = world.energy();
        for _ in 0..720 {
            step_within_bounds(&mut world);
        }
        assert!(world.energy() <= before + 1e-2 * before.abs() + 1e-3);
    }
}

#[test]
fn departures_from_the_letter_are_counted() {
    let m = material(1.0, 0.0);
    // An elastic ball never meets the floor slowly; what is merely laid down does.
    let mut world = room(1.0, 0.0);
    world.add(ball(m, DVec3::Y));
    let laid = |world: &mut World| {
        world.add(ball(m, DVec3::new(1.0, BALL_RADIUS + 1e-6, 0.0)));
        (0..72).for_each(|_| world.step());
        world.effort()
    };
    (0..720).for_each(|_| world.step());
    let bounced = world.effort();
    assert!(bounced.impulses >= 1);
    assert_eq!((bounced.slow, bounced.worn, bounced.squeezed), (0, 0, 0));
    let laid = laid(&mut world);
    assert!(laid.slow >= 1 && laid.worn == 0 && laid.squeezed == 0);
    // Between a hand and the floor nothing can be satisfied.
    let mut world = room(1.0, 0.0);
    world.add(ball(m, DVec3::Y * BALL_RADIUS));
    let (high, low) = (DVec3::Y * 0.4, DVec3::Y * 0.2);
    let hand_id = world.add(hand(m, high));
    press(&mut world, hand_id, high, low, 100);
    let pressed = world.effort();
    assert!(pressed.worn > 0 && pressed.squeezed > 0, "{pressed:?}");
}
