//! Practice: `bowling play --practice`, with any pins, balls of chosen weights, and a lane whose oil and last ball are seen.

use anyhow::{Result, ensure};
use game::{BallConfig, Conditions, EffectName, EventKind, Game, Model};
use glam::{DVec3, Mat4, Quat, Vec3};
use renderer::{Instance, Material};

use crate::args::PlayArguments;
use crate::convert::Stock;
use crate::signs::{Ground, Sign, facing};
use crate::words::{Words, fill};

/// Points of a ball's way lie at least this far apart [m].
const SPACING_M: f64 = 0.2;
/// Width of the way that is drawn, and its height over the lane [m].
const WAY_WIDTH_M: f32 = 0.025;
const WAY_OVER_M: f32 = 0.002;
/// How far over a ball its weight is written, and in letters of which size [m].
const OVER_BALL_M: f64 = 0.2;
/// Size of the letters of a weight [m], and from how far it is read at most [m].
pub const WEIGHT_LETTER_AND_DISTANCE: [f64; 2] = [0.045, 2.0];

/// The settings that practice makes of those that `loaded` are without it, as arguments.
///
/// # Errors
/// When there are more balls than a rack is long.
pub fn settings(arguments: &PlayArguments, loaded: &Conditions) -> Result<Vec<String>> {
    let config = &loaded.lobby;
    let mut effects = config.physics.effects.clone();
    let oil = EffectName(physics::Effect::Oil);
    if !effects.contains(&oil) {
        effects.push(oil);
    }
    let leave = arguments.leave.as_ref().map_or(&[][..], |pins| &pins.0[..]);
    let mut settings = vec![
        "practice.only=true".to_owned(),
        format!("practice.leave={leave:?}"),
        "practice.shows_lane=true".to_owned(),
        format!("physics.effects={}", toml::Value::try_from(&effects)?),
    ];
    if !arguments.ball_kg.is_empty() {
        ensure!(
            arguments.ball_kg.len() <= config.balls.len(),
            "--ball-kg: the rack holds {} balls, not {}; give fewer weights",
            config.balls.len(),
            arguments.ball_kg.len()
        );
        let balls: Vec<BallConfig> = arguments
            .ball_kg
            .iter()
            .map(|kilograms| of_weight(*kilograms, &config.balls))
            .collect();
        settings.push(format!("balls={}", toml::Value::try_from(&balls)?));
    }
    Ok(settings)
}

/// A ball of a weight, its radius of gyration between those of the balls that are known.
fn of_weight(mass_kg: f64, known: &[BallConfig]) -> BallConfig {
    let mut known: Vec<&BallConfig> = known.iter().collect();
    known.sort_by(|a, b| a.mass_kg.total_cmp(&b.mass_kg));
    let heavier = known.iter().position(|ball| ball.mass_kg >= mass_kg);
    let rg_m = match heavier {
        Some(0) => known[0].rg_m,
        Some(at) => {
            let (light, heavy) = (known[at - 1], known[at]);
            let share = (mass_kg - light.mass_kg) / (heavy.mass_kg - light.mass_kg);
            light.rg_m + (heavy.rg_m - light.rg_m) * share
        }
        None => known[known.len() - 1].rg_m,
    };
    BallConfig {
        mass_kg,
        rg_m,
        ..known[0].clone()
    }
}

/// The weights of the balls on the rack, written over them.
pub fn weights(game: &Game, words: &Words, eye: DVec3) -> Vec<Sign> {
    let config = game.config();
    if !config.practice.only {
        return Vec::new();
    }
    let seen = game.observe().balls;
    seen.iter()
        .filter(|ball| ball.is_on_rack)
        .filter_map(|ball| {
            let mass = config.balls.get(usize::from(ball.index))?.mass_kg;
            let over = ball.position + DVec3::Y * OVER_BALL_M;
            Some(Sign {
                text: fill(&words.practice.weight, &[("kg", &format!("{mass:.1}"))]),
                letter_m: WEIGHT_LETTER_AND_DISTANCE[0],
                pose: facing(over, eye),
                ground: Ground::Plain,
            })
        })
        .collect()
}

/// The way of the last ball down the lane.
#[derive(Clone, Debug, Default)]
pub struct Track {
    /// Where it touched the lane, world frame [m].
    pub points: Vec<DVec3>,
}

impl Track {
    /// Takes notice of what the last frame brought.
    pub fn notice(&mut self, game: &Game) {
        if !game.config().practice.shows_lane {
            return;
        }
        let has_begun = |kind: &EventKind| matches!(kind, EventKind::ThrowStarted { .. });
        if game.events().iter().any(|event| has_begun(&event.kind)) {
            self.points.clear();
        }
        for ball in game.rolling() {
            let is_new = self
                .points
                .last()
                .is_none_or(|last| last.distance(ball.point) >= SPACING_M);
            if ball.surface == Model::Lane && ball.point.z < 0.0 && is_new {
                self.points.push(ball.point);
            }
        }
    }

    /// The way as it is drawn: a box for each of its pieces.
    pub fn instances(&self, stock: &Stock) -> Vec<Instance> {
        let pieces = self.points.windows(2).map(|piece| {
            let [from, to] = [piece[0], piece[1]].map(|point| point.as_vec3());
            let way = to - from;
            let turn = Quat::from_rotation_arc(Vec3::NEG_Z, way.normalize_or(Vec3::NEG_Z));
            let half = Vec3::new(0.5 * WAY_WIDTH_M, 0.5 * WAY_OVER_M, 0.5 * way.length());
            Instance {
                mesh: stock.cuboid(),
                material: Material {
                    casts_shadows: false,
                    takes_shadows: false,
                    ..Material::unlit([0.1, 0.75, 0.95])
                },
                world_from_mesh: Mat4::from_scale_rotation_translation(
                    half,
                    turn,
                    0.5 * (from + to) + Vec3::Y * WAY_OVER_M,
                ),
            }
        });
        pieces.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convert::tests::config;
    use crate::devices::Device;
    use crate::devices::script::{Script, Velocities};

    #[test]
    fn a_ball_of_a_weight_lies_between_its_neighbours() {
        let balls = config().balls;
        let known = of_weight(balls[0].mass_kg, &balls);
        assert!((known.rg_m - balls[0].rg_m).abs() < 1e-12);
        let between = of_weight(6.0, &balls);
        assert!(between.rg_m > balls[0].rg_m && between.rg_m < balls[1].rg_m);
        assert_eq!(of_weight(2.8, &balls).rg_m, balls[2].rg_m);
        assert_eq!(of_weight(7.2, &balls).rg_m, balls[0].rg_m);
    }

    #[test]
    fn the_way_of_a_ball_runs_down_the_lane_to_the_pins() {
        let mut config = config();
        config.practice.shows_lane = true;
        let conditions = Conditions {
            lobby: config.clone(),
            red: config.clone(),
            blue: config,
        };
        let mut game = Game::new(conditions, 1).expect("the shipped room");
        let mut script = Script::new(game.config(), 4, Velocities::Measured, &[]).practising(1);
        let mut track = Track::default();
        while !script.is_done() {
            let input = script.next(&game);
            game.step(&input);
            track.notice(&game);
        }
        let (first, last) = (track.points[0], track.points[track.points.len() - 1]);
        // A ball that is set down a little late lands behind the arrows' first row.
        assert!(first.z > -6.0, "{first}");
        assert!(last.z < -17.0, "{last}");
        assert!(track.points.windows(2).all(|two| two[1].z < two[0].z));
        assert!(track.points.iter().all(|point| point.y.abs() < 0.01));
    }
}
