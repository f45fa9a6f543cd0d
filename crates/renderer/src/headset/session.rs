//! The session: its beginning, its frames, and what the hands do in them.

mod events;
mod picture;

use std::time::Instant;

use openxr as xr;

use super::actions::{Actions, HandReading, Readings, Side};
use super::begin::{choose_rate, create, floor, lower_rate};
use super::eyes::Eye;
use super::frame::Frame;
use super::images::Images;
use super::joints::Joints;
use super::note::{Focus, Note};
use super::runtime::{Found, Runtime, STEREO};
use super::vulkan::{self, Vulkan};
use super::{Headset, HeadsetError, bounds, space};
use crate::Gpu;

pub use picture::{Seen, Shown};

/// What may be chosen of a session.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeadsetSettings {
    /// Refresh rate that is asked for [Hz]; `None` for the highest that the runtime offers.
    pub refresh_rate_hz: Option<f32>,
    /// Where none is asked for, the highest is taken that is not above this one [Hz].
    pub highest_rate_hz: Option<f32>,
}

/// A session with a headset. Fields are dropped in this order: the runtime wants its images back before the session goes,
/// the session before Vulkan's device, the device before the instance.
pub struct HeadsetSession {
    eyes: [Eye; 2],
    actions: Actions,
    /// `None` where the runtime tracks no hands.
    joints: Option<Joints>,
    /// Hands that the runtime's chosen profile says to be bare, left first.
    is_bare: [bool; 2],
    /// Which of the runtime's spaces `base` is.
    floor: xr::ReferenceSpaceType,
    base: xr::Space,
    /// The space of the bounds.
    stage: Option<xr::Space>,
    head: xr::Space,
    stream: xr::FrameStream<xr::Vulkan>,
    waiter: xr::FrameWaiter,
    session: xr::Session<xr::Vulkan>,
    gpu: Gpu,
    blend: xr::EnvironmentBlendMode,
    focus: Focus,
    is_running: bool,
    notes: Vec<Note>,
    runtime: Runtime,
}

impl HeadsetSession {
    /// Begins a session with a headset.
    ///
    /// # Errors
    /// One sentence: what is missing, or what the runtime refused.
    pub fn open(found: Found, settings: HeadsetSettings) -> Result<Self, HeadsetError> {
        let Found(runtime) = found;
        // Bound before the session, so that it outlives the session where something below fails.
        let Vulkan { gpu, binding } = vulkan::open(&runtime)?;
        let (session, waiter, stream) = create(&runtime, &binding)?;
        let mut notes = Vec::new();
        let actions = Actions::attach(&runtime, &session, &mut notes)?;
        let joints = Joints::new(&runtime, &session)?;
        let floor = floor(&runtime, &session)?;
        let base = session.create_reference_space(floor, xr::Posef::IDENTITY)?;
        let head =
            session.create_reference_space(xr::ReferenceSpaceType::VIEW, xr::Posef::IDENTITY)?;
        let stage = bounds::stage(&session)?;
        let blends = runtime
            .instance
            .enumerate_environment_blend_modes(runtime.system, STEREO)?;
        let blend = *blends.first().ok_or_else(|| HeadsetError::Lacks {
            runtime: runtime.headset.runtime.clone(),
            what: "a way to blend pictures with the surroundings",
        })?;
        let eye = |index| Eye::new(&runtime, &session, &gpu, index);
        let eyes = [eye(0)?, eye(1)?];
        notes.push(Note::Began {
            extensions: runtime.extensions(),
            images: eyes
                .iter()
                .flat_map(Eye::images)
                .map(Images::count)
                .collect(),
        });
        if runtime.enabled.fb_display_refresh_rate {
            notes.push(choose_rate(&session, settings)?);
        } else if let Some(wanted) = settings.refresh_rate_hz {
            let why = format!("{wanted} Hz: this runtime lets nobody choose");
            notes.push(Note::RateRefused(why));
        }
        Ok(Self {
            eyes,
            actions,
            joints,
            is_bare: [false; 2],
            floor,
            base,
            stage,
            head,
            stream,
            waiter,
            session,
            gpu,
            blend,
            focus: Focus::Stopped,
            is_running: false,
            notes,
            runtime,
        })
    }

    /// The device that draws for the headset.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The headset and its runtime.
    pub fn headset(&self) -> &Headset {
        &self.runtime.headset
    }

    /// The session, the space of its bounds and the one that everything is told in.
    pub(super) fn stage(&self) -> Option<(&xr::Session<xr::Vulkan>, &xr::Space, &xr::Space)> {
        Some((&self.session, self.stage.as_ref()?, &self.base))
    }

    /// Whether the runtime wants frames.
    pub fn is_running(&self) -> bool {
        self.is_running
    }

    /// How much attention the session has.
    pub fn focus(&self) -> Focus {
        self.focus
    }

    /// Asks for the next lower rate that the display offers. Returns the one it had and the one asked for [Hz]; `None` where there is
    /// no lower one, or the runtime does not let it be chosen.
    pub fn slow_down(&self) -> Option<(f32, f32)> {
        if !self.runtime.enabled.fb_display_refresh_rate {
            return None;
        }
        let from = self.session.get_display_refresh_rate().ok()?;
        let offered = self.session.enumerate_display_refresh_rates().ok()?;
        let to = lower_rate(&offered, from)?;
        self.session.request_display_refresh_rate(to).ok()?;
        Some((from, to))
    }

    /// Asks the runtime to end the session; [`Note::Exit`] follows.
    ///
    /// # Errors
    /// When the session is lost or not running.
    pub fn request_exit(&self) -> Result<(), HeadsetError> {
        Ok(self.session.request_exit()?)
    }

    /// Waits until the runtime wants the next frame begun. The session must be running.
    ///
    /// # Errors
    /// When the session is lost.
    pub fn wait(&mut self) -> Result<Frame, HeadsetError> {
        let state = self.waiter.wait()?;
        let ahead = self.runtime.now().map(|now| {
            let ahead = state.predicted_display_time.as_nanos() - now.as_nanos();
            ahead as f64 * 1e-9
        });
        Ok(Frame {
            prediction_s: ahead,
            time: state.predicted_display_time,
            period: state.predicted_display_period,
            should_render: state.should_render,
            woken: Instant::now(),
        })
    }

    /// Head, hands and buttons at the frame's time of display. Without focus the hands are absent.
    ///
    /// # Errors
    /// When the session is lost.
    pub fn read(&mut self, frame: &Frame) -> Result<Readings, HeadsetError> {
        let mut readings = Readings {
            head: space::locate(&self.head, &self.base, frame.time)?,
            ..Readings::default()
        };
        if self.focus == Focus::Focused {
            self.actions.sync(&self.session)?;
            for side in Side::BOTH {
                readings.hands[side as usize] = self.read_hand(side, frame.time)?;
            }
        }
        Ok(readings)
    }

    fn read_hand(&self, side: Side, time: xr::Time) -> Result<HandReading, HeadsetError> {
        let at = (&self.base, time);
        let mut hand = self.actions.read(&self.session, side, at)?;
        let has_controller = hand.grip.is_some() && !self.is_bare[side as usize];
        if let Some(joints) = self.joints.as_ref().filter(|_| !has_controller) {
            hand.bare = joints.read(side, &self.base, time)?;
        }
        Ok(hand)
    }

    /// Lets a hand feel a pulse of an amplitude from 0 to 1.
    ///
    /// # Errors
    /// When the session is lost.
    pub fn pulse(&self, side: Side, amplitude: f32, seconds: f64) -> Result<(), HeadsetError> {
        let duration = xr::Duration::from_nanos((seconds * 1e9) as i64);
        self.actions.pulse(&self.session, side, amplitude, duration)
    }

    /// Ends a frame without a picture.
    ///
    /// # Errors
    /// When the session is lost.
    pub fn skip(&mut self, frame: Frame) -> Result<(), HeadsetError> {
        self.stream.begin()?;
        Ok(self.stream.end(frame.time, self.blend, &[])?)
    }
}

impl Drop for HeadsetSession {
    fn drop(&mut self) {
        // Images go back to the runtime, which must find no work on them; a lost device has none.
        let _ = self.gpu.device.poll(wgpu::PollType::wait_indefinitely());
    }
}
