//! Answers of the query before the judge, in great numbers.

use std::thread;

use glam::{DQuat, DVec3};
use physics::query::{Limits, Separation, apart, separation};

use crate::Filter;
use crate::judge::built::drawn;
use crate::judge::cases::{self, Case, Class};
use crate::judge::oracle::Oracle;
use crate::judge::verdict::{Truth, Verdict, judge};

/// Poses of a pair and class unless the command line says otherwise.
pub const POSES: usize = 1000;
/// Seed of the first pose; each next pose has the next seed.
pub const SEED: u64 = 20_261_122;
/// A normal that is farther off than this is wrong [rad].
const NORMAL: f64 = 1e-4;
/// A converged interval wider than this is too wide, relative to the size.
const WIDTH: f64 = 1e-7;
/// How far the warm start is off the answer [rad].
const WARM: f64 = 0.02;
/// Wrong answers that are printed for each row.
const EXAMPLES: usize = 3;

/// A gap that is farther off than this is wrong, relative to the size.
fn tolerance(class: Class) -> f64 {
    if class == Class::Deep { 1e-4 } else { 1e-6 }
}

/// What came of the answers of one pair and class.
pub struct Tally {
    name: (String, &'static str),
    /// How the bodies of its poses lie.
    pub class: Class,
    poses: usize,
    wrong_gaps: usize,
    worst_gap: f64,
    wrong_normals: usize,
    worst_normal: f64,
    outside: usize,
    worst_outside: f64,
    too_wide: usize,
    widest: f64,
    capped: usize,
    iterations: u32,
    unsaid: usize,
    warm_wrong: usize,
    warm_unsaid: usize,
    not_apart: usize,
    /// The first wrong answers, in words.
    pub examples: Vec<String>,
}

/// Head of the table.
pub const HEAD: &str = "\
| pair | class | poses | wrong gaps | worst, of size | wrong normals | worst [rad] | outside interval | too wide | widest, of size | capped | most iterations | wrong and unsaid | warm wrong (unsaid) | apart missed |
|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|";

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(
            f,
            "| {} | {} | {} | {} | {:.1e} | {} | {:.1e} | {} | {} | {:.1e} | {} | {} | {} | {} ({}) | {} |",
            self.name.0,
            self.name.1,
            self.poses,
            self.wrong_gaps,
            self.worst_gap,
            self.wrong_normals,
            self.worst_normal,
            self.outside,
            self.too_wide,
            self.widest,
            self.capped,
            self.iterations,
            self.unsaid,
            self.warm_wrong,
            self.warm_unsaid,
            self.not_apart,
        )
    }
}

impl Tally {
    /// Nothing counted yet of `pair`.
    pub fn new(pair: String, class: Class) -> Tally {
        Tally {
            name: (pair, class.name()),
            class,
            poses: 0,
            wrong_gaps: 0,
            worst_gap: 0.0,
            wrong_normals: 0,
            worst_normal: 0.0,
            outside: 0,
            worst_outside: 0.0,
            too_wide: 0,
            widest: 0.0,
            capped: 0,
            iterations: 0,
            unsaid: 0,
            warm_wrong: 0,
            warm_unsaid: 0,
            not_apart: 0,
            examples: Vec::new(),
        }
    }

    /// Whether nothing is wrong but warm answers that say so.
    pub fn is_clean(&self) -> bool {
        let serious = [
            self.wrong_gaps,
            self.wrong_normals,
            self.outside,
            self.too_wide,
            self.not_apart,
            self.warm_unsaid,
        ];
        serious == [0; 6]
    }

    /// Adds what another tally counted.
    pub fn merge(&mut self, other: Tally) {
        self.poses += other.poses;
        self.wrong_gaps += other.wrong_gaps;
        self.worst_gap = self.worst_gap.max(other.worst_gap);
        self.wrong_normals += other.wrong_normals;
        self.worst_normal = self.worst_normal.max(other.worst_normal);
        self.outside += other.outside;
        self.worst_outside = self.worst_outside.max(other.worst_outside);
        self.too_wide += other.too_wide;
        self.widest = self.widest.max(other.widest);
        self.capped += other.capped;
        self.iterations = self.iterations.max(other.iterations);
        self.unsaid += other.unsaid;
        self.warm_wrong += other.warm_wrong;
        self.warm_unsaid += other.warm_unsaid;
        self.not_apart += other.not_apart;
        self.examples.extend(other.examples);
        self.examples.truncate(EXAMPLES);
    }

    /// Asks about one case and counts what the judge says.
    fn add(&mut self, case: &Case, truth: Option<Truth>, oracle: &Oracle, name: &str) {
        let (a, b) = (case.a.shape(), case.b.shape());
        let ask = |start: Option<DVec3>| {
            separation(
                (&a, &case.pose_a),
                (&b, &case.pose_b),
                start,
                Limits::default(),
            )
        };
        let answer = ask(None);
        let verdict = judge(case, &answer, truth, oracle);
        let mut complaints = self.count(case, &answer, &verdict);

        // The truth may hide from a local search that starts near a worse answer; so warm starts start near the best.
        let off = answer.normal.any_orthonormal_vector() * WARM.tan();
        let turn = DQuat::from_axis_angle(answer.normal, self.poses as f64);
        let warm = ask((answer.normal + turn * off).try_normalize());
        if !warm.gap.is_finite() || warm.gap < verdict.truth.0 - tolerance(self.class) * case.size()
        {
            self.warm_wrong += 1;
            if !warm.capped && !warm.local {
                self.warm_unsaid += 1;
                complaints.push("warm");
            }
        }
        let proof = apart(
            (&a, &case.pose_a),
            (&b, &case.pose_b),
            None,
            Limits::default(),
        );
        match proof {
            None if verdict.truth.0 > 1e-9 * case.size() => {
                self.not_apart += 1;
                complaints.push("apart missed");
            }
            Some(proof) if proof.gap_at_least > case.gap_along(proof.normal) + 1e-12 => {
                self.outside += 1;
                complaints.push("apart claims too much");
            }
            _ => {}
        }
        if !complaints.is_empty() && self.examples.len() < EXAMPLES {
            self.examples.push(format!(
                "{name}: {}; truth {:?}, answer {answer:?}, warm {:.3e}, normal off {:.1e}",
                complaints.join(", "),
                verdict.truth,
                warm.gap,
                verdict.normal_error,
            ));
        }
    }

    fn count(&mut self, case: &Case, answer: &Separation, verdict: &Verdict) -> Vec<&'static str> {
        let size = case.size();
        let mut complaints = Vec::new();
        self.poses += 1;
        self.worst_gap = self.worst_gap.max(verdict.gap_error / size);
        if verdict.gap_error > tolerance(self.class) * size {
            self.wrong_gaps += 1;
            self.unsaid += usize::from(!answer.capped);
            complaints.push("gap");
        }
        if self.class != Class::Deep {
            self.worst_normal = self.worst_normal.max(verdict.normal_error);
            if verdict.normal_error > NORMAL {
                self.wrong_normals += 1;
                complaints.push("normal");
            }
        }
        if verdict.outside > 0.0 {
            self.outside += 1;
            self.worst_outside = self.worst_outside.max(verdict.outside);
            complaints.push("interval");
        }
        if verdict.truth.0 > 0.0 && !answer.capped {
            let width = verdict.width.map_or(f64::INFINITY, |width| width / size);
            self.widest = self.widest.max(width);
            if width > WIDTH {
                self.too_wide += 1;
                complaints.push("width");
            }
        }
        self.capped += usize::from(answer.capped);
        self.iterations = self.iterations.max(answer.iterations);
        complaints
    }
}

/// Prints a case in full, with the solver's answer and what the judge makes of it.
pub fn show(pairs: &Filter, classes: &Filter, index: usize, seed: u64) {
    let oracle = Oracle::new(20_000, 12);
    for (pair, class) in chosen(pairs, classes) {
        let (case, truth) = drawn(pair, class, seed, index);
        let (a, b) = (case.a.shape(), case.b.shape());
        let (a, b) = ((&a, &case.pose_a), (&b, &case.pose_b));
        println!(
            "{}-{} {} seed {seed} index {index}",
            pair.0,
            pair.1,
            class.name()
        );
        println!(
            "a: {:?}\n   {:?}\nb: {:?}\n   {:?}",
            case.a, case.pose_a, case.b, case.pose_b
        );
        println!("known truth: {truth:?}\noracle: {:?}", oracle.best(&case));
        let answer = separation(a, b, None, Limits::default());
        println!("answer: {answer:?}");
        println!(
            "gap along the answer's normal: {}",
            case.gap_along(answer.normal)
        );
        println!("{:?}", judge(&case, &answer, truth, &oracle));
        println!("apart: {:?}", apart(a, b, None, Limits::default()));
    }
}

/// Pairs and classes that the filters take.
fn chosen<'a>(
    pairs: &'a Filter,
    classes: &'a Filter,
) -> impl Iterator<Item = ((&'static str, &'static str), Class)> + 'a {
    cases::all_pairs()
        .into_iter()
        .flat_map(|pair| Class::ALL.map(|class| (pair, class)))
        .filter(|(pair, class)| {
            pairs.takes(&format!("{}-{}", pair.0, pair.1)) && classes.takes(class.name())
        })
}

/// Judges `poses` answers of each pair and class that the filters take.
pub fn tallies<'a>(
    pairs: &'a Filter,
    classes: &'a Filter,
    poses: usize,
    seed: u64,
) -> impl Iterator<Item = Tally> + 'a {
    chosen(pairs, classes).map(move |(pair, class)| tally(pair, class, poses, seed))
}

fn tally(pair: (&str, &str), class: Class, poses: usize, seed: u64) -> Tally {
    let name = format!("{}-{}", pair.0, pair.1);
    let name = &name;
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let part = |first: usize| {
        let oracle = Oracle::new(1200, 5);
        let mut tally = Tally::new(name.clone(), class);
        for index in (first..poses).step_by(threads) {
            let (case, truth) = drawn(pair, class, seed, index);
            let pose = format!("{name} {} {index} {seed}", class.name());
            tally.add(&case, truth, &oracle, &pose);
        }
        tally
    };
    let mut whole = Tally::new(name.clone(), class);
    thread::scope(|scope| {
        let parts: Vec<_> = (0..threads)
            .map(|first| scope.spawn(move || part(first)))
            .collect();
        for part in parts {
            whole.merge(part.join().expect("the judge and the query do not panic"));
        }
    });
    whole
}
