//! Whole shots: what they keep, and what they must not gain. Sections 2.8, 2.9 and 3.14.

use glam::DVec3;
use physics::{Pose, Response, World};

use super::Case;
use super::findings::{Findings, Outcome, worse};
use super::scene::{
    BALL_RADIUS, MODELS, RATES, Setup, add_alley, add_rack, close_alley, composite_pin,
    ellipsoid_pin, momenta, run, throw,
};

pub const CASES: &[Case] = &[
    Case {
        name: "momentum-of-a-shot",
        section: "2.8",
        expected: "ten pins struck in free space: P and L constant (analysis)",
        criterion: "P 1e-6, L 1e-5, at 60 to 1440 Hz",
        run: momentum,
    },
    Case {
        name: "overlap-keeps-momentum",
        section: "2.8",
        expected: "bodies that begin inside each other: P and L constant (analysis)",
        criterion: "P and L 1e-9 of m v, no energy appears",
        run: overlap,
    },
    Case {
        name: "weightless-elastic-shot",
        section: "2.9",
        expected: "e = 1, mu = 0 in a closed alley: energy ratio 1 (analysis)",
        criterion: "1 +- 1e-5 after every step of 4 s, at 60 to 1440 Hz",
        run: weightless_shot,
    },
    Case {
        name: "closed-alley-10-min",
        section: "2.9",
        expected: "e = 1, mu = 0 under gravity: energy ratio 1 (analysis)",
        criterion: "1 +- 2e-4 through 10 minutes, every number finite, all inside",
        run: closed_alley,
    },
    Case {
        name: "energy-never-rises",
        section: "3.14",
        expected: "nothing in a shot does work: E(t) falls or stays (analysis)",
        criterion: "no step adds more than 1e-5 of E0, 240 shots of 3 s",
        run: energy_audit,
    },
];

fn momentum() -> Outcome {
    let mut findings = Findings::new();
    let (mut p_off, mut l_off): (f64, f64) = (0.0, 0.0);
    let mut broken = Vec::new();
    for response in MODELS {
        for hz in RATES {
            for (e, mu) in [(0.49, 0.49), (1.0, 0.0), (0.0, 1.0)] {
                let setup = Setup::new(response).rate(hz).weightless().contact(e, mu);
                let mut world = setup.world();
                add_rack(&mut world, &setup, &composite_pin());
                throw(&mut world, &setup, 0.03, 1.0, 8.0);
                let (p, l) = momenta(&world);
                run(&mut world, 2.0);
                let (p1, l1) = momenta(&world);
                let off = (p1 - p).length() / p.length();
                p_off = worse(p_off, off);
                l_off = worse(l_off, (l1 - l).length() / l.length());
                if worse(off, 1e-6) != 1e-6 {
                    broken.push(format!("{response:?} {hz} Hz e {e} mu {mu}"));
                }
            }
        }
    }
    findings.at_most("P off by", p_off, 1e-6, "");
    findings.at_most("L", l_off, 1e-5, "");
    findings.holds(broken.is_empty(), || {
        format!(
            "in {} of 36 settings, the first {}",
            broken.len(),
            broken[0]
        )
    });
    findings.outcome()
}

fn overlap() -> Outcome {
    let mut findings = Findings::new();
    let (mut off, mut gained): (f64, f64) = (0.0, f64::NEG_INFINITY);
    for response in MODELS {
        for hz in RATES {
            let setup = Setup::new(response)
                .rate(hz)
                .weightless()
                .contact(0.49, 0.49);
            let mut world = setup.world();
            // Two pins and a ball a centimetre inside each other, drifting together.
            for x in [0.0, 0.11] {
                world.add(setup.pin(&composite_pin(), DVec3::X * x));
            }
            world.add(setup.bowling_ball(DVec3::new(0.055, 0.2, 0.14)));
            for id in world.ids().collect::<Vec<_>>() {
                world.set_velocity(id, DVec3::X, DVec3::ZERO);
            }
            let (energy, (p, l)) = (world.energy(), momenta(&world));
            run(&mut world, 2.0);
            let (p1, l1) = momenta(&world);
            off = worse(off, (p1 - p).length() / p.length());
            off = worse(off, (l1 - l).length() / p.length());
            gained = worse(gained, world.energy() / energy - 1.0);
        }
    }
    findings.at_most("P, L off by", off, 1e-9, "");
    findings.at_most("E up by", gained, 1e-9, "");
    findings.outcome()
}

fn weightless_shot() -> Outcome {
    let mut findings = Findings::new();
    let mut off: f64 = 0.0;
    for response in MODELS {
        for pin in [composite_pin(), ellipsoid_pin()] {
            for hz in RATES {
                let setup = Setup::new(response).rate(hz).weightless().contact(1.0, 0.0);
                let mut world = setup.world();
                add_alley(&mut world, &setup);
                close_alley(&mut world, &setup);
                add_rack(&mut world, &setup, &pin);
                throw(&mut world, &setup, 0.03, 1.0, 8.0);
                let start = world.energy();
                for _ in 0..(4.0 * hz) as u64 {
                    world.step();
                    off = worse(off, (world.energy() / start - 1.0).abs());
                }
            }
        }
    }
    findings.at_most("ratio off by", off, 1e-5, "");
    findings.outcome()
}

fn closed_alley() -> Outcome {
    let mut findings = Findings::new();
    let setup = Setup::new(Response::Guarded).contact(1.0, 0.0);
    let mut world = setup.world();
    add_alley(&mut world, &setup);
    close_alley(&mut world, &setup);
    add_rack(&mut world, &setup, &composite_pin());
    throw(&mut world, &setup, 0.05, 2.0, 8.0);
    // Measured from the pit's floor, so that the height of the origin has no part in the ratio.
    let depth = 0.3 * weight(&world);
    let start = world.energy() + depth;
    let mut ratio = 1.0;
    for _ in 0..600 * 720 {
        world.step();
        let now = (world.energy() + depth) / start;
        if worse((now - 1.0).abs(), (ratio - 1.0f64).abs()) != (ratio - 1.0).abs() {
            ratio = now;
        }
    }
    let inside = |pose: &Pose| {
        let p = pose.position;
        pose.is_finite() && p.x.abs() < 0.8 && (-0.4..0.7).contains(&p.y) && p.z.abs() < 3.1
    };
    let bodies = world.ids().map(|id| world.body(id));
    let out = bodies.filter(|b| moves(b) && !inside(&b.pose())).count();
    findings.near("ratio furthest from 1", ratio, 1.0, 2e-4, "");
    findings.none_of("left the alley", out, 11);
    findings.outcome()
}

fn moves(body: &physics::Body) -> bool {
    body.motion() == physics::Motion::Dynamic
}

/// Weight of all that moves [N].
fn weight(world: &World) -> f64 {
    let g = world.settings().gravity.length();
    let bodies = world.ids().map(|id| world.body(id));
    let masses = bodies.filter(|b| moves(b)).map(|b| b.mass().mass);
    masses.sum::<f64>() * g
}

fn energy_audit() -> Outcome {
    let mut findings = Findings::new();
    let mut most = f64::NEG_INFINITY;
    let (mut where_most, mut shots) = (String::new(), 0);
    let pins = [composite_pin(), ellipsoid_pin()];
    let values = [0.0, 0.49, 0.7, 1.0];
    for i in 0..20 {
        for (j, e) in values.into_iter().enumerate() {
            for (k, hz) in [60.0, 90.0, 720.0].into_iter().enumerate() {
                let response = MODELS[(i + k) % MODELS.len()];
                let mu = values[(i + j) % 4];
                let setup = Setup::new(response).rate(hz).contact(e, mu);
                let aside = -0.19 + 0.02 * i as f64;
                let (rise, step) = greatest_rise(&setup, &pins[(i / 2 + j) % 2], aside);
                shots += 1;
                if worse(rise, most) != most {
                    most = rise;
                    where_most = format!(
                        "step {step} of {response:?} e {e} mu {mu} {hz} Hz {aside:.2} m aside"
                    );
                }
            }
        }
    }
    findings.at_most("largest rise", most, 1e-5, "E0");
    findings.note(format!("{shots} shots"));
    findings.holds(most <= 1e-5, || where_most);
    findings.outcome()
}

/// The largest rise of energy in a step of a shot, as a share of the start's, and in which step.
fn greatest_rise(setup: &Setup, pin: &std::sync::Arc<physics::Compound>, aside: f64) -> (f64, u64) {
    let mut world = setup.world();
    add_alley(&mut world, setup);
    add_rack(&mut world, setup, pin);
    throw(&mut world, setup, aside, 0.5, 8.0);
    // Kinetic energy of a rolling ball of 8 m/s; heights are small beside it.
    let start = world.energy() - 6.803886 * 9.81 * BALL_RADIUS;
    let mut before = world.energy();
    let mut most = (f64::NEG_INFINITY, 0);
    for _ in 0..(3.0 * setup.step_hz) as u64 {
        world.step();
        let now = world.energy();
        let rise = (now - before) / start;
        if worse(rise, most.0) != most.0 {
            most = (rise, world.steps());
        }
        before = now;
    }
    most
}
