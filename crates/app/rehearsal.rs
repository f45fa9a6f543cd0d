//! Whole scripted games with nothing recorded: for the benchmark, the score statistics and tests.

use anyhow::{Context, Result, bail};
use game::{Button, Conditions, Game};

use crate::boundary::Boundary;
use crate::devices::Device;
use crate::devices::script::{Script, Velocities};

/// Longest simulated time per delivery before the script counts as stuck [s]: walk, throw and
/// pinsetter take under a minute.
const STUCK_AFTER: f64 = 120.0;

/// Longest simulated time that a script may take for games of `frames` bowling frames [s].
pub fn patience(frames: u32, games: usize) -> f64 {
    STUCK_AFTER * f64::from(2 * frames + 2) * games as f64
}

/// Plays `games` one after the other and returns the game as it ends; `witness` sees it after each input.
///
/// # Errors
/// When the settings make no game, or the participant cannot finish one with them.
pub fn rehearse(
    conditions: &Conditions,
    frames: u32,
    seed: u64,
    velocities: Velocities,
    games: &[Button],
    mut witness: impl FnMut(&Game),
) -> Result<Game> {
    let mut game = Game::new(conditions.clone(), frames).context("cannot set up the alley")?;
    let mut script = Script::new(&conditions.lobby, seed, velocities, games);
    let mut boundary = Boundary::default();
    while !script.is_done() {
        let input = boundary.admit(script.next(&game));
        game.step(&input);
        witness(&game);
        if game.time() > patience(frames, games.len()) {
            bail!(
                "the scripted participant got stuck with seed {seed}: it does not finish a game with these settings"
            );
        }
    }
    Ok(game)
}
