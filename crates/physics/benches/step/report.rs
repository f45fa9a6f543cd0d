//! Writes docs/step.md.

use std::fmt::Write;
use std::path::Path;

use physics::Response;

use crate::growth::Growth;
use crate::measure::{self, Contest, Tail};
use crate::rapier::PEERS;
use crate::rounds::Times;
use crate::scenes::{DURATION, MODELS, RATES, THROWS};
use crate::{machine, profile};

/// How many times as fast as the peer a shot and ten pins that stand awake are to be, at its frame rate.
const SHOT_TARGET: f64 = 8.0;
const SHOT_STRETCH: f64 = 11.0;
const STANDING_TARGET: f64 = 7.0;
/// Time of a simulated second in which all sleeps [us], at most.
const ASLEEP_TARGET: f64 = 1.0;
/// Whole throws per second, at least.
const THROWS_TARGET: f64 = 300.0;
/// 99th percentile of a step's time over the median, at most.
const TAIL_TARGET: f64 = 3.0;
/// Power of the number of lanes, at most.
const GROWTH_TARGET: f64 = 1.05;
/// A lane that is awake among 256 over the same alone, at most: what sleeps is free but for the cache.
const SLEEPING_TARGET: f64 = 1.1;
/// Step rate for which the targets are set [1/s].
const TARGET_RATE: u32 = 90;

const INTRODUCTION: &str = "\
# The step: what it costs

Written by `cargo bench -p physics --features peers --bench step -- report`; do not edit by hand. What was tried where a target is missed,
and what the limit is: [step-limits.md](step-limits.md).

";

const SCENE: &str = "\
A lane box with gutters, kickbacks, pit and cushion; ten composite pins of 1.59 kg; a ball of 6.8 kg, radius 0.1086 m, that begins
to roll 2 m before the head pin at 8 m/s. Sixteen throws, 12 mm apart across the lane, of 4 s each. The peer is rapier3d 0.36, single
precision, default parameters, with the same boxes, masses and moments of inertia, restitution 0.5 and friction 0.2. It has no ellipsoids
and no frustums, and its time depends on what stands for them, so that three pins are measured, each a compound of four parts with a ball
for the head: `primitives`, the cheapest (cylinders for base and neck, a capsule of the same width and height for the belly); `frustums` (hulls
of two rings of 16 points for base and neck, the same capsule); `hulls` (the belly, too, is a hull, of nine rings). Targets are judged
against each, in this order.
`uno_slater` and `guarded` run with elasticity and friction rate 0.7, `coulomb` with the peer's coefficients.

Times are processor time of one core per simulated second. In every round all contenders take each throw in turn; a ratio is
taken round by round. Given are medians, in brackets lower and upper quartile.

";

/// Whether a target is kept, in a word; a rate that is not the target's has none.
fn verdict(rate: u32, is_met: bool) -> &'static str {
    match (rate == TARGET_RATE, is_met) {
        (false, _) => "-",
        (true, true) => "yes",
        (true, false) => "**no**",
    }
}

fn spread(values: [f64; 3], digits: usize) -> String {
    let [low, median, high] = values;
    format!("{median:.digits$} ({low:.digits$} to {high:.digits$})")
}

fn milliseconds(times: &Times) -> String {
    spread(times.quartiles().map(|s| 1e3 * s), 3)
}

/// Rows of a contest: each model at each rate against the peers, and the peers' own times.
fn add_contest(text: &mut String, contest: &Contest, target: f64) {
    text.push_str("| steps/s | model | ours [ms] |");
    for (pins, _) in PEERS {
        let _ = write!(text, " {pins} / ours |");
    }
    text.push_str(" target | met |\n|--:|---|--:|--:|--:|--:|--:|---|\n");
    for (i, rate) in RATES.into_iter().enumerate() {
        for (j, (name, _)) in MODELS.into_iter().enumerate() {
            let ours = &contest.ours[i][j];
            let _ = write!(text, "| {rate} | {name} | {} |", milliseconds(ours));
            let ratios: Vec<[f64; 3]> = contest.peer[i]
                .iter()
                .map(|peer| ours.times_faster_than(peer))
                .collect();
            for ratio in &ratios {
                let _ = write!(text, " {} |", spread(*ratio, 2));
            }
            let met = ratios.iter().map(|ratio| verdict(rate, ratio[1] >= target));
            let met: Vec<&str> = met.collect();
            let _ = writeln!(text, " {target} | {} |", met.join(", "));
        }
    }
    text.push_str("\n| steps/s | peer | its time [ms] |\n|--:|---|--:|\n");
    for (i, rate) in RATES.into_iter().enumerate() {
        for (j, (pins, _)) in PEERS.into_iter().enumerate() {
            let times = milliseconds(&contest.peer[i][j]);
            let _ = writeln!(text, "| {rate} | {pins} | {times} |");
        }
    }
}

/// How the throws of a round end: pins that fell, bodies that are awake.
fn add_ends(text: &mut String, contest: &Contest) {
    let pins = 10 * THROWS;
    let bodies = 11 * THROWS;
    let _ = writeln!(
        text,
        "\nAt the end of the {THROWS} throws: pins felled of {pins}, bodies awake of {bodies}.\n"
    );
    text.push_str("| steps/s | | felled | awake |\n|--:|---|--:|--:|\n");
    for (i, rate) in RATES.into_iter().enumerate() {
        let ours = MODELS
            .map(|(name, _)| name)
            .into_iter()
            .zip(contest.ends_ours[i]);
        let peers = PEERS
            .map(|(name, _)| name)
            .into_iter()
            .zip(contest.ends_peer[i]);
        for (name, end) in ours.chain(peers) {
            let _ = writeln!(text, "| {rate} | {name} | {} | {} |", end.fallen, end.awake);
        }
    }
}

fn add_shots(text: &mut String, contest: &Contest) {
    let _ = writeln!(
        text,
        "## A shot\n\nTarget: {SHOT_TARGET} times as fast as the peer, stretch {SHOT_STRETCH}.\n"
    );
    add_contest(text, contest, SHOT_TARGET);
    add_ends(text, contest);
    add_throws(text, contest);
}

fn add_throws(text: &mut String, contest: &Contest) {
    let _ = writeln!(
        text,
        "\n## Whole throws\n\nThrows of {DURATION} s a second on one core; target: {THROWS_TARGET}.\n"
    );
    text.push_str("| steps/s | model | throws/s | met |\n|--:|---|--:|---|\n");
    for (i, rate) in RATES.into_iter().enumerate() {
        for (j, (name, _)) in MODELS.into_iter().enumerate() {
            let throws = contest.ours[i][j]
                .quartiles()
                .map(|s| 1.0 / (s * f64::from(DURATION)));
            let [high, median, low] = throws;
            let met = verdict(rate, median >= THROWS_TARGET);
            let _ = writeln!(
                text,
                "| {rate} | {name} | {} | {met} |",
                spread([low, median, high], 0)
            );
        }
    }
}

fn add_standing(text: &mut String, contest: &Contest) {
    let _ = writeln!(
        text,
        "\n## Ten pins that stand awake\n\nSleeping is off on both sides. Target: {STANDING_TARGET} times as fast as the peer.\n"
    );
    add_contest(text, contest, STANDING_TARGET);
}

fn add_asleep(text: &mut String, contest: &Contest) {
    let _ = writeln!(
        text,
        "\n## Ten pins asleep\n\nTarget: at most {ASLEEP_TARGET} µs per simulated second.\n"
    );
    text.push_str("| steps/s | model | ours [µs] | peer, primitives [µs] | met |\n");
    text.push_str("|--:|---|--:|--:|---|\n");
    for (i, rate) in RATES.into_iter().enumerate() {
        for (j, (name, _)) in MODELS.into_iter().enumerate() {
            let micro = |times: &Times| times.quartiles().map(|s| 1e6 * s);
            let (ours, peer) = (micro(&contest.ours[i][j]), micro(&contest.peer[i][0]));
            let met = verdict(rate, ours[1] <= ASLEEP_TARGET);
            let _ = writeln!(
                text,
                "| {rate} | {name} | {} | {} | {met} |",
                spread(ours, 2),
                spread(peer, 0)
            );
        }
    }
}

fn add_tails(text: &mut String, tails: &[(u32, &'static str, Tail)]) {
    let _ = writeln!(
        text,
        "\n## The slowest steps\n\nOf all steps of the sixteen throws, each timed five times of which the least counts. Target: the 99th\n\
        percentile at most {TAIL_TARGET} times the median.\n"
    );
    text.push_str("| steps/s | | median [µs] | 99 % [µs] | longest [µs] | 99 % / median | met |\n");
    text.push_str("|--:|---|--:|--:|--:|--:|---|\n");
    for (rate, name, tail) in tails {
        let ratio = tail.slow / tail.median;
        let is_ours = MODELS.into_iter().any(|(model, _)| model == *name);
        let met = if is_ours {
            verdict(*rate, ratio <= TAIL_TARGET)
        } else {
            "-"
        };
        let _ = writeln!(
            text,
            "| {rate} | {name} | {:.2} | {:.2} | {:.1} | {ratio:.1} | {met} |",
            tail.median, tail.slow, tail.longest
        );
    }
}

/// When in a throw the time goes, and what the work is: both per simulated second.
fn add_work(text: &mut String, tails: &[(u32, &'static str, Tail)]) {
    text.push_str("\n## When a throw's time goes, and into what\n\n");
    text.push_str("Of the same steps: milliseconds in each second of a throw; the ball hits after a quarter of one.\n\n");
    text.push_str("| steps/s | | 1st | 2nd | 3rd | 4th |\n|--:|---|--:|--:|--:|--:|\n");
    for (rate, name, tail) in tails {
        let _ = write!(text, "| {rate} | {name} |");
        for second in tail.seconds {
            let _ = write!(text, " {:.2} |", 1e-3 * second);
        }
        text.push('\n');
    }
    text.push_str(
        "\nCounts per simulated second of a throw (`World::effort`): stretches that islands were carried through, answers of single\n\
        lasting contacts in them, times at which a pair was looked at, contacts that came about, impulses that answered them.\n\n",
    );
    text.push_str("| steps/s | model | stretches | passes | looks | events | impulses |\n");
    text.push_str("|--:|---|--:|--:|--:|--:|--:|\n");
    for rate in RATES {
        for (name, response) in MODELS {
            let effort = measure::effort(response, rate);
            let each = |count: u64| count / u64::from(THROWS * DURATION);
            let _ = writeln!(
                text,
                "| {rate} | {name} | {} | {} | {} | {} | {} |",
                each(effort.stretches),
                each(effort.passes),
                each(effort.looks),
                each(effort.events),
                each(effort.impulses)
            );
        }
    }
}

fn add_growth(text: &mut String, growth: &Growth) {
    let exponent = growth.exponent();
    let free = |lanes: usize| growth.one_awake[lanes].1;
    let asleep = free(growth.one_awake.len() - 1) / free(0);
    let word = |is_met| verdict(TARGET_RATE, is_met);
    let _ = writeln!(
        text,
        "\n## Lanes\n\nBalls fall into all racks at once (720 steps/s, `guarded`); a ball rolls down one lane while all others sleep. Least of five means.\n"
    );
    text.push_str("| lanes | all racks fall: µs a step and lane | one ball rolls: µs a step |\n|--:|--:|--:|\n");
    for (falling, one) in growth.falling.iter().zip(&growth.one_awake) {
        let _ = writeln!(text, "| {} | {:.2} | {:.3} |", falling.0, falling.1, one.1);
    }
    let _ = writeln!(
        text,
        "\nExponent of time against lanes {exponent:.3}, target at most {GROWTH_TARGET}: {}. One lane awake among 256 takes {asleep:.2} times as\n\
        long as alone, target at most {SLEEPING_TARGET}: {}.",
        word(exponent <= GROWTH_TARGET),
        word(asleep <= SLEEPING_TARGET)
    );
}

/// Measures everything, in `rounds` rounds, and writes the file.
pub fn write(rounds: usize) {
    let mut text = format!(
        "{INTRODUCTION}{}, {rounds} rounds\n\n{SCENE}",
        machine::describe()
    );
    add_shots(&mut text, &measure::shots(rounds));
    println!("shots: done");
    add_standing(&mut text, &measure::standing(rounds));
    add_asleep(&mut text, &measure::asleep(rounds));
    println!("standing, asleep: done");
    let tails = measure::tails();
    add_tails(&mut text, &tails);
    add_work(&mut text, &tails);
    println!("slowest steps: done");
    add_growth(&mut text, &Growth::measure());
    println!("lanes: done");
    let shares = profile::of_a_shot(Response::Guarded, TARGET_RATE);
    let throws = profile::THROWS;
    let _ = writeln!(
        text,
        "\n## Where a shot's instructions go\n\n`guarded`, {TARGET_RATE} steps/s, {throws} of the {THROWS} throws; valgrind's callgrind, instructions of a function without those that it\n\
        calls; what the compiler has inlined counts to its caller.\n\n{shares}"
    );
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/step.md");
    std::fs::write(&path, text).expect("docs can be written to");
    println!("docs/step.md is written");
}
