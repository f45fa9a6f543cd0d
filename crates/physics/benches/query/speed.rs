//! Times of the query, cold and warm, and of parry on the same poses, taking turns in every round.

use std::hint::black_box;
use std::time::Instant;

use glam::{DQuat, DVec3};
use parry3d_f64::math::Pose as ParryPose;
use parry3d_f64::query::Contact;
use physics::query::{Limits, Separation, separation};
use physics::{Pose, Shape};

use crate::Filter;
use crate::judge::cases::{self, Case, Class};
use crate::judge::known::Known;
use crate::parry::{self, Rival};
use crate::support::{BASE_RADIUS, Random};
use crate::targets::{Target, targets};

/// A gap that is proven larger than this is not refined, by either library [m].
const PREDICTION: f64 = 0.05;
/// How far the warm start is off the answer [rad].
const WARM: f64 = 0.02;
/// Rounds in which the contenders take turns; the tables hold medians over them.
const ROUNDS: usize = 15;
/// Poses that a contender is asked about in one turn.
const BATCH: usize = 25;
/// Seed of all poses.
const SEED: u64 = 1;

/// One pose, ready to be asked about.
pub struct Trial {
    a: Shape,
    pose_a: Pose,
    b: Shape,
    pose_b: Pose,
    start: DVec3,
    rivals: (Rival, ParryPose, Rival, ParryPose),
}

const LIMITS: Limits = Limits {
    iteration_cap: 20,
    tolerance: 1e-13,
    enough: PREDICTION,
};

impl Trial {
    fn new(case: &Case, random: &mut Random) -> Trial {
        let (a, b) = (case.a.shape(), case.b.shape());
        let exact = Limits {
            enough: f64::INFINITY,
            ..LIMITS
        };
        let answer = separation((&a, &case.pose_a), (&b, &case.pose_b), None, exact);
        let aside = answer.normal.any_orthonormal_vector();
        let turn = DQuat::from_axis_angle(answer.normal, 3.2 * random.next());
        let start = (answer.normal + turn * aside * WARM.tan()).normalize_or(answer.normal);
        Trial {
            a,
            pose_a: case.pose_a,
            b,
            pose_b: case.pose_b,
            start,
            rivals: (
                Rival::new(&case.a),
                parry::pose(&case.pose_a),
                Rival::new(&case.b),
                parry::pose(&case.pose_b),
            ),
        }
    }

    /// The query without a known normal.
    pub fn cold(&self) -> Separation {
        separation(
            (&self.a, &self.pose_a),
            (&self.b, &self.pose_b),
            None,
            LIMITS,
        )
    }

    /// The query from a normal that is 0.02 rad off.
    pub fn warm(&self) -> Separation {
        let (a, b) = ((&self.a, &self.pose_a), (&self.b, &self.pose_b));
        separation(a, b, Some(self.start), LIMITS)
    }

    /// Parry's answer.
    pub fn parry(&self) -> Option<Contact> {
        let (a, pose_a, b, pose_b) = &self.rivals;
        parry::rival_contact((a, pose_a), (b, pose_b), PREDICTION)
    }
}

/// All poses of one pair and class.
pub struct Scene {
    pair: (&'static str, &'static str),
    class: Class,
    /// The poses.
    pub trials: Vec<Trial>,
}

impl Scene {
    /// Pair and class.
    pub fn name(&self) -> String {
        format!("{}-{} {}", self.pair.0, self.pair.1, self.class.name())
    }
}

/// The scenes that the filters take, one after the other.
pub fn scenes<'a>(
    pairs: &'a Filter,
    classes: &'a Filter,
    poses: usize,
) -> impl Iterator<Item = Scene> + 'a {
    let mixed = cases::pairs()
        .into_iter()
        .flat_map(|pair| Class::ALL.map(|class| (pair, class)));
    let resting = [
        (("lane", "pin"), Class::Touching),
        (("lanebox", "pin"), Class::Touching),
    ];
    mixed
        .chain(resting)
        .filter(|(pair, class)| {
            pairs.takes(&format!("{}-{}", pair.0, pair.1)) && classes.takes(class.name())
        })
        .map(move |(pair, class)| {
            let mut random = cases::random(SEED, pair, class);
            let trials = (0..poses)
                .map(|_| {
                    let case = match pair.1 {
                        "pin" => resting_pin(pair.0, &mut random),
                        _ => cases::case(pair, class, &mut random),
                    };
                    Trial::new(&case, &mut random)
                })
                .collect();
            Scene {
                pair,
                class,
                trials,
            }
        })
}

/// The base of a pin that rests on the lane, as a simulation leaves it: a micrometre deep, leaning by 10 microradians.
fn resting_pin(lane: &str, random: &mut Random) -> Case {
    let half_height = 0.0095;
    let lean = DQuat::from_scaled_axis(DVec3::new(random.next(), 0.0, random.next()) * 1e-5);
    let turn = DQuat::from_rotation_y(3.0 * random.next());
    let deep = 1e-6 * random.next();
    let spot = DVec3::new(0.5 * random.next(), half_height + deep, 0.5 * random.next());
    let (a, pose_a) = match lane {
        "lane" => (Known::HalfSpace(DVec3::Y), Pose::IDENTITY),
        _ => (
            Known::Cuboid(DVec3::new(0.52705, 0.15, 9.578)),
            Pose::from_position(DVec3::new(0.0, -0.15, 0.0)),
        ),
    };
    Case {
        a,
        pose_a,
        b: Known::Frustum(BASE_RADIUS, 0.0359, half_height),
        pose_b: Pose::new(spot, lean * turn),
    }
}

/// A line of the table of ratios.
pub struct Row {
    name: (String, &'static str),
    cold: f64,
    warm: f64,
    parry: f64,
    iterations: (f64, u32),
    targets: (Option<Target>, Option<Target>),
}

/// Head of the table.
pub const HEAD: &str = "\
| pair | class | cold [ns] | warm [ns] | parry [ns] | parry/cold | parry/warm | target cold, warm | met | iterations, most |
|---|---|--:|--:|--:|--:|--:|---|---|---|";

impl Row {
    /// Whether every target of the row is kept.
    pub fn met(&self) -> bool {
        let keeps = |target: Option<Target>, ours| target.is_none_or(|t| t.met(ours, self.parry));
        keeps(self.targets.0, self.cold) && keeps(self.targets.1, self.warm)
    }
}

impl std::fmt::Display for Row {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let target = |t: Option<Target>| t.map_or("-".to_owned(), |t| t.to_string());
        write!(
            f,
            "| {:<12} | {:<8} | {:>5.0} | {:>5.0} | {:>6.0} | {:>5.1} | {:>5.1} | {}, {} | {} | {:.1}, {} |",
            self.name.0,
            self.name.1,
            self.cold,
            self.warm,
            self.parry,
            self.parry / self.cold,
            self.parry / self.warm,
            target(self.targets.0),
            target(self.targets.1),
            if self.met() { "yes" } else { "no" },
            self.iterations.0,
            self.iterations.1,
        )
    }
}

/// Measures the scenes that the filters take.
pub fn rows<'a>(
    pairs: &'a Filter,
    classes: &'a Filter,
    poses: usize,
) -> impl Iterator<Item = Row> + 'a {
    scenes(pairs, classes, poses).map(|scene| measure(&scene))
}

fn measure(scene: &Scene) -> Row {
    let [cold, warm, parry] = times(&scene.trials);
    let iterations: Vec<u32> = scene.trials.iter().map(|t| t.cold().iterations).collect();
    Row {
        name: (
            format!("{}-{}", scene.pair.0, scene.pair.1),
            scene.class.name(),
        ),
        cold,
        warm,
        parry,
        iterations: (
            f64::from(iterations.iter().sum::<u32>()) / iterations.len() as f64,
            iterations.iter().copied().max().unwrap_or(0),
        ),
        targets: targets(scene.pair, scene.class),
    }
}

/// Time of a call of each contender [ns]: of each batch of poses the median over the rounds, of these the mean.
///
/// A batch is short, so that another process seldom falls into it, and falls into that of either library alike.
fn times(trials: &[Trial]) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for batch in trials.chunks(BATCH) {
        let mut rounds = [const { Vec::new() }; 3];
        for _ in 0..ROUNDS {
            rounds[0].push(time(batch, Trial::cold));
            rounds[1].push(time(batch, Trial::warm));
            rounds[2].push(time(batch, Trial::parry));
        }
        for (sum, round) in sums.iter_mut().zip(rounds) {
            *sum += median(round);
        }
    }
    sums.map(|sum| sum / trials.len() as f64)
}

/// Time of a call for every pose of a batch, together [ns].
fn time<T>(batch: &[Trial], ask: impl Fn(&Trial) -> T) -> f64 {
    let started = Instant::now();
    for trial in batch {
        black_box(ask(black_box(trial)));
    }
    started.elapsed().as_nanos() as f64
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
