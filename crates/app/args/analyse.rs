//! Arguments of `bowling analyse` and `bowling power`.

use std::path::PathBuf;

use clap::Args;
use experiment::analysis::model::Model;

/// Arguments of `bowling analyse`.
#[derive(Debug, Args)]
pub struct AnalyseArguments {
    /// A study's folder, or a table: CSV or TSV with a row for each subject.
    #[arg(value_name = "STUDY|FILE.csv")]
    pub input: PathBuf,

    /// Folder for report.html, report.txt, report.json and the figures.
    #[arg(long, value_name = "DIR", default_value = "out/analysis")]
    pub out: PathBuf,

    /// Print the JSON instead of the text; both are in the folder.
    #[arg(long)]
    pub json: bool,

    /// The model: terms joined by +.
    ///
    /// A term is 1 (a constant), change (an indicator for each changed parameter), a column, a column:change (the
    /// column where each parameter changes) or column:column (a product) [default: the paper's,
    /// change + F + sick + vr + S:change + E:change].
    #[arg(long, value_name = "TERMS")]
    pub model: Option<Model>,

    /// Re-allocations of the randomisation tests; where there are no more, all are done [default: 10000].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(100..=10_000_000))]
    pub randomisations: Option<u32>,

    /// Seed of the re-allocations; the same seed gives the same report [default: 1].
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub seed: Option<u64>,
}

/// Arguments of `bowling power`.
#[derive(Debug, Args)]
pub struct PowerArguments {
    /// Size of the physics' effects, as a factor of the published ones; or a file of coefficients: TOML with a
    /// number for each column (change1 to change3_E), or the report.json of `bowling analyse`.
    #[arg(
        long,
        value_name = "FACTOR|FILE",
        default_value = "1.0",
        allow_negative_numbers = true
    )]
    pub effect: String,

    /// Numbers of subjects, with commas between.
    #[arg(long, value_name = "N,N,..", value_delimiter = ',', default_value = "18,36,54,72,90,108,144,180", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(12..=10_000))]
    pub subjects: Vec<u32>,

    /// Presence is asked after each game: subjects per changed parameter for the paired test.
    #[arg(long)]
    pub per_game: bool,

    /// Correlation of one subject's answers.
    #[arg(long, value_name = "RHO", default_value_t = experiment::analysis::power::CORRELATION, allow_negative_numbers = true, value_parser = correlation)]
    pub correlation: f64,

    /// Studies simulated for each number of subjects.
    #[arg(long, value_name = "N", default_value_t = 1_000, allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(100..=1_000_000))]
    pub studies: u32,

    /// Seed of the simulation; the same seed gives the same curve.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        allow_negative_numbers = true
    )]
    pub seed: u64,

    /// Folder for power.json and power.svg.
    #[arg(long, value_name = "DIR", default_value = "out/power")]
    pub out: PathBuf,

    /// Print the JSON instead of the text.
    #[arg(long)]
    pub json: bool,
}

fn correlation(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if (0.0..=0.95).contains(&value) => Ok(value),
        _ => Err("a correlation of answers is a number from 0 to 0.95".to_owned()),
    }
}
