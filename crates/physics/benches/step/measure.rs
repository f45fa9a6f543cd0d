//! The contests: who takes which turn, and how long.

use std::array;
use std::time::Instant;

use physics::{Effort, Response, World};

use crate::rapier::{PEERS, Peer};
use crate::rounds::{Times, percentile, seconds};
use crate::scenes::{DURATION, MODELS, RATES, THROWS, awake, counted_steps, fallen, rack, shot};

/// Simulated time of a turn in which pins stand awake [s].
const STANDING: u32 = 5;
/// Simulated time of a turn in which they sleep, ours and the peer's [s].
const ASLEEP: u32 = 5_000;
const PEER_ASLEEP: u32 = 20;
/// Simulated time before it, in which a rack settles and falls asleep [s].
const SETTLING: u32 = 5;
/// How often a step is timed; the least counts.
const REPEATS: usize = 5;

/// How throws end, counted together.
#[derive(Clone, Copy, Debug, Default)]
pub struct End {
    /// Pins that fell.
    pub fallen: usize,
    /// Bodies that are not asleep.
    pub awake: usize,
}

impl End {
    fn add(&mut self, fallen: usize, awake: usize) {
        self.fallen += fallen;
        self.awake += awake;
    }
}

/// Times per simulated second, by rate and model; and the peers', by rate and pin.
#[derive(Default)]
pub struct Contest {
    /// Ours.
    pub ours: [[Times; MODELS.len()]; RATES.len()],
    /// The peers'.
    pub peer: [[Times; PEERS.len()]; RATES.len()],
    /// What all throws of a round end with.
    pub ends_ours: [[End; MODELS.len()]; RATES.len()],
    /// The peers'.
    pub ends_peer: [[End; PEERS.len()]; RATES.len()],
}

/// All throws, throw by throw; worlds are made before the clock runs.
pub fn shots(rounds: usize) -> Contest {
    let mut contest = Contest::default();
    let share = 1.0 / f64::from(THROWS * DURATION);
    for round in 0..rounds {
        let mut ours = [[0.0; MODELS.len()]; RATES.len()];
        let mut peers = [[0.0; PEERS.len()]; RATES.len()];
        for throw in 0..THROWS {
            for (i, rate) in RATES.into_iter().enumerate() {
                let steps = rate * DURATION;
                for (j, (_, response)) in MODELS.into_iter().enumerate() {
                    let mut world = shot(response, rate, throw);
                    ours[i][j] += seconds(|| counted_steps(&mut world, steps));
                    if round == 0 {
                        contest.ends_ours[i][j].add(fallen(&world), awake(&world));
                    }
                }
                for (j, (_, pins)) in PEERS.into_iter().enumerate() {
                    let mut peer = Peer::shot(pins, rate, throw);
                    peers[i][j] += seconds(|| peer.run(steps));
                    if round == 0 {
                        contest.ends_peer[i][j].add(peer.fallen(), peer.awake());
                    }
                }
            }
        }
        contest.note(ours, peers, share, share);
    }
    contest
}

impl Contest {
    /// Adds a round.
    fn note(
        &mut self,
        ours: [[f64; MODELS.len()]; RATES.len()],
        peers: [[f64; PEERS.len()]; RATES.len()],
        our_share: f64,
        peer_share: f64,
    ) {
        for (times, spent) in self.ours.iter_mut().flatten().zip(ours.iter().flatten()) {
            times.0.push(spent * our_share);
        }
        for (times, spent) in self.peer.iter_mut().flatten().zip(peers.iter().flatten()) {
            times.0.push(spent * peer_share);
        }
    }
}

/// A rack that has settled, by rate and model, and the peers'.
type Racks = (
    [[World; MODELS.len()]; RATES.len()],
    [[Peer; PEERS.len()]; RATES.len()],
);

fn racks(sleeping: bool) -> Racks {
    let ours = array::from_fn(|i| {
        array::from_fn(|j| {
            let mut world = rack(MODELS[j].1, RATES[i], sleeping);
            counted_steps(&mut world, SETTLING * RATES[i]);
            world
        })
    });
    let peers = array::from_fn(|i| {
        array::from_fn(|j| {
            let mut peer = Peer::rack(PEERS[j].1, RATES[i], sleeping);
            peer.run(SETTLING * RATES[i]);
            peer
        })
    });
    (ours, peers)
}

/// Racks go on for so long [s] in every turn.
fn rest(rounds: usize, (mut ours, mut peers): Racks, our_time: u32, peer_time: u32) -> Contest {
    let mut contest = Contest::default();
    for _ in 0..rounds {
        let times = array::from_fn(|i| {
            array::from_fn(|j| seconds(|| counted_steps(&mut ours[i][j], our_time * RATES[i])))
        });
        let theirs = array::from_fn(|i| {
            array::from_fn(|j| seconds(|| peers[i][j].run(peer_time * RATES[i])))
        });
        let shares = (1.0 / f64::from(our_time), 1.0 / f64::from(peer_time));
        contest.note(times, theirs, shares.0, shares.1);
    }
    contest
}

/// Ten pins stand, sleeping off.
pub fn standing(rounds: usize) -> Contest {
    rest(rounds, racks(false), STANDING, STANDING)
}

/// Ten pins sleep.
pub fn asleep(rounds: usize) -> Contest {
    rest(rounds, racks(true), ASLEEP, PEER_ASLEEP)
}

/// Times of single steps [us].
pub struct Tail {
    /// Median.
    pub median: f64,
    /// 99th percentile.
    pub slow: f64,
    /// The longest.
    pub longest: f64,
    /// Mean time of each simulated second of a throw [us].
    pub seconds: [f64; DURATION as usize],
}

/// Times of the steps of all throws, for each rate, of each model and each of the peers.
pub fn tails() -> Vec<(u32, &'static str, Tail)> {
    let mut tails = Vec::new();
    for rate in RATES {
        for (name, response) in MODELS {
            let make = |throw| shot(response, rate, throw);
            tails.push((rate, name, tail(rate, make, World::step)));
        }
        for (name, pins) in PEERS {
            let make = |throw| Peer::shot(pins, rate, throw);
            tails.push((rate, name, tail(rate, make, Peer::step)));
        }
    }
    tails
}

fn tail<T>(rate: u32, make: impl Fn(u32) -> T, step: impl Fn(&mut T)) -> Tail {
    let steps = (rate * DURATION) as usize;
    let (mut all, mut seconds) = (Vec::new(), [0.0; DURATION as usize]);
    for throw in 0..THROWS {
        let mut least = vec![f64::INFINITY; steps];
        for _ in 0..REPEATS {
            let mut world = make(throw);
            for least in &mut least {
                let start = Instant::now();
                step(&mut world);
                *least = least.min(1e6 * start.elapsed().as_secs_f64());
            }
        }
        for (sum, second) in seconds.iter_mut().zip(least.chunks(rate as usize)) {
            *sum += second.iter().sum::<f64>() / f64::from(THROWS);
        }
        all.extend(least);
    }
    Tail {
        median: percentile(&mut all, 0.5),
        slow: percentile(&mut all, 0.99),
        longest: percentile(&mut all, 1.0),
        seconds,
    }
}

/// Work of a model's throws at a rate, all together.
pub fn effort(response: Response, rate: u32) -> Effort {
    let mut sum = Effort::default();
    for throw in 0..THROWS {
        let mut world = shot(response, rate, throw);
        counted_steps(&mut world, rate * DURATION);
        let effort = world.effort();
        sum.stretches += effort.stretches;
        sum.events += effort.events;
        sum.impulses += effort.impulses;
        sum.looks += effort.looks;
        sum.passes += effort.passes;
    }
    sum
}
