//! The things one can touch: pins, ball, hand, buttons.

use anyhow::{Context, Result, ensure};
use bowling_app::scenery::mesh::{Mesh, capsule, cuboid, drum, lathe, sphere};
use glam::{Affine3A, Quat, Vec3};
use std::f32::consts::{FRAC_PI_2, PI};

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
    sphere(1.0, 28, 16)
}

/// A right hand about its palm: fingers along -z, palm down, thumb to the left; `curl` 0 is open, 1 is a fist,
/// and at 0.4 the fingers lie round a ball or in its holes.
pub fn hand(curl: f32) -> Mesh {
    let mut hand = Mesh::default();
    let palm = sphere(1.0, 14, 8);
    hand.append(&palm, Affine3A::from_scale(Vec3::new(0.043, 0.016, 0.050)));
    let wrist = capsule(0.026, 0.03, 12);
    let along_z = Quat::from_rotation_x(FRAC_PI_2);
    hand.append(
        &wrist,
        Affine3A::from_rotation_translation(along_z, Vec3::new(0.0, 0.0, 0.065)),
    );
    // Side offset [m], length [m] and thickness [m] of index, middle, ring and little finger.
    let fingers = [
        (-0.030, 0.072, 0.0095),
        (-0.010, 0.080, 0.0098),
        (0.011, 0.074, 0.0093),
        (0.030, 0.058, 0.0082),
    ];
    for (side, length, radius) in fingers {
        finger(
            &mut hand,
            Vec3::new(side, 0.0, -0.044),
            0.0,
            length,
            radius,
            curl,
        );
    }
    finger(
        &mut hand,
        Vec3::new(-0.036, -0.004, 0.010),
        0.9,
        0.052,
        0.0105,
        0.5 * curl,
    );
    hand
}

/// Three phalanges from `root`, turned by `yaw` outward and bent downward by `curl`.
fn finger(hand: &mut Mesh, root: Vec3, yaw: f32, length: f32, radius: f32, curl: f32) {
    let along_z = Quat::from_rotation_x(FRAC_PI_2);
    let mut joint = root;
    let mut bend = 0.12 + 0.25 * curl;
    for share in [0.45, 0.32, 0.23] {
        let turn = Quat::from_rotation_y(yaw) * Quat::from_rotation_x(-bend);
        let half = 0.5 * share * length;
        let phalanx = capsule(radius, half, 8);
        let middle = joint + turn * (Vec3::NEG_Z * half);
        hand.append(
            &phalanx,
            Affine3A::from_rotation_translation(turn * along_z, middle),
        );
        joint += turn * (Vec3::NEG_Z * 2.0 * half);
        bend += 0.10 + 0.75 * curl;
    }
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
