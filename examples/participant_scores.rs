//! How well the scripted participant bowls: scores of many seeds under Red and under Blue.
//!
//!     cargo run --release --example participant_scores            50 games each
//!     cargo run --release --example participant_scores 200 key=value ...

use std::path::Path;
use std::time::Instant;

use anyhow::Result;
use bowling_app::devices::script::Velocities;
use bowling_app::rehearsal::rehearse;
use game::{Button, Conditions, EventKind};

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let count: u64 = arguments.next().map_or(Ok(50), |text| text.parse())?;
    let settings: Vec<String> = arguments.collect();
    let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("config");
    let conditions = &Conditions::load(&config, "alley", &settings)?;
    // A thread for each: the games of one do not depend on those of the other.
    let lines = std::thread::scope(|scope| {
        Button::BOTH
            .map(|button| scope.spawn(move || bowl(conditions, button, count)))
            .map(|games| games.join().expect("no game panics"))
    });
    for line in lines {
        println!("{}", line?);
    }
    Ok(())
}

/// Bowls `count` games under one condition; returns a line about them.
fn bowl(conditions: &Conditions, button: Button, count: u64) -> Result<String> {
    let started = Instant::now();
    let (mut scores, mut simulated) = (Vec::new(), 0.0);
    let (mut balls, mut empty, mut empty_first, mut strikes) = (0, 0, 0, 0);
    for seed in 1..=count {
        let game = rehearse(
            conditions,
            10,
            seed,
            Velocities::Measured,
            &[button],
            |game| {
                for event in game.events() {
                    if let EventKind::Rolled { roll, ball, .. } = &event.kind {
                        balls += 1;
                        empty += u32::from(roll.pins() == 0);
                        empty_first += u32::from(*ball == 1 && roll.pins() == 0);
                        strikes += u32::from(*ball == 1 && roll.pins() == 10);
                    }
                }
            },
        )?;
        scores.push(game.score_sheet(button).total());
        simulated += game.time();
    }
    scores.sort_unstable();
    let mean = scores.iter().sum::<u32>() as f64 / count as f64;
    let variance = scores
        .iter()
        .map(|score| (f64::from(*score) - mean).powi(2))
        .sum::<f64>()
        / count as f64;
    Ok(format!(
        "{button}: mean {mean:.1}, deviation {:.1}, from {} to {}, over {count} games; {balls} balls, {empty} without a pin ({empty_first} of them at ten), {strikes} strikes; {:.0} s per game, {:.0} times as fast as real time",
        variance.sqrt(),
        scores[0],
        scores[scores.len() - 1],
        simulated / count as f64,
        simulated / started.elapsed().as_secs_f64()
    ))
}
