//! Bodies on an edge or a point: a rod that Coulomb's law jams, leaning cards, a spun coin. Sections 2.11, 3.9, 3.13.

use glam::{DQuat, DVec3};
use physics::{BodyDef, BodyId, Compound, MassProperties, Pose, Response, Shape, World};

use super::Case;
use super::findings::{Findings, Outcome, worse};
use super::scene::{G, MODELS, Setup, run, single, wrapped};

pub const CASES: &[Case] = &[
    Case {
        name: "painleve-rod",
        section: "2.11",
        expected: "mu beyond the critical: no rigid answer; a finite, passive one (analysis)",
        criterion: "rods at 30 to 70 deg, both ways, mu 0.5 to 5: E never up by 1e-6, finite",
        run: painleve,
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
    let shape = single(Shape::capsule(radius, half));
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
                    phase += due + wrapped(heading - before - due);
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
