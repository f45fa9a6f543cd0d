//! Arguments of throws without hands: `bowling shot`, and what it shares with the commands that throw many.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Most values of a span.
const MOST_VALUES: u32 = 400;

/// Which law answers collisions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum ModelChoice {
    /// Eq. (3)-(9) of the paper to the letter.
    UnoSlater,
    /// The same without pull and without hop.
    Guarded,
    /// Restitution with a cone of friction, pair by pair.
    Coulomb,
}

/// Which shape pins have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ShapeChoice {
    /// A composite of primitives.
    True,
    /// One ellipsoid, cut flat at the base.
    Ellipsoid,
}

/// Numbers of pins that stand on the deck.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PinNumbers(pub Vec<u8>);

/// What is thrown at what, under which law.
#[derive(Debug, Args)]
pub struct ThrowArguments {
    /// Speed of the ball, in m/s.
    #[arg(long, value_name = "V", allow_negative_numbers = true, default_value_t = 8.0, value_parser = within(0.01, 1000.0, "m/s"))]
    pub speed: f64,

    /// How far before the head pin's spot the ball begins, in metres.
    #[arg(long, value_name = "D", allow_negative_numbers = true, default_value_t = 2.0, value_parser = within(-2.0, 30.0, "metres"))]
    pub start: f64,

    /// Revolutions a minute about the ball's axis; 0 lets it roll without sliding.
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 0.0, value_parser = within(0.0, 100_000.0, "revolutions a minute"))]
    pub revs: f64,

    /// Turn of that axis about the vertical, in degrees: 0 rolls ahead, 90 spins sideways and hooks to the left.
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, default_value_t = 0.0, value_parser = within(-180.0, 180.0, "degrees"))]
    pub axis_rotation: f64,

    /// The pins that stand, or none.
    #[arg(long, value_name = "LIST", default_value = "1,2,3,4,5,6,7,8,9,10", value_parser = pin_numbers)]
    pub pins: PinNumbers,

    /// Steps of the scene a second.
    #[arg(long, value_name = "HZ", allow_negative_numbers = true, default_value_t = 90.0, value_parser = within(60.0, 5760.0, "steps a second"))]
    pub frame_rate: f64,

    /// Simulated time, in seconds.
    #[arg(long, value_name = "S", allow_negative_numbers = true, default_value_t = 4.0, value_parser = within(0.001, 3600.0, "seconds"))]
    pub duration: f64,

    /// Law of collisions.
    #[arg(long, value_enum, default_value = "guarded")]
    pub model: ModelChoice,

    /// Elasticity of every object, for uno_slater and guarded [default: the scene's].
    #[arg(long, value_name = "E", allow_negative_numbers = true, value_parser = within(0.0, 1.0, "of the paper's elasticity"))]
    pub elasticity: Option<f64>,

    /// Friction rate of every object, for uno_slater and guarded [default: the scene's].
    #[arg(long, value_name = "F", allow_negative_numbers = true, value_parser = within(0.0, 1.0, "of the paper's friction"))]
    pub friction_rate: Option<f64>,

    /// Restitution of every pair, for coulomb [default: the scene's table].
    #[arg(long, value_name = "R", allow_negative_numbers = true, value_parser = within(0.0, 1.0, "of restitution"))]
    pub restitution: Option<f64>,

    /// Coefficient of friction of every pair, for coulomb [default: the scene's table].
    #[arg(long, value_name = "M", allow_negative_numbers = true, value_parser = within(0.0, 10.0, "of friction"))]
    pub mu: Option<f64>,

    /// Shape of the pins [default: the scene's].
    #[arg(long, value_enum)]
    pub shape: Option<ShapeChoice>,

    /// Seed of all jitter; the same seed gives the same throws.
    #[arg(
        long,
        value_name = "N",
        allow_negative_numbers = true,
        default_value_t = 1
    )]
    pub seed: u64,

    /// Let nothing fall asleep.
    #[arg(long)]
    pub no_sleep: bool,

    /// Threads that throw [default: one a core]; the throws do not depend on it.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub threads: Option<u32>,

    /// Scene to throw in: a file of config/scenes, without its ending.
    #[arg(long, value_name = "NAME", default_value = "alley")]
    pub scene: String,

    /// Change one setting, as in `bowling play`; may be given several times.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<String>,
}

/// Arguments of `bowling shot`.
#[derive(Debug, Args)]
pub struct ShotArguments {
    /// What every throw has.
    #[command(flatten)]
    pub throw: ThrowArguments,

    /// Where the ball begins, in metres to the bowler's right of the lane's middle.
    #[arg(long, value_name = "X", allow_negative_numbers = true, default_value_t = 0.0, value_parser = within(-10.0, 10.0, "metres"))]
    pub offset: f64,

    /// Direction of the throw, in degrees to the bowler's right.
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, default_value_t = 0.0, value_parser = within(-89.0, 89.0, "degrees"))]
    pub angle: f64,

    /// Standard deviation of the offset, in metres.
    #[arg(long, value_name = "SD", allow_negative_numbers = true, default_value_t = 0.0, value_parser = within(0.0, 1.0, "metres"))]
    pub jitter_offset: f64,

    /// Standard deviation of the direction, in degrees.
    #[arg(long, value_name = "SD", allow_negative_numbers = true, default_value_t = 0.0, value_parser = within(0.0, 10.0, "degrees"))]
    pub jitter_angle: f64,

    /// Standard deviation of the speed, in m/s.
    #[arg(long, value_name = "SD", allow_negative_numbers = true, default_value_t = 0.0, value_parser = within(0.0, 100.0, "m/s"))]
    pub jitter_speed: f64,

    /// How many throws.
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=100_000_000))]
    pub repeat: u64,

    /// Number of the first of them: a long series can be thrown in pieces, and any throw of it once more.
    #[arg(long, value_name = "K", allow_negative_numbers = true, default_value_t = 0, value_parser = clap::value_parser!(u64).range(0..=100_000_000))]
    pub first: u64,

    /// Print JSON lines, one object a throw.
    #[arg(long)]
    pub json: bool,

    /// Keep poses and velocities of every step of the one throw in this file.
    #[arg(long, value_name = "FILE")]
    pub record: Option<PathBuf>,
}

/// Arguments of `bowling strike-map`.
#[derive(Debug, Args)]
pub struct StrikeMapArguments {
    /// What every throw has.
    #[command(flatten)]
    pub throw: ThrowArguments,

    /// Where the ball's middle passes the head pin's spot, in metres to the right of it: first, last and step.
    #[arg(long, value_name = "FROM:TO:STEP", allow_hyphen_values = true, default_value = "0:0.18:0.01", value_parser = span_of(0.5, "metres"))]
    pub offsets: Span,

    /// Entry angles, in degrees to the left, as a right-hander's ball comes: first, last and step.
    #[arg(long, value_name = "FROM:TO:STEP", allow_hyphen_values = true, default_value = "-2:8:1", value_parser = span_of(45.0, "degrees"))]
    pub angles: Span,

    /// Throws for each pair of offset and angle, spread evenly over half a step to all sides.
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 100, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub shots: u64,

    /// Standard deviation of the speed, in m/s.
    #[arg(long, value_name = "SD", allow_negative_numbers = true, default_value_t = 0.2, value_parser = within(0.0, 100.0, "m/s"))]
    pub jitter_speed: f64,

    /// Folder for strike-map.csv and strike-map.svg [default: out/strike-map-MODEL].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Evenly spaced values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// First value.
    pub from: f64,
    /// Distance between neighbours.
    pub step: f64,
    /// How many.
    pub count: u32,
}

impl ModelChoice {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            ModelChoice::UnoSlater => "uno_slater",
            ModelChoice::Guarded => "guarded",
            ModelChoice::Coulomb => "coulomb",
        }
    }
}

impl Span {
    /// Value `index`.
    pub fn at(&self, index: u32) -> f64 {
        self.from + self.step * f64::from(index)
    }

    /// The last value.
    pub fn last(&self) -> f64 {
        self.at(self.count - 1)
    }
}

impl StrikeMapArguments {
    /// Why the arguments contradict each other, if they do.
    pub fn contradiction(&self) -> Option<String> {
        stopped(self.throw.speed, self.jitter_speed)
    }
}

impl ShotArguments {
    /// Why the arguments contradict each other, if they do.
    pub fn contradiction(&self) -> Option<String> {
        if self.record.is_some() && self.repeat > 1 {
            return Some("--record keeps one throw: leave out --repeat".to_owned());
        }
        stopped(self.throw.speed, self.jitter_speed)
    }
}

/// Why a speed cannot have so much jitter, of which none is beyond six standard deviations.
fn stopped(speed: f64, jitter: f64) -> Option<String> {
    (speed - 6.0 * jitter <= 0.0).then(|| {
        let most = speed / 6.0;
        format!("--jitter-speed {jitter} could stop a ball of {speed} m/s: give less than {most}")
    })
}

/// A parser of numbers in a range; the words say what of.
pub(super) fn within(
    low: f64,
    high: f64,
    words: &'static str,
) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    move |text| match text.parse() {
        Ok(value) if (low..=high).contains(&value) => Ok(value),
        _ => Err(format!("give a number from {low} to {high} {words}")),
    }
}

/// A parser of evenly spaced values that lie within `limit` of zero.
fn span_of(
    limit: f64,
    words: &'static str,
) -> impl Fn(&str) -> Result<Span, String> + Clone + Send + Sync + 'static {
    move |text| {
        let numbers: Vec<f64> = text.split(':').filter_map(|n| n.parse().ok()).collect();
        if let [from, to, step] = numbers[..]
            && text.split(':').count() == 3
            && from.abs() <= limit
            && to.abs() <= limit
            && from <= to
            && step > 0.0
        {
            // The last value is met when it is a whole number of steps away but for rounding.
            let steps = ((to - from) / step + 1e-9).floor();
            if steps < f64::from(MOST_VALUES) {
                let count = steps as u32 + 1;
                return Ok(Span { from, step, count });
            }
        }
        Err(format!(
            "give FROM:TO:STEP from -{limit} to {limit} {words}, rising, with at most {MOST_VALUES} values"
        ))
    }
}

/// At least one pin to throw at.
pub(super) fn leave(text: &str) -> Result<PinNumbers, String> {
    let pins = pin_numbers(text)?;
    if pins.0.is_empty() {
        return Err("leave at least one pin to throw at, as 7,10".to_owned());
    }
    Ok(pins)
}

/// A ball's weight: 6 to 16 pounds are made.
pub(super) fn ball_kg(text: &str) -> Result<f64, String> {
    match text.trim().parse() {
        Ok(kilograms) if (2.7..=7.26).contains(&kilograms) => Ok(kilograms),
        _ => Err("a bowling ball weighs from 2.7 to 7.26 kilograms".to_owned()),
    }
}

fn pin_numbers(text: &str) -> Result<PinNumbers, String> {
    if text == "none" {
        return Ok(PinNumbers(Vec::new()));
    }
    let advice = || "give numbers from 1 to 10 with commas between, each once, or none".to_owned();
    let mut numbers = Vec::new();
    for word in text.split(',') {
        let number = word.trim().parse().map_err(|_| advice())?;
        if !(1..=game::PINS).contains(&number) || numbers.contains(&number) {
            return Err(advice());
        }
        numbers.push(number);
    }
    Ok(PinNumbers(numbers))
}
