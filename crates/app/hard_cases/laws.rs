//! The impact laws as laws, over many random contacts: section 2.5.

use glam::{DMat3, DVec3};
use physics::response::{Coefficients, compliance, impulse};
use physics::{BodyId, Compound, MassProperties, Pose, Response, Shape, World};

use super::Case;
use super::findings::{Findings, Outcome, worse};
use super::scene::{MODELS, Setup, between, direction, momenta, rotation, vector};
use experiment::random::SplitMix64;

pub const CASES: &[Case] = &[
    Case {
        name: "blend-never-adds-energy",
        section: "2.5",
        expected: "a convex blend of passive impulses is passive (analysis)",
        criterion: "1e5 contacts: E <= largest corner's, F10 and F11 keep E to 1e-12",
        run: blend,
    },
    Case {
        name: "random-impacts",
        section: "2.5",
        expected: "P and L constant, E never up, bodies separate (analysis)",
        criterion: "1e5 pairs of bodies: P 1e-12, L 1e-10, E 1e-12",
        run: random_impacts,
    },
];

/// A random eccentric contact: normal, approaching relative velocity, the `K` of both bodies.
fn contact(random: &mut SplitMix64) -> (DVec3, DVec3, DMat3) {
    let mut k = DMat3::ZERO;
    for _ in 0..2 {
        let turn = DMat3::from_quat(rotation(random));
        let inverse = vector(random).abs() * 5.0 + DVec3::splat(0.05);
        let inertia = turn * DMat3::from_diagonal(inverse) * turn.transpose();
        let inv_mass = between(random, -3.0, 3.0).exp();
        k += compliance(inv_mass, &inertia, vector(random));
    }
    let (n, dv) = (direction(random), vector(random));
    (n, if dv.dot(n) < 0.0 { -dv } else { dv }, k)
}

fn blend() -> Outcome {
    let mut findings = Findings::new();
    let mut random = SplitMix64::new(25);
    let (mut over, mut kept): (f64, f64) = (0.0, 0.0);
    let mut approaching = 0;
    const COUNT: usize = 100_000;
    for _ in 0..COUNT {
        let (n, dv, k) = contact(&mut random);
        let before = 0.5 * dv.dot(k.inverse() * dv);
        for response in MODELS {
            let energy = |e: f64, mu: f64| {
                let pair = Coefficients {
                    elasticity: e,
                    friction: mu,
                };
                let f = impulse(response, pair, n, dv, &k);
                let gained = f.dot(dv) + 0.5 * f.dot(k * f);
                (1.0 + gained / before, n.dot(dv + k * f))
            };
            let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(e, mu)| {
                let after = energy(e, mu).0;
                over = worse(over, after - 1.0);
                after
            });
            kept = worse(kept, (corners[1] - 1.0).abs());
            if response == Response::UnoSlater {
                kept = worse(kept, (corners[3] - 1.0).abs());
            }
            let largest = corners.into_iter().fold(0.0, worse);
            let (after, leaving) = energy(random.uniform(), random.uniform());
            let bound = match response {
                // Coulomb's law is no blend of corners.
                Response::Coulomb => 1.0,
                _ => largest.min(1.0),
            };
            over = worse(over, after - bound);
            approaching += usize::from(leaving > 1e-9 * dv.length());
        }
    }
    findings.at_most("E over its bound by", over, 1e-12, "of it");
    findings.at_most("F10, F11 off by", kept, 1e-12, "");
    findings.none_of("still approach", approaching, MODELS.len() * COUNT);
    findings.outcome()
}

fn random_impacts() -> Outcome {
    let mut findings = Findings::new();
    let mut random = SplitMix64::new(28);
    let (mut p_off, mut l_off, mut gained): (f64, f64, f64) = (0.0, 0.0, 0.0);
    let mut missed = 0;
    const COUNT: usize = 100_000;
    for i in 0..COUNT {
        let response = MODELS[i % MODELS.len()];
        let setup = Setup::new(response)
            .weightless()
            .contact(random.uniform(), random.uniform());
        let mut world = setup.world();
        let n = direction(&mut random);
        let (_, a) = ball_off_centre(&mut world, &setup, &mut random, DVec3::ZERO);
        let (_, b) = ball_off_centre(&mut world, &setup, &mut random, n * 0.2001);
        let speed = between(&mut random, 1.0, 10.0);
        // Towards each other, and the spins too slow to part the balls before they meet.
        let spins = [(); 2].map(|()| vector(&mut random));
        world.set_velocity(a, n * speed, spins[0]);
        world.set_velocity(b, n * -speed, spins[1]);
        let (energy, (p, l)) = (world.energy(), momenta(&world));
        let (scale_p, scale_l) = (speed_sum(&world), l.length() + speed_sum(&world) * 0.1);
        world.step();
        missed += usize::from(world.impacts().is_empty());
        let (p1, l1) = momenta(&world);
        p_off = worse(p_off, (p1 - p).length() / scale_p);
        l_off = worse(l_off, (l1 - l).length() / scale_l);
        gained = worse(gained, world.energy() / energy - 1.0);
    }
    findings.at_most("P off by", p_off, 1e-12, "");
    findings.at_most("L", l_off, 1e-10, "");
    findings.at_most("E up by", gained, 1e-12, "");
    findings.none_of("missed", missed, COUNT);
    findings.outcome()
}

/// A ball of radius 0.1 m at a place, its centre of mass somewhere inside and its inertia anything.
fn ball_off_centre(
    world: &mut World,
    setup: &Setup,
    random: &mut SplitMix64,
    at: DVec3,
) -> (DVec3, BodyId) {
    let off = vector(random) * 0.05;
    let sphere = Shape::sphere(0.1).expect("the radius is valid");
    let shape = Compound::new(vec![(Pose::from_position(off), sphere)]);
    let mass = between(random, -2.0, 2.0).exp();
    let spread = DVec3::new(
        between(random, 0.8, 1.2),
        between(random, 0.8, 1.2),
        between(random, 0.8, 1.2),
    );
    let inertia = spread * (0.4 * mass * 0.01);
    let shape = shape.expect("one part makes a body");
    let mut def = setup.body(shape, MassProperties { mass, inertia }, DVec3::ZERO);
    def.pose.rotation = rotation(random);
    def.pose.position = at - def.pose.rotation * off;
    (off, world.add(def))
}

/// Sum of the momenta's sizes: what the sum of the momenta is measured against.
fn speed_sum(world: &World) -> f64 {
    let bodies = world.ids().map(|id| world.body(id));
    bodies
        .map(|b| b.mass().mass * b.linear_velocity().length())
        .sum()
}
