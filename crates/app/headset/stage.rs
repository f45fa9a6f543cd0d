//! Everything that lasts as long as one connection to the runtime.

use std::path::Path;

use anyhow::{Context, Result};
use game::Config;
use renderer::Renderer;
use renderer::headset::{Found, HeadsetSession, HeadsetSettings};

use crate::convert::{self, Stock};
use crate::lettering::Scribe;
use crate::panel::PanelStock;
use crate::signs::SignStock;
use crate::words::Words;

/// Everything that lasts as long as one connection to the runtime.
pub struct Stage {
    pub renderer: Renderer,
    pub stock: Stock,
    pub panel: PanelStock,
    pub signs: SignStock,
    pub headset: HeadsetSession,
}

impl Stage {
    /// Begins a session with the headset that was found, and gets ready all that is to be drawn; texts are the scribe's.
    ///
    /// # Errors
    /// When the runtime refuses, or an asset cannot be used.
    pub fn open(
        found: Found,
        settings: HeadsetSettings,
        scribe: &Scribe,
        root: &Path,
        config: &Config,
        words: &Words,
    ) -> Result<Self> {
        let headset = HeadsetSession::open(found, settings)?;
        let mut renderer = Renderer::new(headset.gpu(), convert::settings(&config.shows))
            .context("cannot draw for the headset")?;
        let mut stock = Stock::load(&mut renderer, root, config)?;
        stock.add_screen(&mut renderer, root, config)?;
        stock.paint_apart(scribe);
        let mut panel = PanelStock::new(headset.gpu(), &mut renderer, words)?;
        panel.paint_apart(scribe);
        let mut signs = SignStock::new(headset.gpu(), &mut renderer)?;
        signs.paint_apart(scribe);
        Ok(Self {
            renderer,
            stock,
            panel,
            signs,
            headset,
        })
    }
}
