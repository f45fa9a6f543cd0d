//! All short texts that hang in the room while somebody plays: the names of the buttons, the weights of balls in practice, and the
//! hint that is due.

use game::{Button, Game};
use glam::DVec3;

use crate::hints::Grip;
use crate::signs::{Ground, Sign, facing};
use crate::words::Words;
use crate::{hints, practice};

/// Where the name of a button hangs from the middle of its top [m].
const FROM_BUTTON: DVec3 = DVec3::new(0.0, 0.12, -0.12);
/// Size of its letters [m], and from how far it is read at most: from the start [m].
pub const BUTTON_LETTER_AND_DISTANCE: [f64; 2] = [0.048, 2.8];

/// What hangs in the room now for who takes balls with this; nothing while the head is not tracked.
pub fn signs(game: &Game, grip: Grip, words: &Words) -> Vec<Sign> {
    let Some(head) = game.head_pose_world() else {
        return Vec::new();
    };
    let mut signs = Vec::new();
    if !game.config().practice.only {
        signs.extend(names(game, words, head.position));
    }
    signs.extend(practice::weights(game, words, head.position));
    signs.extend(hints::sign(game, grip, &words.hints));
    signs
}

/// The buttons' names: whoever sees neither colour nor shape reads them.
fn names(game: &Game, words: &Words, eye: DVec3) -> [Sign; 2] {
    let buttons = game.observe().buttons;
    Button::BOTH.map(|button| Sign {
        text: words.button(button).to_owned(),
        letter_m: BUTTON_LETTER_AND_DISTANCE[0],
        pose: facing(buttons[button as usize].top + FROM_BUTTON, eye),
        ground: Ground::Plain,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convert::board;
    use crate::convert::tests::config;
    use crate::hints::Hint;
    use crate::panel;
    use crate::scenery::furnishings::{SCREEN, screen_middle};
    use game::{Conditions, Input, Tracked};
    use physics::Pose;
    use renderer::egui;

    /// Pixels to a degree of the coarsest headset that everything has to be readable in.
    const PIXELS_PER_DEGREE: f64 = 15.0;
    /// Height of capital letters in pixels from which text is read word by word, and from which figures are: characters of
    /// 7 x 9 and 5 x 7 pixels, as ISO 9241-3 (1992) asks of displays.
    const WORDS_PX: f64 = 9.0;
    const FIGURES_PX: f64 = 7.0;

    /// Height of a capital in sizes of its font, as egui draws it.
    fn capital() -> f64 {
        let size = 400.0;
        let mut height = 0.0;
        let context = egui::Context::default();
        let mut output = context.run_ui(egui::RawInput::default(), |ui| {
            let font = egui::FontId::proportional(size);
            let painter = ui.ctx().debug_painter();
            let galley = painter.layout_no_wrap("H".to_owned(), font, egui::Color32::WHITE);
            height = galley.mesh_bounds.height();
        });
        output.textures_delta.clear();
        f64::from(height / size)
    }

    #[test]
    fn every_text_in_the_room_is_readable_at_15_pixels_to_a_degree() {
        let config = config();
        let eye = DVec3::new(config.start.x_m, 1.62, config.start.z_m);
        let board_m = |pixels: f32| f64::from(pixels / board::SIZE[1] as f32 * SCREEN[1]);
        let to_board = eye.distance(screen_middle(&config).as_dvec3());
        let mut texts = vec![
            (
                "figures of the scoreboard",
                board_m(board::FIGURE_PX),
                to_board,
                FIGURES_PX,
            ),
            (
                "words of the scoreboard",
                board_m(board::WORD_PX),
                to_board,
                WORDS_PX,
            ),
        ];
        for (name, letter, distance) in panel::letters(&config, eye) {
            texts.push((name, letter, distance, WORDS_PX));
        }
        let signs = [
            ("names of the buttons", BUTTON_LETTER_AND_DISTANCE),
            ("weights of the balls", practice::WEIGHT_LETTER_AND_DISTANCE),
            ("the panel at the wrist", crate::wrist::LETTER_AND_DISTANCE),
        ];
        let hints = Hint::ALL.map(|hint| ("a hint", hint.letter_and_distance()));
        for (name, [letter, distance]) in signs.into_iter().chain(hints) {
            texts.push((name, letter, distance, WORDS_PX));
        }
        let capital = capital();
        assert!((0.6..0.8).contains(&capital), "{capital}");
        for (name, letter, distance, least) in texts {
            let height = capital * letter;
            let degrees = 2.0 * (0.5 * height / distance).atan().to_degrees();
            let pixels = degrees * PIXELS_PER_DEGREE;
            assert!(pixels >= least, "{name}: {pixels:.1} pixels, not {least}");
        }
    }

    #[test]
    fn the_buttons_have_their_names_also_where_no_game_is_played() {
        let config = config();
        let conditions = Conditions {
            lobby: config.clone(),
            red: config.clone(),
            blue: config,
        };
        let mut game = Game::new(conditions, 1).expect("the shipped room");
        let words = Words::shipped();
        assert!(
            signs(&game, Grip::Trigger, &words).is_empty(),
            "nobody is there to read"
        );
        game.step(&Input {
            head: Some(Tracked::at(Pose::from_position(DVec3::Y * 1.62))),
            steps: 8,
            ..Input::default()
        });
        let texts: Vec<String> = signs(&game, Grip::Trigger, &words)
            .into_iter()
            .map(|sign| sign.text)
            .collect();
        assert_eq!(texts, ["Red", "Blue", "Reach for a ball"]);
    }

    /// Seen from above, the Red button's outline is a disc and the Blue one's a square.
    #[test]
    fn the_buttons_differ_in_shape() {
        let outline = |name: &str| {
            let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
                .join(format!("assets/meshes/{name}.obj"));
            let text = std::fs::read_to_string(path).expect("an asset");
            let vertices = text.lines().filter_map(|line| {
                let numbers: Vec<f64> = line
                    .strip_prefix("v ")?
                    .split_whitespace()
                    .filter_map(|word| word.parse().ok())
                    .collect();
                Some((numbers[0], numbers[2]))
            });
            let points: Vec<(f64, f64)> = vertices.collect();
            let farthest = |of: &dyn Fn(f64, f64) -> f64| {
                points.iter().map(|(x, z)| of(*x, *z)).fold(0.0, f64::max)
            };
            farthest(&|x, z| x.hypot(z)) / farthest(&|x, z| x.abs().max(z.abs()))
        };
        let (disc, square) = (outline("button_round"), outline("button_square"));
        assert!((0.99..1.03).contains(&disc), "{disc}");
        assert!(square > 1.3, "{square}");
    }
}
