//! As one should: dispersion, separation, Firth's estimates, randomisation tests, exact tests, intervals.

use experiment::analysis::behaviour::Behaviour;
use experiment::analysis::exact;
use experiment::analysis::noticed::Noticed;
use experiment::analysis::randomisation::Randomisation;
use experiment::analysis::regression::Regression;
use experiment::analysis::separation::{Kind, Reach};
use experiment::analysis::study::Analysis;
use experiment::analysis::subjects::PARAMETERS;
use experiment::analysis::tails;

use super::paper::papers_name;
use super::report::{Block, Table, digits, interval, p};

/// This part of the report.
pub fn blocks(analysis: &Analysis) -> Vec<Block> {
    let regression = &analysis.regression;
    let mut blocks = vec![Block::Heading("As one should".to_owned())];
    blocks.extend(separation(regression));
    blocks.extend(dispersion(regression));
    blocks.extend(firth(regression));
    if let Some(randomisation) = &analysis.randomisation {
        blocks.extend(randomised(randomisation));
    }
    if let Some(counts) = &analysis.noticed {
        blocks.push(Block::Heading("Which change was noticed".to_owned()));
        blocks.extend(noticed(counts));
        blocks.push(Block::Figure("noticed"));
    }
    blocks.extend(paired(analysis));
    if !analysis.behaviour.is_empty() {
        blocks.push(Block::Heading("Behaviour and frame times".to_owned()));
        blocks.push(behaviour(&analysis.behaviour));
        blocks.push(Block::Figure("behaviour"));
    }
    blocks
}

fn separation(regression: &Regression) -> Vec<Block> {
    let separation = &regression.fit.separation;
    let names = regression.design.names(&regression.fit.aliases.kept);
    let of = |reach: Reach| -> Vec<String> {
        let columns = names
            .iter()
            .zip(&separation.per_column)
            .filter(|(_, r)| **r == reach);
        columns.map(|(name, _)| papers_name(name)).collect()
    };
    let rows = separation.is_separated.iter().filter(|is| **is).count();
    let first = match separation.kind {
        Kind::None => "Separation: none; every estimate is finite (linear programme).".to_owned(),
        Kind::Quasi => format!(
            "Separation: quasi-complete. {rows} of {} rows are fitted exactly in the limit, so that some estimates are infinite. The deviance is \
             an infimum and valid; its chi-squared tests are poor: use Firth's.",
            separation.is_separated.len()
        ),
        Kind::Complete => {
            "Separation: complete. Every row is fitted exactly in the limit; use Firth's estimates."
                .to_owned()
        }
    };
    let mut blocks = vec![Block::Text(first)];
    for (reach, words) in [
        (Reach::Plus, "Goes to +infinity"),
        (Reach::Minus, "Goes to -infinity"),
        (Reach::Either, "Infinite, sign not determined"),
    ] {
        let columns = of(reach);
        if !columns.is_empty() {
            blocks.push(Block::Text(format!("{words}: {}.", columns.join(", "))));
        }
    }
    blocks
}

fn dispersion(regression: &Regression) -> Vec<Block> {
    let fit = &regression.fit;
    let Some(dispersion) = regression.dispersion() else {
        return vec![Block::Text(
            "Dispersion: no residual degrees of freedom to estimate it from.".to_owned(),
        )];
    };
    let mut blocks = vec![Block::Text(format!(
        "Dispersion (Pearson's chi-squared / d.f.): {:.3}. One subject's six answers resemble each other; above 1 the binomial errors are too small.",
        dispersion
    ))];
    if !fit.is_valid() {
        return blocks;
    }
    let mut table = Table::new(
        "Quasi-binomial t tests",
        &["parameter", "estimate", "S.E.", "t", "P", "95 %"],
    );
    let df = fit.df() as f64;
    let quantile = tails::student_beyond(0.025, df);
    let mut least = 1.0_f64;
    for (k, name) in regression
        .design
        .names(&fit.aliases.kept)
        .iter()
        .enumerate()
    {
        let (estimate, error) = (fit.estimate[k], fit.error[k] * dispersion.sqrt());
        let probability = tails::student_both(estimate / error, df);
        least = least.min(probability);
        table.rows.push(vec![
            papers_name(name),
            digits(estimate),
            digits(error),
            digits(estimate / error),
            p(Some(probability)),
            interval(estimate - quantile * error, estimate + quantile * error),
        ]);
    }
    blocks.push(Block::Table(table));
    if least >= 0.05 {
        blocks.push(Block::Text(format!(
            "No coefficient reaches 5 %: the smallest P is {}.",
            p(Some(least))
        )));
    }
    blocks
}

fn firth(regression: &Regression) -> Vec<Block> {
    let Some(firth) = &regression.firth else {
        return vec![Block::Text(
            "Firth's estimates: the information is singular, so there are none.".to_owned(),
        )];
    };
    let header = [
        "parameter",
        "estimate",
        "S.E.",
        "penalised LR",
        "P",
        "profile 95 %",
    ];
    let mut table = Table::new("Firth's penalised estimates, always finite", &header);
    for (k, name) in regression
        .design
        .names(&regression.fit.aliases.kept)
        .iter()
        .enumerate()
    {
        let (test, bounds) = (firth.single[k], firth.intervals[k]);
        table.rows.push(vec![
            papers_name(name),
            digits(firth.maximum.beta[k]),
            digits(firth.errors[k]),
            digits(test.ratio),
            p(Some(test.p)),
            interval(bounds.low, bounds.high),
        ]);
    }
    let mut groups = Table::new(
        "Penalised likelihood-ratio tests of groups",
        &["group", "penalised LR", "d.f.", "P"],
    );
    for (g, test) in &firth.groups {
        let name = regression.design.groups[*g].term.group();
        groups.rows.push(vec![
            name,
            digits(test.ratio),
            test.df.to_string(),
            p(Some(test.p)),
        ]);
    }
    vec![Block::Table(table), Block::Table(groups)]
}

fn randomised(randomisation: &Randomisation) -> Vec<Block> {
    let how = if randomisation.is_exact {
        "all"
    } else {
        "random"
    };
    let blocks_word = match randomisation.blocks {
        1 => "one block".to_owned(),
        n => format!("{n} blocks"),
    };
    let caption = format!(
        "Randomisation tests: {} {how} re-allocations of the subjects over the places of the design that was used, within {blocks_word}, seed {}",
        randomisation.tried, randomisation.plan.seed
    );
    let mut table = Table::new(
        caption,
        &[
            "deleted",
            "change in deviance",
            "d.f.",
            "P (chi-squared)",
            "P (randomisation)",
        ],
    );
    for test in &randomisation.tests {
        table.rows.push(vec![
            test.name.clone(),
            format!("{:.3}", test.ratio),
            test.df.to_string(),
            p(test.p_chi_squared),
            p(Some(test.p)),
        ]);
    }
    let mut blocks = vec![Block::Table(table)];
    let physics = randomisation.tests.iter().map(|test| test.p);
    let least = physics.fold(1.0, f64::min);
    blocks.push(Block::Text(match least < 0.05 {
        true => format!("The smallest of these is {}.", p(Some(least))),
        false => format!(
            "Had the design made no difference at all, changes as large would come up in at least {:.0} % of allocations: no effect of the design reaches 5 %.",
            100.0 * least
        ),
    }));
    if let Some(fit) = randomisation.goodness_of_fit {
        let words = "Goodness of fit without chi-squared: data drawn from the fitted model have a deviance as large with P";
        blocks.push(Block::Text(format!(
            "{words} = {} ({} draws).",
            p(Some(fit)),
            randomisation.plan.draws
        )));
    }
    blocks
}

fn noticed(noticed: &Noticed) -> Vec<Block> {
    let mut blocks = Vec::new();
    if noticed.is_papers {
        blocks.push(Block::Text(
            "The counts are the paper's: this table has no answers of its own.".to_owned(),
        ));
    } else if noticed.missing > 0 {
        blocks.push(Block::Text(format!(
            "{} subjects gave no answer and are not counted.",
            noticed.missing
        )));
    }
    blocks.push(Block::Text(format!(
        "Fisher-Freeman-Halton exact test of all parameters together: P = {}.",
        digits(noticed.freeman_halton())
    )));
    let mut shares = Table::new(
        "Who noticed",
        &[
            "parameter",
            "noticed",
            "share",
            "Clopper-Pearson 95 %",
            "Wilson 95 %",
        ],
    );
    for (i, [no, yes]) in &noticed.rows {
        let of = no + yes;
        let percent =
            |[low, high]: [f64; 2]| format!("{:.1} to {:.1} %", 100.0 * low, 100.0 * high);
        shares.rows.push(vec![
            PARAMETERS[*i].to_owned(),
            format!("{yes} of {of}"),
            format!("{:.0} %", 100.0 * f64::from(*yes) / f64::from(of)),
            percent(exact::clopper_pearson(*yes, of)),
            percent(exact::wilson(*yes, of)),
        ]);
    }
    blocks.push(Block::Table(shares));
    let pairs = noticed.pairs();
    let probabilities: Vec<f64> = pairs.iter().map(|(_, pair)| pair.p).collect();
    let mut table = Table::new(
        "Pairs, Fisher's exact test",
        &["pair", "P", "P (Holm)", "odds ratio of not noticing, 95 %"],
    );
    for ((name, pair), holm) in pairs.iter().zip(exact::holm(&probabilities)) {
        let odds = format!(
            "{} ({})",
            digits(pair.odds_ratio),
            interval(pair.odds_low, pair.odds_high)
        );
        table.rows.push(vec![
            name.replace("_vs_", " against "),
            p(Some(pair.p)),
            p(Some(holm)),
            odds,
        ]);
    }
    blocks.push(Block::Table(table));
    if !noticed.said.is_empty() {
        let mut said = Table::new("What was said to differ", &["changed", "noticed"]);
        let rows = noticed
            .said
            .iter()
            .map(|(i, words)| vec![PARAMETERS[*i].to_owned(), words.clone()]);
        said.rows.extend(rows);
        blocks.push(Block::Table(said));
    }
    blocks
}

fn paired(analysis: &Analysis) -> Option<Block> {
    if analysis.paired.is_empty() {
        return None;
    }
    let header = [
        "changed",
        "subjects",
        "mean difference of shares",
        "S.E.",
        "t",
        "P",
    ];
    let caption = "Presence was asked after each game: high level less low, every subject their own control (paired t)";
    let mut table = Table::new(caption, &header);
    for test in &analysis.paired {
        table.rows.push(vec![
            PARAMETERS[test.parameter].to_owned(),
            test.subjects.to_string(),
            digits(test.mean),
            digits(test.error),
            digits(test.t),
            p(Some(test.p)),
        ]);
    }
    Some(Block::Table(table))
}

fn behaviour(conditions: &[Behaviour]) -> Block {
    let header = [
        "changed",
        "level",
        "games",
        "pins a throw",
        "came towards the head",
        "answered",
        "frame median [ms]",
        "99 % below [ms]",
        "longest [ms]",
    ];
    let mut table = Table::new(
        "Recordings, by the level of the parameter that changed",
        &header,
    );
    for condition in conditions {
        let frame = |value: fn(&experiment::analysis::behaviour::Summary) -> f64| {
            condition.frames.as_ref().map_or("-".to_owned(), |frames| {
                format!("{:.2}", 1e3 * value(frames))
            })
        };
        table.rows.push(vec![
            PARAMETERS[condition.parameter].to_owned(),
            u8::from(condition.is_high).to_string(),
            condition.games.to_string(),
            condition
                .pins
                .map_or("-".to_owned(), |pins| format!("{:.2}", pins.mean)),
            condition.approaches.0.to_string(),
            condition.approaches.1.to_string(),
            frame(|frames| frames.median),
            frame(|frames| frames.p99),
            frame(|frames| frames.most),
        ]);
    }
    Block::Table(table)
}
