//! The time of impact: two fast, spinning bodies meet where and when the oracle says.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use physics::{
    BodyDef, Compound, Effect, Effects, MassProperties, Material, Motion, Pose, Settings, World,
};

use crate::Wrong;
use crate::judge::cases::{self, Case, Class, between, direction, random_shape, rotation};
use crate::judge::known::Known;
use crate::judge::oracle::{Best, Oracle};
use crate::judge::verdict::angle;

/// A body that nothing pulls on: its turn goes on evenly, because its inertia is the same about all axes.
struct Flight {
    shape: Known,
    pose: Pose,
    velocity: DVec3,
    spin: DVec3,
}

impl Flight {
    fn pose_at(&self, t: f64) -> Pose {
        Pose::new(
            self.pose.position + self.velocity * t,
            DQuat::from_scaled_axis(self.spin * t) * self.pose.rotation,
        )
    }

    fn body(&self) -> BodyDef {
        BodyDef {
            compound: Arc::new(Compound::single(self.shape.shape())),
            motion: Motion::Dynamic,
            mass: MassProperties {
                mass: 2.0,
                inertia: DVec3::splat(0.3),
            },
            material: Material {
                elasticity: 1.0,
                friction_rate: 0.0,
                surface: Default::default(),
            },
            pose: self.pose,
            linear_velocity: self.velocity,
            angular_velocity: self.spin,
            drag_area_m2: 0.0,
        }
    }
}

fn at(a: &Flight, b: &Flight, t: f64) -> Case {
    Case {
        a: a.shape.clone(),
        pose_a: a.pose_at(t),
        b: b.shape.clone(),
        pose_b: b.pose_at(t),
    }
}

/// Advances by what the gap allows at the largest speed that any two points can have, until there is no gap.
fn first_touch(a: &Flight, b: &Flight, oracle: &Oracle) -> Option<(f64, Best)> {
    let turning = a.spin.length() * a.shape.radius() + b.spin.length() * b.shape.radius();
    let fastest = (b.velocity - a.velocity).length() + turning;
    let mut t = 0.0;
    for _ in 0..2000 {
        let best = oracle.best(&at(a, b, t));
        if best.gap < 1e-9 {
            return Some((t, best));
        }
        t += best.gap / fastest;
        if t * fastest > 20.0 {
            return None;
        }
    }
    None
}

#[test]
fn fast_bodies_meet_within_a_micrometre_of_where_they_should() {
    let oracle = Oracle::new(600, 4);
    let mut wrong = Wrong::default();
    for (i, pair) in cases::all_pairs().into_iter().enumerate() {
        if pair.0 == "plane" {
            continue;
        }
        let speed = [8.0, 20.0, 50.0, 100.0][i % 4];
        let mut random = cases::random(97, pair, Class::Far);
        let towards = direction(&mut random);
        let aside = direction(&mut random) * 0.2;
        let mut fly = |kind: &str, position: DVec3, velocity: DVec3| Flight {
            shape: random_shape(kind, &mut random),
            pose: Pose::new(position, rotation(&mut random)),
            velocity,
            spin: direction(&mut random) * between(&mut random, 0.0, 50.0),
        };
        let a = fly(pair.0, DVec3::ZERO, towards * 0.4 * speed);
        let b = fly(pair.1, towards * 3.0 + aside, towards * -0.6 * speed);
        let touch = first_touch(&a, &b, &oracle);

        let mut world = World::new(Settings {
            gravity: DVec3::ZERO,
            effects: Effects::default().without(Effect::Sleeping),
            ..Settings::default()
        })
        .expect("the settings are valid");
        world.add(a.body());
        world.add(b.body());
        while world.impacts().is_empty() && world.time() * speed < 10.0 {
            world.step();
        }
        let impact = world.impacts().first().copied();
        let Some((t, Best { normal, .. })) = touch else {
            wrong.unless(impact.is_none(), || {
                format!("{pair:?}: no impact was due: {impact:?}")
            });
            continue;
        };
        let Some(impact) = impact else {
            wrong.unless(false, || format!("{pair:?}: missed an impact at {t} s"));
            continue;
        };
        // Both tangent planes at the true time go through the point, if it is the true time's.
        let plane = |body: &Flight, n: DVec3| {
            let pose = body.pose_at(t);
            n.dot(impact.point - pose.position) - body.shape.height(pose.rotation.conjugate() * n)
        };
        let (off_a, off_b) = (plane(&a, normal), plane(&b, -normal));
        wrong.unless(off_a.abs() < 1e-6 && off_b.abs() < 1e-6, || {
            format!("{pair:?} at {speed} m/s: {off_a:.1e}, {off_b:.1e} m off: {impact:?}")
        });
        let turned = angle(impact.normal, normal);
        wrong.unless(turned < 1e-3, || {
            format!("{pair:?} at {speed} m/s: normal {turned:.1e} rad off")
        });
    }
    wrong.end();
}
