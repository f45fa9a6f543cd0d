//! What dials measure with: how much, and in which scene.

use std::path::Path;

use anyhow::Result;
use game::Config;

/// The scene that settings are taken from.
const SCENE: &str = "alley";

/// Numbers of poses, throws and rounds: a quick look, or figures to publish.
#[derive(Clone, Debug)]
pub struct Budget {
    /// Poses of each class of pair.
    pub poses: usize,
    /// Poses of each class whose truth takes a search of the whole sphere.
    pub deep_poses: usize,
    /// Rounds of which times of queries are the median.
    pub rounds: usize,
    /// Rounds of whole scenes.
    pub scene_rounds: usize,
    /// Jittered throws of each setting.
    pub throws: u64,
    /// First hits of each setting.
    pub hits: usize,
    /// Simulated time of long scenes, as a share of the full one.
    pub share: f64,
    /// The alley's settings.
    pub config: Config,
}

impl Budget {
    /// A quick look, or all that is wanted, with the settings in `root`.
    ///
    /// # Errors
    /// When the settings cannot be read.
    pub fn new(quick: bool, root: &Path) -> Result<Budget> {
        let config = Config::load(&root.join("config"), SCENE, None, &[])?;
        let budget = if quick {
            Budget {
                poses: 60,
                deep_poses: 20,
                rounds: 5,
                scene_rounds: 2,
                throws: 50,
                hits: 40,
                share: 0.25,
                config,
            }
        } else {
            Budget {
                poses: 300,
                deep_poses: 120,
                rounds: 21,
                scene_rounds: 7,
                throws: 600,
                hits: 200,
                share: 1.0,
                config,
            }
        };
        Ok(budget)
    }
}
