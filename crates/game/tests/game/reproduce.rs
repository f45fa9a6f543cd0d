//! The same inputs give the same bits, and every world stays finite.

use crate::support::{Player, Swing, conditions};
use game::{Button, Game, Input};

/// Plays inputs into a new game.
fn replay(inputs: &[Input], arguments: &[&str]) -> Game {
    let mut game = Game::new(conditions(arguments), 1).unwrap();
    for input in inputs {
        game.step(input);
    }
    game
}

#[test]
fn the_same_inputs_give_the_same_hash_also_through_json() {
    let mut player = Player::new(conditions(&[]), 1);
    player.key(Button::Blue);
    player.throw(Swing::straight());
    let hash = player.game.hash();
    assert_eq!(replay(&player.inputs, &[]).hash(), hash);
    let text = serde_json::to_string(&player.inputs).unwrap();
    let inputs: Vec<Input> = serde_json::from_str(&text).unwrap();
    assert_eq!(replay(&inputs, &[]).hash(), hash);

    // A hair's breadth in one pose is enough to differ.
    let mut changed = player.inputs.clone();
    let grabbed = changed
        .iter()
        .position(|input| input.trigger > 0.5)
        .unwrap();
    let hand = changed[grabbed].hand.as_mut().unwrap();
    hand.pose.position.x += 1e-12;
    assert_ne!(replay(&changed, &[]).hash(), hash);
}

#[test]
fn every_corner_of_table_1_stays_finite_and_scores() {
    for elasticity in ["1.0", "0.7"] {
        for friction in ["0.0", "0.7"] {
            for shape in ["true", "ellipsoid"] {
                let arguments = [
                    format!("objects.elasticity={elasticity}"),
                    format!("objects.friction_rate={friction}"),
                    format!("objects.shape=\"{shape}\""),
                ];
                let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
                let mut player = Player::new(conditions(&arguments), 1);
                player.key(Button::Red);
                player.throw(Swing::straight());
                let sheet = player.game.score_sheet(Button::Red);
                assert_eq!(sheet.rolls().len(), 1, "{arguments:?}");
                for seen in player.game.visible() {
                    assert!(seen.pose.is_finite(), "{arguments:?} {seen:?}");
                    assert!(seen.pose.position.length() < 40.0, "{arguments:?} {seen:?}");
                }
            }
        }
    }
}

#[test]
fn pins_stand_untouched_for_a_minute_in_every_condition() {
    for shape in ["true", "ellipsoid"] {
        let awake =
            r#"["gravity", "elasticity", "friction", "rotation", "gyroscopic", "continuous"]"#;
        for effects in [awake, &awake.replace(']', ", \"sleeping\"]")] {
            let shape = format!("objects.shape=\"{shape}\"");
            let effects = format!("physics.effects={effects}");
            let mut player = Player::new(conditions(&[&shape, &effects]), 1);
            for button in Button::BOTH {
                player.key(button);
                player.key(button);
                let before = player.game.observe().pins;
                player.wait(60.0);
                for (was, is) in before.iter().zip(player.game.observe().pins) {
                    let drift = was.position.distance(is.position);
                    assert!(
                        drift < 1e-5 && is.lean < 1e-4,
                        "{shape} {effects} {is:?} drifted {drift} m"
                    );
                }
                assert!(player.is_ready());
            }
        }
    }
}
