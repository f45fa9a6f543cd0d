//! What is around a participant and no part of the game: the panel at the wrist, texts in the room, the way of the last ball, and the
//! fence where the tracked space ends.

use anyhow::Result;
use game::{Config, Game};
use glam::DVec3;
use physics::Pose;
use renderer::Instance;
use renderer::headset::{Frame, HeadsetSession};

use crate::convert::Stock;
use crate::fence::{self, Space};
use crate::hints::Grip;
use crate::labels;
use crate::practice::Track;
use crate::signs::Sign;
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

    /// Heeds the panel at the wrist of who `is_busy` with a ball or not: what was chosen there, a pause already carried out.
    pub fn heed(
        &mut self,
        arms: Option<Arms>,
        is_busy: bool,
        attention: &mut Attention,
        display_ns: i64,
    ) -> Option<Wish> {
        let now_s = display_ns as f64 * 1e-9;
        let is_due = attention.needs_panel(is_busy);
        let wish = self.wrist.attend(arms, is_due, now_s);
        if wish == Some(Wish::Pause) {
            attention.toggle();
        }
        wish
    }

    /// What is to be seen of it by who takes balls with this, while `arms` are where they are.
    pub fn beside(
        &mut self,
        game: &Game,
        grip: Grip,
        arms: Option<Arms>,
        is_paused: bool,
    ) -> Beside {
        self.track.notice(game);
        let mut signs = labels::signs(game, grip, &self.words);
        signs.extend(self.wrist.signs(is_paused, &self.words.pause));
        Beside {
            signs,
            track: self.track.clone(),
            space: self.space,
            wrist: arms.map(|arms| arms.wrist.position),
        }
    }
}

/// What is to be seen of it: by the participant, and by who watches the mirror.
#[derive(Clone, Debug, Default)]
pub struct Beside {
    /// Texts in the room and at the wrist.
    pub signs: Vec<Sign>,
    track: Track,
    space: Option<Space>,
    wrist: Option<DVec3>,
}

impl Beside {
    /// All of it that is no text.
    pub fn instances(&self, game: &Game, stock: &Stock) -> Vec<Instance> {
        let mut instances = self.track.instances(stock);
        let (space, wrist) = (self.space.as_ref(), self.wrist.as_slice());
        instances.extend(fence::instances(game, space, wrist, stock));
        instances
    }
}
