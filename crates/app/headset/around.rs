//! What is around a participant and no part of the game: the panel at the wrist, texts in the room, the way of the last ball, and the
//! fence where the tracked space ends.

use anyhow::Result;
use game::{Config, Game};
use physics::Pose;
use renderer::headset::{Frame, HeadsetSession};
use renderer::{Instance, Renderer};

use crate::convert::Stock;
use crate::fence::{self, Space};
use crate::labels;
use crate::practice::Track;
use crate::signs::SignStock;
use crate::words::Words;
use crate::wrist::{Arms, Wish, Wrist};

use super::attention::Attention;

/// The runtime is asked for its bounds once in so many frames: whoever draws them anew waits a second or so.
const FRAMES: u32 = 72;

/// All of it.
#[derive(Debug)]
pub struct Around {
    wrist: Wrist,
    track: Track,
    words: Words,
    /// The tracked space, where it has an end.
    space: Option<Space>,
    /// What the settings say of it.
    otherwise: Option<Space>,
    /// Frames until the runtime is asked.
    wait: u32,
}

impl Around {
    /// As the settings have it, until the runtime tells better.
    pub fn new(config: &Config, words: Words) -> Self {
        let otherwise = Space::of_settings(config.comfort.space_m);
        Self {
            wrist: Wrist::default(),
            track: Track::default(),
            words,
            space: otherwise,
            otherwise,
            wait: 0,
        }
    }

    /// Asks the runtime now and then where the tracked space ends.
    ///
    /// # Errors
    /// When the session is lost.
    pub fn look(&mut self, headset: &HeadsetSession, frame: &Frame) -> Result<()> {
        if self.wait > 0 {
            self.wait -= 1;
            return Ok(());
        }
        self.wait = FRAMES;
        let told = headset.bounds(frame)?.map(|bounds| Space {
            pose: Pose::new(bounds.pose.position, bounds.pose.rotation),
            size_m: bounds.size_m,
        });
        self.space = told.or(self.otherwise);
        Ok(())
    }

    /// Heeds the panel at the wrist: what was chosen there, a pause already carried out.
    pub fn heed(
        &mut self,
        arms: Option<Arms>,
        attention: &mut Attention,
        display_ns: i64,
    ) -> Option<Wish> {
        let now_s = display_ns as f64 * 1e-9;
        let wish = self.wrist.attend(arms, attention.needs_panel(), now_s);
        if wish == Some(Wish::Pause) {
            attention.toggle();
        }
        wish
    }

    /// Everything that is to be drawn of it.
    ///
    /// # Errors
    /// When a text cannot be painted.
    pub fn instances(
        &mut self,
        game: &Game,
        arms: Option<Arms>,
        is_paused: bool,
        (stock, signs, renderer): (&Stock, &mut SignStock, &mut Renderer),
    ) -> Result<Vec<Instance>> {
        self.track.notice(game);
        let mut texts = labels::signs(game, &self.words);
        texts.extend(self.wrist.signs(is_paused, &self.words.pause));
        let mut instances = signs.instances(&texts, renderer)?;
        instances.extend(self.track.instances(stock));
        let wrist = arms.map(|arms| arms.wrist.position);
        let fence = fence::instances(game, self.space.as_ref(), wrist.as_slice(), stock);
        instances.extend(fence);
        Ok(instances)
    }
}
