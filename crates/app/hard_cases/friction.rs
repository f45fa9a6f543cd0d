//! Friction: slopes, skids, leaning cards, a coin, a rod that Coulomb's law jams. Sections 2.11 and 3.

use glam::{DQuat, DVec3};
use physics::{BodyDef, BodyId, Compound, MassProperties, Pose, Response, Shape, World};

use super::Case;
use super::findings::{Findings, Outcome, worse};
use super::scene::{BALL_RADIUS, G, MODELS, RATES, Setup, run};

pub const CASES: &[Case] = &[
    Case {
        name: "painleve-rod",
        section: "2.11",
        expected: "mu beyond the critical: no rigid answer; a finite, passive one (analysis)",
        criterion: "rods at 30 to 70 deg, both ways, mu 0.5 to 5: E never up by 1e-6, finite",
        run: painleve,
    },
    Case {
        name: "box-on-slope",
        section: "3.4",
        expected: "slips iff tan > mu, then a = g (sin - mu cos): coulomb (analysis)",
        criterion: "threshold 0.1 deg, a 1 %, creep 0.1 mm/min, 60 to 1440 Hz",
        run: box_on_slope,
    },
    Case {
        name: "cylinder-on-slope",
        section: "3.4",
        expected: "upright: slips iff tan > mu, a = g (sin - mu cos): coulomb (analysis)",
        criterion: "threshold 0.1 deg, a 1 %, creep 0.1 mm/min, 60 to 1440 Hz",
        run: cylinder_on_slope,
    },
    Case {
        name: "sphere-rolls-down",
        section: "3.5",
        expected: "no slip iff tan < 3.5 mu; a = 5/7 g sin, else g (sin - mu cos) (analysis)",
        criterion: "speeds 0.5 % 0.5 deg either side; all models, 60 to 1440 Hz",
        run: sphere_on_slope,
    },
    Case {
        name: "cylinder-rolls-down",
        section: "3.5",
        expected: "no slip iff tan < 3 mu; a = 2/3 g sin, else g (sin - mu cos) (analysis)",
        criterion: "speeds 0.5 % 0.5 deg either side; all models, 60 to 1440 Hz",
        run: lying_cylinder_on_slope,
    },
    Case {
        name: "skid-to-roll",
        section: "3.6",
        expected: "t = 2 v0/(7 mu g), x = 12 v0^2/(49 mu g), v = 5/7 v0: coulomb (analysis)",
        criterion: "0.5 % at 90 to 1440 Hz, mu 0.04 to 0.25; then v constant to 1e-4 for 18 m",
        run: skid,
    },
    Case {
        name: "rolling-keeps-speed",
        section: "3.6",
        expected: "8 m/s and 73.7 rad/s stay over 18 m (analysis; rapier loses 5 %)",
        criterion: "v and w 1e-4, all models, 60 to 1440 Hz",
        run: rolling,
    },
    Case {
        name: "leaning-cards",
        section: "3.9",
        expected: "two cards stand iff mu >= tan/2: coulomb (analysis)",
        criterion: "60 s at 1.2 times that, fall at 0.8 times; 60 to 720 Hz",
        run: cards,
    },
    Case {
        name: "eulers-disk",
        section: "3.13",
        expected: "W^2 sin a = 4 g/R, then rest (Moffatt)",
        criterion: "30, 10, 5, 3 deg: a and W 5 % for 1 s; no step adds 1e-5 E; rest in 60 s",
        run: coin,
    },
];

fn painleve() -> Outcome {
    let mut findings = Findings::new();
    let (mut gained, mut strongest): (f64, f64) = (f64::NEG_INFINITY, 0.0);
    let (mut broken, mut count) = (0, 0);
    for response in MODELS {
        for mu in [0.5, 1.0, 2.0, 5.0] {
            for degrees in [30.0, 40.0, 50.0, 60.0, 70.0] {
                for way in [-1.0, 1.0] {
                    // The paper's friction rate ends at 1.
                    let mu = if response == Response::Coulomb {
                        mu
                    } else {
                        f64::min(mu, 1.0)
                    };
                    let setup = Setup::new(response).contact(0.0, mu);
                    let (most, impulse, finite) = drag_rod(&setup, f64::to_radians(degrees), way);
                    count += 1;
                    broken += usize::from(!finite);
                    gained = worse(gained, most);
                    strongest = worse(strongest, impulse);
                }
            }
        }
    }
    findings.at_most("E up by", gained, 1e-6, "of it");
    findings.at_most("strongest impulse", strongest, 100.0, "m v");
    findings.none_of("not finite", broken, count);
    findings.outcome()
}

/// Drags the lower end of a leaning rod over the floor: largest rise of energy, largest impulse, all finite.
fn drag_rod(setup: &Setup, angle: f64, way: f64) -> (f64, f64, bool) {
    let (half, radius, mass, speed) = (0.5, 0.01, 1.0, 3.0);
    let mut world = setup.world();
    world.add(setup.ground());
    let shape = super::scene::single(Shape::capsule(radius, half));
    let across = mass * half * half / 3.0;
    let inertia = DVec3::new(across, 0.5 * mass * radius * radius, across);
    let mut def = setup.body(shape, MassProperties { mass, inertia }, DVec3::ZERO);
    // The axis rises by `angle` towards +x.
    def.pose.rotation = DQuat::from_rotation_z(angle - std::f64::consts::FRAC_PI_2);
    def.pose.position = DVec3::Y * (half * angle.sin() + radius);
    def.linear_velocity = DVec3::X * (speed * way);
    let id = world.add(def);
    let scale = 0.5 * mass * speed * speed;
    let mut before = world.energy();
    let (mut most, mut strongest): (f64, f64) = (f64::NEG_INFINITY, 0.0);
    for _ in 0..720 {
        world.step();
        most = worse(most, (world.energy() - before) / scale);
        before = world.energy();
        let impulses = world.impacts().iter().map(|i| i.impulse.length());
        strongest = impulses.fold(strongest, worse);
    }
    let body = world.body(id);
    let finite = body.pose().is_finite() && !body.is_frozen() && before.is_finite();
    (most, strongest / (mass * speed), finite)
}

fn box_on_slope() -> Outcome {
    on_slope(|setup| setup.cuboid(DVec3::new(0.1, 0.05, 0.08), 2.0, DVec3::Y * 0.05))
}

fn cylinder_on_slope() -> Outcome {
    on_slope(|setup| setup.cylinder(0.1, 0.05, 2.0, DVec3::Y * 0.05))
}

/// A body that cannot tip or roll, on slopes about the one where it begins to slide.
fn on_slope(body: fn(&Setup) -> BodyDef) -> Outcome {
    let mut findings = Findings::new();
    let (mut creep, mut off): (f64, f64) = (0.0, 0.0);
    let (mut stuck, mut count) = (0, 0);
    for hz in RATES {
        for mu in [0.1, 0.3, 0.6f64] {
            let slide = |angle: f64, seconds: f64| {
                let setup = Setup::new(Response::Coulomb)
                    .rate(hz)
                    .contact(0.0, mu)
                    .slope(angle);
                let mut world = setup.world();
                world.add(setup.ground());
                let id = world.add(body(&setup));
                let from = world.body(id).pose().position;
                run(&mut world, seconds);
                let body = world.body(id);
                let way = (body.pose().position - from).length();
                (way, body.linear_velocity().x / world.time())
            };
            let threshold = mu.atan();
            creep = worse(creep, slide(threshold - 0.1f64.to_radians(), 60.0).0);
            count += 1;
            stuck += usize::from(slide(threshold + 0.1f64.to_radians(), 2.0).0 < 0.01);
            for more in [2.0, 10.0f64] {
                let angle = threshold + more.to_radians();
                let right = G * (angle.sin() - mu * angle.cos());
                off = worse(off, (slide(angle, 1.0).1 / right - 1.0).abs());
            }
        }
    }
    findings.at_most("creep", 1e3 * creep, 0.1, "mm/min");
    findings.none_of("stick above", stuck, count);
    findings.at_most("a off by", 100.0 * off, 1.0, "%");
    findings.outcome()
}

fn sphere_on_slope() -> Outcome {
    roll_down(0.4, |setup| setup.ball(0.1, 3.0, DVec3::Y * 0.1))
}

fn lying_cylinder_on_slope() -> Outcome {
    roll_down(0.5, |setup| {
        let mut def = setup.cylinder(0.1, 0.2, 3.0, DVec3::Y * 0.1);
        def.pose.rotation = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
        def
    })
}

/// A round body with moment `share` m r^2 from rest, for a second, r = 0.1 m.
fn roll_down(share: f64, body: fn(&Setup) -> BodyDef) -> Outcome {
    let mut findings = Findings::new();
    let mut off: f64 = 0.0;
    let mut where_off = String::new();
    let mut judge = |setup: Setup, angle: f64, (v, w): (f64, f64)| {
        let setup = setup.slope(angle);
        let mut world = setup.world();
        world.add(setup.ground());
        let id = world.add(body(&setup));
        run(&mut world, 1.0);
        let body = world.body(id);
        let dv = body.linear_velocity() - DVec3::X * v;
        let dw = (body.angular_velocity() + DVec3::Z * w) * 0.1;
        let worst = worse(dv.length(), dw.length()) / v;
        if worse(worst, off) != off {
            off = worst;
            where_off = format!(
                "{:?} {} Hz {:.1} deg",
                setup.response,
                setup.step_hz,
                angle.to_degrees()
            );
        }
    };
    for hz in RATES {
        let rolling = |angle: f64| {
            let v = G * angle.sin() / (1.0 + share);
            (v, v / 0.1)
        };
        for response in [Response::UnoSlater, Response::Guarded] {
            for degrees in [5.0, 30.0f64] {
                let setup = Setup::new(response).rate(hz).contact(0.0, 1.0);
                judge(setup, degrees.to_radians(), rolling(degrees.to_radians()));
            }
        }
        for mu in [0.1, 0.2f64] {
            let setup = Setup::new(Response::Coulomb).rate(hz).contact(0.0, mu);
            let threshold = (mu * (1.0 + 1.0 / share)).atan();
            let below = threshold - 0.5f64.to_radians();
            judge(setup, below, rolling(below));
            judge(setup, 0.5 * below, rolling(0.5 * below));
            let above = threshold + 0.5f64.to_radians();
            let v = G * (above.sin() - mu * above.cos());
            judge(setup, above, (v, mu * G * above.cos() / (share * 0.1)));
        }
    }
    findings.at_most("speeds off by", 100.0 * off, 0.5, "%");
    findings.note(format!("most at {where_off}"));
    findings.outcome()
}

fn skid() -> Outcome {
    let mut findings = Findings::new();
    let (mut time_off, mut speed_off, mut change): (f64, f64, f64) = (0.0, 0.0, 0.0);
    let v0 = 8.0;
    for hz in [90.0, 720.0, 1440.0] {
        for mu in [0.04, 0.12, 0.25] {
            let setup = Setup::new(Response::Coulomb).rate(hz).contact(0.0, mu);
            let mut world = setup.world();
            world.add(setup.ground());
            let mut def = setup.ball(BALL_RADIUS, 6.8, DVec3::Y * BALL_RADIUS);
            def.linear_velocity = DVec3::X * v0;
            let id = world.add(def);
            let right = 2.0 * v0 / (7.0 * mu * G);
            run(&mut world, right + 0.5);
            let (x, v) = place_and_speed(&world, id);
            // x(t) = x_roll + v (t - t_roll) with x_roll = 6/7 v0 t_roll; the lag behind v t gives t_roll.
            let lag = x - 5.0 / 7.0 * v0 * world.time();
            time_off = worse(time_off, (7.0 * lag / v0 / right - 1.0).abs());
            speed_off = worse(speed_off, (v / (5.0 / 7.0 * v0) - 1.0).abs());
            run(&mut world, 18.0 / v);
            change = worse(change, (place_and_speed(&world, id).1 / v - 1.0).abs());
        }
    }
    findings.at_most("t, x off by", 100.0 * time_off, 0.5, "%");
    findings.at_most("v", 100.0 * speed_off, 0.5, "%");
    findings.at_most("then v changes by", change, 1e-4, "");
    findings.outcome()
}

fn place_and_speed(world: &World, id: BodyId) -> (f64, f64) {
    let body = world.body(id);
    (body.pose().position.x, body.linear_velocity().x)
}

fn rolling() -> Outcome {
    let mut findings = Findings::new();
    let (mut v_off, mut w_off): (f64, f64) = (0.0, 0.0);
    for response in MODELS {
        for hz in RATES {
            let setup = Setup::new(response).rate(hz).contact(0.49, 0.3);
            let mut world = setup.world();
            world.add(setup.floor());
            let mut def = setup.bowling_ball(DVec3::new(-9.0, BALL_RADIUS, 0.0));
            def.linear_velocity = DVec3::X * 8.0;
            def.angular_velocity = DVec3::NEG_Z * (8.0 / BALL_RADIUS);
            let right = def.angular_velocity;
            let id = world.add(def);
            run(&mut world, 18.0 / 8.0);
            let body = world.body(id);
            v_off = worse(v_off, (body.linear_velocity() / 8.0 - DVec3::X).length());
            let w = (body.angular_velocity() - right).length() / right.length();
            w_off = worse(w_off, w);
        }
    }
    findings.at_most("v off by", v_off, 1e-4, "");
    findings.at_most("w", w_off, 1e-4, "");
    findings.outcome()
}

/// Half height and half thickness of a card [m].
const CARD: (f64, f64) = (0.05, 0.001);

/// A card that leans by `angle` towards the middle, its top edge round; `side` is -1 for the left one.
fn card(setup: &Setup, angle: f64, side: f64) -> (BodyDef, f64) {
    let (half, thin) = CARD;
    let plate = Shape::cuboid(DVec3::new(thin, half, 0.03)).expect("the card's sizes are valid");
    let edge = Shape::cylinder(thin, 0.03).expect("the card's sizes are valid");
    let along_z = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let parts = vec![
        (Pose::IDENTITY, plate),
        (Pose::new(DVec3::Y * half, along_z), edge),
    ];
    let shape = Compound::new(parts).expect("two parts make a body");
    let mass = 0.02;
    let square = DVec3::new(thin * thin, half * half, 9e-4);
    let inertia = (DVec3::splat(square.element_sum()) - square) * (mass / 3.0);
    let mut def = setup.body(shape, MassProperties { mass, inertia }, DVec3::ZERO);
    let rotation = DQuat::from_rotation_z(side * angle);
    // The inner lower edge is the foot; the top's centre is `thin` beside the middle plane.
    let foot = rotation * DVec3::new(-side * thin, -half, 0.0);
    let top = rotation * (DVec3::Y * half);
    let middle = DVec3::new(side * thin - top.x, -foot.y, 0.0);
    def.pose = Pose::new(middle, rotation);
    // Moments about the foot: the push at the top against the weight.
    let critical = (foot.x / (top.y - foot.y)).abs();
    (def, critical)
}

fn cards() -> Outcome {
    let mut findings = Findings::new();
    let (mut wrong, mut count, mut which) = (0, 0, Vec::new());
    for hz in [60.0, 90.0, 720.0] {
        for degrees in [15.0, 25.0f64] {
            for (share, stands) in [(1.2, true), (0.8, false)] {
                let angle = degrees.to_radians();
                let setup = Setup::new(Response::Coulomb).rate(hz);
                let critical = card(&setup, angle, 1.0).1;
                let setup = setup.contact(0.0, share * critical);
                let mut world = setup.world();
                world.add(setup.floor());
                let left = world.add(card(&setup, angle, -1.0).0);
                let right = world.add(card(&setup, angle, 1.0).0);
                let from = [left, right].map(|id| world.body(id).pose().position);
                let mut stood = true;
                while stood && world.time() < if stands { 60.0 } else { 5.0 } {
                    run(&mut world, 1.0);
                    let now = [left, right].map(|id| world.body(id).pose().position);
                    stood = (0..2).all(|k| now[k].distance(from[k]) < 1e-3);
                }
                count += 1;
                if stood != stands {
                    wrong += 1;
                    which.push(format!("{share} of mu at {degrees} deg {hz} Hz"));
                }
            }
        }
    }
    findings.none_of("wrong", wrong, count);
    findings.holds(which.is_empty(), || which.join("; "));
    findings.outcome()
}

/// Radius and half thickness of the coin [m].
const COIN: (f64, f64) = (0.05, 2e-4);

/// A coin in steady motion at `lean` from lying: the contact runs round, the centre stands still.
fn spun_coin(setup: &Setup, lean: f64) -> (World, BodyId, f64) {
    let (radius, thin) = COIN;
    let mut world = setup.world();
    world.add(setup.ground());
    let mut def = setup.cylinder(radius, thin, 0.1, DVec3::ZERO);
    let rotation = DQuat::from_rotation_z(lean);
    def.pose.rotation = rotation;
    let rim = rotation * DVec3::new(-radius, -thin, 0.0);
    def.pose.position = DVec3::Y * -rim.y;
    let rate = (4.0 * G / (radius * lean.sin())).sqrt();
    // It turns about the line through centre and contact.
    def.angular_velocity = rotation * DVec3::X * (rate * lean.sin());
    let id = world.add(def);
    (world, id, rate)
}

/// Angle between the coin and the floor [rad], and where its axis points to [rad].
fn lean_and_heading(world: &World, id: BodyId) -> (f64, f64) {
    let axis = world.body(id).pose().rotation * DVec3::Y;
    (axis.x.hypot(axis.z).atan2(axis.y), (-axis.z).atan2(axis.x))
}

fn coin() -> Outcome {
    let mut findings = Findings::new();
    let (mut lean_off, mut rate_off, mut rise): (f64, f64, f64) = (0.0, 0.0, f64::NEG_INFINITY);
    let (mut moving, mut count) = (0, 0);
    for response in MODELS {
        for hz in [90.0, 720.0, 1440.0] {
            let setup = Setup::new(response).rate(hz).contact(0.0, 1.0);
            for degrees in [30.0, 10.0, 5.0, 3.0f64] {
                let lean = degrees.to_radians();
                let (mut world, id, rate) = spun_coin(&setup, lean);
                let start = world.energy();
                let (mut phase, mut before) = (0.0, lean_and_heading(&world, id).1);
                let mut energy = start;
                for _ in 0..hz as u32 {
                    world.step();
                    let (now, heading) = lean_and_heading(&world, id);
                    lean_off = worse(lean_off, (now / lean - 1.0).abs());
                    // The nearest of all angles that look the same: up to half a round from the steady motion's.
                    let due = rate / hz;
                    phase += due + super::scene::wrapped(heading - before - due);
                    before = heading;
                    rise = worse(rise, (world.energy() - energy) / start);
                    energy = world.energy();
                }
                rate_off = worse(rate_off, (phase / rate - 1.0).abs());
            }
            let (mut world, id, _) = spun_coin(&setup, 0.05);
            run(&mut world, 60.0);
            count += 1;
            moving += usize::from(world.body(id).angular_velocity().length() > 1e-3);
        }
    }
    findings.at_most("a off by", 100.0 * lean_off, 5.0, "%");
    findings.at_most("W", 100.0 * rate_off, 5.0, "%");
    findings.at_most("step adds", rise, 1e-5, "E0");
    findings.none_of("never rest", moving, count);
    findings.outcome()
}
