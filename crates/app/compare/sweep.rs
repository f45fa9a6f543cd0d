//! How far throws part from the recorded one along a parameter.

use std::sync::Arc;

use anyhow::Result;
use game::{BareAlley, Config};
use physics::Compound;

use super::condition::with;
use super::course::Course;
use super::divergence::Divergence;
use super::table::{number, quoted};
use super::thrown::Thrown;
use crate::accuracy::ladder;
use crate::args::Sweep;

/// One value of the parameter, and what came of it.
pub struct Step {
    /// The value in words.
    pub name: String,
    /// Where it lies on the axis: the value, or the rung of the ladder from 0.
    pub x: f64,
    /// How it parts from the recorded setting.
    pub divergence: Divergence,
    /// Pins that fell.
    pub pins: usize,
    /// Impulse of the ball's first touch of a pin [N s].
    pub first_impulse: Option<f64>,
    /// All impulses between ball and pins [N s].
    pub impulse: f64,
}

/// A swept parameter.
pub struct Swept {
    /// Its name for files.
    pub name: &'static str,
    /// Its name for people.
    pub axis: &'static str,
    /// Whether its values are names, at 0, 1, 2, ...
    pub is_named: bool,
    /// The recorded value, where it is a number.
    pub recorded: Option<f64>,
    /// Pins that fell with the recorded value.
    pub pins: usize,
    /// The values.
    pub steps: Vec<Step>,
}

/// A value, the settings and the pin that belong to it.
type Setting = (String, f64, Config, Arc<Compound>);

impl Swept {
    /// Throws with every value.
    ///
    /// # Errors
    /// When a scene cannot be built.
    pub fn of(
        sweep: &Sweep,
        thrown: &Thrown,
        duration: f64,
        progress: &mut dyn FnMut(&str) -> Result<()>,
    ) -> Result<Self> {
        let config = &thrown.config;
        let pin = BareAlley::pin_shape(config)?;
        let base = Course::of(thrown, config, pin, duration)?;
        let (name, axis, recorded) = match sweep {
            Sweep::Elasticity(_) => ("elasticity", "elasticity", Some(config.objects.elasticity)),
            Sweep::Friction(_) => (
                "friction",
                "friction rate",
                Some(config.objects.friction_rate),
            ),
            Sweep::Cap(_) => (
                "cap",
                "iteration cap",
                Some(f64::from(config.physics.iteration_cap)),
            ),
            Sweep::Shape => ("shape", "shape of the pins", None),
        };
        let settings = settings(sweep, config)?;
        let count = settings.len();
        let mut steps = Vec::new();
        for (index, (value, x, config, pin)) in settings.into_iter().enumerate() {
            progress(&format!("{name} {value}: {} of {count}", index + 1))?;
            let course = Course::of(thrown, &config, pin, duration)?;
            steps.push(Step {
                name: value,
                x,
                divergence: Divergence::of(thrown, &base, &course),
                pins: course.fallen.len(),
                first_impulse: course.first_hit.map(|hit| hit.impulse),
                impulse: course.impulse,
            });
        }
        Ok(Self {
            name,
            axis,
            is_named: *sweep == Sweep::Shape,
            recorded,
            pins: base.fallen.len(),
            steps,
        })
    }

    /// The table for people.
    pub fn text(&self) -> String {
        let mut text = format!(
            "\n{}, against the recorded setting ({} pins)\n{:<16}{:>5}{:>10}{:>11}{:>12}{:>12}{:>10}\n",
            self.axis,
            self.pins,
            self.name,
            "pins",
            "1 cm [s]",
            "5 deg [s]",
            "most [deg]",
            "first [Ns]",
            "all [Ns]"
        );
        let two =
            |value: Option<f64>| value.map_or("n/a".to_owned(), |value| format!("{value:.2}"));
        for step in &self.steps {
            let parting = &step.divergence;
            text += &format!(
                "{:<16}{:>5}{:>10}{:>11}{:>12.2}{:>12}{:>10.2}\n",
                step.name,
                step.pins,
                two(parting.apart),
                two(parting.seen),
                parting.most_deg,
                two(step.first_impulse),
                step.impulse
            );
        }
        text
    }

    /// The table as CSV.
    pub fn csv(&self) -> String {
        let mut text = format!(
            "{},fallen_pins,apart_1cm_s,apart_5deg_s,largest_angle_deg,largest_angle_at_s,first_impulse_Ns,total_impulse_Ns\n",
            self.name
        );
        for step in &self.steps {
            let parting = &step.divergence;
            let fields = [
                quoted(&step.name),
                step.pins.to_string(),
                number(parting.apart),
                number(parting.seen),
                number(Some(parting.most_deg)),
                number(Some(parting.most_at)),
                number(step.first_impulse),
                number(Some(step.impulse)),
            ];
            text += &(fields.join(",") + "\n");
        }
        text
    }
}

fn settings(sweep: &Sweep, config: &Config) -> Result<Vec<Setting>> {
    let along = |key: &str, values: &[f64]| {
        let setting = |value: &f64| {
            let config = with(config, &[format!("{key}={}", toml_number(key, *value))])?;
            let pin = BareAlley::pin_shape(&config)?;
            Ok((value.to_string(), *value, config, pin))
        };
        values.iter().map(setting).collect::<Result<Vec<_>>>()
    };
    match sweep {
        Sweep::Elasticity(values) => along("objects.elasticity", values),
        Sweep::Friction(values) => along("objects.friction_rate", values),
        Sweep::Cap(values) => along(CAP, values),
        Sweep::Shape => {
            let rungs = ladder::pins(config).into_iter().enumerate();
            let setting = |(index, (name, pin)): (usize, (String, Arc<Compound>))| {
                (name, index as f64, config.clone(), pin)
            };
            Ok(rungs.map(setting).collect())
        }
    }
}

const CAP: &str = "physics.iteration_cap";

/// A value as the key's type wants it: a whole number of iterations, else one with a point.
fn toml_number(key: &str, value: f64) -> String {
    if key == CAP {
        format!("{value}")
    } else {
        format!("{value:?}")
    }
}
