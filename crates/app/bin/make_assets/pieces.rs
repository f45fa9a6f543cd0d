//! The things one can touch: pins, ball, buttons.

use anyhow::{Context, Result, ensure};
use bowling_app::scenery::mesh::{Mesh, cuboid, drum, lathe, sphere};
use glam::{Affine3A, Vec3};
use std::f32::consts::PI;

use crate::textures;

/// Reads `height_m,radius_m` rows, from the centre of the base to the crown, as (radius, height).
pub fn read_profile(csv: &str) -> Result<Vec<(f32, f32)>> {
    let mut profile = Vec::new();
    for (index, line) in csv.lines().enumerate().skip(1) {
        let row = || -> Option<(f32, f32)> {
            let (height, radius) = line.split_once(',')?;
            Some((radius.trim().parse().ok()?, height.trim().parse().ok()?))
        };
        profile.push(
            row().with_context(|| format!("line {}: expected `height_m,radius_m`", index + 1))?,
        );
    }
    ensure!(profile.len() > 2, "the profile needs at least three rows");
    Ok(profile)
}

/// The profile with as few points as keep every dropped one within `tolerance` [m] of the line that replaces it
/// (Ramer 1972, Douglas and Peucker 1973).
pub fn simplify(profile: &[(f32, f32)], tolerance: f32) -> Vec<(f32, f32)> {
    let (first, last) = (profile[0], profile[profile.len() - 1]);
    let along = Vec3::new(last.0 - first.0, last.1 - first.1, 0.0);
    let away = |p: &(f32, f32)| {
        let d = Vec3::new(p.0 - first.0, p.1 - first.1, 0.0);
        if along.length() == 0.0 {
            d.length()
        } else {
            (d - d.project_onto(along)).length()
        }
    };
    let inner = &profile[1..profile.len() - 1];
    let farthest = inner
        .iter()
        .enumerate()
        .max_by(|a, b| away(a.1).total_cmp(&away(b.1)));
    match farthest {
        Some((index, point)) if away(point) > tolerance => {
            let mut kept = simplify(&profile[..index + 2], tolerance);
            kept.pop();
            kept.extend(simplify(&profile[index + 1..], tolerance));
            kept
        }
        _ => vec![first, last],
    }
}

/// A pin of the given profile: origin at the centre of the base, y up.
pub fn pin(profile: &[(f32, f32)]) -> Mesh {
    // A third of a millimetre: at arm's length less than a pixel of any headset.
    lathe(&simplify(profile, 3.3e-4), 20, 0.9)
}

/// A ball of radius 1 about the origin.
pub fn ball() -> Mesh {
    sphere(1.0, 32, 18)
}

/// A pin of few corners, for the distance and for blurred sights: nowhere farther from the profile than 2.5 mm.
pub fn pin_low(profile: &[(f32, f32)]) -> Mesh {
    lathe(&simplify(profile, 2.5e-3), 8, 0.9)
}

/// Heights of the red bands on a pin's neck [m].
pub const BANDS: [(f32, f32); 2] = [(0.2290, 0.2410), (0.2500, 0.2620)];

/// The red bands of a pin that has no texture, a little outside of its skin.
pub fn pin_bands(profile: &[(f32, f32)]) -> Mesh {
    let radius = |height: f32| {
        let after = profile.partition_point(|(_, at)| *at < height);
        let [(r0, h0), (r1, h1)] = [profile[after - 1], profile[after]];
        r0 + (r1 - r0) * (height - h0) / (h1 - h0)
    };
    let mut bands = Mesh::default();
    for (low, high) in BANDS {
        // The skin between two corners of the low pin bulges out of this by up to the tolerance it was made with.
        let skin = |height: f32| (radius(height) + 0.0022, height);
        let band = lathe(&[skin(low), skin(high)], 8, 0.9);
        bands.append(&band, Affine3A::IDENTITY);
    }
    bands
}

/// The finger holes of a ball of radius 1 that has no texture: dark discs on its skin.
pub fn ball_holes() -> Mesh {
    let mut mesh = Mesh::default();
    for middle in textures::HOLES.map(textures::on_ball) {
        let across = middle.any_orthonormal_vector();
        let up = middle.cross(across);
        let rim = |i: i32| {
            let turn = glam::Vec2::from_angle(std::f32::consts::TAU * i as f32 / 8.0);
            let out = middle + textures::HOLE_RADIUS * (across * turn.x + up * turn.y);
            1.012 * out.normalize_or(middle)
        };
        for i in 0..4 {
            let corners = [1.012 * middle, rim(2 * i), rim(2 * i + 1), rim(2 * i + 2)];
            mesh.quad(corners, [glam::Vec2::ZERO, glam::Vec2::ONE]);
        }
    }
    mesh
}

/// A push button's cap of radius 1 and height 1, resting on y = 0: round, or square for the one told apart by shape.
pub fn button(round: bool) -> Mesh {
    if round {
        return drum(1.0, 1.0, 32);
    }
    let mut mesh = Mesh::default();
    // Equal in area to the round one, so that neither is the easier target.
    let half = 0.5 * PI.sqrt();
    mesh.append(
        &cuboid(Vec3::new(half, 0.5, half)),
        Affine3A::from_translation(Vec3::Y * 0.5),
    );
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simplify_keeps_every_point_within_the_tolerance() {
        let profile = read_profile(include_str!("../../../../assets/source/pin_profile.csv"))
            .expect("profile");
        let kept = simplify(&profile, 2e-4);
        assert!(
            kept.len() < 50,
            "{} points are too many triangles",
            kept.len()
        );
        for &(radius, height) in &profile[1..profile.len() - 1] {
            let near = kept.windows(2).map(|w| {
                let (a, b) = (glam::Vec2::from(w[0]), glam::Vec2::from(w[1]));
                let p = glam::Vec2::new(radius, height);
                let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                p.distance(a + (b - a) * t)
            });
            let nearest = near.fold(f32::INFINITY, f32::min);
            assert!(nearest < 2.1e-4, "({radius}, {height}) is {nearest} m away");
        }
    }

    #[test]
    fn read_profile_names_the_bad_line() {
        let error = read_profile("height_m,radius_m\n0,0\n0.1;0.2\n").expect_err("semicolon");
        assert!(error.to_string().contains("line 3"), "{error}");
    }
}
