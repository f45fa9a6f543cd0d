//! Free motion and integration, section 1.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};
use physics::{BodyDef, BodyId, Compound, MassProperties, Pose, Response, Shape, World};

use super::Case;
use super::findings::{Findings, Outcome, worse};
use super::scene::{
    BALL_RADIUS, G, MODELS, RATES, Setup, composite_pin, run, single, tilt, wrapped,
};

pub const CASES: &[Case] = &[
    Case {
        name: "free-fall",
        section: "1.1",
        expected: "y = -g t^2 / 2 = -490.5 m after 10 s (analysis)",
        criterion: "1e-5 of the way, at 60 to 1440 Hz",
        run: free_fall,
    },
    Case {
        name: "dzhanibekov",
        section: "1.2",
        expected: "12 flips in 60 s, one every 5.026 s; E and L constant (analysis)",
        criterion: "12 flips, interval 1 %, E 1e-3, L 1e-4, at 60 to 1440 Hz",
        run: dzhanibekov,
    },
    Case {
        name: "symmetric-top",
        section: "1.3",
        expected: "w precesses in the body at (I3 - I1) w3 / I1; w3 constant (analysis)",
        criterion: "rate 0.1 %, w3 1e-5, over 1e5 steps about any axis",
        run: symmetric_top,
    },
    Case {
        name: "heavy-top",
        section: "1.4",
        expected: "slow precession, the smaller root for a fixed tip (analysis)",
        criterion: "mean precession 1 %, nod at most 0.2 degrees in 10 s",
        run: heavy_top,
    },
    Case {
        name: "spin-1000",
        section: "1.5",
        expected: "1000 rad/s stay 1000 rad/s, 16 rad a step at 60 Hz (analysis)",
        criterion: "w and |q| 1e-6, ball, pin and box, at 60 to 1440 Hz",
        run: spin,
    },
    Case {
        name: "million-steps",
        section: "1.6",
        expected: "numbers stay numbers, rotations rotations, no energy appears",
        criterion: "1e6 steps in flight, 1e6 at rest: |q| 1e-6, E grows by 1e-9 at most",
        run: million_steps,
    },
];

/// A body without a name: three moments of inertia [kg m2] and a turn [rad/s].
fn tumbler(setup: &Setup, inertia: DVec3, angular_velocity: DVec3) -> BodyDef {
    let shape = single(Shape::cuboid(DVec3::splat(0.1)));
    let mass = MassProperties { mass: 1.0, inertia };
    BodyDef {
        angular_velocity,
        ..setup.body(shape, mass, DVec3::ZERO)
    }
}

fn free_fall() -> Outcome {
    let mut findings = Findings::new();
    let way = 0.5 * G * 100.0;
    let mut off: f64 = 0.0;
    for hz in RATES {
        let setup = Setup::new(Response::Guarded).rate(hz);
        let mut world = setup.world();
        let id = world.add(setup.ball(0.1, 1.0, DVec3::ZERO));
        run(&mut world, 10.0);
        off = worse(off, (world.body(id).pose().position.y / -way - 1.0).abs());
    }
    findings.at_most("off by", off, 1e-5, "of the way");
    findings.outcome()
}

fn dzhanibekov() -> Outcome {
    let mut findings = Findings::new();
    let (mut energy_off, mut momentum_off): (f64, f64) = (0.0, 0.0);
    let (mut counts, mut intervals) = (Vec::new(), Vec::new());
    for hz in RATES {
        let setup = Setup::new(Response::Guarded).rate(hz).weightless();
        let mut world = setup.world();
        let inertia = DVec3::new(1e-2, 2e-2, 3e-2);
        let id = world.add(tumbler(&setup, inertia, DVec3::new(0.01, 5.0, 0.01)));
        let (energy, momentum) = (world.energy(), world.body(id).angular_momentum());
        let mut flips: Vec<f64> = Vec::new();
        let mut about_middle = 5.0;
        for _ in 0..(60.0 * hz) as u64 {
            world.step();
            let body = world.body(id);
            let own = body.pose().rotation.conjugate() * body.angular_velocity();
            if own.y * about_middle < 0.0 {
                // Where the straight line between the two steps crosses zero.
                let share = own.y / (own.y - about_middle);
                flips.push(world.time() - share / hz);
            }
            about_middle = own.y;
            energy_off = worse(energy_off, (body.kinetic_energy() / energy - 1.0).abs());
            let off = (turned(&world, id) - momentum).length() / momentum.length();
            momentum_off = worse(momentum_off, off);
        }
        counts.push(flips.len());
        let (first, last) = (flips.first().copied(), flips.last().copied());
        let span = last.unwrap_or(f64::NAN) - first.unwrap_or(f64::NAN);
        intervals.push(span / (flips.len() as f64 - 1.0));
    }
    let wrong = counts.iter().filter(|count| **count != 12).count();
    findings.holds(wrong == 0, || format!("{counts:?} flips"));
    let far = |x: &f64| (x / 5.026 - 1.0).abs();
    let worst = intervals
        .into_iter()
        .max_by(|x, y| far(x).total_cmp(&far(y)));
    findings.near("interval", worst.unwrap_or(f64::NAN), 5.026, 0.01, "s");
    findings.at_most("E off by", energy_off, 1e-3, "");
    findings.at_most("L off by", momentum_off, 1e-4, "");
    findings.outcome()
}

/// Angular momentum from pose and angular velocity, not the one that the engine keeps.
fn turned(world: &World, id: BodyId) -> DVec3 {
    let body = world.body(id);
    let rotation = body.pose().rotation;
    rotation * (rotation.conjugate() * body.angular_velocity() * body.mass().inertia)
}

fn symmetric_top() -> Outcome {
    let mut findings = Findings::new();
    let (mut rate_off, mut drift): (f64, f64) = (0.0, 0.0);
    let (across, along) = (1.37e-2, 2.0e-3);
    for hz in [90.0, 720.0] {
        // The body's axis of revolution is y; a body may have its two equal moments elsewhere.
        for axis in 0..3 {
            let setup = Setup::new(Response::Guarded).rate(hz).weightless();
            let mut world = setup.world();
            let (mut inertia, mut w) = (DVec3::splat(across), DVec3::splat(0.0));
            inertia[axis] = along;
            w[axis] = 10.0;
            w[(axis + 1) % 3] = 3.0;
            let id = world.add(tumbler(&setup, inertia, w));
            let mut phase = 0.0;
            let mut before = 0.0;
            for _ in 0..100_000 {
                world.step();
                let body = world.body(id);
                let own = body.pose().rotation.conjugate() * body.angular_velocity();
                let now = own[(axis + 2) % 3].atan2(own[(axis + 1) % 3]);
                phase += wrapped(now - before);
                before = now;
                drift = worse(drift, (own[axis] / 10.0 - 1.0).abs());
            }
            // dw1/dt = -(I3 - I1) / I1 w3 w2 and the other way round: against the spin for a long body.
            let right = (along - across) / across * 10.0;
            rate_off = worse(rate_off, (phase / world.time() / right - 1.0).abs());
        }
    }
    findings.at_most("rate off by", 100.0 * rate_off, 0.1, "%");
    findings.at_most("w3 off by", drift, 1e-5, "");
    findings.outcome()
}

/// A cone spins on its tip on a floor so rough that the tip stays where it is.
fn heavy_top() -> Outcome {
    let mut findings = Findings::new();
    let (mut worst, mut nod): (f64, f64) = (0.0, 0.0);
    for response in MODELS {
        for hz in [90.0, 720.0] {
            let setup = Setup::new(response).rate(hz).contact(0.0, 1.0);
            let (rate, nods) = top_on_its_tip(&setup);
            worst = worse(worst, rate);
            nod = worse(nod, nods);
        }
    }
    findings.at_most("precession off by", 100.0 * worst, 1.0, "%");
    findings.at_most("nod", nod, 0.2, "deg");
    findings.outcome()
}

/// How far the mean precession of a top is off, as a share, and how far its axis nods [degrees].
fn top_on_its_tip(setup: &Setup) -> (f64, f64) {
    // Centre of mass l above the tip; moments about the tip across and along the axis.
    let (mass, l, lean) = (0.5, 0.06, 0.35f64);
    let (own_across, along): (f64, f64) = (4e-4, 3e-4);
    let (across, spin) = (own_across + mass * l * l, 250.0);
    // Steady precession: across cos(lean) W^2 - along spin W + m g l = 0, the smaller root.
    let (a, b, c) = (across * lean.cos(), along * spin, mass * G * l);
    let right = 2.0 * c / (b + (b * b - 4.0 * a * c).sqrt());
    let mut world = setup.world();
    world.add(setup.ground());
    let cone = Shape::cone(0.05, 0.5 * l).expect("the cone's sizes are valid");
    // Upside down, the tip l below the centre of mass.
    let flip = DQuat::from_rotation_x(PI);
    let part = Pose::new(DVec3::NEG_Y * (0.5 * l), flip);
    let shape = Compound::new(vec![(part, cone)]).expect("one part makes a body");
    let inertia = DVec3::new(own_across, along, own_across);
    let mut def = setup.body(shape, MassProperties { mass, inertia }, DVec3::ZERO);
    let rotation = DQuat::from_rotation_z(-lean);
    let axis = rotation * DVec3::Y;
    def.pose = Pose::new(axis * l, rotation);
    // Along the axis in all `spin`; the precession about the vertical has its part in that.
    def.angular_velocity = DVec3::Y * right + axis * (spin - right * lean.cos());
    def.linear_velocity = def.angular_velocity.cross(axis * l);
    let id = world.add(def);
    let (mut phase, mut before, mut nod): (f64, f64, f64) = (0.0, 0.0, 0.0);
    for _ in 0..(10.0 * setup.step_hz) as u64 {
        world.step();
        let axis = world.body(id).pose().rotation * DVec3::Y;
        // About +y: from +x towards -z.
        let now = (-axis.z).atan2(axis.x);
        phase += wrapped(now - before);
        before = now;
        nod = worse(nod, (tilt(world.body(id)) - lean.to_degrees()).abs());
    }
    ((phase / world.time() / right - 1.0).abs(), nod)
}

fn spin() -> Outcome {
    let mut findings = Findings::new();
    let (mut speed_off, mut norm_off): (f64, f64) = (0.0, 0.0);
    for hz in RATES {
        let setup = Setup::new(Response::Guarded).rate(hz).weightless();
        let mut world = setup.world();
        let mut ball = setup.bowling_ball(DVec3::ZERO);
        ball.angular_velocity = DVec3::new(600.0, 0.0, 800.0);
        let mut pin = setup.pin(&composite_pin(), DVec3::X * 3.0);
        pin.angular_velocity = DVec3::Y * 1000.0;
        let mut cuboid = setup.cuboid(DVec3::new(0.1, 0.2, 0.3), 1.0, DVec3::X * 6.0);
        cuboid.angular_velocity = DVec3::Z * 1000.0;
        let spins = [ball, pin, cuboid].map(|def| (def.angular_velocity, world.add(def)));
        for _ in 0..(10.0 * hz) as u64 {
            world.step();
        }
        for (right, id) in spins {
            let body = world.body(id);
            speed_off = worse(speed_off, (body.angular_velocity() - right).length() / 1e3);
            norm_off = worse(norm_off, (body.pose().rotation.length() - 1.0).abs());
        }
    }
    findings.at_most("w off by", speed_off, 1e-6, "");
    findings.at_most("|q| off by", norm_off, 1e-6, "");
    findings.outcome()
}

fn million_steps() -> Outcome {
    let mut findings = Findings::new();
    let (mut norm_off, mut grown): (f64, f64) = (0.0, f64::NEG_INFINITY);
    for weightless in [true, false] {
        let mut setup = Setup::new(Response::Guarded).contact(0.49, 0.49);
        let (spin, drift) = if weightless {
            setup = setup.weightless();
            (DVec3::new(3.0, 20.0, 1.0), DVec3::new(0.3, 0.2, 0.1))
        } else {
            (DVec3::ZERO, DVec3::ZERO)
        };
        let mut world = setup.world();
        if !weightless {
            world.add(setup.ground());
        }
        let half = DVec3::new(0.1, 0.2, 0.3);
        let mut bodies = [
            setup.pin(&composite_pin(), DVec3::ZERO),
            setup.bowling_ball(DVec3::new(1.0, BALL_RADIUS, 0.0)),
            setup.cuboid(half, 1.0, DVec3::new(2.0, half.y, 0.0)),
        ];
        for def in &mut bodies {
            (def.angular_velocity, def.linear_velocity) = (spin, drift);
            world.add(def.clone());
        }
        // The box's energy swings about its value as its turn is put together; only what stays counts as growth.
        let largest = |world: &mut World| {
            let steps = 0..500_000;
            steps.fold(f64::NEG_INFINITY, |most, _| {
                world.step();
                worse(most, world.energy())
            })
        };
        let (first, second) = (largest(&mut world), largest(&mut world));
        grown = worse(grown, second / first - 1.0);
        for id in world.ids() {
            let body = world.body(id);
            findings.holds(body.pose().is_finite() && !body.is_frozen(), || {
                "a body froze".to_owned()
            });
            norm_off = worse(norm_off, (body.pose().rotation.length() - 1.0).abs());
        }
    }
    findings.at_most("|q| off by", norm_off, 1e-6, "");
    findings.at_most("E grows by", grown, 1e-9, "of it");
    findings.outcome()
}
