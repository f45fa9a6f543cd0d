//! Simulated participants: answers from a model that is written down, so that a study can be played without anybody.
//!
//! The chance of a high answer (6 or 7) to each presence item is `1 / (1 + exp(-eta))`, with `eta` from Table 6 of the paper; sickness
//! is drawn from Table 3, prior experience is 7 in 18 (section 3), a change is noticed as in Table 4. Answers of one
//! participant are alike: each item takes, with chance `sqrt(r)`, the participant's common draw instead of one of its own, which
//! gives every pair of items the correlation `r` and leaves each item's chance as it is. `r` is 0.114, for which the
//! paper's dispersion of 1.57 is expected: `1 + 5 r`. The rest is chosen: which of 6 and 7, which of 1 to 5, ages, how long
//! somebody thinks. A cell in which several factors change has the mean of their `eta`.

use crate::plan::{Design, Row};
use crate::questionnaire::{Act, Answer, Item, Kind, Questionnaire, Stage};
use crate::random::SplitMix64;

/// Numbers of participants who gave each answer to the question about sickness: Table 3, as parts of 18.
const SICKNESS: [u64; 7] = [5, 5, 3, 0, 3, 1, 1];
/// Participants with prior experience, of 18 (section 3).
const EXPERIENCED: u64 = 7;
/// Chance that a change is noticed: Table 4.
const NOTICED: [(&str, f64, &str); 3] = [
    ("elasticity", 0.5, "bounce"),
    ("friction", 1.0, "slide"),
    ("shape", 0.0, "shape"),
];

/// The coefficients of Table 6 and the likeness of one participant's answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Model {
    /// Constant where elasticity, friction or shape is changed.
    pub changed: [f64; 3],
    /// Level 1 of friction; nothing where friction is what changes.
    pub friction: f64,
    /// Each step of sickness.
    pub sick: f64,
    /// Prior experience.
    pub vr_before: f64,
    /// Level 1 of shape where elasticity, and where friction is changed.
    pub shape: [f64; 2],
    /// Level 1 of elasticity where friction, and where shape is changed.
    pub elasticity: [f64; 2],
    /// Correlation of any two presence items of one participant.
    pub likeness: f64,
}

impl Model {
    /// Table 6 of the paper.
    pub const TABLE_6: Model = Model {
        changed: [1.501, -0.9969, 0.7149],
        friction: 2.112,
        sick: -0.6980,
        vr_before: -1.580,
        shape: [-1.496, 3.786],
        elasticity: [-3.836, -0.5273],
        likeness: 0.114,
    };

    /// The chance of a high answer, for these kept levels of E, F and S, at this sickness (1 to 7) and experience.
    fn chance(&self, changed: &str, efs: [f64; 3], sick: f64, vr_before: bool) -> f64 {
        let [e, f, s] = efs;
        let [by_e, by_f, by_s] = self.changed;
        let each = |factor: &str| match factor {
            "elasticity" => Some(by_e + self.friction * f + self.shape[0] * s),
            "friction" => Some(by_f + self.shape[1] * s + self.elasticity[0] * e),
            "shape" => Some(by_s + self.friction * f + self.elasticity[1] * e),
            _ => None,
        };
        let parts: Vec<f64> = changed.split('+').filter_map(each).collect();
        // A factor that the paper does not have says nothing.
        let own = if parts.is_empty() {
            0.0
        } else {
            parts.iter().sum::<f64>() / parts.len() as f64
        };
        let eta = own + self.sick * sick + if vr_before { self.vr_before } else { 0.0 };
        1.0 / (1.0 + libm::exp(-eta))
    }
}

/// Somebody who is not there.
#[derive(Debug, Clone)]
pub struct Simulated {
    questionnaire: Questionnaire,
    seed: u64,
    sick: u8,
    vr_before: bool,
    /// What is noticed, as an option of the shipped questionnaire; `None` for nothing.
    noticed: Option<&'static str>,
    chance: f64,
    likeness: f64,
}

impl Simulated {
    /// The participant of a row; the same arguments give the same person.
    pub fn new(
        model: &Model,
        questionnaire: &Questionnaire,
        design: &Design,
        row: &Row,
        seed: u64,
    ) -> Self {
        let mut random = SplitMix64::new(seed);
        let sick = sickness(random.below(18));
        let vr_before = random.below(18) < EXPERIENCED;
        let is_changed = |name: &str| row.changed.split('+').any(|changed| changed == name);
        let mut noticed = None;
        for (factor, chance, option) in NOTICED {
            let notices = random.uniform() < chance;
            if notices && is_changed(factor) {
                noticed = Some(option);
            }
        }
        let level = |name: &str| {
            let index = design.factors.iter().position(|factor| factor.name == name);
            index.map_or(0.0, |index| f64::from(row.low.0[index].min(1)))
        };
        let efs = ["elasticity", "friction", "shape"].map(level);
        Simulated {
            questionnaire: questionnaire.clone(),
            seed: random.next_u64(),
            chance: model.chance(&row.changed, efs, f64::from(sick), vr_before),
            likeness: model.likeness,
            sick,
            vr_before,
            noticed,
        }
    }

    /// What this person does at an item, and how long it takes [s]. Asked twice, the same.
    pub fn answer(&self, stage: Stage, item: &Item) -> (Act, f64) {
        let index = self
            .questionnaire
            .items
            .iter()
            .position(|other| other.id == item.id);
        let place = match stage {
            Stage::Before => 0,
            Stage::AfterGame(game) => u64::from(game),
            Stage::After => 3,
        };
        let index = index.map_or(u64::MAX, |index| index as u64 * 4 + place);
        let mut random = SplitMix64::for_index(self.seed, index);
        let thinks_s = 2.0 + 6.0 * random.uniform();
        // What is common to all items of one form.
        let form = SplitMix64::for_index(self.seed, u64::MAX / 2 + place);
        let act = match &item.kind {
            Kind::Scale { .. } => Act::Answer(Answer::Scale(self.step(item, form, &mut random))),
            Kind::YesNo => Act::Answer(Answer::YesNo(match item.id.as_str() {
                "vr_before" => self.vr_before,
                "noticed" => self.noticed.is_some(),
                _ => random.below(2) == 0,
            })),
            Kind::Choice { options, .. } => {
                let named = options
                    .iter()
                    .find(|option| Some(option.id.as_str()) == self.noticed);
                let chosen = named.unwrap_or(&options[random.below(options.len() as u64) as usize]);
                Act::Answer(Answer::Choice {
                    chosen: vec![chosen.id.clone()],
                    other: String::new(),
                })
            }
            Kind::Text => Act::Skip,
        };
        (act, thinks_s)
    }

    fn step(&self, item: &Item, mut form: SplitMix64, random: &mut SplitMix64) -> u8 {
        let common = form.uniform() < self.chance;
        let mood = form.normal();
        match item.id.as_str() {
            "sick" => self.sick,
            "sick_before" => 1 + u8::from(random.below(6) == 0),
            "sick_between" => self.sick.saturating_sub(random.below(2) as u8).max(1),
            _ => {
                let alike = random.uniform() < self.likeness.sqrt();
                let own = random.uniform() < self.chance;
                if if alike { common } else { own } {
                    6 + random.below(2) as u8
                } else {
                    // From 1 to 5 around 3, with the form's mood.
                    (3.0 + mood + 0.8 * random.normal()).round().clamp(1.0, 5.0) as u8
                }
            }
        }
    }
}

fn sickness(ticket: u64) -> u8 {
    let mut before = 0;
    let answers = (1..).zip(SICKNESS);
    let drawn = answers.into_iter().find(|(_, count)| {
        before += count;
        ticket < before
    });
    drawn.map_or(7, |(answer, _)| answer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Scheme, allocate};
    use crate::questionnaire::Form;
    use std::path::Path;

    fn shipped() -> Questionnaire {
        let text = include_str!("../../../config/questionnaire.toml");
        Questionnaire::parse(text, Path::new("q.toml")).unwrap()
    }

    /// Answers of `count` participants of the row of this cell to the last form.
    fn forms(efs: &str, changed: &str, model: &Model, count: u64) -> Vec<(Simulated, Form)> {
        let questionnaire = shipped();
        let design = Scheme::Table2.design().unwrap();
        let rows = allocate(&design, 18, 1);
        let row = rows
            .iter()
            .find(|row| row.low.to_string() == efs && row.changed == changed)
            .unwrap();
        let play = |seed| {
            let person = Simulated::new(model, &questionnaire, &design, row, seed);
            let mut form = Form::new(&questionnaire, Stage::After, false);
            while let Some(item) = form.current() {
                let (act, thinks_s) = person.answer(Stage::After, item);
                form.act(thinks_s, act).unwrap();
            }
            (person, form)
        };
        (0..count).map(play).collect()
    }

    #[test]
    fn answers_follow_table_6() {
        // Table 6 added up by hand for somebody without sickness' slope and experience: model with both set to zero.
        let plain = Model {
            sick: 0.0,
            vr_before: 0.0,
            ..Model::TABLE_6
        };
        let cells = [
            ("000", "elasticity", 1.501),
            ("011", "elasticity", 2.117),
            ("101", "friction", -1.0469),
            ("110", "shape", 2.2996),
        ];
        for (efs, changed, eta) in cells {
            let forms = forms(efs, changed, &plain, 3000);
            let counts: Vec<f64> = forms
                .iter()
                .map(|(_, form)| f64::from(form.answers().presence(&shipped()).count))
                .collect();
            let p = 1.0 / (1.0 + f64::exp(-eta));
            let mean = counts.iter().sum::<f64>() / 3000.0;
            let variance = counts
                .iter()
                .map(|count| (count - mean).powi(2))
                .sum::<f64>()
                / 2999.0;
            let binomial = 6.0 * p * (1.0 - p);
            // Four standard errors of the mean; of the dispersion 1.57 about 4 % each.
            assert!(
                (mean - 6.0 * p).abs() < 4.0 * (1.57 * binomial / 3000.0).sqrt(),
                "{efs} {changed}: {mean} for {p}"
            );
            assert!(
                (variance / binomial - 1.57).abs() < 0.25,
                "{efs} {changed}: {}",
                variance / binomial
            );
        }
    }

    #[test]
    fn sickness_experience_and_what_is_noticed_follow_the_paper() {
        let forms = forms("000", "elasticity", &Model::TABLE_6, 3600);
        let share = |is: &dyn Fn(&Form) -> bool| {
            forms.iter().filter(|(_, form)| is(form)).count() as f64 / 3600.0
        };
        for (answer, percent) in (1..).zip([28.0, 28.0, 17.0, 0.0, 17.0, 6.0, 6.0]) {
            let found = share(&|form| form.answers().scale("sick") == Some(answer)) * 100.0;
            // Table 3 is rounded to a percent; three standard errors are 2.2.
            assert!((found - percent).abs() < 2.8, "{answer}: {found}");
        }
        let experienced =
            forms.iter().filter(|(person, _)| person.vr_before).count() as f64 / 3600.0;
        assert!((experienced - 7.0 / 18.0).abs() < 0.033, "{experienced}");
        let noticed = share(&|form| form.answers().yes_no("noticed") == Some(true));
        assert!((noticed - 0.5).abs() < 0.034, "{noticed}");
        assert!(forms.iter().all(|(person, form)| {
            let what = form.answers().get("noticed_what").map(Answer::cell);
            person.noticed.is_some() == (what.as_deref() == Some("bounce"))
        }));
    }

    #[test]
    fn person_is_the_same_person_twice() {
        let answers = || -> Vec<_> {
            forms("110", "shape", &Model::TABLE_6, 20)
                .into_iter()
                .map(|(_, form)| form.answers())
                .collect()
        };
        assert_eq!(answers(), answers());
        // Nobody noticed a change of shape: Table 4.
        assert!(
            answers()
                .iter()
                .all(|answers| answers.yes_no("noticed") == Some(false))
        );
        let different: std::collections::BTreeSet<String> = answers()
            .iter()
            .map(|a| format!("{:?}", a.scale("q1")))
            .collect();
        assert!(different.len() > 2);
    }
}
