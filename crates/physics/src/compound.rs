//! Bodies made of several convex parts.

use crate::pose::Pose;
use crate::shape::{Kind, Shape, ShapeError};
use glam::{DMat3, DQuat, DVec3};

/// What a turn of the body does to its surface; decides how far a spinning body can reach in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Symmetry {
    /// Every turn moves the surface.
    None,
    /// Turns about the body's y axis leave it in place (a pin).
    Axis,
    /// All turns do (a ball).
    Full,
}

/// One convex part with its pose in the body frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Shape, in the part's frame.
    pub shape: Shape,
    /// `body_from_part`; the body frame has its origin at the centre of mass.
    pub pose: Pose,
    pub(crate) rotation: DMat3,
    /// Whether the part is not turned in the body.
    pub(crate) is_square: bool,
    pub(crate) radius: f64,
}

/// A body's surface: convex parts fixed to each other. Two compounds touch where their parts do.
#[derive(Clone, Debug, PartialEq)]
pub struct Compound {
    parts: Vec<Part>,
    radius: f64,
    symmetry: Symmetry,
}

impl Compound {
    /// Puts parts together; poses are `body_from_part` with the body's centre of mass at the origin.
    ///
    /// # Errors
    /// Without parts, with more than 255, or with a pose that is not finite.
    pub fn new(parts: Vec<(Pose, Shape)>) -> Result<Compound, ShapeError> {
        if parts.is_empty() {
            return Err(ShapeError::NoParts);
        }
        if parts.len() > 255 {
            return Err(ShapeError::TooManyParts(parts.len()));
        }
        if let Some(bad) = parts.iter().position(|(pose, _)| !pose.is_finite()) {
            return Err(ShapeError::BadPose(bad));
        }
        let parts: Vec<Part> = parts
            .into_iter()
            .map(|(pose, shape)| Part {
                radius: shape.bounding_radius(),
                shape,
                pose,
                rotation: DMat3::from_quat(pose.rotation),
                is_square: pose.rotation == DQuat::IDENTITY,
            })
            .collect();
        let reach = |part: &Part| part.pose.position.length() + part.radius;
        let radius = parts.iter().map(reach).fold(0.0, f64::max);
        let symmetry = symmetry(&parts);
        Ok(Compound {
            parts,
            radius,
            symmetry,
        })
    }

    /// A body of one part whose frame is the body's own.
    pub fn single(shape: Shape) -> Compound {
        Compound::new(vec![(Pose::IDENTITY, shape)])
            .expect("one part at a finite pose is a compound")
    }

    /// The parts, in the order given; contacts number them so.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// Radius of a ball about the centre of mass that holds every part [m]; infinite with a half-space.
    pub fn bounding_radius(&self) -> f64 {
        self.radius
    }

    pub(crate) fn symmetry(&self) -> Symmetry {
        self.symmetry
    }
}

fn symmetry(parts: &[Part]) -> Symmetry {
    let centred = |p: &Part| p.pose.position == DVec3::ZERO;
    if parts
        .iter()
        .all(|p| centred(p) && matches!(p.shape.kind, Kind::Sphere { .. }))
    {
        return Symmetry::Full;
    }
    let on_axis = |p: &Part| p.pose.position.x == 0.0 && p.pose.position.z == 0.0;
    let round = |p: &Part| {
        let axis = p.pose.rotation * DVec3::Y;
        let along = axis.x == 0.0 && axis.z == 0.0;
        matches!(p.shape.kind, Kind::Sphere { .. }) || (p.shape.is_axisymmetric() && along)
    };
    if parts.iter().all(|p| on_axis(p) && round(p)) {
        Symmetry::Axis
    } else {
        Symmetry::None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compound_knows_its_symmetry_and_size() {
        let ball = Shape::sphere(0.1).unwrap();
        let disc = Shape::cylinder(0.1, 0.02).unwrap();
        let up = |y| Pose::from_position(DVec3::new(0.0, y, 0.0));
        assert_eq!(Compound::single(ball.clone()).symmetry(), Symmetry::Full);
        let pin = Compound::new(vec![(up(-0.1), disc), (up(0.2), ball.clone())]).unwrap();
        assert_eq!(pin.symmetry(), Symmetry::Axis);
        assert!((pin.bounding_radius() - 0.3).abs() < 1e-15);
        let aside = Compound::new(vec![(Pose::from_position(DVec3::X), ball)]).unwrap();
        assert_eq!(aside.symmetry(), Symmetry::None);
    }

    #[test]
    fn bad_compounds_are_refused() {
        let ball = Shape::sphere(0.1).unwrap();
        assert_eq!(Compound::new(vec![]), Err(ShapeError::NoParts));
        let lost = Pose::from_position(DVec3::new(f64::NAN, 0.0, 0.0));
        assert_eq!(
            Compound::new(vec![(lost, ball)]),
            Err(ShapeError::BadPose(0))
        );
    }
}
