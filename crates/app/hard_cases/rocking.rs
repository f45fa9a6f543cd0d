//! Rocking on an edge, section 3.3.

use glam::{DQuat, DVec3};
use physics::{BodyDef, BodyId, MassProperties, Pose, Shape, World};

use super::Case;
use super::findings::{Findings, Outcome, worse};
use super::scene::{
    BASE_RADIUS, G, MODELS, PIN, PIN_CG, Setup, composite_pin, ellipsoid_pin, run, single, tilt,
};

pub const CASES: &[Case] = &[
    Case {
        name: "tip-angle",
        section: "3.3",
        expected: "returns below atan(r/h) and falls above: 10.05 to 11.64 deg (analysis)",
        criterion: "right at 0.2 deg below and above, 8 directions, 60 to 1440 Hz",
        run: tip_angle,
    },
    Case {
        name: "rocking-loss",
        section: "3.3",
        expected: "e = 0: w+/w- = (k2+h2-r2)/(k2+h2+r2), .955 .946 .940 (Housner)",
        criterion: "2 % per impact, four impacts, r = 25.8, 28.6, 30 mm; below 0.1 deg in 20 s",
        run: rocking_loss,
    },
    Case {
        name: "rocking-period",
        section: "3.3",
        expected: "quarter period acosh(1/(1-a/tip))/p: 0.1157, 0.1915, 0.3000 s (Housner)",
        criterion: "5 % from tip/4, tip/2, 3 tip/4",
        run: rocking_period,
    },
];

/// Height of the centre of mass [m] and moments of the source's test pin.
const HEIGHT: f64 = 0.1456;
const TEST_PIN: MassProperties = MassProperties {
    mass: 1.5,
    inertia: DVec3::new(0.01205, 2e-3, 0.01205),
};

/// The source's test pin as an upright cylinder that stands on the floor.
fn test_pin(setup: &Setup, radius: f64) -> BodyDef {
    let shape = single(Shape::cylinder(radius, HEIGHT));
    setup.body(shape, TEST_PIN, DVec3::Y * HEIGHT)
}

/// Leans a body with a flat base about the lowest point of its rim.
fn lean(def: &mut BodyDef, base: f64, height: f64, angle: f64, direction: f64) {
    let axis = DVec3::new(direction.cos(), 0.0, direction.sin());
    let rotation = DQuat::from_axis_angle(axis, angle);
    let outward = axis.cross(DVec3::Y);
    let rim = [outward, -outward].map(|o| (rotation * (o * base - DVec3::Y * height)).y);
    def.pose = Pose::new(DVec3::Y * -rim[0].min(rim[1]), rotation);
}

fn tip_angle() -> Outcome {
    let mut findings = Findings::new();
    let (mut wrong, mut count) = (0, 0);
    let mut which = Vec::new();
    for response in MODELS {
        for hz in [60.0, 90.0, 720.0, 1440.0] {
            for direction in 0..8 {
                for (e, mu) in [(0.49, 0.49), (0.0, 1.0), (0.5, 0.0)] {
                    let setup = Setup::new(response).rate(hz).contact(e, mu);
                    for shape in 0..5 {
                        for off in [-0.2, 0.2] {
                            count += 1;
                            let direction = f64::from(direction) * 0.7;
                            if falls(&setup, shape, off, direction) != (off > 0.0) {
                                wrong += 1;
                                which.push((shape, hz, off));
                            }
                        }
                    }
                }
            }
        }
    }
    findings.none_of("wrong", wrong, count);
    findings.holds(which.is_empty(), || {
        format!(
            "the first (shape, Hz, degrees): {:?}",
            &which[..which.len().min(3)]
        )
    });
    findings.outcome()
}

/// Whether a body falls that is let go `off` degrees from its tip angle: three test pins and the two reference pins.
fn falls(setup: &Setup, shape: usize, off: f64, direction: f64) -> bool {
    let mut world = setup.world();
    world.add(setup.floor());
    let (mut def, base, height) = match shape {
        0..3 => {
            let radius = [0.0258, 0.0286, 0.03][shape];
            (test_pin(setup, radius), radius, HEIGHT)
        }
        3 => (
            setup.pin(&composite_pin(), DVec3::ZERO),
            BASE_RADIUS,
            PIN_CG,
        ),
        _ => (
            setup.pin(&ellipsoid_pin(), DVec3::ZERO),
            BASE_RADIUS,
            PIN_CG,
        ),
    };
    let angle = (base / height).atan() + off.to_radians();
    lean(&mut def, base, height, angle, direction);
    let id = world.add(def);
    while world.time() < 3.0 {
        world.step();
        let tilt = tilt(world.body(id));
        if tilt > 30.0 {
            return true;
        }
        // Far from the balance on its way back.
        if tilt < 0.5 * angle.to_degrees() {
            return false;
        }
    }
    // Neither: wrong both ways.
    off < 0.0
}

/// Energy of the test pin above its rest [J].
fn energy_above_rest(world: &World) -> f64 {
    world.energy() - TEST_PIN.mass * G * HEIGHT
}

fn rocking_loss() -> Outcome {
    let mut findings = Findings::new();
    let (mut off, mut left): (f64, f64) = (0.0, 0.0);
    let (mut said, mut stuck) = (Vec::new(), Vec::new());
    for radius in [0.0258, 0.0286, 0.03] {
        let k2 = TEST_PIN.inertia.x / TEST_PIN.mass;
        let (sum, r2) = (k2 + HEIGHT * HEIGHT, radius * radius);
        let right = (sum - r2) / (sum + r2);
        let mut worst = right;
        for response in MODELS {
            for hz in [90.0, 720.0] {
                let setup = Setup::new(response).rate(hz).contact(0.0, 1.0);
                let mut world = setup.world();
                world.add(setup.floor());
                let mut def = test_pin(&setup, radius);
                lean(&mut def, radius, HEIGHT, 5f64.to_radians(), 0.0);
                let id = world.add(def);
                // Upright all energy is motion about the edge, so the ratio of rates is the root of that of energies.
                let energies = energies_between_impacts(&mut world, id, 5);
                for pair in energies.windows(2) {
                    let ratio = (pair[1] / pair[0]).sqrt();
                    if worse((ratio - right).abs(), (worst - right).abs()) != (worst - right).abs()
                    {
                        worst = ratio;
                    }
                }
                if energies.len() < 5 {
                    stuck.push(format!("{response:?} {hz} Hz r {radius} m"));
                }
                let rest = 20.0 - world.time();
                run(&mut world, rest);
                left = worse(left, tilt(world.body(id)));
            }
        }
        off = worse(off, (worst / right - 1.0).abs());
        said.push(format!("{worst:.4} ({right:.4})"));
    }
    findings.note(format!("ratios {} furthest from right", said.join(" ")));
    findings.at_most("off by", 100.0 * off, 2.0, "%");
    findings.at_most("left", left, 0.1, "deg");
    findings.holds(stuck.is_empty(), || format!("stuck: {}", stuck.join("; ")));
    findings.outcome()
}

/// Energies above rest in so many swings from one side to the other [J], each when its lean is largest.
fn energies_between_impacts(world: &mut World, id: BodyId, count: usize) -> Vec<f64> {
    let mut energies = Vec::new();
    let (mut side, mut largest, mut energy) = (1.0, 0.0, 0.0);
    while energies.len() < count && world.time() < 5.0 {
        let axis = world.body(id).pose().rotation * DVec3::Y;
        if axis.z * side < 0.0 {
            energies.push(energy);
            (side, largest) = (-side, 0.0);
        }
        if axis.z.abs() >= largest {
            (largest, energy) = (axis.z.abs(), energy_above_rest(world));
        }
        world.step();
    }
    energies
}

fn rocking_period() -> Outcome {
    let mut findings = Findings::new();
    let mut off: f64 = 0.0;
    // The reference pin about its edge.
    let arm2 = PIN_CG * PIN_CG + BASE_RADIUS * BASE_RADIUS;
    let about_edge = PIN.inertia.x + PIN.mass * arm2;
    let p = (PIN.mass * G * arm2.sqrt() / about_edge).sqrt();
    let tip = (BASE_RADIUS / PIN_CG).atan();
    for response in MODELS {
        for hz in [90.0, 720.0] {
            for share in [0.25, 0.5, 0.75] {
                let setup = Setup::new(response).rate(hz).contact(0.0, 1.0);
                let mut world = setup.world();
                world.add(setup.floor());
                let mut def = setup.pin(&composite_pin(), DVec3::ZERO);
                lean(&mut def, BASE_RADIUS, PIN_CG, share * tip, 0.0);
                let id = world.add(def);
                let right = (1.0 / (1.0 - share)).acosh() / p;
                off = worse(off, (upright_at(&mut world, id) / right - 1.0).abs());
            }
        }
    }
    findings.at_most("off by", 100.0 * off, 5.0, "%");
    findings.outcome()
}

/// When a body that leans towards +z first passes the upright [s], between the steps before and after.
fn upright_at(world: &mut World, id: BodyId) -> f64 {
    let mut before = f64::NAN;
    while world.time() < 2.0 {
        let axis = world.body(id).pose().rotation * DVec3::Y;
        if axis.z <= 0.0 {
            return world.time() + axis.z / (before - axis.z) * world.dt();
        }
        before = axis.z;
        world.step();
    }
    f64::NAN
}
