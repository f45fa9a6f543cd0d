//! The session: its states, its frames, and what it shows.

use std::time::Instant;

use glam::{Quat, Vec3};
use image::RgbaImage;
use openxr as xr;

use super::actions::{Actions, Readings, Side};
use super::begin::{choose_rate, create, floor};
use super::eyes::Eye;
use super::frame::Frame;
use super::note::{Focus, Note};
use super::runtime::{Runtime, STEREO};
use super::vulkan::{self, Vulkan};
use super::{Headset, HeadsetError, space};
use crate::offscreen::Readback;
use crate::{Fov, Gpu, Renderer, Scene, View};

/// What may be chosen of a session.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeadsetSettings {
    /// Refresh rate that is asked for [Hz]; `None` for the highest that the runtime offers.
    pub refresh_rate_hz: Option<f32>,
}

/// A session with a headset. Fields are dropped in this order: the runtime wants its images back before the session goes,
/// the session before Vulkan's device, the device before the instance.
pub struct HeadsetSession {
    eyes: [Eye; 2],
    actions: Actions,
    /// Which of the runtime's spaces `base` is.
    floor: xr::ReferenceSpaceType,
    base: xr::Space,
    head: xr::Space,
    stream: xr::FrameStream<xr::Vulkan>,
    waiter: xr::FrameWaiter,
    session: xr::Session<xr::Vulkan>,
    gpu: Gpu,
    blend: xr::EnvironmentBlendMode,
    focus: Focus,
    is_running: bool,
    is_locked: bool,
    notes: Vec<Note>,
    runtime: Runtime,
}

impl HeadsetSession {
    /// Connects to the runtime and its headset.
    ///
    /// # Errors
    /// One sentence: what is missing, or what the runtime refused.
    pub fn open(settings: HeadsetSettings) -> Result<Self, HeadsetError> {
        let runtime = Runtime::find()?;
        // Bound before the session, so that it outlives the session where something below fails.
        let Vulkan { gpu, binding } = vulkan::open(&runtime)?;
        let (session, waiter, stream) = create(&runtime, &binding)?;
        let mut notes = Vec::new();
        let actions = Actions::attach(&runtime, &session, &mut notes)?;
        let floor = floor(&runtime, &session)?;
        let base = session.create_reference_space(floor, xr::Posef::IDENTITY)?;
        let head =
            session.create_reference_space(xr::ReferenceSpaceType::VIEW, xr::Posef::IDENTITY)?;
        let blends = runtime
            .instance
            .enumerate_environment_blend_modes(runtime.system, STEREO)?;
        let blend = *blends.first().ok_or_else(|| HeadsetError::Lacks {
            runtime: runtime.headset.runtime.clone(),
            what: "a way to blend pictures with the surroundings",
        })?;
        let eye = || Eye::new(&runtime, &session, &gpu, runtime.headset.eye_size);
        let eyes = [eye()?, eye()?];
        if runtime.enabled.fb_display_refresh_rate {
            notes.push(Note::RefreshRate(choose_rate(
                &session,
                settings.refresh_rate_hz,
            )?));
        }
        Ok(Self {
            eyes,
            actions,
            floor,
            base,
            head,
            stream,
            waiter,
            session,
            gpu,
            blend,
            focus: Focus::Stopped,
            is_running: false,
            is_locked: false,
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

    /// Whether the runtime wants frames.
    pub fn is_running(&self) -> bool {
        self.is_running
    }

    /// How much attention the session has.
    pub fn focus(&self) -> Focus {
        self.focus
    }

    /// Lets the Red and Blue buttons of the controllers rest, or wakes them.
    pub fn lock_choice(&mut self, locked: bool) {
        self.is_locked = locked;
    }

    /// Asks the runtime to end the session; [`Note::Exit`] follows.
    ///
    /// # Errors
    /// When the session is lost or not running.
    pub fn request_exit(&self) -> Result<(), HeadsetError> {
        Ok(self.session.request_exit()?)
    }

    /// Hears what the runtime has to say, and follows the session's states.
    ///
    /// # Errors
    /// [`HeadsetError::Lost`] when the session cannot go on.
    pub fn poll(&mut self) -> Result<Vec<Note>, HeadsetError> {
        let mut buffer = xr::EventDataBuffer::new();
        while let Some(event) = self.runtime.instance.poll_event(&mut buffer)? {
            use xr::Event;
            match event {
                Event::SessionStateChanged(change) => {
                    let state = change.state();
                    if state == xr::SessionState::READY {
                        self.session.begin(STEREO)?;
                        self.is_running = true;
                    } else if state == xr::SessionState::STOPPING {
                        self.session.end()?;
                        self.is_running = false;
                    } else if state == xr::SessionState::LOSS_PENDING {
                        return Err(HeadsetError::Lost("LOSS_PENDING".to_owned()));
                    } else if state == xr::SessionState::EXITING {
                        self.notes.push(Note::Exit);
                    }
                    let focus = Focus::from(state);
                    if focus != self.focus {
                        self.focus = focus;
                        self.notes.push(Note::Focus(focus));
                    }
                }
                Event::InstanceLossPending(_) => {
                    return Err(HeadsetError::Lost("INSTANCE_LOSS_PENDING".to_owned()));
                }
                Event::InteractionProfileChanged(_) => {
                    for side in Side::BOTH {
                        let profile = self.actions.profile(&self.session, side)?;
                        self.notes.push(Note::Profile { side, profile });
                    }
                }
                Event::ReferenceSpaceChangePending(change)
                    if change.reference_space_type() == self.floor =>
                {
                    let at = change.change_time().as_nanos();
                    self.notes.push(Note::Recentred(at));
                }
                Event::UserPresenceChangedEXT(change) => {
                    self.notes.push(Note::Worn(change.is_user_present()));
                }
                Event::DisplayRefreshRateChangedFB(change) => {
                    let rate = change.to_display_refresh_rate();
                    self.notes.push(Note::RefreshRate(rate));
                }
                _ => {}
            }
        }
        Ok(std::mem::take(&mut self.notes))
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
            self.actions.sync(&self.session, self.is_locked)?;
            for side in Side::BOTH {
                let at = (&self.base, frame.time);
                readings.hands[side as usize] =
                    self.actions.read(&self.session, side, at, self.is_locked)?;
            }
        }
        Ok(readings)
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

    /// Locates the eyes and draws the scene for them; `world_from_tracking` is where the participant's space lies in it.
    ///
    /// Returns the eyes' views, world frame. With `wanted` their images are brought back too, which costs a wait for the device.
    ///
    /// # Errors
    /// When the session is lost or the scene cannot be drawn.
    pub fn show(
        &mut self,
        frame: Frame,
        renderer: &mut Renderer,
        scene: &Scene,
        world_from_tracking: (Vec3, Quat),
        wanted: bool,
    ) -> Result<(Vec<View>, Option<Vec<RgbaImage>>), HeadsetError> {
        self.stream.begin()?;
        let (flags, located) = self.session.locate_views(STEREO, frame.time, &self.base)?;
        let known = xr::ViewStateFlags::POSITION_VALID | xr::ViewStateFlags::ORIENTATION_VALID;
        let [left, right] = located.as_slice() else {
            return Err(HeadsetError::Other("a view for one eye only".to_owned()));
        };
        if !flags.contains(known) {
            self.stream.end(frame.time, self.blend, &[])?;
            return Ok((Vec::new(), None));
        }
        let located = [left, right];
        let views = located.map(|eye| view(eye, world_from_tracking));
        let images = self.draw(renderer, scene, views, wanted)?;
        let projections: Vec<_> = located
            .iter()
            .zip(&self.eyes)
            .map(|(view, eye)| {
                xr::CompositionLayerProjectionView::new()
                    .pose(view.pose)
                    .fov(view.fov)
                    .sub_image(eye.sub_image())
            })
            .collect();
        let layer = xr::CompositionLayerProjection::new()
            .space(&self.base)
            .views(&projections);
        self.stream.end(frame.time, self.blend, &[&layer])?;
        Ok((views.to_vec(), images))
    }

    fn draw(
        &mut self,
        renderer: &mut Renderer,
        scene: &Scene,
        views: [View; 2],
        wanted: bool,
    ) -> Result<Option<Vec<RgbaImage>>, HeadsetError> {
        let device = &self.gpu.device;
        for eye in &mut self.eyes {
            eye.acquire()?;
        }
        let size = self.eyes[0].size();
        let textures: Vec<_> = self.eyes.iter().filter_map(Eye::current).collect();
        let targets: Vec<_> = textures
            .iter()
            .map(|texture| texture.create_view(&Default::default()))
            .collect();
        let eyes: Vec<_> = views.into_iter().zip(&targets).collect();
        let mut encoder = device.create_command_encoder(&Default::default());
        renderer.record(&mut encoder, scene, &eyes, size)?;
        let readback = wanted.then(|| {
            let readback = Readback::new(device, size[0], size[1], textures.len());
            for (index, texture) in textures.iter().enumerate() {
                readback.copy(&mut encoder, texture, index);
            }
            // The compositor expects its images as colour targets.
            let back = textures.iter().map(|texture| wgpu::TextureTransition {
                texture: *texture,
                selector: None,
                state: wgpu::TextureUses::COLOR_TARGET,
            });
            encoder.transition_resources(std::iter::empty(), back);
            readback
        });
        self.gpu.queue.submit([encoder.finish()]);
        let images = readback
            .map(|readback| readback.images(device))
            .transpose()?;
        for eye in &mut self.eyes {
            eye.release()?;
        }
        Ok(images)
    }
}

impl Drop for HeadsetSession {
    fn drop(&mut self) {
        // Images go back to the runtime, which must find no work on them; a lost device has none.
        let _ = self.gpu.device.poll(wgpu::PollType::wait_indefinitely());
    }
}

/// An eye in the world.
fn view(eye: &xr::View, (position, rotation): (Vec3, Quat)) -> View {
    View {
        position: position + rotation * space::vector(eye.pose.position).as_vec3(),
        rotation: (rotation * space::rotation(eye.pose.orientation).as_quat()).normalize(),
        fov: Fov {
            left: eye.fov.angle_left,
            right: eye.fov.angle_right,
            up: eye.fov.angle_up,
            down: eye.fov.angle_down,
        },
    }
}
