//! How many subjects it takes: studies are drawn from known coefficients and analysed, thousands of times.

use serde_json::{Map, Value, json};

use super::design::Design;
use super::exact::wilson;
use super::model::Model;
use super::newton::supremum;
use super::paired::student;
use super::parallel;
use super::rows::{Rows, chance};
use super::subjects::{LEVELS, Subject, Subjects};
use super::table::Table;
use super::tails;
use crate::plan::{Scheme, SchemeError, allocate};
use crate::random::SplitMix64;

/// Names of the coefficients, in their order.
pub const COLUMNS: [&str; 10] = [
    "change1",
    "change2",
    "change3",
    "F",
    "sick",
    "vr",
    "change1_S",
    "change2_S",
    "change2_E",
    "change3_E",
];
/// The coefficients that Table 6 prints.
pub const PUBLISHED: [f64; 10] = [
    1.501, -0.9969, 0.7149, 2.112, -0.6980, -1.580, -1.496, 3.786, -3.836, -0.5273,
];
/// Correlation of one subject's answers for which the dispersion of six answers is the paper's: 1 + 5 rho = 1.567.
pub const CORRELATION: f64 = 0.113;
/// Subjects at each level of sickness (Table 3).
const SICKNESS: [u64; 7] = [5, 5, 3, 0, 3, 1, 1];
/// Of 18 subjects 7 had experience of virtual reality (section 3).
const EXPERIENCED: (u64, u64) = (7, 18);
/// Presence items (Appendix A).
const ITEMS: usize = 6;
/// Level of the tests.
const LEVEL: f64 = 0.05;
/// Power that is asked for.
pub const WANTED: f64 = 0.8;
/// Studies that a thread does in one go.
const BATCH: usize = 20;

/// What is deleted in a test, by the coefficients' places.
const TESTS: [(&str, &[usize]); 6] = [
    ("F", &[3]),
    ("change.S", &[6, 7]),
    ("change.E", &[8, 9]),
    ("sick", &[4]),
    ("vr", &[5]),
    ("physics(F,S,E)", &[3, 6, 7, 8, 9]),
];
/// The tests of the physics' effects, each by itself.
const EACH: [usize; 3] = [0, 1, 2];
/// The test of all of them together.
const TOGETHER: usize = 5;

/// The world that studies are drawn from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct World {
    /// The coefficients of [`COLUMNS`].
    pub coefficients: [f64; 10],
    /// Correlation of one subject's answers, 0 to below 1: the counts are beta-binomial.
    pub correlation: f64,
}

impl World {
    /// The same with the effects of the base levels multiplied by `factor`; sickness, experience and the level of
    /// presence stay.
    pub fn with_effect(mut self, factor: f64) -> World {
        for (name, coefficient) in COLUMNS.iter().zip(&mut self.coefficients) {
            let is_effect = LEVELS.contains(name) || name.contains('_');
            *coefficient *= if is_effect { factor } else { 1.0 };
        }
        self
    }
}

/// How to simulate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// Studies of each size.
    pub studies: usize,
    /// Seed.
    pub seed: u64,
}

/// How often a test rejected.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rejections {
    /// Name of the test.
    pub name: &'static str,
    /// By the paper's chi-squared test.
    pub chi_squared: u32,
    /// By the quasi-binomial F test, with a dispersion of at least 1.
    pub quasi: u32,
}

/// A point of the power curve.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Point {
    /// Subjects.
    pub subjects: u32,
    /// Studies.
    pub studies: u32,
    /// The tests.
    pub tests: Vec<Rejections>,
}

/// The rows of a study whose answers are not yet given: Table 2's places for `subjects`, with sickness and experience
/// as in the paper's sample.
///
/// # Errors
/// When the paper's design cannot be built.
fn places(subjects: u32, random: &mut SplitMix64) -> Result<Rows, SchemeError> {
    let plan = Scheme::Table2.design()?;
    let names = ["elasticity", "friction", "shape"];
    let list: Vec<Subject> = allocate(&plan, subjects, random.next_u64())
        .iter()
        .map(|row| Subject {
            change: names.iter().position(|name| *name == row.changed),
            levels: [0, 1, 2].map(|i| Some(f64::from(row.low.0[i]))),
            answers: Some((0.0, ITEMS as f64)),
            ..Subject::default()
        })
        .collect();
    let header = ["changed", "efs", "sick", "vr"].map(str::to_owned).to_vec();
    let cells = list
        .iter()
        .map(|_| vec![String::new(), String::new(), "1".to_owned(), "1".to_owned()])
        .collect();
    let lines = vec![1; list.len()];
    let table = Table {
        name: "simulated".to_owned(),
        header,
        rows: cells,
        lines,
    };
    let design = Design::new(&Subjects { table, list }, &Model::paper());
    Ok(design
        .expect("a simulated table has all that the paper's model needs")
        .rows())
}

/// Draws sickness, experience and answers of every row.
fn answer(rows: &mut Rows, world: &World, random: &mut SplitMix64) {
    for i in 0..rows.len() {
        let mut left = random.below(SICKNESS.iter().sum());
        let level = SICKNESS.iter().position(|&count| {
            let is_here = left < count;
            left = left.wrapping_sub(if is_here { 0 } else { count });
            is_here
        });
        let row = &mut rows.x[i * COLUMNS.len()..(i + 1) * COLUMNS.len()];
        row[4] = level.map_or(1.0, |level| level as f64 + 1.0);
        row[5] = f64::from(u8::from(random.below(EXPERIENCED.1) < EXPERIENCED.0));
        let p = chance(super::rows::dot(row, &world.coefficients)).p;
        rows.high[i] = correlated(p, world.correlation, random);
    }
}

/// A count out of six: a beta-binomial one by Polya's urn, where each answer makes its like more probable.
fn correlated(p: f64, correlation: f64, random: &mut SplitMix64) -> f64 {
    let mut high = 0.0;
    for before in 0..ITEMS {
        // With s = (1 - rho) / rho balls in the urn; the weights are multiplied by rho, which may be 0.
        let urn = 1.0 - correlation;
        let chance = (p * urn + high * correlation) / (urn + before as f64 * correlation);
        high += f64::from(u8::from(random.uniform() < chance));
    }
    high
}

/// For each test whether the paper's test rejects and whether the quasi-binomial one does.
fn judge(rows: &Rows) -> Vec<[bool; 2]> {
    let all: Vec<usize> = (0..rows.columns).collect();
    let full = supremum(rows, &all, None);
    let df = (rows.len() - rows.columns.min(rows.len())) as f64;
    let pearson: f64 = (0..rows.len())
        .map(|i| {
            let at = chance(super::rows::dot(rows.row(i), &full.beta));
            let variance = rows.asked[i] * at.spread;
            // Where the fit has run away it is exact.
            if variance < 1e-12 {
                0.0
            } else {
                (rows.high[i] - rows.asked[i] * at.p).powi(2) / variance
            }
        })
        .sum();
    let dispersion = if df > 0.0 {
        (pearson / df).max(1.0)
    } else {
        1.0
    };
    let test = |(_, gone): &(&str, &[usize])| {
        let free: Vec<usize> = all.iter().copied().filter(|j| !gone.contains(j)).collect();
        let small = supremum(rows, &free, None);
        let change = 2.0 * (full.sums.kernel - small.sums.kernel).max(0.0);
        let chi_squared = tails::chi_squared(change, gone.len()).is_some_and(|p| p < LEVEL);
        let value = change / gone.len() as f64 / dispersion;
        [
            chi_squared,
            df > 0.0 && tails::fisher(value, gone.len() as f64, df) < LEVEL,
        ]
    };
    TESTS.iter().map(test).collect()
}

/// The power curve: for each number of subjects how often each test rejects. `done` hears of studies that are ready.
///
/// # Errors
/// When the paper's design cannot be built.
pub fn curve(
    world: &World,
    sizes: &[u32],
    effort: Effort,
    done: &(dyn Fn(usize) + Sync),
) -> Result<Vec<Point>, SchemeError> {
    let mut points = Vec::new();
    for &subjects in sizes {
        let empty = places(subjects, &mut SplitMix64::new(effort.seed))?;
        let batches = parallel::map(effort.studies.div_ceil(BATCH), |batch| {
            let mut counts = vec![[0_u32; 2]; TESTS.len()];
            let studies = batch * BATCH..((batch + 1) * BATCH).min(effort.studies);
            let many = studies.len();
            for study in studies {
                let stream = effort.seed ^ (u64::from(subjects) << 32);
                let mut rows = empty.clone();
                answer(
                    &mut rows,
                    world,
                    &mut SplitMix64::for_index(stream, study as u64),
                );
                for (count, rejects) in counts.iter_mut().zip(judge(&rows)) {
                    count[0] += u32::from(rejects[0]);
                    count[1] += u32::from(rejects[1]);
                }
            }
            done(many);
            counts
        });
        let sum =
            |test: usize, which: usize| batches.iter().map(|counts| counts[test][which]).sum();
        let tests = TESTS.iter().enumerate();
        let tests = tests.map(|(t, (name, _))| Rejections {
            name,
            chi_squared: sum(t, 0),
            quasi: sum(t, 1),
        });
        points.push(Point {
            subjects,
            studies: effort.studies as u32,
            tests: tests.collect(),
        });
    }
    Ok(points)
}

/// The first number of subjects from which on every one of the tests reaches the wanted power by the quasi-binomial test.
fn first(points: &[Point], tests: &[usize]) -> Option<u32> {
    let reaches = |point: &&Point| {
        tests
            .iter()
            .all(|&t| f64::from(point.tests[t].quasi) >= WANTED * f64::from(point.studies))
    };
    points.iter().find(reaches).map(|point| point.subjects)
}

/// Subjects that it takes for the physics together, and for each of its effects.
pub fn enough(points: &[Point]) -> (Option<u32>, Option<u32>) {
    (first(points, &[TOGETHER]), first(points, &EACH))
}

/// The world of presence asked after each game.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairedWorld {
    /// Effect of the high level [logit].
    pub effect: f64,
    /// Standard deviation among subjects [logit].
    pub subject_sd: f64,
    /// Standard deviation among one subject's games [logit].
    pub game_sd: f64,
}

/// A point of the power curve of presence asked after each game.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PairedPoint {
    /// Subjects for each changed parameter.
    pub subjects: u32,
    /// Studies.
    pub studies: u32,
    /// Studies in which the paired t test rejected.
    pub rejections: u32,
}

/// The power of the paired t test of two counts, the chances of both levels around one half.
pub fn paired_curve(
    world: &PairedWorld,
    sizes: &[u32],
    effort: Effort,
    done: &(dyn Fn(usize) + Sync),
) -> Vec<PairedPoint> {
    let point = |&subjects: &u32| {
        let batches = parallel::map(effort.studies.div_ceil(BATCH), |batch| {
            let studies = batch * BATCH..((batch + 1) * BATCH).min(effort.studies);
            let many = studies.len();
            let stream = !effort.seed ^ (u64::from(subjects) << 32);
            let rejects = |study: &usize| {
                let mut random = SplitMix64::for_index(stream, *study as u64);
                let differences: Vec<f64> = (0..subjects)
                    .map(|_| difference(world, &mut random))
                    .collect();
                student(&differences).is_some_and(|(_, _, _, p)| p < LEVEL)
            };
            let count = studies.filter(rejects).count() as u32;
            done(many);
            count
        });
        PairedPoint {
            subjects,
            studies: effort.studies as u32,
            rejections: batches.iter().sum(),
        }
    };
    sizes.iter().map(point).collect()
}

/// High answers in the game at the high level less those in the game at the low one.
fn difference(world: &PairedWorld, random: &mut SplitMix64) -> f64 {
    let person = world.subject_sd * random.normal();
    let mut game = |level: f64| {
        let p = chance(person + world.game_sd * random.normal() + level * world.effect).p;
        (0..ITEMS).filter(|_| random.uniform() < p).count() as f64
    };
    game(0.5) - game(-0.5)
}

/// The points with their 95 % intervals.
pub fn json(points: &[Point]) -> Value {
    let share = |count: u32, of: u32| json!({"power": f64::from(count) / f64::from(of), "wilson95": wilson(count, of)});
    let point = |point: &Point| {
        let tests = point.tests.iter().map(|test| {
            let both = json!({"chi_squared": share(test.chi_squared, point.studies), "quasi_f": share(test.quasi, point.studies)});
            (test.name.to_owned(), both)
        });
        json!({"subjects": point.subjects, "studies": point.studies, "tests": tests.collect::<Map<_, _>>()})
    };
    points.iter().map(point).collect()
}
