//! Who noticed a difference, by the parameter that changed (Table 4), and how sure that is.

use serde_json::{Map, Value, json};

use super::exact;
use super::json::number;
use super::subjects::{PARAMETERS, Subjects};

/// Counts of who noticed, and where they are from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Noticed {
    /// For each parameter that changed for anyone: its index, who did not notice, who did.
    pub rows: Vec<(usize, [u32; 2])>,
    /// Whether the counts are the paper's, because the table has none.
    pub is_papers: bool,
    /// Subjects with an answer, and without.
    pub answered: u32,
    /// Subjects without an answer or without a parameter.
    pub missing: u32,
    /// What those who noticed say it was, with the parameter that changed.
    pub said: Vec<(usize, String)>,
}

/// Table 4: no change observed, change observed.
const PAPER: [[u32; 2]; 3] = [[3, 3], [0, 6], [6, 0]];

impl Noticed {
    /// Counts `subjects`; the paper's counts where the table does not have the answers, and nothing where it does not
    /// even say what changed.
    pub fn of(subjects: &Subjects) -> Option<Noticed> {
        if !subjects.has_change() {
            return None;
        }
        if !subjects.has("noticed") {
            let rows = PAPER.iter().copied().enumerate().collect();
            return Some(Noticed {
                rows,
                is_papers: true,
                answered: 18,
                missing: 0,
                said: Vec::new(),
            });
        }
        let mut counts = [[0_u32; 2]; 3];
        let mut noticed = Noticed {
            rows: Vec::new(),
            is_papers: false,
            answered: 0,
            missing: 0,
            said: Vec::new(),
        };
        for subject in &subjects.list {
            let (Some(change), Some(is)) = (subject.change, subject.noticed) else {
                noticed.missing += 1;
                continue;
            };
            counts[change][usize::from(is)] += 1;
            noticed.answered += 1;
            if let (true, Some(words)) = (is, &subject.noticed_what) {
                noticed.said.push((change, words.clone()));
            }
        }
        noticed.said.sort();
        noticed.rows = counts
            .into_iter()
            .enumerate()
            .filter(|(_, row)| row[0] + row[1] > 0)
            .collect();
        Some(noticed)
    }

    fn counts(&self) -> Vec<[u32; 2]> {
        self.rows.iter().map(|(_, row)| *row).collect()
    }

    /// The exact test of all parameters together.
    pub fn freeman_halton(&self) -> f64 {
        exact::freeman_halton(&self.counts())
    }

    /// Each two parameters against each other: their names and the test; odds are those of not noticing, as in Table 4's rows.
    pub fn pairs(&self) -> Vec<(String, exact::Pair)> {
        let mut pairs = Vec::new();
        for (i, (a, row_a)) in self.rows.iter().enumerate() {
            for (b, row_b) in &self.rows[i + 1..] {
                let name = format!("{}_vs_{}", PARAMETERS[*a], PARAMETERS[*b]);
                pairs.push((name, exact::pair(*row_a, *row_b)));
            }
        }
        pairs
    }

    /// Every number, with the names that the reference has.
    pub fn json(&self) -> Value {
        let counts = self.counts();
        let pairs = self.pairs();
        let p: Vec<f64> = pairs.iter().map(|(_, pair)| pair.p).collect();
        let named = |values: Vec<Value>| -> Map<String, Value> {
            pairs
                .iter()
                .map(|(name, _)| name.clone())
                .zip(values)
                .collect()
        };
        let plain = |values: Vec<f64>| named(values.into_iter().map(number).collect());
        let pearson = exact::pearson(&counts);
        let odds = pairs.iter().map(|(_, pair)| {
            json!([
                odds_text(pair.odds_ratio),
                odds_text(pair.odds_low),
                odds_text(pair.odds_high)
            ])
        });
        json!({
            "source": if self.is_papers { "Table 4 of the paper: this table has no answers of its own" } else { "this table" },
            "parameters": self.rows.iter().map(|(i, _)| PARAMETERS[*i]).collect::<Vec<_>>(),
            "table": [counts.iter().map(|row| row[0]).collect::<Vec<_>>(), counts.iter().map(|row| row[1]).collect::<Vec<_>>()],
            "answered": self.answered,
            "missing": self.missing,
            "freeman_halton_p": self.freeman_halton(),
            "pearson_chi2": pearson.map(|(value, _)| value),
            "pearson_df": pearson.map(|(_, df)| df),
            "pearson_p": pearson.and_then(|(value, df)| exact::pearson_p(value, df)),
            "pairwise_fisher_two_sided": plain(p.clone()),
            "pairwise_holm": plain(exact::holm(&p)),
            "pairwise_bonferroni": plain(exact::bonferroni(&p)),
            "pairwise_mid_p": plain(pairs.iter().map(|(_, pair)| pair.mid_p).collect()),
            "pairwise_odds_ratio_conditional_mle": named(odds.collect()),
            "proportions": self.rows.iter().map(|(i, row)| (PARAMETERS[*i].to_owned(), proportion(*row))).collect::<Map<_, _>>(),
            "said": self.said.iter().map(|(i, words)| json!({"changed": PARAMETERS[*i], "noticed": words})).collect::<Vec<_>>(),
        })
    }
}

fn proportion([no, yes]: [u32; 2]) -> Value {
    let of = no + yes;
    json!({
        "noticed": yes,
        "n": of,
        "clopper_pearson95": exact::clopper_pearson(yes, of),
        "wilson95": exact::wilson(yes, of),
        "jeffreys95": exact::jeffreys(yes, of),
        "binom_test_p_vs_half": exact::against_half(yes, of),
    })
}

/// An odds ratio as text, because it may be infinite.
fn odds_text(odds: f64) -> String {
    if odds.is_infinite() {
        "Inf".to_owned()
    } else {
        odds.to_string()
    }
}
