//! What the runtime says, for the journal and for the experimenter.

use renderer::headset::{Focus, Note};
use serde_json::json;

/// A note as the journal keeps it.
pub fn line(note: &Note) -> serde_json::Value {
    match note {
        Note::Began { extensions, images } => {
            json!({ "extensions": extensions, "swapchain_images": images })
        }
        Note::Focus(focus) => json!({ "focus": format!("{focus:?}").to_lowercase() }),
        Note::Exit => json!({ "exit": true }),
        Note::Profile { side, profile } => {
            json!({ "hand": format!("{side:?}").to_lowercase(), "profile": profile })
        }
        Note::BindingsRejected {
            profile,
            paths,
            answer,
        } => {
            json!({ "bindings_rejected": profile, "paths": paths, "answer": answer })
        }
        Note::Recentred(at) => json!({ "recentred": { "xr_time_ns": at } }),
        Note::Worn(is_worn) => json!({ "worn": is_worn }),
        Note::RefreshRate(rate) => json!({ "refresh_rate_hz": rate }),
        Note::RateRefused(why) => json!({ "refresh_rate_refused": why }),
    }
}

/// What the experimenter reads of a note; nothing of what is in order.
pub fn text(note: &Note) -> Option<String> {
    match note {
        Note::Profile {
            side,
            profile: Some(profile),
        } => Some(format!("{side:?} hand: {profile}.")),
        Note::Profile { side, .. } => Some(format!("{side:?} hand: no controller.")),
        Note::BindingsRejected {
            profile,
            paths,
            answer,
        } => Some(format!(
            "The runtime refused these bindings of {profile} ({answer}), the others work: {}.",
            paths.join(", ")
        )),
        Note::Focus(Focus::Visible) => {
            Some("The participant is in a menu of the system: the game waits.".to_owned())
        }
        Note::RateRefused(why) => Some(format!(
            "The headset's refresh rate could not be chosen ({why}): it stays as it is."
        )),
        Note::Worn(false) => Some("The headset was taken off.".to_owned()),
        _ => None,
    }
}
