//! Where things lie on the panel, in pixels of its picture.

use experiment::questionnaire::{Answer, Item, Kind, SCALE_STEPS};
use experiment::staircase::Reply;
use glam::{DVec2, UVec2};

use crate::words::PanelWords;

/// Size of the picture [pixels]: 640 per metre, more than a headset shows at 2 m.
pub const SIZE_PX: UVec2 = UVec2::new(1024, 640);

const MARGIN: f64 = 40.0;
const GAP: f64 = 12.0;
/// Where the answers begin.
const ANSWERS_TOP: f64 = 250.0;
/// Height of a step of a scale.
const STEP_HEIGHT: f64 = 90.0;
/// Height of the row with Back, Skip and Stop, and where it begins.
const FOOT_TOP: f64 = 550.0;
const FOOT_HEIGHT: f64 = 60.0;
const FOOT_WIDTH: f64 = 200.0;

/// What the panel shows.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// A question.
    Item {
        /// It.
        item: Item,
        /// Its number, and how many there are.
        position: (usize, usize),
        /// What was answered before.
        given: Option<Answer>,
    },
    /// A pair of throws is to be compared: its number, and how many there are.
    Pair(u32, u32),
    /// Words alone.
    Words(String),
}

/// What pointing at a box means.
#[derive(Debug, Clone, PartialEq)]
pub enum Choice {
    /// This answer.
    Answer(Answer),
    /// This of a pair of throws.
    Reply(Reply),
    /// No answer.
    Skip,
    /// The question before.
    Back,
    /// The end of the session.
    Stop,
}

/// Something that can be chosen.
#[derive(Debug, Clone, PartialEq)]
pub struct Area {
    /// Its upper left corner [pixels].
    pub from: DVec2,
    /// Its lower right corner [pixels].
    pub to: DVec2,
    /// What it says.
    pub words: String,
    /// What it means.
    pub choice: Choice,
}

/// All that can be chosen.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// The boxes; none overlap.
    pub areas: Vec<Area>,
}

impl Layout {
    /// The layout of some content, its fixed labels in these words.
    pub fn of(content: &Content, words: &PanelWords) -> Self {
        let mut areas = Vec::new();
        match content {
            Content::Item { item, .. } => {
                areas.extend(answers(item, words));
                areas.extend(foot(words));
            }
            Content::Pair(..) => {
                let replies = [
                    (words.same.clone(), Reply::Same),
                    (words.different.clone(), Reply::Different),
                ];
                let choices = replies.map(|(words, reply)| (words, Choice::Reply(reply)));
                areas.extend(row(choices.to_vec()));
                // A reply cannot be taken back or left out: the next pair depends on it.
                areas.extend(
                    foot(words)
                        .into_iter()
                        .filter(|area| area.choice == Choice::Stop),
                );
            }
            Content::Words(_) => {}
        }
        Self { areas }
    }

    /// What lies at a pixel.
    pub fn choice(&self, at: DVec2) -> Option<&Choice> {
        let is_in = |area: &&Area| at.cmpge(area.from).all() && at.cmple(area.to).all();
        self.areas.iter().find(is_in).map(|area| &area.choice)
    }
}

/// The boxes of an item's answers: scales and yes or no side by side, options below each other in two columns.
fn answers(item: &Item, words: &PanelWords) -> Vec<Area> {
    match &item.kind {
        Kind::Scale { .. } => {
            let steps = (1..=SCALE_STEPS).map(|step| {
                let choice = Choice::Answer(Answer::Scale(step));
                (step.to_string(), choice)
            });
            row(steps.collect())
        }
        Kind::YesNo => row(vec![
            (words.yes.clone(), Choice::Answer(Answer::YesNo(true))),
            (words.no.clone(), Choice::Answer(Answer::YesNo(false))),
        ]),
        Kind::Choice { options, .. } => {
            let options = options.iter().map(|option| {
                let answer = Answer::Choice {
                    chosen: vec![option.id.clone()],
                    other: String::new(),
                };
                (option.text.clone(), answer)
            });
            columns(options.collect())
        }
        // Words are said, and the experimenter writes them down.
        Kind::Text => Vec::new(),
    }
}

fn row(choices: Vec<(String, Choice)>) -> Vec<Area> {
    let count = choices.len() as f64;
    let width = (f64::from(SIZE_PX.x) - 2.0 * MARGIN - GAP * (count - 1.0)) / count;
    let place = |(number, (words, choice)): (usize, (String, Choice))| {
        let from = DVec2::new(MARGIN + number as f64 * (width + GAP), ANSWERS_TOP);
        area(from, DVec2::new(width, STEP_HEIGHT), words, choice)
    };
    choices.into_iter().enumerate().map(place).collect()
}

fn columns(answers: Vec<(String, Answer)>) -> Vec<Area> {
    let rows = answers.len().div_ceil(2).max(1);
    let width = (f64::from(SIZE_PX.x) - 2.0 * MARGIN - GAP) / 2.0;
    let room = FOOT_TOP - GAP - ANSWERS_TOP;
    let height = (room / rows as f64 - GAP).min(STEP_HEIGHT);
    let place = |(number, (words, answer)): (usize, (String, Answer))| {
        let (column, row) = (number / rows, number % rows);
        let from = DVec2::new(
            MARGIN + column as f64 * (width + GAP),
            ANSWERS_TOP + row as f64 * (height + GAP),
        );
        area(
            from,
            DVec2::new(width, height),
            words,
            Choice::Answer(answer),
        )
    };
    answers.into_iter().enumerate().map(place).collect()
}

fn foot(words: &PanelWords) -> Vec<Area> {
    let size = DVec2::new(FOOT_WIDTH, FOOT_HEIGHT);
    let right = f64::from(SIZE_PX.x) - MARGIN - FOOT_WIDTH;
    let places = [
        (MARGIN, &words.back, Choice::Back),
        (MARGIN + FOOT_WIDTH + GAP, &words.skip, Choice::Skip),
        (right, &words.stop, Choice::Stop),
    ];
    places
        .into_iter()
        .map(|(x, words, choice)| area(DVec2::new(x, FOOT_TOP), size, words.clone(), choice))
        .collect()
}

fn area(from: DVec2, size: DVec2, words: String, choice: Choice) -> Area {
    Area {
        from,
        to: from + size,
        words,
        choice,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::words::Words;
    use experiment::questionnaire::Questionnaire;

    fn layouts() -> Vec<(Item, Layout)> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("config/questionnaire.toml");
        let items = Questionnaire::read(&path).expect("the shipped one").items;
        let layout = |item: Item| {
            let content = Content::Item {
                item: item.clone(),
                position: (1, 1),
                given: None,
            };
            (item, Layout::of(&content, &Words::shipped().panel))
        };
        items.into_iter().map(layout).collect()
    }

    #[test]
    fn every_shipped_item_has_boxes_on_the_panel_that_do_not_overlap() {
        for (item, layout) in layouts() {
            for (index, area) in layout.areas.iter().enumerate() {
                let is_on =
                    area.from.cmpge(DVec2::ZERO).all() && area.to.cmple(SIZE_PX.as_dvec2()).all();
                assert!(is_on, "{} {area:?}", item.id);
                for other in &layout.areas[..index] {
                    let apart = area.from.cmpge(other.to).any() || other.from.cmpge(area.to).any();
                    assert!(apart, "{}: {area:?} {other:?}", item.id);
                }
                let middle = 0.5 * (area.from + area.to);
                assert_eq!(layout.choice(middle), Some(&area.choice));
            }
        }
    }

    #[test]
    fn a_scale_has_seven_steps_from_left_to_right() {
        let (_, layout) = layouts()
            .into_iter()
            .find(|(item, _)| item.id == "q1")
            .expect("the first item");
        let steps: Vec<&Area> = layout
            .areas
            .iter()
            .filter(|area| matches!(area.choice, Choice::Answer(Answer::Scale(_))))
            .collect();
        assert_eq!(steps.len(), 7);
        for pair in steps.windows(2) {
            assert!(pair[0].to.x < pair[1].from.x);
        }
        assert_eq!(steps[6].choice, Choice::Answer(Answer::Scale(7)));
    }
}
