//! What each effect costs, in instructions: the same scenes with all effects and with one of them left out.
//!
//! `cargo bench -p physics --bench effects -- report` runs each scene under `valgrind --tool=callgrind`, which counts the
//! instructions of the steps alone, and writes docs/effects.md. Without `report` the work of each effect is printed, in
//! bodies and contacts. `run SCENE EFFECT..` is what runs under valgrind.

#[path = "query/machine.rs"]
mod machine;
#[path = "../tests/support/mod.rs"]
mod support;

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

use glam::DVec3;
use physics::{Effect, Effects, OilPattern, Pose, Response, Settings, World};
use support::{
    BALL_RADIUS, Random, add_building, ball, composite_pin, every_effect, hand, material, pin,
    spots,
};

const INTRODUCTION: &str = "\
# Effects: what each costs

Written by `cargo bench -p physics --bench effects -- report`; do not edit by hand. Instructions per step of 1/720 s on one
core (valgrind's callgrind, the steps alone; they are the same on every run), in scenes that list all effects, all but
one, the default set, and none. What an effect saves when it is left out is its own work and what follows from it: without
gravity nothing lies on anything, without friction nothing rolls.

- `roll`: a ball rolls for a second over oil towards a rack that falls asleep, a hand moves above the lane.
- `throws`: sixteen throws of three seconds at 8 m/s into the rack. Which pins fall, and so what there is to do, changes with
  every effect that is left out.
- `flight`: ten pins tumble through the air for a second and touch nothing.

The models are `guarded`, and in the last column `coulomb`.

";

/// A scene, by name.
const SCENES: [&str; 3] = ["roll", "throws", "flight"];
/// Throws of the scene of that name.
const THROWS: u32 = 16;

fn settings(response: Response, effects: Effects) -> Settings {
    Settings {
        effects,
        ..every_effect(response)
    }
}

/// An alley with oil, a rack, a hand and a ball that rolls at `speed` [m/s] from `z` [m].
fn alley(settings: Settings, x: f64, z: f64, speed: f64) -> World {
    let m = material(0.7, 0.7);
    let mut world = World::new(settings).expect("these settings can run");
    let lane = add_building(&mut world, m)[0];
    let foul_line = -world.body(lane).pose().position.z;
    let corners = ([-0.53, foul_line], [0.53, foul_line - 12.192]);
    let oil = OilPattern::new(
        corners.0,
        corners.1,
        [3, 2],
        vec![0.8, 0.2, 0.8, 1.0, 0.4, 1.0],
    );
    world.set_oil(lane, oil.expect("six factors for six nodes"));
    for spot in spots() {
        let mut def = pin(&composite_pin(), m, spot);
        def.drag_area_m2 = 0.03;
        world.add(def);
    }
    let mut def = ball(m, DVec3::new(x, BALL_RADIUS, z));
    def.linear_velocity = DVec3::NEG_Z * speed;
    def.angular_velocity = DVec3::new(-0.8 * speed / BALL_RADIUS, 0.0, 5.0);
    def.drag_area_m2 = 0.02;
    world.add(def);
    world.add(hand(m, DVec3::new(-0.6, 0.4, -17.0)));
    world
}

/// Ten pins that tumble far from each other.
fn flight(settings: Settings) -> World {
    let mut world = World::new(settings).expect("these settings can run");
    let mut random = Random(7);
    for spot in spots() {
        let mut def = pin(&composite_pin(), material(0.7, 0.7), spot * 30.0);
        def.drag_area_m2 = 0.03;
        def.linear_velocity = random.vector();
        def.angular_velocity = random.vector() * 20.0;
        world.add(def);
    }
    world
}

/// The worlds of a scene, and the steps that each is to take.
fn scene(name: &str, settings: Settings) -> (Vec<World>, u32) {
    match name {
        "roll" => (vec![alley(settings, 0.1, -1.0, 8.0)], 720),
        "flight" => (vec![flight(settings)], 720),
        _ => {
            let throw = |i| alley(settings, 0.012 * f64::from(i) - 0.09, -17.0, 8.0);
            ((0..THROWS).map(throw).collect(), 3 * 720)
        }
    }
}

/// What callgrind counts, found by its name.
#[inline(never)]
fn counted_steps(world: &mut World, steps: u32) {
    let hand = world.ids().last();
    for i in 0..steps {
        if let Some(hand) = hand {
            let y = 0.4 + 1e-4 * f64::from(i % 2);
            world.drive_to(hand, Pose::from_position(DVec3::new(-0.6, y, -17.0)));
        }
        world.step();
    }
}

/// Takes all steps of a scene; returns their number.
fn run(name: &str, settings: Settings) -> (Vec<World>, u32) {
    let (mut worlds, steps) = scene(name, settings);
    for world in &mut worlds {
        counted_steps(world, steps);
    }
    let count = steps * worlds.len() as u32;
    (worlds, count)
}

fn response(name: &str) -> Response {
    match name {
        "coulomb" => Response::Coulomb,
        _ => Response::Guarded,
    }
}

/// Instructions per step of a scene, as callgrind counts them.
fn instructions(scene: &str, law: &str, effects: Effects) -> u64 {
    let program = std::env::current_exe().expect("a running program has a path");
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .args(["--collect-atstart=no", "--toggle-collect=*counted_steps*"])
        .arg(program)
        .args(["run", scene, law])
        .args(effects.iter().map(Effect::name))
        .output()
        .expect("valgrind has to be installed");
    let said = String::from_utf8_lossy(&output.stderr);
    let collected = said.lines().find_map(|line| {
        let (_, count) = line.split_once("Collected :")?;
        count.trim().parse::<u64>().ok()
    });
    let total = collected.unwrap_or_else(|| panic!("no count of instructions in:\n{said}"));
    let steps = String::from_utf8_lossy(&output.stdout);
    let steps: u64 = steps.trim().parse().expect("the run prints its steps");
    total / steps
}

/// Sets of effects with their names: all, all but one each, the default, none.
fn sets() -> Vec<(String, Effects)> {
    let all: Effects = Effect::ALL.into_iter().collect();
    let mut sets = vec![("all".to_owned(), all)];
    let less = |effect: Effect| (format!("without {effect}"), all.without(effect));
    sets.extend(Effect::ALL.map(less));
    sets.push(("default".to_owned(), Effects::default()));
    sets.push(("none".to_owned(), Effects::NONE));
    sets
}

fn report() {
    let columns = [
        ("roll", "guarded"),
        ("throws", "guarded"),
        ("flight", "guarded"),
        ("throws", "coulomb"),
    ];
    let mut text = format!("{INTRODUCTION}{}\n\n| effects |", machine::describe());
    for (scene, law) in columns {
        let _ = write!(text, " {scene}, {law} | |");
    }
    text.push_str("\n|---|");
    text.push_str(&"--:|--:|".repeat(columns.len()));
    text.push('\n');
    let mut full = [0; 4];
    for (name, effects) in sets() {
        let _ = write!(text, "| {name} |");
        for (i, (scene, law)) in columns.into_iter().enumerate() {
            let count = instructions(scene, law, effects);
            if name == "all" {
                full[i] = count;
            }
            let change = 100.0 * (count as f64 / full[i] as f64 - 1.0);
            let _ = write!(text, " {count} | {change:+.1} % |");
        }
        text.push('\n');
        println!("{name}");
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/effects.md");
    std::fs::write(&path, text).expect("docs can be written to");
}

fn print_work() {
    for name in SCENES {
        let all = Effect::ALL.into_iter().collect();
        let (worlds, steps) = run(name, settings(Response::Guarded, all));
        println!("{name}, {steps} steps:");
        for effect in Effect::ALL {
            let counts = worlds.iter().map(|world| world.effort().work.of(effect));
            println!("  {effect}: {}", counts.sum::<u64>());
        }
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["run", scene, law, ref effects @ ..] => {
            let known = |name: &&str| Effect::from_name(name);
            let effects = effects.iter().filter_map(known).collect();
            let (_, steps) = run(scene, settings(response(law), effects));
            println!("{steps}");
        }
        ["report", ..] => report(),
        _ => print_work(),
    }
}
