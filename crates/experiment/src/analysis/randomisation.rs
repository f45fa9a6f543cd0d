//! Tests that need no distribution: what would have come out had the subjects been allocated otherwise?
//!
//! Each subject keeps answers, sickness and experience and gets another's place, within the block of the allocation.
//! How often a test statistic comes out at least as large is its probability if the design made no difference at all.

use serde_json::{Map, Value, json};

use super::design::{Design, Group};
use super::model::Term;
use super::newton::{Maximum, supremum};
use super::parallel;
use super::regression::{Regression, without};
use super::rows::Rows;
use super::tails;
use crate::random::SplitMix64;

/// A statistic within this of the observed one is as large: looser than the fits' rounding, far closer than any two values.
const TIE: f64 = 1e-5;
/// Re-allocations that a thread does in one go.
const BATCH: usize = 64;

/// How to randomise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plan {
    /// Re-allocations drawn; all of them are done where there are no more than these.
    pub draws: usize,
    /// Seed of the draws.
    pub seed: u64,
}

/// A test by re-allocation.
#[derive(Debug, Clone, PartialEq)]
pub struct Test {
    /// What is deleted.
    pub name: String,
    /// The change in deviance, as observed.
    pub ratio: f64,
    /// By how many parameters.
    pub df: usize,
    /// The paper's chi-squared test of it.
    pub p_chi_squared: Option<f64>,
    /// The share of re-allocations with a change at least as large, the observed one among them.
    pub p: f64,
}

/// The tests of one study.
#[derive(Debug, Clone, PartialEq)]
pub struct Randomisation {
    /// Re-allocations that were tried.
    pub tried: usize,
    /// Whether these were all there are.
    pub is_exact: bool,
    /// How many different ones there are, as far as a floating-point number can say.
    pub possible: f64,
    /// How many blocks the subjects stay in.
    pub blocks: usize,
    /// The plan.
    pub plan: Plan,
    /// The tests.
    pub tests: Vec<Test>,
    /// The share of data sets drawn from the fitted model whose deviance is at least the observed; `None` where the fit
    /// is infinite.
    pub goodness_of_fit: Option<f64>,
}

/// A set of terms whose deletion is tested.
struct Target<'a> {
    name: String,
    groups: Vec<&'a Group>,
}

impl Randomisation {
    /// Re-allocates the subjects of a regression; `None` where nothing of the model belongs to the design.
    pub fn of(regression: &Regression, plan: Plan) -> Option<Randomisation> {
        let design = &regression.design;
        let targets = targets(design);
        if targets.is_empty() {
            return None;
        }
        let blocks = blocks(design);
        let possible = possible(design, &blocks);
        let own: Vec<usize> = (0..design.used.len()).collect();
        let observed = ratios(design, &targets, &own);
        let is_exact = possible <= plan.draws as f64;
        let all = is_exact.then(|| every(design, &blocks));
        let tried = all.as_ref().map_or(plan.draws, Vec::len);
        let who = |draw: usize| match &all {
            Some(all) => all[draw].clone(),
            None => drawn(&blocks, own.len(), plan.seed, draw),
        };
        let counts = parallel::map(tried.div_ceil(BATCH), |batch| {
            let mut counts = vec![0_usize; targets.len()];
            for draw in batch * BATCH..((batch + 1) * BATCH).min(tried) {
                let found = ratios(design, &targets, &who(draw));
                for ((count, ratio), observed) in counts.iter_mut().zip(found).zip(&observed) {
                    *count += usize::from(ratio >= observed - TIE * (1.0 + observed));
                }
            }
            counts
        });
        let full = regression.fit.rank();
        let test = |(t, target): (usize, &Target<'_>)| {
            let count: usize = counts.iter().map(|counts| counts[t]).sum();
            let small = without(design, &design.rows(), &target.groups);
            let df = full - super::linear::aliases(&small.x, small.columns).kept.len();
            // Among draws the observed allocation is one more.
            let p = if is_exact {
                count as f64 / tried as f64
            } else {
                (count + 1) as f64 / (tried + 1) as f64
            };
            Test {
                name: target.name.clone(),
                ratio: observed[t],
                df,
                p_chi_squared: tails::chi_squared(observed[t], df),
                p,
            }
        };
        let tests = targets.iter().enumerate().map(test).collect();
        let goodness_of_fit = regression
            .fit
            .is_valid()
            .then(|| bootstrap(regression, plan));
        Some(Randomisation {
            tried,
            is_exact,
            possible,
            blocks: blocks.len(),
            plan,
            tests,
            goodness_of_fit,
        })
    }

    /// Every number.
    pub fn json(&self) -> Value {
        let test = |test: &Test| {
            let value = json!({"LR": test.ratio, "df": test.df, "p_chi2": test.p_chi_squared, "p_randomisation": test.p});
            (test.name.clone(), value)
        };
        json!({
            "tried": self.tried,
            "exact": self.is_exact,
            "possible": self.possible,
            "blocks": self.blocks,
            "seed": self.plan.seed,
            "tests": self.tests.iter().map(test).collect::<Map<_, _>>(),
            "gof_p_parametric_bootstrap": self.goodness_of_fit,
        })
    }
}

/// Every term of the design alone, those with a base level together, and all of them.
fn targets(design: &Design) -> Vec<Target<'_>> {
    let of_design: Vec<&Group> = design
        .groups
        .iter()
        .filter(|group| group.term.is_design())
        .collect();
    let physics: Vec<&Group> = of_design
        .iter()
        .copied()
        .filter(|group| group.term.is_physics())
        .collect();
    let named = |groups: &[&Group]| {
        let mut letters = Vec::new();
        for group in groups {
            for letter in group
                .term
                .columns()
                .into_iter()
                .filter(|name| super::subjects::LEVELS.contains(name))
            {
                if !letters.contains(&letter) {
                    letters.push(letter);
                }
            }
        }
        letters.join(",")
    };
    let alone = of_design.iter().filter(|group| group.term != Term::Change);
    let mut targets: Vec<Target<'_>> = alone
        .map(|group| Target {
            name: group.term.group(),
            groups: vec![*group],
        })
        .collect();
    if physics.len() > 1 {
        targets.push(Target {
            name: format!("physics({})", named(&physics)),
            groups: physics.clone(),
        });
    }
    if of_design.len() > physics.len() {
        let letters = named(&physics);
        let comma = if letters.is_empty() { "" } else { "," };
        targets.push(Target {
            name: format!("all design terms (change{comma}{letters})"),
            groups: of_design,
        });
    }
    targets
}

/// The rows of each block.
fn blocks(design: &Design) -> Vec<Vec<usize>> {
    let mut blocks: Vec<(&Option<String>, Vec<usize>)> = Vec::new();
    for (row, block) in design.blocks.iter().enumerate() {
        match blocks.iter_mut().find(|(name, _)| *name == block) {
            Some((_, rows)) => rows.push(row),
            None => blocks.push((block, vec![row])),
        }
    }
    blocks.into_iter().map(|(_, rows)| rows).collect()
}

/// Whether two rows have the same place in the design.
fn is_same_place(design: &Design, a: usize, b: usize) -> bool {
    design
        .columns
        .iter()
        .all(|column| column.place[a] == column.place[b])
}

/// The number of different allocations: orders of each block's places, of which equal ones cannot be told apart.
fn possible(design: &Design, blocks: &[Vec<usize>]) -> f64 {
    let log = |n: usize| libm::lgamma(n as f64 + 1.0);
    let block = |rows: &Vec<usize>| {
        let kinds = kinds(design, rows).1;
        log(rows.len()) - kinds.into_iter().map(log).sum::<f64>()
    };
    libm::exp(blocks.iter().map(block).sum::<f64>()).round()
}

/// One row of each kind of place in a block, and how many there are of each.
fn kinds(design: &Design, rows: &[usize]) -> (Vec<usize>, Vec<usize>) {
    let (mut firsts, mut counts) = (Vec::new(), Vec::new());
    for &row in rows {
        match firsts
            .iter()
            .position(|&first| is_same_place(design, first, row))
        {
            Some(kind) => counts[kind] += 1,
            None => {
                firsts.push(row);
                counts.push(1);
            }
        }
    }
    (firsts, counts)
}

/// Every different allocation: for each place who is there.
fn every(design: &Design, blocks: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut all = vec![vec![0; design.used.len()]];
    for rows in blocks {
        let (firsts, counts) = kinds(design, rows);
        let places: Vec<Vec<usize>> = firsts
            .iter()
            .map(|&first| {
                rows.iter()
                    .copied()
                    .filter(|&row| is_same_place(design, first, row))
                    .collect()
            })
            .collect();
        let mut orders = Vec::new();
        deal(
            rows,
            &mut vec![0; counts.len()],
            &counts,
            &mut Vec::new(),
            &mut orders,
        );
        let mut next = Vec::with_capacity(all.len() * orders.len());
        for so_far in &all {
            for order in &orders {
                let mut who = so_far.clone();
                let mut taken = vec![0; counts.len()];
                for (&person, &kind) in rows.iter().zip(order) {
                    who[places[kind][taken[kind]]] = person;
                    taken[kind] += 1;
                }
                next.push(who);
            }
        }
        all = next;
    }
    all
}

/// Gives each person of a block a kind of place in all ways.
fn deal(
    rows: &[usize],
    taken: &mut Vec<usize>,
    counts: &[usize],
    order: &mut Vec<usize>,
    orders: &mut Vec<Vec<usize>>,
) {
    if order.len() == rows.len() {
        orders.push(order.clone());
        return;
    }
    for kind in 0..counts.len() {
        if taken[kind] < counts[kind] {
            taken[kind] += 1;
            order.push(kind);
            deal(rows, taken, counts, order, orders);
            order.pop();
            taken[kind] -= 1;
        }
    }
}

/// The allocation of draw number `draw`: its stream is its own, so that no thread decides what is drawn.
fn drawn(blocks: &[Vec<usize>], subjects: usize, seed: u64, draw: usize) -> Vec<usize> {
    let mut random = SplitMix64::for_index(seed, draw as u64);
    let mut who = vec![0; subjects];
    for rows in blocks {
        let mut people = rows.clone();
        random.shuffle(&mut people);
        for (&place, person) in rows.iter().zip(people) {
            who[place] = person;
        }
    }
    who
}

/// The change in deviance of each target, with person `who[i]` at place i.
fn ratios(design: &Design, targets: &[Target<'_>], who: &[usize]) -> Vec<f64> {
    let rows = design.allocated(who);
    let all: Vec<usize> = (0..rows.columns).collect();
    let full = supremum(&rows, &all, None);
    let ratio = |target: &Target<'_>| {
        2.0 * (full.sums.kernel - smaller(design, &rows, target, &full)).max(0.0)
    };
    targets.iter().map(ratio).collect()
}

/// The kernel without a target.
fn smaller(design: &Design, rows: &Rows, target: &Target<'_>, full: &Maximum) -> f64 {
    if target.groups.iter().any(|group| group.term == Term::Change) {
        let rows = without(design, rows, &target.groups);
        return supremum(&rows, &(0..rows.columns).collect::<Vec<_>>(), None)
            .sums
            .kernel;
    }
    let gone = |j: usize| target.groups.iter().any(|group| group.columns.contains(&j));
    let free: Vec<usize> = (0..rows.columns).filter(|&j| !gone(j)).collect();
    if !full.converged {
        return supremum(rows, &free, None).sums.kernel;
    }
    let begin: Vec<f64> = full
        .beta
        .iter()
        .enumerate()
        .map(|(j, b)| if gone(j) { 0.0 } else { *b })
        .collect();
    let near = supremum(rows, &free, Some(&begin));
    if near.converged {
        near.sums.kernel
    } else {
        supremum(rows, &free, None)
            .sums
            .kernel
            .max(near.sums.kernel)
    }
}

/// The parametric bootstrap of the goodness of fit.
fn bootstrap(regression: &Regression, plan: Plan) -> f64 {
    let fit = &regression.fit;
    let probabilities = fit.probabilities();
    let all: Vec<usize> = (0..fit.rows.columns).collect();
    let counts = parallel::map(plan.draws.div_ceil(BATCH), |batch| {
        let mut rows = fit.rows.clone();
        let mut count = 0;
        for draw in batch * BATCH..((batch + 1) * BATCH).min(plan.draws) {
            // Another seed than the allocations have.
            let mut random = SplitMix64::for_index(!plan.seed, draw as u64);
            for (i, p) in probabilities.iter().enumerate() {
                rows.high[i] = (0..rows.asked[i] as u64)
                    .filter(|_| random.uniform() < *p)
                    .count() as f64;
            }
            let kernel = supremum(&rows, &all, None).sums.kernel;
            let deviance = 2.0 * (super::fit::saturated(&rows) - kernel);
            count += usize::from(deviance >= fit.deviance - TIE);
        }
        count
    });
    (counts.iter().sum::<usize>() + 1) as f64 / (plan.draws + 1) as f64
}
