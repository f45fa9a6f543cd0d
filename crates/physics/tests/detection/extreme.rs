//! Sizes of any magnitude.

use glam::DVec3;
use physics::Pose;
use physics::query::Limits;

use crate::judge::built::put_together;
use crate::judge::cases::{Case, between, direction, rotation};
use crate::judge::known::Known;
use crate::judge::slender;
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
fn needle_or_plate(random: &mut Random) -> Known {
    let plate = random.next() < 0.0;
    let (across, along) = if plate { (1.0, 1e-3) } else { (1e-3, 1.0) };
    match between(random, 0.0, 4.0) as i32 {
        0 => Known::Frustum(across, across, along),
        1 => {
            let third = 10f64.powf(between(random, -3.0, 0.0));
            Known::Ellipsoid(DVec3::new(across, along, third))
        }
        2 => Known::Cuboid(DVec3::new(across, along, across)),
        _ if plate => Known::Frustum(across, 0.5 * across, along),
        _ => Known::Capsule(across, along),
    }
}

/// Needles and plates 1:1000 that are apart: the gap is right and the interval narrow, or the answer says that it did
/// not get there.
#[test]
fn needles_and_plates_apart() {
    let mut wrong = Wrong::default();
    let mut random = Random(1000);
    let mut capped = 0;
    let poses = 12_000;
    for i in 0..poses {
        let (a, b) = (needle_or_plate(&mut random), needle_or_plate(&mut random));
        let touching = 10f64.powf(between(&mut random, -7.0, -4.0));
        let gap = if i % 2 == 0 { 0.02 } else { touching };
        let built = put_together(a, b, gap, &mut random);
        let found = ask(&built.case, None, Limits::default());
        let off = (found.gap - built.gap).abs() / built.case.size();
        capped += usize::from(found.capped);
        wrong.unless(found.gap <= built.gap + 1e-12, || format!("{i}: {found:?}"));
        wrong.unless(off < 1e-6 || found.capped, || {
            format!("{i}: off by {off:.1e}, {:?} {found:?}", built.case)
        });
        if found.gap > 0.0 {
            let upper = found.upper.expect("what is apart has a distance");
            wrong.unless(upper >= built.gap - 1e-12, || format!("{i}: {found:?}"));
            let width = (upper - found.gap) / built.case.size();
            wrong.unless(width <= 1e-7 || found.capped, || {
                format!("{i}: {width:.1e} wide, {:?} {found:?}", built.case)
            });
        }
    }
    wrong.unless(capped * 100 <= poses, || {
        format!("{capped} of {poses} poses did not end")
    });
    wrong.end();
}

/// Needles and plates 1:1000 in each other: no way out is shorter than the one that is answered by 1e-5 of the size, or
/// the answer says that there may be.
#[test]
fn needles_and_plates_in_each_other() {
    let mut wrong = Wrong::default();
    let mut random = Random(1001);
    let (mut capped, mut short) = (0, 0);
    let poses = 600;
    for i in 0..poses {
        let (a, b) = (needle_or_plate(&mut random), needle_or_plate(&mut random));
        let depth = 10f64.powf(between(&mut random, -6.0, -0.3));
        let built = put_together(a, b, -depth, &mut random);
        let best = slender::best(&built.case, &mut random);
        for iteration_cap in [20, 100] {
            let limits = Limits {
                iteration_cap,
                ..Limits::default()
            };
            let found = ask(&built.case, None, limits);
            let off = (best.gap - found.gap) / built.case.size();
            let name = || format!("{i}: {off:.1e} below {best:?}, {:?} {found:?}", built.case);
            wrong.unless(found.capped || off < 1e-5, name);
            wrong.unless(found.upper.is_none_or(|up| up >= best.gap - 1e-12), name);
            let proven = built.case.gap_along(found.normal);
            wrong.unless(found.gap <= proven + 1e-12, name);
            if iteration_cap == 20 {
                capped += usize::from(found.capped);
                short += usize::from(off >= 1e-5);
            }
        }
    }
    wrong.unless(capped * 5 <= poses && short * 50 <= poses, || {
        format!("of {poses} poses {capped} did not end, {short} of them too deep")
    });
    wrong.end();
}
