//! One condition's course of a throw: where ball and pins went, and what they did to each other.

use std::sync::Arc;

use anyhow::{Context, Result};
use game::{BareAlley, Config, Visible};
use glam::DVec3;
use physics::{BodyId, Compound, Impact};

use super::thrown::Thrown;

/// Pictures a second that are kept: more than a video shows, so that instants can be picked.
const PICTURES_PER_S: f64 = 90.0;

/// What came of the throw under one condition.
#[derive(Clone, Debug)]
pub struct Course {
    /// Time between two places of the ball [s].
    pub dt: f64,
    /// Centre of the ball at the release and after every step [m].
    pub ball: Vec<DVec3>,
    /// Steps between two pictures.
    stride: usize,
    pictures: Vec<Vec<Visible>>,
    /// The ball's first touch of a pin.
    pub first_hit: Option<Hit>,
    /// Sizes of all impulses between ball and pins, added [N s].
    pub impulse: f64,
    /// Numbers of the pins that count as fallen at the end.
    pub fallen: Vec<u8>,
}

/// A touch of ball and pin.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// End of the step in which it happened, after the release [s].
    pub time: f64,
    /// Size of the impulse [N s].
    pub impulse: f64,
}

impl Course {
    /// Throws under settings, at pins of a shape, and follows for `duration` [s].
    ///
    /// # Errors
    /// When the scene cannot be built or the ball's place is not free.
    pub fn of(thrown: &Thrown, config: &Config, pin: Arc<Compound>, duration: f64) -> Result<Self> {
        let mut alley = BareAlley::with_pins(config, &thrown.pins, pin)?;
        let ball = alley
            .let_go(thrown.ball, thrown.pose, thrown.linear, thrown.angular)
            .context("the recorded ball cannot be thrown there")?;
        let dt = alley.world.dt();
        let mut course = Self {
            dt,
            ball: vec![thrown.pose.position],
            stride: ((1.0 / (PICTURES_PER_S * dt)).round() as usize).max(1),
            pictures: vec![alley.visible()],
            first_hit: None,
            impulse: 0.0,
            fallen: Vec::new(),
        };
        let steps = (duration / dt).round().max(1.0) as usize;
        for step in 1..=steps {
            alley.world.step();
            course.ball.push(alley.world.body(ball).pose().position);
            course.note_impacts(&alley, ball);
            if step % course.stride == 0 {
                course.pictures.push(alley.visible());
            }
        }
        course.fallen = alley.fallen();
        course.fallen.sort_unstable();
        Ok(course)
    }

    fn note_impacts(&mut self, alley: &BareAlley, ball: BodyId) {
        let is_pin = |id: BodyId| alley.pins().iter().any(|(_, pin)| *pin == id);
        let is_hit = |impact: &&Impact| {
            (impact.a == ball && is_pin(impact.b)) || (impact.b == ball && is_pin(impact.a))
        };
        for impact in alley.world.impacts().iter().filter(is_hit) {
            let (time, impulse) = (alley.world.time(), impact.impulse.length());
            self.first_hit.get_or_insert(Hit { time, impulse });
            self.impulse += impulse;
        }
    }

    /// How long it was followed [s].
    pub fn duration(&self) -> f64 {
        self.dt * (self.ball.len() - 1) as f64
    }

    /// Ball and pins at a time after the release [s], or at the nearest that was kept.
    pub fn picture(&self, time: f64) -> &[Visible] {
        let index = (time / (self.dt * self.stride as f64)).round() as usize;
        &self.pictures[index.min(self.pictures.len() - 1)]
    }

    /// Centre of the ball at a time after the release [s].
    pub fn ball_at(&self, time: f64) -> DVec3 {
        let index = (time / self.dt).round() as usize;
        self.ball[index.min(self.ball.len() - 1)]
    }
}
