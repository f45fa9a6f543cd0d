//! Observers that are known, against whom both rules are run.

use super::*;

fn plan(rule: Rule) -> StaircasePlan {
    StaircasePlan {
        key: "objects.elasticity".to_owned(),
        standard: 1.0,
        furthest: 0.5,
        rule,
        trials: 80,
        catch_share: 0.2,
    }
}

fn run(rule: Rule, target: f64, seed: u64) -> Staircase {
    let mut staircase = Staircase::new(&plan(rule), seed).unwrap();
    let observer = Observer {
        target,
        false_alarms: 0.08,
    };
    let mut random = SplitMix64::for_index(seed, 77);
    while let Some(trial) = staircase.next_trial().unwrap() {
        let reply = observer.reply(trial.difference, &mut random);
        staircase.reply(reply).unwrap();
    }
    staircase
}

/// Mean and spread of the estimates' logarithms about the truth, and how often the interval has it.
fn quality(rule: Rule, target: f64) -> (f64, f64, f64) {
    let truth = target * 0.5;
    let estimates: Vec<Estimate> = (0..300)
        .filter_map(|seed| run(rule, target, seed).estimate())
        .collect();
    assert!(
        estimates.len() >= 295,
        "{rule:?} {target}: {}",
        estimates.len()
    );
    let count = estimates.len() as f64;
    let errors: Vec<f64> = estimates
        .iter()
        .map(|estimate| (estimate.threshold / truth).ln())
        .collect();
    let bias = errors.iter().sum::<f64>() / count;
    let spread = (errors
        .iter()
        .map(|error| (error - bias).powi(2))
        .sum::<f64>()
        / count)
        .sqrt();
    let covered =
        |estimate: &&Estimate| (estimate.interval[0]..=estimate.interval[1]).contains(&truth);
    (
        bias,
        spread,
        estimates.iter().filter(covered).count() as f64 / count,
    )
}

/// Both rules are within 10 % of the truth on average, spread by 15 %, and their 95 % intervals have it about nine times in ten: turns
/// hang together, and this observer is none of the grid's.
#[test]
fn both_rules_find_the_difference_of_known_observers() {
    for target in [0.05, 0.15, 0.4] {
        let (bias, spread, cover) = quality(Rule::OneUpTwoDown, target);
        println!(
            "one up two down, target {target}: bias {bias:.3}, spread {spread:.3}, covered {cover:.2}, seeds 0 to 299"
        );
        assert!(
            bias.abs() < 0.1 && spread < 0.25 && cover > 0.8,
            "{target}: {bias} {spread} {cover}"
        );
        let (bias, spread, cover) = quality(Rule::Bayesian, target);
        println!(
            "bayesian, target {target}: bias {bias:.3}, spread {spread:.3}, covered {cover:.2}, seeds 0 to 299"
        );
        assert!(
            bias.abs() < 0.1 && spread < 0.15 && cover > 0.84,
            "{target}: {bias} {spread} {cover}"
        );
    }
}

#[test]
fn one_up_two_down_settles_where_70_7_percent_are_different() {
    let mut long = plan(Rule::OneUpTwoDown);
    (long.trials, long.catch_share) = (1000, 0.0);
    let mut log_error = 0.0;
    for seed in 0..40 {
        let mut staircase = Staircase::new(&long, seed).unwrap();
        let observer = Observer {
            target: 0.2,
            false_alarms: 0.0,
        };
        let mut random = SplitMix64::for_index(seed, 3);
        while let Some(trial) = staircase.next_trial().unwrap() {
            let reply = observer.reply(trial.difference, &mut random);
            staircase.reply(reply).unwrap();
        }
        log_error += (staircase.estimate().unwrap().threshold / 0.1).ln() / 40.0;
    }
    // The 50 % point lies a factor of 0.8 away, the 79.4 % point of one-up three-down 1.12.
    assert!(log_error.abs() < 0.05, "{log_error}");
}

#[test]
fn catch_trials_are_one_in_five_and_never_first() {
    for seed in 0..50 {
        let staircase = run(Rule::OneUpTwoDown, 0.2, seed);
        let differences: Vec<f64> = staircase
            .done()
            .iter()
            .map(|(trial, _)| trial.difference)
            .collect();
        assert!(differences[0] > 0.0);
        for stretch in differences.chunks(5) {
            assert_eq!(
                stretch
                    .iter()
                    .filter(|difference| **difference == 0.0)
                    .count(),
                1,
                "seed {seed}"
            );
        }
        assert_eq!(staircase.estimate().unwrap().catches, 16);
        for (trial, _) in staircase.done() {
            assert!(trial.first == 1.0 || trial.second == 1.0);
            let off = (trial.first + trial.second - 2.0) / -0.5;
            assert!((off - trial.difference).abs() < 1e-12);
        }
    }
    let orders = run(Rule::OneUpTwoDown, 0.2, 1)
        .done()
        .iter()
        .filter(|(trial, _)| trial.first == 1.0 && trial.difference > 0.0)
        .count();
    // 64 pairs, half of them, and four standard errors.
    assert!((16..=48).contains(&orders), "{orders}");
}

#[test]
fn staircase_is_made_again_from_its_replies() {
    for rule in [Rule::OneUpTwoDown, Rule::Bayesian] {
        let whole = run(rule, 0.2, 9);
        let replies: Vec<Reply> = whole.done().iter().map(|(_, reply)| *reply).collect();
        let mut half = Staircase::replay(&plan(rule), 9, &replies[..33]).unwrap();
        assert_eq!(half.done(), &whole.done()[..33]);
        let next = half.next_trial().unwrap().unwrap();
        assert_eq!(next, whole.done()[33].0);
        assert_eq!(half.next_trial(), Err(StaircaseError::Turn));
        half.reply(Reply::Same).unwrap();
        assert_eq!(half.reply(Reply::Same), Err(StaircaseError::Turn));
        assert!(Staircase::replay(&plan(rule), 9, &[Reply::Same; 81]).is_err());
    }
}

#[test]
fn observer_who_never_hears_a_difference_has_no_false_certainty() {
    for rule in [Rule::OneUpTwoDown, Rule::Bayesian] {
        let staircase = Staircase::replay(&plan(rule), 4, &[Reply::Same; 80]).unwrap();
        match (rule, staircase.estimate()) {
            (Rule::OneUpTwoDown, estimate) => assert_eq!(estimate, None),
            // Beyond the range, which is 0.5 in the parameter's unit.
            (Rule::Bayesian, estimate) => assert!(estimate.unwrap().threshold > 0.5),
        }
    }
}

#[test]
fn check_refuses_what_cannot_be_run() {
    let good = plan(Rule::Bayesian);
    let cases = [
        (
            StaircasePlan {
                key: " ".to_owned(),
                ..good.clone()
            },
            "key is empty",
        ),
        (
            StaircasePlan {
                furthest: 1.0,
                ..good.clone()
            },
            "two different numbers",
        ),
        (
            StaircasePlan {
                standard: f64::NAN,
                ..good.clone()
            },
            "two different numbers",
        ),
        (
            StaircasePlan {
                trials: 0,
                ..good.clone()
            },
            "trials is 0",
        ),
        (
            StaircasePlan {
                catch_share: 0.6,
                ..good.clone()
            },
            "catch_share is 0.6",
        ),
    ];
    for (plan, expected) in cases {
        let error = plan.check().unwrap_err().to_string();
        assert!(
            error.starts_with("staircase.") && error.contains(expected),
            "{error}"
        );
    }
    assert_eq!(good.check(), Ok(()));
}

#[test]
fn catch_trials_do_not_move_the_staircase() {
    let differences = |at_catches: Reply| -> Vec<f64> {
        let mut staircase = Staircase::new(&plan(Rule::OneUpTwoDown), 6).unwrap();
        let mut tried = Vec::new();
        while let Some(trial) = staircase.next_trial().unwrap() {
            let heard = if trial.difference > 0.2 {
                Reply::Different
            } else {
                Reply::Same
            };
            staircase
                .reply(if trial.difference > 0.0 {
                    heard
                } else {
                    at_catches
                })
                .unwrap();
            if trial.difference > 0.0 {
                tried.push(trial.difference);
            }
        }
        tried
    };
    assert_eq!(differences(Reply::Same), differences(Reply::Different));
}
