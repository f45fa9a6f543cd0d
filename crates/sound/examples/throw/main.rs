//! Writes the sound of a strike: `cargo run -p sound --example throw -- strike.wav`.

use std::fs::File;
use std::io::BufWriter;

use sound::{Settings, offline, wav};

mod strike;

fn main() -> std::io::Result<()> {
    let path = std::env::args().nth(1).unwrap_or("strike.wav".into());
    let settings = Settings::default();
    let samples = offline::render(&settings, &strike::strike(), strike::LENGTH_S);
    let file = BufWriter::new(File::create(&path)?);
    wav::write_wav(file, &samples, settings.sample_rate)?;
    let loudest = samples.iter().flatten().fold(0.0f32, |a, b| a.max(b.abs()));
    println!(
        "{path}: {:.1} s, the loudest sample at {loudest:.2} of full scale ({} Pa), {} contacts in the crash at {} s",
        strike::LENGTH_S,
        settings.full_scale_pa,
        strike::crash().len(),
        strike::CRASH_S,
    );
    Ok(())
}
