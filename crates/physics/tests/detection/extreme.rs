//! Sizes of any magnitude.

use glam::DVec3;
use physics::Pose;
use physics::query::Limits;

use crate::judge::built::put_together;
use crate::judge::cases::{Case, between, direction, rotation};
use crate::judge::known::Known;
use crate::support::Random;
use crate::{Wrong, ask};

/// From micrometres to kilometres nothing becomes a NaN, and the lower bound is one.
#[test]
fn sizes_and_places_of_any_magnitude() {
    let mut wrong = Wrong::default();
    let mut random = Random(83);
    for _ in 0..3000 {
        let scale = |random: &mut Random| 10f64.powf(between(random, -6.0, 3.0));
        let some = |random: &mut Random| {
            let (x, y, z) = (scale(random), scale(random), scale(random));
            match (random.next() * 4.0) as i32 {
                -3 => Known::Sphere(x),
                -2 => Known::Capsule(x, y),
                -1 => Known::Frustum(x, y, z),
                0 => Known::Ellipsoid(DVec3::new(x, y, z)),
                1 => Known::Frustum(x, x, y),
                2 => Known::Frustum(x, 0.0, y),
                _ => Known::Cuboid(DVec3::new(x, y, z)),
            }
        };
        let (a, b) = (some(&mut random), some(&mut random));
        let far = direction(&mut random) * scale(&mut random);
        let case = Case {
            a,
            pose_a: Pose::new(direction(&mut random), rotation(&mut random)),
            b,
            pose_b: Pose::new(far, rotation(&mut random)),
        };
        for iteration_cap in [1, 20] {
            let limits = Limits {
                iteration_cap,
                ..Limits::default()
            };
            let found = ask(&case, None, limits);
            let name = format!("{case:?}: {found:?}");
            wrong.unless((found.normal.length() - 1.0).abs() < 1e-12, || name.clone());
            wrong.unless(found.iterations <= iteration_cap, || name.clone());
            let own = case.gap_along(found.normal);
            let reach = case.a.radius() + case.b.radius() + far.length() + 1.0;
            wrong.unless((own - found.gap).abs() <= 1e-12 * reach, || {
                format!("{name}: {own}")
            });
        }
    }
    wrong.end();
}

/// A shape a thousand times as long as it is thick, or as wide.
fn slender(random: &mut Random) -> Known {
    let plate = random.next() < 0.0;
    let (across, along) = if plate { (1.0, 1e-3) } else { (1e-3, 1.0) };
    match between(random, 0.0, 4.0) as i32 {
        0 => Known::Frustum(across, across, along),
        1 => Known::Ellipsoid(DVec3::new(across, along, across)),
        2 => Known::Cuboid(DVec3::new(across, along, across)),
        _ if plate => Known::Frustum(across, 0.5 * across, along),
        _ => Known::Capsule(across, along),
    }
}

/// Needles and plates 1:1000 that are apart: the gap is right, or the answer says that it did not get there.
#[test]
fn needles_and_plates_apart() {
    let mut wrong = Wrong::default();
    let mut random = Random(1000);
    let mut capped = 0;
    let poses = 2000;
    for i in 0..poses {
        let (a, b) = (slender(&mut random), slender(&mut random));
        let built = put_together(a, b, 0.02, &mut random);
        let found = ask(&built.case, None, Limits::default());
        let off = (found.gap - built.gap).abs() / built.case.size();
        capped += usize::from(found.capped);
        wrong.unless(found.gap <= built.gap + 1e-12, || format!("{i}: {found:?}"));
        wrong.unless(off < 1e-6 || found.capped, || {
            format!("{i}: off by {off:.1e}, {:?} {found:?}", built.case)
        });
    }
    wrong.unless(capped * 100 <= poses, || {
        format!("{capped} of {poses} poses did not end")
    });
    wrong.end();
}
