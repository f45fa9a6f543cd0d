//! Arguments of `bowling compare`.

use std::path::PathBuf;

use clap::Args;

use super::throw::within;

/// Most values of one sweep.
const MOST_VALUES: f64 = 200.0;

/// What sweeps are refused with.
const SWEEPS: &str = "give elasticity=FROM..TO:STEP or friction=FROM..TO:STEP from 0 to 1, cap=FROM..TO:STEP in whole numbers from 1 to 100, each rising with at most 200 values, or shape";

/// Arguments of `bowling compare`.
#[derive(Debug, Args)]
pub struct CompareArguments {
    /// A recorded throw: the folder of `bowling play`, its journal, or the file of `bowling shot --record`.
    #[arg(value_name = "THROW")]
    pub recording: PathBuf,

    /// Which throw of a folder, counted from 1 in the order of play.
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    pub throw: u32,

    /// Conditions: all (the eight of Table 1); some of red, blue and three digits E, F, S such as 101, with
    /// commas between; or a TOML file.
    #[arg(
        long,
        value_name = "all|red,blue|FILE",
        default_value = "all",
        conflicts_with = "sweep"
    )]
    pub conditions: String,

    /// What the others are compared with [default: the condition that it was thrown under, else the first].
    #[arg(long, value_name = "NAME", conflicts_with = "sweep")]
    pub base: Option<String>,

    /// Vary one parameter instead of conditions, and draw how far throws part from the one that was recorded;
    /// may be given several times.
    ///
    /// elasticity=0..1:0.1, friction=0..1:0.1, cap=1..20:1 (iterations of the detection), or shape (the ladder of
    /// docs/accuracy.md).
    #[arg(long, value_name = "NAME=FROM..TO:STEP", value_parser = sweep)]
    pub sweep: Vec<Sweep>,

    /// Simulated time from the release on, in seconds [default: until the pins were counted, or the recording ends].
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = within(0.1, 60.0, "seconds"))]
    pub duration: Option<f64>,

    /// Instants of the contact sheet, in seconds after the release [default: two on the way, two at the pins, the end].
    #[arg(long, value_name = "S,S,..", value_delimiter = ',', allow_negative_numbers = true, value_parser = within(0.0, 60.0, "seconds"))]
    pub at: Vec<f64>,

    /// Width of a picture of the contact sheet, in pixels.
    #[arg(long, value_name = "PX", allow_negative_numbers = true, default_value_t = 236, value_parser = clap::value_parser!(u32).range(64..=640))]
    pub tile: u32,

    /// Make no video.
    #[arg(long)]
    pub no_video: bool,

    /// Change one setting under every condition, as in `bowling play`; may be given several times.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<String>,

    /// Folder for tables, figures and pictures; must be new or empty [default: out/TIME-compare].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// A parameter and its values.
#[derive(Debug, Clone, PartialEq)]
pub enum Sweep {
    /// Elasticity of every object.
    Elasticity(Vec<f64>),
    /// Friction rate of every object.
    Friction(Vec<f64>),
    /// The ladder of the pin's shapes.
    Shape,
    /// Most iterations of a detection.
    Cap(Vec<f64>),
}

fn sweep(text: &str) -> Result<Sweep, String> {
    if text == "shape" {
        return Ok(Sweep::Shape);
    }
    let (name, span) = text.split_once('=').unwrap_or((text, ""));
    let values = match name {
        "elasticity" | "friction" => values(span, 0.0, 1.0),
        "cap" => values(span, 1.0, 100.0).filter(|all| all.iter().all(|x| x.fract() == 0.0)),
        _ => None,
    };
    let values = values.ok_or_else(|| SWEEPS.to_owned())?;
    Ok(match name {
        "elasticity" => Sweep::Elasticity(values),
        "friction" => Sweep::Friction(values),
        _ => Sweep::Cap(values),
    })
}

/// The values of `FROM..TO:STEP` if they rise within the limits.
fn values(span: &str, low: f64, high: f64) -> Option<Vec<f64>> {
    let (from, rest) = span.split_once("..")?;
    let (to, step) = rest.split_once(':')?;
    let [from, to, step]: [f64; 3] = [from.parse().ok()?, to.parse().ok()?, step.parse().ok()?];
    let fits = from >= low && to <= high && from <= to && step > 0.0;
    // The last value is met when it is a whole number of steps away but for rounding.
    let count = ((to - from) / step + 1e-9).floor();
    (fits && count < MOST_VALUES).then(|| {
        let value = |index: u32| from + step * f64::from(index);
        // Sums of decimal steps are shown as what was meant.
        let rounded = |value: f64| (value * 1e9).round() / 1e9;
        (0..=count as u32)
            .map(|index| rounded(value(index)))
            .collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sweep_meets_its_last_value() {
        let Ok(Sweep::Elasticity(values)) = sweep("elasticity=0..1:0.1") else {
            panic!("it is well formed");
        };
        assert_eq!(values.len(), 11);
        assert_eq!((values[3], values[10]), (0.3, 1.0));
        assert_eq!(sweep("cap=1..20:1").map(|_| ()), Ok(()));
        assert_eq!(sweep("shape"), Ok(Sweep::Shape));
    }

    #[test]
    fn sweep_refuses_what_is_no_span() {
        let wrong = [
            "",
            "mass=0..1:0.1",
            "elasticity",
            "elasticity=0..2:0.1",
            "friction=1..0:0.1",
            "friction=0..1:0",
            "friction=0..1:0.001",
            "friction=0..nan:0.1",
            "cap=0..5:1",
            "cap=1..5:0.5",
            "shape=1",
        ];
        for text in wrong {
            let refused = sweep(text).expect_err(text);
            assert!(refused.contains("cap=FROM..TO:STEP"), "{text}: {refused}");
        }
    }
}
