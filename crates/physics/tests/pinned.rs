//! A minute of everything at once, down to the last bit: throws, stacks, rocking and rolling under each model.
//!
//! The hashes are the same in debug and release, and whatever else the test binary does. A change of what is simulated
//! changes them; `PINNED` says what to do then.

mod support;

use glam::{DQuat, DVec3};
use physics::{BodyDef, BodyId, PairContact, Pose, Response, Settings, Shape, World};
use support::*;

/// Model, step rate [1/s], and the hash of all states at whole seconds.
///
/// A change that is meant to alter simulated results copies the hashes from the failure's message, in a commit of its own
/// that says which results change and why. A change that is not meant to leaves them as they are.
const PINNED: [(Response, f64, u64); 3] = [
    (Response::UnoSlater, 90.0, 0xa1af_db57_3b9b_b4dc),
    (Response::Guarded, 240.0, 0xa371_dc07_e1d7_237f),
    (Response::Coulomb, 120.0, 0x2559_e2fc_e9ef_1670),
];
/// Simulated time [s].
const MINUTE: u32 = 60;
/// A ball is thrown into a new rack every so often [s].
const THROW_EVERY: u32 = 12;
/// When the state is kept, and taken up again [s].
const MIDDLE: u32 = 30;
/// When a body comes, far from all others, and when it is taken out again [s].
const PASSER_BY: (u32, u32) = (33, 41);

/// A world and what acts in it.
#[derive(Clone)]
struct Scene {
    world: World,
    pins: Vec<BodyId>,
    ball: BodyId,
    second: u32,
    hash: u64,
}

/// A body of one part at rest on the approach, beyond the reach of the throws.
fn thing(shape: Shape, inertia: DVec3, pose: Pose) -> BodyDef {
    solid(shape, 1.2, inertia, material(0.6, 0.8), pose)
}

/// Three cubes on each other, a cylinder that rolls between the walls, and a pin that rocks.
fn furnish(world: &mut World) {
    for k in 0..3 {
        let cube = Shape::cuboid(DVec3::splat(0.1)).expect("a cube has a size");
        let at = DVec3::new(-1.5, 0.1 + 0.2 * f64::from(k), 2.0);
        world.add(thing(
            cube,
            DVec3::splat(0.04 / 6.0),
            Pose::from_position(at),
        ));
    }
    let roller = Shape::cylinder(0.08, 0.1).expect("a cylinder has a size");
    let lying = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let pose = Pose::new(DVec3::new(0.5, 0.08, 3.0), lying);
    let mut roller = thing(roller, DVec3::new(0.0049, 0.0032, 0.0049), pose);
    roller.linear_velocity = DVec3::X * 1.5;
    roller.angular_velocity = DVec3::NEG_Z * (1.5 / 0.08);
    world.add(roller);
    let mut rocker = pin(
        &composite_pin(),
        material(0.6, 0.8),
        DVec3::new(0.0, 0.0, 1.5),
    );
    rocker.angular_velocity = DVec3::Z;
    world.add(rocker);
}

impl Scene {
    fn new(response: Response, step_hz: f64) -> Scene {
        let settings = Settings {
            step_hz,
            response,
            contact: PairContact {
                restitution: 0.6,
                friction: 0.25,
            },
            ..Settings::default()
        };
        let m = material(0.7, 0.7);
        let (mut world, pins) = alley(settings, &composite_pin(), m);
        let ball = throw(&mut world, m, 0.0, 2.0, 8.0);
        furnish(&mut world);
        Scene {
            world,
            pins,
            ball,
            second: 0,
            hash: 0xcbf2_9ce4_8422_2325,
        }
    }

    /// Sets the rack anew and lets a new ball go, each time elsewhere, faster and with more spin.
    fn throw_again(&mut self) {
        for (id, spot) in self.pins.iter().zip(spots()) {
            self.world.set_velocity(*id, DVec3::ZERO, DVec3::ZERO);
            let pose = Pose::from_position(spot + DVec3::Y * PIN_CG);
            self.world.set_pose(*id, pose);
        }
        let turn = f64::from(self.second / THROW_EVERY);
        self.world.remove(self.ball);
        let x = 0.09 - 0.03 * turn;
        let m = material(0.7, 0.7);
        self.ball = throw(&mut self.world, m, x, 3.0, 7.0 + 0.5 * turn);
        let linear = DVec3::new(0.0, 0.0, -(7.0 + 0.5 * turn));
        let spin = DVec3::new(-40.0, 5.0, 10.0 * turn);
        self.world.set_velocity(self.ball, linear, spin);
    }

    /// Runs until a whole second [s], and takes the state of each into the hash.
    fn run_until(&mut self, end: u32) {
        let steps = self.world.settings().step_hz as u32;
        while self.second < end {
            if self.second > 0 && self.second.is_multiple_of(THROW_EVERY) {
                self.throw_again();
            }
            for _ in 0..steps {
                self.world.step();
            }
            self.second += 1;
            self.hash = (self.hash ^ self.world.hash()).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

/// Runs the minute under one model: straight on, from the state kept in the middle, and from there with a body that comes,
/// far away, and goes.
fn check(row: usize) {
    let (response, step_hz, pinned) = PINNED[row];
    let mut scene = Scene::new(response, step_hz);
    scene.run_until(MIDDLE);
    let (mut kept, mut visited) = (scene.clone(), scene.clone());
    scene.run_until(MINUTE);

    kept.run_until(MINUTE);
    assert_eq!(
        kept.hash, scene.hash,
        "{response:?}: a snapshot runs on to other bits"
    );

    visited.run_until(PASSER_BY.0);
    let at = DVec3::new(300.0, 900.0, 40.0);
    let passer_by = visited.world.add(ball(material(0.7, 0.7), at));
    visited.run_until(PASSER_BY.1);
    visited.world.remove(passer_by);
    visited.run_until(MINUTE);
    assert_eq!(
        visited.world.hash(),
        scene.world.hash(),
        "{response:?}: a body that came and went far away has changed the others' bits"
    );

    assert_eq!(
        scene.hash,
        pinned,
        "{response:?} at {step_hz} steps/s: the minute's hash is {:#018x}, not {pinned:#018x}. If simulated results are meant to \
         change, write the new one into PINNED in {}, in a commit of its own that says what changes; if not, something \
         has changed them.",
        scene.hash,
        file!()
    );
}

#[test]
fn a_minute_under_uno_slater_is_the_same_to_the_last_bit() {
    check(0);
}

#[test]
fn a_minute_under_guarded_is_the_same_to_the_last_bit() {
    check(1);
}

#[test]
fn a_minute_under_coulomb_is_the_same_to_the_last_bit() {
    check(2);
}
