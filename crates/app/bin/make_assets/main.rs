//! Makes the meshes and textures in `assets/` from the pin's profile. Scenery is built by the program itself (`scenery`).
//!
//!     cargo run --bin make-assets             writes them
//!     cargo run --bin make-assets -- --check  says which differ from what it would write, and fails if any does
//!
//! They are committed, so that the program needs no generator and a reviewer sees what changes.

mod pieces;
mod textures;

use anyhow::{Context, Result, bail};
use bowling_app::scenery::mesh::{Mesh, cuboid};
use image::{ImageFormat, RgbImage};
use std::io::Cursor;
use std::path::{Path, PathBuf};

fn main() -> Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let check = match std::env::args().nth(1).as_deref() {
        None => false,
        Some("--check") => true,
        Some(other) => bail!("unknown argument {other}: the only one is --check"),
    };
    let mut stale = Vec::new();
    for (path, bytes) in assets(root)? {
        let path = root.join("assets").join(path);
        if check {
            if std::fs::read(&path).ok().as_deref() != Some(&bytes) {
                stale.push(path);
            }
        } else {
            std::fs::write(&path, bytes)
                .with_context(|| format!("cannot write {}", path.display()))?;
            println!("{}", path.display());
        }
    }
    if !stale.is_empty() {
        let list: Vec<_> = stale.iter().map(|p| p.display().to_string()).collect();
        bail!(
            "not what make-assets writes: {}. Run `cargo run --bin make-assets`.",
            list.join(", ")
        );
    }
    Ok(())
}

/// Every generated file: its path in `assets/` and its bytes.
fn assets(root: &Path) -> Result<Vec<(PathBuf, Vec<u8>)>> {
    let source = root.join("assets/source/pin_profile.csv");
    let csv = std::fs::read_to_string(&source)
        .with_context(|| format!("cannot read {}", source.display()))?;
    let profile = pieces::read_profile(&csv).with_context(|| source.display().to_string())?;
    let (_, height) = *profile.last().expect("read_profile wants three rows");
    let mut files = Vec::new();
    for (name, mesh) in meshes(&profile) {
        let path = PathBuf::from(format!("meshes/{name}.obj"));
        files.push((path, mesh.to_obj(name).into_bytes()));
    }
    for (name, texture) in textures(height) {
        let mut png = Cursor::new(Vec::new());
        texture
            .write_to(&mut png, ImageFormat::Png)
            .context("cannot encode a texture")?;
        let path = PathBuf::from(format!("textures/{name}.png"));
        files.push((path, png.into_inner()));
    }
    Ok(files)
}

/// The meshes of what is touched, with their names.
fn meshes(profile: &[(f32, f32)]) -> [(&'static str, Mesh); 8] {
    [
        ("pin", pieces::pin(profile)),
        ("pin_low", pieces::pin_low(profile)),
        ("pin_bands", pieces::pin_bands(profile)),
        ("ball", pieces::ball()),
        ("ball_holes", pieces::ball_holes()),
        ("button_round", pieces::button(true)),
        ("button_square", pieces::button(false)),
        ("box", cuboid(glam::Vec3::ONE)),
    ]
}

/// The textures, with their names, for pins of a height [m].
fn textures(height: f32) -> [(&'static str, RgbImage); 7] {
    let ball = textures::ball;
    [
        ("grain", textures::grain()),
        ("masking", textures::masking()),
        ("pin", textures::pin(height)),
        (
            "ball_blue",
            ball([22.0, 38.0, 96.0], [92.0, 140.0, 214.0], 5),
        ),
        (
            "ball_green",
            ball([14.0, 66.0, 44.0], [104.0, 178.0, 120.0], 23),
        ),
        (
            "ball_orange",
            ball([168.0, 74.0, 16.0], [244.0, 176.0, 84.0], 41),
        ),
        (
            "ball_violet",
            ball([70.0, 22.0, 92.0], [178.0, 120.0, 204.0], 67),
        ),
    ]
}
