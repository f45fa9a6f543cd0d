//! A panel in the room with the question that is due: read from where one stands, answered by pointing.
//!
//! What is pointed at is what the hand covers for the eye, as one points at things far away: the ray goes from the head
//! through the hand. So it works alike for a controller, a tracked hand and the desk's arm. The trigger chooses.

mod layout;
mod paint;
mod stop;

use anyhow::Result;
use experiment::protocol::{AnsweredIn, Place, Who};
use experiment::questionnaire::Act;
use glam::{DQuat, DVec2, DVec3, Mat4, Quat, Vec3};
use physics::Pose;
use renderer::{Gpu, Instance, Material, MeshData, MeshId, Renderer, TextPainter, TextureId};

use crate::lettering::{Letters, Scribe};
use crate::session::Session;
use crate::trigger::Trigger;
use crate::words::Words;
pub use layout::Choice;
use layout::{Content, Layout};
use stop::StopSign;

/// Size of the panel in the room [m]; a letter of the question is 4 cm high, 1.1 degrees at its distance.
const SIZE_M: DVec2 = DVec2::new(1.6, 1.0);
/// How far from the head it appears [m].
const DISTANCE_M: f64 = 2.0;
/// Its middle is this much below the eyes, where one looks without raising the head [m].
const BELOW_EYES_M: f64 = 0.15;
/// Radius of the dot that shows where one points [m].
const DOT_M: f32 = 0.012;

/// Where the participant points from.
#[derive(Debug, Clone, Copy)]
pub struct Pointing {
    /// The head, world frame.
    pub head: Pose,
    /// The hand, world frame.
    pub hand: Option<Pose>,
}

/// The panel, whether it is shown or not.
#[derive(Debug)]
pub struct Panel {
    /// Where its answers are given.
    answered_in: AnsweredIn,
    /// What is asked, and where it hangs.
    shown: Option<Shown>,
    stop: StopSign,
    trigger: Trigger,
    words: Words,
}

#[derive(Debug)]
struct Shown {
    content: Content,
    layout: Layout,
    /// `world_from_panel`; the panel faces +z.
    pose: Pose,
    /// Where the participant points at it, in pixels of the layout.
    at: Option<DVec2>,
}

impl Panel {
    /// Nothing yet; answers will have been given in `answered_in`, and the labels are in these words.
    pub fn new(answered_in: AnsweredIn, words: Words) -> Self {
        Self {
            answered_in,
            shown: None,
            stop: StopSign::default(),
            trigger: Trigger::held(),
            words,
        }
    }

    /// Shows what is due and takes a choice that is pointed at; never waits.
    ///
    /// # Errors
    /// When the journal cannot be written.
    pub fn attend(&mut self, session: &mut Session) -> Result<()> {
        let (content, pointing) = (content(session, &self.words), session.pointing());
        self.stop.attend(session, pointing)?;
        self.show(content, pointing.map(|pointing| pointing.head));
        // Also while nothing is asked: a trigger that is pulled already answers nothing.
        let is_pressed = if pointing.and_then(|pointing| pointing.hand).is_some() {
            self.trigger.press(session.trigger())
        } else {
            self.forget_trigger();
            false
        };
        let (Some(shown), Some(pointing)) = (&mut self.shown, pointing) else {
            return Ok(());
        };
        shown.at = pointing
            .hand
            .and_then(|hand| pixel(&shown.pose, pointing.head.position, hand.position));
        let choice = shown.at.and_then(|at| shown.layout.choice(at)).cloned();
        match choice {
            Some(choice) if is_pressed => choose(&choice, session, self.answered_in),
            _ => Ok(()),
        }
    }

    /// What the trigger does now is not meant for the panel, or not known: it has to be let go before it answers.
    pub fn forget_trigger(&mut self) {
        self.trigger = Trigger::held();
    }

    /// A new question hangs where the last one did; the first one of a form before the head.
    fn show(&mut self, content: Option<Content>, head: Option<Pose>) {
        let Some(content) = content else {
            self.shown = None;
            return;
        };
        match &mut self.shown {
            Some(shown) if shown.content == content => {}
            Some(shown) => {
                shown.layout = Layout::of(&content, &self.words.panel);
                shown.content = content;
            }
            None => {
                // Who is not tracked gets it later.
                self.shown = head.map(|head| Shown {
                    layout: Layout::of(&content, &self.words.panel),
                    content,
                    pose: before(head),
                    at: None,
                });
            }
        }
    }

    /// Where the stop sign hangs in the room; `None` while nothing is played.
    pub fn stop_sign(&self) -> Option<DVec3> {
        self.stop.pose.map(|pose| pose.position)
    }

    /// Where a choice lies in the room, for a participant that is a program; `None` while it is not shown.
    pub fn place_of(&self, choice: &Choice) -> Option<DVec3> {
        let shown = self.shown.as_ref()?;
        let area = shown
            .layout
            .areas
            .iter()
            .find(|area| area.choice == *choice)?;
        let share = 0.5 * (area.from + area.to) / layout::SIZE_PX.as_dvec2() - 0.5;
        let on_panel = DVec3::new(share.x * SIZE_M.x, -share.y * SIZE_M.y, 0.0);
        Some(shown.pose.transform_point(on_panel))
    }
}

/// What is to be read now.
fn content(session: &Session, words: &Words) -> Option<Content> {
    let course = session.course()?;
    if let Some(form) = session.form()
        && let Some(item) = form.current()
    {
        return Some(Content::Item {
            item: item.clone(),
            position: form.position(),
            given: form.given().cloned(),
        });
    }
    match course.protocol().place() {
        Place::Comparing(number) => {
            let count = course.staircase_plan().map_or(number, |plan| plan.trials);
            Some(Content::Pair(number, count))
        }
        Place::Debriefing => Some(Content::Words(words.panel.thanks.clone())),
        _ => None,
    }
}

fn choose(choice: &Choice, session: &mut Session, answered_in: AnsweredIn) -> Result<()> {
    match choice {
        Choice::Answer(answer) => session.answer(Act::Answer(answer.clone()), answered_in),
        Choice::Reply(reply) => session.compare(*reply, answered_in),
        Choice::Skip => session.answer(Act::Skip, answered_in),
        // Before the first item there is none: nothing happens.
        Choice::Back => session.answer(Act::Back, answered_in).or_else(|error| {
            if error.is::<experiment::questionnaire::AnswerError>() {
                Ok(())
            } else {
                Err(error)
            }
        }),
        Choice::Stop => session.stop(Who::Participant, "chose Stop on the panel".to_owned()),
    }
}

/// Upright before a head, facing it.
fn before(head: Pose) -> Pose {
    let ahead = head.rotation * DVec3::NEG_Z;
    let level = DVec3::new(ahead.x, 0.0, ahead.z);
    // Who looks straight down or up gets it down the lane.
    let ahead = level.try_normalize().unwrap_or(DVec3::NEG_Z);
    let yaw = libm::atan2(-ahead.x, -ahead.z);
    Pose {
        position: head.position + ahead * DISTANCE_M - DVec3::Y * BELOW_EYES_M,
        rotation: DQuat::from_rotation_y(yaw),
    }
}

/// Where the line from the eye through the hand meets the panel, in its pixels; `None` beside it.
fn pixel(panel: &Pose, eye: DVec3, hand: DVec3) -> Option<DVec2> {
    share(panel, SIZE_M, eye, hand).map(|share| share * layout::SIZE_PX.as_dvec2())
}

/// Where the line from the eye through the hand meets a board of `size` [m], from its upper left corner, each side 1; `None`
/// beside it.
pub(crate) fn share(panel: &Pose, size: DVec2, eye: DVec3, hand: DVec3) -> Option<DVec2> {
    let [eye, hand] = [eye, hand].map(|point| panel.inverse().transform_point(point));
    let way = hand - eye;
    // The panel faces +z: who points at it looks along -z.
    if way.z >= -1e-6 || eye.z <= 0.0 {
        return None;
    }
    let hit = eye - way * (eye.z / way.z);
    let share = DVec2::new(hit.x / size.x + 0.5, 0.5 - hit.y / size.y);
    let is_on = (0.0..=1.0).contains(&share.x) && (0.0..=1.0).contains(&share.y);
    is_on.then_some(share)
}

/// The panel's mesh and picture, held by a renderer.
pub struct PanelStock {
    letters: Letters<()>,
    quad: MeshId,
    dot: MeshId,
    texture: TextureId,
    stop: (MeshId, TextureId),
    /// What was painted last, or is being painted.
    asked: Option<Content>,
    /// Whether the picture shows anything yet.
    is_painted: bool,
}

impl PanelStock {
    /// An empty panel.
    ///
    /// # Errors
    /// When the renderer does not take it.
    pub fn new(gpu: &Gpu, renderer: &mut Renderer, words: &Words) -> Result<Self> {
        let size = SIZE_M.as_vec2();
        let stop_size = stop::SIZE_M.as_vec2();
        let mut painter = TextPainter::new(gpu);
        let sign = paint::stop_sign(&mut painter, &words.stop_sign)?;
        Ok(Self {
            letters: Letters::here(gpu),
            stop: (
                renderer.add_mesh(&MeshData::quad(stop_size.x, stop_size.y))?,
                renderer.add_texture(&sign)?,
            ),
            quad: renderer.add_mesh(&MeshData::quad(size.x, size.y))?,
            dot: renderer.add_mesh(&MeshData::quad(2.0 * DOT_M, 2.0 * DOT_M))?,
            texture: renderer.add_texture(&renderer::RgbaImage::new(1, 1))?,
            asked: None,
            is_painted: false,
        })
    }

    /// Has questions painted by somebody else: the last one is seen until the next is done.
    pub fn paint_apart(&mut self, scribe: &Scribe) {
        self.letters = Letters::apart(scribe);
    }

    /// What is to be drawn of `panel`; paints its picture when it has changed.
    ///
    /// # Errors
    /// When the picture cannot be painted.
    pub fn instances(&mut self, panel: &Panel, renderer: &mut Renderer) -> Result<Vec<Instance>> {
        let mut instances = Vec::new();
        if let Some(pose) = &panel.stop.pose {
            let (mesh, texture) = self.stop;
            instances.push(Instance {
                mesh,
                material: picture(texture),
                world_from_mesh: placed(pose, Vec3::ZERO),
            });
        }
        let Some(shown) = &panel.shown else {
            return Ok(instances);
        };
        if self.asked.as_ref() != Some(&shown.content) {
            let (content, layout) = (shown.content.clone(), shown.layout.clone());
            let words = panel.words.panel.clone();
            self.asked = Some(content.clone());
            self.letters.ask((), move |painter| {
                paint::paint(painter, &content, &layout, &words)
            })?;
        }
        while let Some(((), picture)) = self.letters.done()? {
            renderer.update_picture(self.texture, &picture)?;
            self.is_painted = true;
        }
        if !self.is_painted {
            return Ok(instances);
        }
        instances.push(Instance {
            mesh: self.quad,
            material: picture(self.texture),
            world_from_mesh: placed(&shown.pose, Vec3::ZERO),
        });
        if let Some(at) = shown.at {
            let share = at / layout::SIZE_PX.as_dvec2() - 0.5;
            let offset = DVec3::new(share.x * SIZE_M.x, -share.y * SIZE_M.y, 0.005);
            instances.push(Instance {
                mesh: self.dot,
                material: Material::unlit([1.0, 0.6, 0.05]),
                world_from_mesh: placed(&shown.pose, offset.as_vec3()),
            });
        }
        Ok(instances)
    }
}

/// A picture that shines by itself.
fn picture(texture: TextureId) -> Material {
    Material {
        texture: Some(texture),
        ..Material::unlit([1.0; 3])
    }
}

fn placed(pose: &Pose, offset: Vec3) -> Mat4 {
    let rotation: Quat = pose.rotation.as_quat().normalize();
    Mat4::from_rotation_translation(rotation, pose.position.as_vec3() + rotation * offset)
}

/// Texts of panel and stop sign: size of the letters and distance from which they are read, from the start at `eye` [m].
#[cfg(test)]
pub(crate) fn letters(config: &game::Config, eye: DVec3) -> [(&'static str, f64, f64); 4] {
    let panel = |pixels: f32| f64::from(pixels) * SIZE_M.x / f64::from(layout::SIZE_PX.x);
    let sign = f64::from(paint::STOP_HOW_PX) * stop::SIZE_M.x / f64::from(paint::STOP_SIZE_PX.x);
    let to_sign = stop::over(config).position.distance(eye);
    [
        ("a question", panel(paint::QUESTION_PX), DISTANCE_M),
        ("an answer", panel(paint::ANSWER_PX), DISTANCE_M),
        ("small print", panel(paint::SMALL_PX), DISTANCE_M),
        ("the stop sign", sign, to_sign),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head() -> Pose {
        Pose {
            position: DVec3::new(1.0, 1.7, 3.0),
            rotation: DQuat::from_rotation_y(0.7) * DQuat::from_rotation_x(-0.3),
        }
    }

    #[test]
    fn the_panel_hangs_upright_before_the_head_and_faces_it() {
        let pose = before(head());
        let to_head = head().position - pose.position;
        let level = DVec3::new(to_head.x, 0.0, to_head.z);
        assert!((level.length() - DISTANCE_M).abs() < 1e-12);
        assert!((pose.rotation * DVec3::Z).angle_between(level) < 1e-7);
        assert!((pose.rotation * DVec3::Y).distance(DVec3::Y) < 1e-12);
    }

    #[test]
    fn a_hand_points_at_what_it_covers() {
        let pose = before(head());
        let size = layout::SIZE_PX.as_dvec2();
        for (x, y) in [(0.5, 0.5), (0.1, 0.9), (0.99, 0.02)] {
            let on_panel = DVec3::new((x - 0.5) * SIZE_M.x, (0.5 - y) * SIZE_M.y, 0.0);
            let target = pose.transform_point(on_panel);
            let hand = head().position.lerp(target, 0.3);
            let at = pixel(&pose, head().position, hand).expect("it points at the panel");
            assert!(at.distance(DVec2::new(x, y) * size) < 1e-6, "{at}");
        }
        let away = head().position - (pose.position - head().position);
        assert_eq!(pixel(&pose, head().position, away), None);
        let beside = head().position + DVec3::Y;
        assert_eq!(pixel(&pose, head().position, beside), None);
    }
}
