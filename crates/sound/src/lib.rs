//! What a bowling alley sounds like, from its contacts alone.
//!
//! A [`Mixer`] takes [`Event`]s (an [`Impact`], a ball's [`Rolling`], the machine, the head) and renders what both ears hear:
//! modes of what was struck ([`Material::modes`]), the blow's own click, noise of rolling, a head's delay and shadow
//! ([`ear`]) and the room. Nothing here knows of the game, the physics or the screen. Two backends pull from it:
//! [`offline`] for files and tests, [`live`] for the card. `docs/sound.md` has the model, its sources and its figures.

mod bank;
mod contact;
mod continuous;
pub mod ear;
mod event;
mod limiter;
pub mod live;
mod material;
mod mixer;
mod noise;
pub mod offline;
mod room;
mod voice;
pub mod wav;

pub use contact::contact_time;
pub use event::{Event, Impact, Listener, Rolling, Sounding};
pub use limiter::{KNEE, limit};
pub use material::{Material, Mode};
pub use mixer::{Mixer, QUANTUM, ROLLERS, Settings, VOICES};
pub use room::Room;
