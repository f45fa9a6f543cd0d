//! Single impacts, section 2.

use glam::DVec3;
use physics::{BodyDef, BodyId, MassProperties, Response, Shape, World};

use super::Case;
use super::findings::{Findings, Outcome, worse};
use super::scene::{G, MODELS, RATES, Setup, momenta, run, single};

pub const CASES: &[Case] = &[
    Case {
        name: "ball-drop-elastic",
        section: "2.1",
        expected: "e = 1: every apex is the height of the drop, 1 m (analysis)",
        criterion: "20 apexes within 0.1 %, none above start + 0.1 mm, 60 to 1440 Hz",
        run: elastic_drop,
    },
    Case {
        name: "ball-drop-zeno",
        section: "2.2",
        expected: "apex k is e^2k h; rest after sqrt(2h/g) (1+e)/(1-e) (analysis)",
        criterion: "apexes over 5 mm 1 %, rest time 3 %, e = 0.8 and 0.5, 60 to 1440 Hz",
        run: zeno,
    },
    Case {
        name: "masses-1-to-1000",
        section: "2.3",
        expected: "speeds of a central impact, 1:1000, 1:1, 1000:1 (analysis)",
        criterion: "1e-5 for e = 1, 0.5, 0",
        run: mass_ratios,
    },
    Case {
        name: "oblique-corners",
        section: "2.4",
        expected: "a spinning sphere on a plane after F00, F10, F01, F11 (analysis)",
        criterion: "velocities 1e-5",
        run: corners,
    },
    Case {
        name: "ball-hits-pin-centrally",
        section: "2.6",
        expected: "J = (1+e) 8 / (1/6.8 + 1/1.5 + h^2/I): 8.621 N s at e = 0 (analysis)",
        criterion: "impulse and velocities 1e-4, at 60 to 1440 Hz",
        run: central_hit,
    },
    Case {
        name: "grazing-hit",
        section: "2.7",
        expected: "normal asin(b/(R+r)), impulse of the normal speed (analysis)",
        criterion: "64 phases, d = 1e-1 to 1e-4: all hit, impulse 2 %, normal 0.5 deg",
        run: grazing,
    },
    Case {
        name: "cradle-with-gaps",
        section: "2.10",
        expected: "five balls 0.1 mm apart: the last leaves with v0 (analysis)",
        criterion: "the others at most 1e-3 v0",
        run: cradle_with_gaps,
    },
    Case {
        name: "cradle-touching",
        section: "2.10",
        expected: "E and P exact; which balls leave is not for rigid bodies to say",
        criterion: "E and P 1e-9, finite; the outcome is printed",
        run: touching_cradle,
    },
];

fn elastic_drop() -> Outcome {
    let mut findings = Findings::new();
    let (mut lowest, mut highest): (f64, f64) = (f64::INFINITY, 0.0);
    for response in MODELS {
        for hz in RATES {
            let setup = Setup::new(response).rate(hz).contact(1.0, 0.0);
            let apexes = apexes(&setup, 20, 20.0);
            findings.holds(apexes.len() == 20, || {
                format!("only {} bounces", apexes.len())
            });
            for apex in apexes {
                lowest = -worse(-lowest, -apex);
                highest = worse(highest, apex);
            }
        }
    }
    findings.at_least("apexes from", lowest, 0.999, "m");
    findings.at_most("to", highest, 1.0001, "m");
    findings.outcome()
}

/// Heights of the apexes of a ball dropped from 1 m onto a floor, from what it has after each bounce [m].
fn apexes(setup: &Setup, most: usize, seconds: f64) -> Vec<f64> {
    let radius = 0.1;
    let mut world = setup.world();
    let floor = world.add(setup.floor());
    let id = world.add(setup.ball(radius, 6.8, DVec3::Y * (1.0 + radius)));
    let mut apexes = Vec::new();
    let (mut highest, mut bounced) = (0.0, false);
    while apexes.len() < most && world.time() < seconds {
        world.step();
        let body = world.body(id);
        let height = body.pose().position.y - radius;
        let up = body.linear_velocity().y;
        if world.touching(id, floor) {
            if bounced {
                apexes.push(highest);
            }
            (highest, bounced) = (0.0, true);
        }
        // In flight what it has now decides the apex; a step may hold the bounce and a part of the flight.
        highest = worse(highest, height + up * up / (2.0 * G));
    }
    apexes
}

fn zeno() -> Outcome {
    let mut findings = Findings::new();
    let (mut apex_off, mut rest_off): (f64, f64) = (0.0, 0.0);
    for response in MODELS {
        for hz in RATES {
            for e in [0.8, 0.5] {
                let setup = Setup::new(response).rate(hz).contact(e, 0.0);
                let heights = apexes(&setup, 40, 5.0);
                let mut right = e * e;
                let mut k = 0;
                while right > 5e-3 {
                    let apex = heights.get(k).copied().unwrap_or(f64::NAN);
                    apex_off = worse(apex_off, (apex / right - 1.0).abs());
                    (right, k) = (right * e * e, k + 1);
                }
                let right = (2.0 / G).sqrt() * (1.0 + e) / (1.0 - e);
                rest_off = worse(rest_off, (rest_time(&setup) / right - 1.0).abs());
            }
        }
    }
    findings.at_most("apexes off by", 100.0 * apex_off, 1.0, "%");
    findings.at_most("rest times", 100.0 * rest_off, 3.0, "%");
    findings.outcome()
}

/// When a ball dropped from 1 m moves for the last time [s].
fn rest_time(setup: &Setup) -> f64 {
    let mut world = setup.world();
    world.add(setup.floor());
    let id = world.add(setup.ball(0.1, 6.8, DVec3::Y * 1.1));
    let mut last = 0.0;
    while world.time() < 6.0 {
        world.step();
        if world.body(id).linear_velocity().length() > 1e-6 {
            last = world.time();
        }
    }
    last
}

fn mass_ratios() -> Outcome {
    let mut findings = Findings::new();
    let mut off: f64 = 0.0;
    for response in MODELS {
        for (m1, m2) in [(1.0, 1000.0), (1.0, 1.0), (1000.0, 1.0)] {
            for e in [1.0, 0.5, 0.0] {
                let setup = Setup::new(response).weightless().contact(e, 0.0);
                let mut world = setup.world();
                let mut first = setup.ball(0.1, m1, DVec3::ZERO);
                first.linear_velocity = DVec3::X * 3.0;
                let first = world.add(first);
                let second = world.add(setup.ball(0.1, m2, DVec3::X * 0.5));
                while world.impacts().is_empty() && world.time() < 1.0 {
                    world.step();
                }
                let common = 3.0 * m1 / (m1 + m2);
                for (id, right) in [
                    (first, common - e * 3.0 * m2 / (m1 + m2)),
                    (second, common + e * common),
                ] {
                    let v = world.body(id).linear_velocity();
                    off = worse(off, (v - DVec3::X * right).length() / 3.0);
                }
            }
        }
    }
    findings.at_most("speeds off by", off, 1e-5, "of v0");
    findings.outcome()
}

fn corners() -> Outcome {
    let mut findings = Findings::new();
    let mut off: f64 = 0.0;
    let radius = 0.1085;
    for response in MODELS {
        for spin in [-20.0, 0.0, 90.0] {
            for (e, rough) in [(0.0, false), (1.0, false), (0.0, true), (1.0, true)] {
                // Rough enough for Coulomb's cone to hold what it takes to stick: 2 s / 7 v_n at most.
                let mu = match (rough, response) {
                    (false, _) => 0.0,
                    (true, Response::Coulomb) => 10.0,
                    (true, _) => 1.0,
                };
                let setup = Setup::new(response).weightless().contact(e, mu);
                let mut world = setup.world();
                world.add(setup.ground());
                let mut def = setup.ball(radius, 6.8, DVec3::Y * (radius + 0.01));
                def.linear_velocity = DVec3::new(8.0, -1.0, 0.0);
                def.angular_velocity = DVec3::Z * spin;
                let id = world.add(def);
                while world.impacts().is_empty() && world.time() < 1.0 {
                    world.step();
                }
                let slip = 8.0 + radius * spin;
                let hop = (1.0 + 2.0 / 7.0 * slip * slip).sqrt();
                let up = match (e, rough, response) {
                    (0.0, _, _) => 0.0,
                    // The guarded model limits it to the approach speed, Coulomb's law to e times that.
                    (_, true, Response::UnoSlater) => hop,
                    _ => 1.0,
                };
                let lost = if rough { slip } else { 0.0 };
                let right = DVec3::new(8.0 - 2.0 / 7.0 * lost, up, 0.0);
                // From the rate of turning follows what the slip became.
                let turning = spin - 5.0 / 7.0 * lost / radius;
                let body = world.body(id);
                let w = body.angular_velocity() - DVec3::Z * turning;
                off = worse(off, (body.linear_velocity() - right).length() / 8.0);
                off = worse(off, w.length() * radius / 8.0);
            }
        }
    }
    findings.at_most("velocities off by", off, 1e-5, "of 8 m/s");
    findings.outcome()
}

/// The test pin of the source: 1.5 kg, its centre at 0.1456 m; the inertia is the one that its figures imply.
fn source_pin(setup: &Setup) -> BodyDef {
    let mass = MassProperties {
        mass: 1.5,
        inertia: DVec3::new(0.01205, 2e-3, 0.01205),
    };
    // An upright cylinder, so that the normal is level.
    let shape = single(Shape::cylinder(0.06, 0.14));
    setup.body(shape, mass, DVec3::Y * 0.1456)
}

fn central_hit() -> Outcome {
    let mut findings = Findings::new();
    let (mut impulse_off, mut speeds_off): (f64, f64) = (0.0, 0.0);
    for response in MODELS {
        for hz in RATES {
            for e in [0.0, 0.5, 1.0] {
                let setup = Setup::new(response).rate(hz).weightless().contact(e, 0.0);
                let mut world = setup.world();
                let pin = world.add(source_pin(&setup));
                let mut def = setup.ball(0.1085, 6.8, DVec3::new(0.0, 0.1085, 1.0));
                def.linear_velocity = DVec3::NEG_Z * 8.0;
                let ball = world.add(def);
                while world.impacts().is_empty() && world.time() < 1.0 {
                    world.step();
                }
                let arm = 0.1456 - 0.1085;
                let denominator = 1.0 / 6.8 + 1.0 / 1.5 + arm * arm / 0.01205;
                let right = (1.0 + e) * 8.0 / denominator;
                let first = world.impacts().first();
                let given = first.map_or(f64::NAN, |i| i.impulse.length());
                impulse_off = worse(impulse_off, (given / right - 1.0).abs());
                if e == 0.0 {
                    // Nothing parts them: ball and pin press on for the rest of the step.
                    continue;
                }
                let (ball, pin) = (world.body(ball), world.body(pin));
                for (speed, right) in [
                    (-ball.linear_velocity().z, 8.0 - right / 6.8),
                    (-pin.linear_velocity().z, right / 1.5),
                    (pin.angular_velocity().length(), right * arm / 0.01205),
                ] {
                    speeds_off = worse(speeds_off, (speed / right - 1.0).abs());
                }
            }
        }
    }
    findings.at_most("impulse off by", impulse_off, 1e-4, "");
    findings.at_most("velocities off by", speeds_off, 1e-4, "");
    findings.outcome()
}

fn grazing() -> Outcome {
    let mut findings = Findings::new();
    let (mut impulse_off, mut normal_off): (f64, f64) = (0.0, 0.0);
    let (mut missed, mut count) = (0, 0);
    let (radius, pin_radius, speed) = (0.1085, 0.06, 8.0);
    for hz in [60.0, 90.0] {
        for d in [1e-1, 1e-2, 1e-3, 1e-4] {
            for phase in 0..64 {
                let setup = Setup::new(Response::Guarded)
                    .rate(hz)
                    .weightless()
                    .contact(0.5, 0.0);
                let mut world = setup.world();
                let mut pin = source_pin(&setup);
                pin.pose.position = DVec3::ZERO;
                world.add(pin);
                let aside = (radius + pin_radius) * (1.0 - d);
                let start = 0.5 + f64::from(phase) / 64.0 * speed / hz;
                let mut def = setup.ball(radius, 6.8, DVec3::new(aside, 0.0, start));
                def.linear_velocity = DVec3::NEG_Z * speed;
                world.add(def);
                while world.impacts().is_empty() && world.time() * speed < start + 0.5 {
                    world.step();
                }
                count += 1;
                let Some(hit) = world.impacts().first() else {
                    missed += 1;
                    continue;
                };
                let angle = (aside / (radius + pin_radius)).asin();
                let right = 1.5 * speed * angle.cos() / (1.0 / 6.8 + 1.0 / 1.5);
                impulse_off = worse(impulse_off, (hit.impulse.length() / right - 1.0).abs());
                let found = hit.normal.x.abs().atan2(hit.normal.z.abs());
                normal_off = worse(normal_off, (found - angle).to_degrees().abs());
            }
        }
    }
    findings.none_of("missed", missed, count);
    findings.at_most("impulse off by", 100.0 * impulse_off, 2.0, "%");
    findings.at_most("normal", normal_off, 0.5, "deg");
    findings.outcome()
}

/// Five balls in a line, the first thrown at the others with 1 m/s; their speeds after 2 s.
fn cradle(setup: &Setup, gap: f64) -> (World, Vec<f64>) {
    let radius = 0.05;
    let mut world = setup.world();
    let mut first = setup.ball(radius, 1.0, DVec3::X * -0.5);
    first.linear_velocity = DVec3::X;
    let mut ids = vec![world.add(first)];
    for k in 0..4 {
        let at = DVec3::X * (f64::from(k) * (2.0 * radius + gap));
        ids.push(world.add(setup.ball(radius, 1.0, at)));
    }
    run(&mut world, 2.0);
    let speed = |id: &BodyId| world.body(*id).linear_velocity().x;
    let speeds = ids.iter().map(speed).collect();
    (world, speeds)
}

fn cradle_with_gaps() -> Outcome {
    let mut findings = Findings::new();
    let (mut last, mut others): (f64, f64) = (0.0, 0.0);
    for response in MODELS {
        for hz in RATES {
            let setup = Setup::new(response).rate(hz).weightless().contact(1.0, 0.0);
            let (_, speeds) = cradle(&setup, 1e-4);
            last = worse(last, (speeds[4] - 1.0).abs());
            others = speeds[..4].iter().map(|v| v.abs()).fold(others, worse);
        }
    }
    findings.at_most("last off by", last, 1e-3, "v0");
    findings.at_most("others", others, 1e-3, "v0");
    findings.outcome()
}

fn touching_cradle() -> Outcome {
    let mut findings = Findings::new();
    let (mut energy_off, mut momentum_off): (f64, f64) = (0.0, 0.0);
    let mut outcomes = Vec::new();
    for response in MODELS {
        for hz in RATES {
            let setup = Setup::new(response).rate(hz).weightless().contact(1.0, 0.0);
            let (world, speeds) = cradle(&setup, 0.0);
            energy_off = worse(energy_off, (world.energy() / 0.5 - 1.0).abs());
            momentum_off = worse(momentum_off, (momenta(&world).0 - DVec3::X).length());
            let rounded: Vec<f64> = speeds.iter().map(|v| (v * 1e3).round() / 1e3).collect();
            if !outcomes.contains(&rounded) {
                outcomes.push(rounded);
            }
        }
    }
    findings.at_most("E off by", energy_off, 1e-9, "");
    findings.at_most("P", momentum_off, 1e-9, "");
    findings.note(format!("speeds {outcomes:?} v0"));
    findings.outcome()
}
