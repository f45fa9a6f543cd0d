//! The two shapes of a pin, from the numbers of the configuration. Body frame: origin at the centre of gravity, axis +y.

use glam::DVec3;
use physics::{Compound, MassProperties, Pose, Shape, ShapeError};

use crate::config::{ObjectShape, PinConfig};

/// The shape that a pin collides with.
///
/// # Errors
/// When a length is impossible, which a checked configuration has none of.
pub(crate) fn pin_compound(pin: &PinConfig, shape: ObjectShape) -> Result<Compound, ShapeError> {
    match shape {
        ObjectShape::True => true_shape(pin),
        ObjectShape::Ellipsoid => one_ellipsoid(pin),
    }
}

/// What a pin weighs, whichever shape it has: or changing the shape would change two things.
pub(crate) fn pin_mass(pin: &PinConfig) -> MassProperties {
    MassProperties {
        mass: pin.mass_kg,
        inertia: DVec3::new(
            pin.i_transverse_kgm2,
            pin.i_axial_kgm2,
            pin.i_transverse_kgm2,
        ),
    }
}

/// Five primitives: a cone for the foot with its flat base, the belly, two cones for the neck, the head.
fn true_shape(pin: &PinConfig) -> Result<Compound, ShapeError> {
    let parts = &pin.parts;
    let at = |height: f64| Pose::from_position(DVec3::Y * (height - pin.cg_height_m));
    let cone = |(low, low_radius): (f64, f64), (high, high_radius): (f64, f64)| {
        let shape = Shape::frustum(low_radius, high_radius, (high - low) / 2.0)?;
        Ok((at((low + high) / 2.0), shape))
    };
    let neck = (parts.neck_height_m, parts.neck_radius_m);
    let belly = DVec3::new(
        parts.belly_radius_m,
        parts.belly_half_length_m,
        parts.belly_radius_m,
    );
    Compound::new(vec![
        cone(
            (0.0, parts.base_radius_m),
            (parts.foot_height_m, parts.foot_radius_m),
        )?,
        (at(parts.belly_height_m), Shape::ellipsoid(belly)?),
        cone((parts.shoulder_height_m, parts.shoulder_radius_m), neck)?,
        cone(neck, (parts.throat_height_m, parts.throat_radius_m))?,
        (at(parts.head_height_m), Shape::sphere(parts.head_radius_m)?),
    ])
}

/// One ellipsoid, its top at the pin's top, cut flat at the pin's base: the experiment's pins were ellipsoids and stood.
fn one_ellipsoid(pin: &PinConfig) -> Result<Compound, ShapeError> {
    let ellipsoid = &pin.ellipsoid;
    let semi = DVec3::new(
        ellipsoid.radius_m,
        ellipsoid.half_length_m,
        ellipsoid.radius_m,
    );
    let middle = pin.height_m - ellipsoid.half_length_m;
    let shape = Shape::truncated_ellipsoid(semi, -middle)?;
    Compound::new(vec![(
        Pose::from_position(DVec3::Y * (middle - pin.cg_height_m)),
        shape,
    )])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::tests::default_config;

    /// Distance along `direction` from the centre of gravity to the tangent plane of a shape.
    fn extent(compound: &Compound, direction: DVec3) -> f64 {
        compound
            .parts()
            .iter()
            .map(|part| {
                let local = part.pose.rotation.inverse() * direction;
                part.pose
                    .transform_point(part.shape.support(local))
                    .dot(direction)
            })
            .fold(f64::MIN, f64::max)
    }

    /// Specification profile: height and radius [m].
    fn profile() -> Vec<(f64, f64)> {
        let rows = include_str!("../tests/data/pin_profile.csv")
            .lines()
            .skip(1);
        let number = |text: &str| text.parse::<f64>().unwrap();
        rows.map(|row| row.split_once(',').unwrap())
            .map(|(height, radius)| (number(height), number(radius)))
            .collect()
    }

    /// Radius of the composite at a height, from the same formulas that the shapes have.
    fn radius(pin: &PinConfig, height: f64) -> f64 {
        let parts = &pin.parts;
        let cone = |(low, r0): (f64, f64), (high, r1): (f64, f64)| {
            let inside = (low..=high).contains(&height);
            if inside {
                r0 + (r1 - r0) * (height - low) / (high - low)
            } else {
                0.0
            }
        };
        let round = |middle: f64, across: f64, along: f64| {
            across * (1.0 - ((height - middle) / along).powi(2)).max(0.0).sqrt()
        };
        let neck = (parts.neck_height_m, parts.neck_radius_m);
        [
            cone(
                (0.0, parts.base_radius_m),
                (parts.foot_height_m, parts.foot_radius_m),
            ),
            round(
                parts.belly_height_m,
                parts.belly_radius_m,
                parts.belly_half_length_m,
            ),
            cone((parts.shoulder_height_m, parts.shoulder_radius_m), neck),
            cone(neck, (parts.throat_height_m, parts.throat_radius_m)),
            round(
                parts.head_height_m,
                parts.head_radius_m,
                parts.head_radius_m,
            ),
        ]
        .into_iter()
        .fold(0.0, f64::max)
    }

    #[test]
    fn true_shape_keeps_to_the_specification_profile() {
        let pin = default_config().pin;
        let profile = profile();
        let mut worst = 0.0_f64;
        for near in profile.windows(3) {
            // Across the surface, not across the axis: the fillet's and the crown's radii change fast with height.
            let slope = DVec3::new(near[2].1 - near[0].1, near[2].0 - near[0].0, 0.0);
            let across = slope.y / slope.length();
            let (height, expected) = near[1];
            worst = worst.max((radius(&pin, height) - expected).abs() * across);
        }
        assert!(profile.len() > 100);
        assert!(worst < 2.5e-3, "{worst} m");
        assert!(worst > 1e-4, "the composite is not the profile itself");
    }

    #[test]
    fn both_shapes_are_as_tall_and_as_wide_and_stand_on_the_same_flat() {
        let pin = default_config().pin;
        for shape in [ObjectShape::True, ObjectShape::Ellipsoid] {
            let compound = pin_compound(&pin, shape).unwrap();
            assert!(
                (extent(&compound, DVec3::Y) - (pin.height_m - pin.cg_height_m)).abs() < 1e-4,
                "{shape:?}"
            );
            assert!(
                (extent(&compound, DVec3::NEG_Y) - pin.cg_height_m).abs() < 1e-9,
                "{shape:?}"
            );
            assert!(
                (extent(&compound, DVec3::X) - 0.0605).abs() < 3e-4,
                "{shape:?}"
            );
            // Just beyond the tip angle the base's rim is the lowest point: its radius follows from the extent.
            let lean = 0.01_f64;
            let down = DVec3::new(lean.sin(), -lean.cos(), 0.0);
            let rim = (extent(&compound, down) - pin.cg_height_m * lean.cos()) / lean.sin();
            assert!((rim - 0.0258).abs() < 1e-4, "{shape:?} {rim}");
        }
    }
}
