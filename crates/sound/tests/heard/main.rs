//! What is heard, held against formulas and figures from outside the crate.

#[cfg(target_os = "linux")]
mod card;
mod level;
mod pitch;
mod place;
mod refusal;
mod repeat;
mod rolling;
#[path = "../../examples/throw/strike.rs"]
mod strike;
mod support;
mod time;
