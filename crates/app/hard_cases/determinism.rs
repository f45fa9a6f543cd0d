//! Determinism, convergence, places far away and numbers that are none. Sections 5.9 and 6.

use glam::DVec3;
use physics::{Body, BodyId, Response, Shape, World};

use super::Case;
use super::findings::{Findings, Outcome, worse};
use super::scene::{
    BALL_RADIUS, MODELS, RATES, Setup, add_alley, add_rack, composite_pin, run, throw, tilt,
};

pub const CASES: &[Case] = &[
    Case {
        name: "bad-numbers",
        section: "5.9",
        expected: "bad sizes are refused; a broken state freezes its body alone",
        criterion: "every bad size an error; the others' bits as without it; no panic",
        run: bad_numbers,
    },
    Case {
        name: "same-bits-again",
        section: "6.1",
        expected: "same calls, same bits; so after a snapshot and beside an idle body",
        criterion: "every state's bits equal after 1e5 steps, 1e4 in the other models",
        run: same_bits,
    },
    Case {
        name: "first-hit-converges",
        section: "6.3",
        expected: "velocities after the first hit do not depend on the step",
        criterion: "ball and pin at 90 Hz within 1 % of 5760 Hz",
        run: first_hit,
    },
    Case {
        name: "far-from-the-origin",
        section: "6.5",
        expected: "1 km and 10 km away a shot and a rack are as at home",
        criterion: "first hit 1e-6; rack 60 s: drift 1 um, tilt 0.001 deg",
        run: far_away,
    },
];

/// Bits of what a body is and does.
fn bits(body: &Body) -> [u64; 13] {
    let pose = pose_numbers(body);
    pose.map(f64::to_bits)
}

fn pose_numbers(body: &Body) -> [f64; 13] {
    let (p, q) = (body.pose().position, body.pose().rotation);
    let (v, w) = (body.linear_velocity(), body.angular_velocity());
    [
        p.x, p.y, p.z, q.x, q.y, q.z, q.w, v.x, v.y, v.z, w.x, w.y, w.z,
    ]
}

fn all_bits(world: &World, ids: &[BodyId]) -> Vec<[u64; 13]> {
    ids.iter().map(|id| bits(world.body(*id))).collect()
}

/// A shot into a rack; the pins, then the ball.
fn shot(setup: &Setup) -> (World, Vec<BodyId>) {
    let mut world = setup.world();
    add_alley(&mut world, setup);
    let mut ids = add_rack(&mut world, setup, &composite_pin());
    ids.push(throw(&mut world, setup, 0.05, 1.0, 8.0));
    (world, ids)
}

fn bad_numbers() -> Outcome {
    let mut findings = Findings::new();
    let (mut taken, mut tried) = (0, 0);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0] {
        let shapes = [
            Shape::sphere(bad),
            Shape::capsule(bad, 1.0),
            Shape::capsule(1.0, bad),
            Shape::cylinder(bad, 1.0),
            Shape::cylinder(1.0, bad),
            Shape::cone(bad, 1.0),
            Shape::cone(1.0, bad),
            Shape::ellipsoid(DVec3::new(1.0, bad, 1.0)),
            Shape::cuboid(DVec3::new(1.0, 1.0, bad)),
            Shape::truncated_ellipsoid(DVec3::ONE, -bad.abs() - 1.0),
            Shape::half_space(DVec3::Y * if bad < 0.0 { f64::NAN } else { bad }),
            Shape::cloud(&[DVec3::X, DVec3::Y * if bad <= 0.0 { f64::NAN } else { bad }]),
        ];
        tried += shapes.len();
        taken += shapes.iter().filter(|shape| shape.is_ok()).count();
    }
    findings.none_of("bad sizes taken", taken, tried);
    let (mut others_changed, mut not_frozen, mut broken) = (0, 0, 0);
    for bad in [DVec3::NAN, DVec3::INFINITY, DVec3::splat(f64::MAX)] {
        let setup = Setup::new(Response::Guarded).contact(0.49, 0.49);
        let (mut right, ids) = shot(&setup);
        let stray = DVec3::new(0.0, 30.0, 0.0);
        let with = |world: &mut World, velocity: DVec3| {
            let id = world.add(setup.ball(0.1, 1.0, stray));
            world.set_velocity(id, velocity, velocity);
            id
        };
        let mut world = right.clone();
        let idle = with(&mut right, DVec3::ZERO);
        let ill = with(&mut world, bad);
        for _ in 0..720 {
            right.step();
            world.step();
        }
        broken += 1;
        others_changed += usize::from(all_bits(&right, &ids) != all_bits(&world, &ids));
        not_frozen += usize::from(!world.body(ill).is_frozen() || right.body(idle).is_frozen());
    }
    findings.none_of("broken bodies not frozen", not_frozen, broken);
    findings.none_of("changed the others", others_changed, broken);
    findings.outcome()
}

fn same_bits() -> Outcome {
    let mut findings = Findings::new();
    let (mut again, mut restored, mut count) = (0, 0, 0);
    for response in MODELS {
        let mut setup = Setup::new(response).contact(0.49, 0.49);
        // In so long a time, as in the program, what has come to rest sleeps.
        setup.sleeping = response == Response::Guarded;
        let (mut world, ids) = shot(&setup);
        let (mut second, _) = shot(&setup);
        let mut snapshot = None;
        let steps = if response == Response::Guarded {
            100_000
        } else {
            10_000
        };
        for i in 0..steps {
            world.step();
            if i == 300 {
                snapshot = Some(world.clone());
            }
            // Far away and at rest it has no part in anything; now it is there, now it is not.
            if i % 2_000 == 100 {
                let mut idle = setup.floor();
                idle.pose.position = DVec3::Y * -500.0;
                let id = second.add(idle);
                second.step();
                second.remove(id);
            } else {
                second.step();
            }
        }
        let mut snapshot = snapshot.expect("one was taken at step 300");
        while snapshot.steps() < world.steps() {
            snapshot.step();
        }
        let right = all_bits(&world, &ids);
        count += 1;
        again += usize::from(all_bits(&second, &ids) != right);
        restored += usize::from(snapshot.hash() != world.hash());
    }
    findings.none_of("differ when run again beside an idle body", again, count);
    findings.none_of("after a snapshot", restored, count);
    findings.outcome()
}

/// Velocities of ball and head pin at the end of the 90th of a second in which they first meet.
fn after_first_hit(setup: &Setup, at: DVec3, aside: f64) -> Option<[DVec3; 4]> {
    let mut world = setup.world();
    let mut floor = setup.floor();
    floor.pose.position += at;
    world.add(floor);
    let pin = world.add(setup.pin(&composite_pin(), at));
    let ball = throw(&mut world, setup, aside, 0.5, 8.0);
    let mut pose = world.body(ball).pose();
    pose.position += at;
    world.set_pose(ball, pose);
    while world.time() < 0.2 {
        let mut hit = false;
        for _ in 0..(setup.step_hz / 90.0).round() as u32 {
            world.step();
            let mut impacts = world.impacts().iter();
            hit |= impacts.any(|i| (i.a == pin && i.b == ball) || (i.a == ball && i.b == pin));
        }
        if hit {
            let (ball, pin) = (world.body(ball), world.body(pin));
            return Some([
                ball.linear_velocity(),
                ball.angular_velocity() * BALL_RADIUS,
                pin.linear_velocity(),
                pin.angular_velocity() * 0.1,
            ]);
        }
    }
    None
}

/// The largest difference of velocities between two hits, as a share of the pin's speed.
fn difference(one: Option<[DVec3; 4]>, other: Option<[DVec3; 4]>) -> f64 {
    match (one, other) {
        (Some(one), Some(other)) => {
            let scale = other[2].length();
            let pairs = one.iter().zip(&other);
            pairs
                .map(|(a, b)| (*a - *b).length() / scale)
                .fold(0.0, worse)
        }
        _ => f64::NAN,
    }
}

fn first_hit() -> Outcome {
    let mut findings = Findings::new();
    let mut off: f64 = 0.0;
    for response in MODELS {
        for (e, mu) in [(0.49, 0.49), (0.7, 0.0), (1.0, 0.0)] {
            for aside in [0.0, 0.03, 0.065, 0.12] {
                let hit = |hz: f64| {
                    let setup = Setup::new(response).rate(hz).contact(e, mu);
                    after_first_hit(&setup, DVec3::ZERO, aside)
                };
                off = worse(off, difference(hit(90.0), hit(5760.0)));
            }
        }
    }
    findings.at_most("off by", 100.0 * off, 1.0, "% of the pin's speed");
    findings.outcome()
}

fn far_away() -> Outcome {
    let mut findings = Findings::new();
    let (mut off, mut drift, mut most): (f64, f64, f64) = (0.0, 0.0, 0.0);
    for away in [1e3, 1e4] {
        let at = DVec3::new(away, 0.0, -0.7 * away);
        let setup = Setup::new(Response::Guarded).contact(0.49, 0.49);
        let hit = |at| after_first_hit(&setup, at, 0.03);
        off = worse(off, difference(hit(at), hit(DVec3::ZERO)));
        for hz in RATES {
            let setup = setup.rate(hz);
            let mut world = setup.world();
            let mut floor = setup.floor();
            floor.pose.position += at;
            world.add(floor);
            let spots = super::scene::spots().into_iter();
            let pin = composite_pin();
            let ids: Vec<BodyId> = spots
                .map(|spot| world.add(setup.pin(&pin, at + spot)))
                .collect();
            let from: Vec<DVec3> = ids
                .iter()
                .map(|id| world.body(*id).pose().position)
                .collect();
            run(&mut world, 60.0);
            for (id, from) in ids.iter().zip(from) {
                let body = world.body(*id);
                drift = worse(drift, (body.pose().position - from).length());
                most = worse(most, tilt(body));
            }
        }
    }
    findings.at_most("first hit off by", off, 1e-6, "");
    findings.at_most("drift", 1e6 * drift, 1.0, "um");
    findings.at_most("tilt", most, 1e-3, "deg");
    findings.outcome()
}
