//! Sizes of any magnitude.

use glam::DVec3;
use physics::Pose;
use physics::query::Limits;

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
