//! Compound bodies in a swarm, section 5.10.

use glam::DVec3;
use physics::query::{Limits, separation};
use physics::{Body, Response};

use super::Case;
use super::findings::{Findings, Outcome, worse};
use super::scene::{Setup, composite_pin, vector};
use experiment::random::SplitMix64;

pub const CASES: &[Case] = &[Case {
    name: "compounds-in-a-swarm",
    section: "5.10",
    expected: "no two bodies pass into each other unseen (brute force over all parts)",
    criterion: "1e6 pairs of compounds in flight: none deeper than 20 um",
    run: swarm,
}];

/// Forty pins fly about in a closed room; after every step all pairs of their parts are looked at.
fn swarm() -> Outcome {
    let mut findings = Findings::new();
    let mut random = SplitMix64::new(510);
    let setup = Setup::new(Response::Guarded)
        .rate(90.0)
        .weightless()
        .contact(1.0, 0.0);
    let mut world = setup.world();
    for axis in DVec3::AXES {
        for side in [-1.0, 1.0] {
            let (middle, half) = (axis * (side * 1.5), DVec3::splat(1.5) - axis);
            world.add(setup.block(middle - half, middle + half));
        }
    }
    let pin = composite_pin();
    let mut ids = Vec::new();
    for k in 0..40 {
        let cell = DVec3::new(f64::from(k % 4), f64::from(k / 4 % 2), f64::from(k / 8));
        let at = (cell - DVec3::new(1.5, 0.5, 2.0)) * DVec3::new(0.45, 0.8, 0.35);
        let mut def = setup.pin(&pin, at);
        def.linear_velocity = vector(&mut random) * 8.0;
        def.angular_velocity = vector(&mut random) * 30.0;
        ids.push(world.add(def));
    }
    let (mut deepest, mut looks, mut impacts): (f64, u64, usize) = (0.0, 0, 0);
    while looks < 1_000_000 {
        world.step();
        impacts += world.impacts().len();
        for (i, a) in ids.iter().enumerate() {
            for b in &ids[..i] {
                looks += 1;
                deepest = worse(deepest, overlap(world.body(*a), world.body(*b)));
            }
        }
    }
    findings.at_most("deepest overlap", 1e6 * deepest, 20.0, "um");
    findings.note(format!("{looks} pairs, {impacts} impacts"));
    findings.outcome()
}

/// How deep two bodies are in each other [m], over all pairs of parts; zero when apart.
fn overlap(a: &Body, b: &Body) -> f64 {
    let mut deepest = 0.0;
    let reach = a.compound().bounding_radius() + b.compound().bounding_radius();
    if a.pose().position.distance(b.pose().position) > reach {
        return deepest;
    }
    for p in a.compound().parts() {
        for q in b.compound().parts() {
            let (pose_p, pose_q) = (a.pose() * p.pose, b.pose() * q.pose);
            let limits = Limits {
                enough: 0.0,
                ..Limits::default()
            };
            let found = separation((&p.shape, &pose_p), (&q.shape, &pose_q), None, limits);
            deepest = worse(deepest, -found.gap);
        }
    }
    deepest
}
