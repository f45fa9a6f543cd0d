//! Convex parametric primitives, validated once when they are made.
//!
//! A shape is its sizes and what follows from them once and for all; `query::cores` puts it into a frame for the
//! detection.

use std::sync::Arc;

use glam::DVec3;
use thiserror::Error;

use crate::hull::Hull;

/// A size that no shape can have.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ShapeError {
    /// A length was zero, negative or not finite.
    #[error("{shape}: {name} must be a positive, finite length in metres, not {value}")]
    BadLength {
        /// Which constructor refused.
        shape: &'static str,
        /// Which argument.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// The plane of a truncated ellipsoid misses the ellipsoid or takes its centre away.
    #[error(
        "truncated ellipsoid: the cut must lie between -{semi_axis} m and 0 m below the centre, not at {cut} m"
    )]
    BadCut {
        /// Height of the cut that was given [m].
        cut: f64,
        /// Vertical semi-axis [m].
        semi_axis: f64,
    },
    /// A half-space needs a direction.
    #[error("half-space: the normal must be a finite, non-zero vector, not {0}")]
    BadNormal(DVec3),
    /// A cloud without points has no hull.
    #[error("vertex cloud: at least one point is needed")]
    NoPoints,
    /// A point of a cloud was not finite.
    #[error("vertex cloud: point {index} is not finite: {point}")]
    BadPoint {
        /// Which point, from 0.
        index: usize,
        /// What was given [m].
        point: DVec3,
    },
    /// A compound without parts has no surface.
    #[error("a compound needs at least one part")]
    NoParts,
    /// A part's pose was not finite.
    #[error("compound: the pose of part {0} is not finite")]
    BadPose(usize),
    /// More parts than a body can have.
    #[error("compound: {0} parts; at most 255 are possible")]
    TooManyParts(usize),
}

/// A convex primitive in its own frame; the axis of revolution, where there is one, is y.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    pub(crate) kind: Kind,
    /// Radius of the smallest ball about the origin that holds the shape [m].
    radius: f64,
}

/// Two coaxial discs at heights on the y axis, of which a frustum is the hull; radii of zero make a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Profile {
    /// Radii of the lower and the upper disc [m].
    pub radius: [f64; 2],
    /// Their heights [m].
    pub height: [f64; 2],
    /// Unit normal of the mantle: across the axis and along it.
    pub mantle: (f64, f64),
    /// Length of the mantle from disc to disc [m].
    pub slant: f64,
}

impl Profile {
    pub fn new(bottom: f64, top: f64, half_height: f64) -> Profile {
        let (rise, widening) = (2.0 * half_height, top - bottom);
        let slant = (rise * rise + widening * widening).sqrt();
        Profile {
            radius: [bottom, top],
            height: [-half_height, half_height],
            mantle: (rise / slant, -widening / slant),
            slant,
        }
    }

    pub fn half_height(&self) -> f64 {
        self.height[1]
    }
}

/// The closed set of primitives, with sizes in metres that the constructors have checked.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Kind {
    Sphere {
        radius: f64,
    },
    Ellipsoid {
        semi: DVec3,
    },
    /// The part of the ellipsoid with y >= cut; `rim` are the semi-axes of the ellipse that the cut leaves.
    TruncatedEllipsoid {
        semi: DVec3,
        cut: f64,
        rim: DVec3,
    },
    Capsule {
        radius: f64,
        segment: Profile,
    },
    /// Hull of two discs: cylinder, cone, frustum.
    Frustum(Profile),
    Cuboid {
        half: DVec3,
    },
    /// All points with `normal . p <= 0`.
    HalfSpace {
        normal: DVec3,
    },
    Cloud(Arc<Hull>),
}

fn length(shape: &'static str, name: &'static str, value: f64) -> Result<f64, ShapeError> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(ShapeError::BadLength { shape, name, value })
    }
}

fn lengths(shape: &'static str, names: [&'static str; 3], v: DVec3) -> Result<DVec3, ShapeError> {
    length(shape, names[0], v.x)?;
    length(shape, names[1], v.y)?;
    length(shape, names[2], v.z)?;
    Ok(v)
}

impl Shape {
    fn new(kind: Kind) -> Shape {
        let radius = bounding_radius(&kind);
        Shape { kind, radius }
    }

    /// A ball of `radius` [m] about the origin.
    ///
    /// # Errors
    /// `ShapeError::BadLength` on a radius that is not positive and finite.
    pub fn sphere(radius: f64) -> Result<Shape, ShapeError> {
        let radius = length("sphere", "radius", radius)?;
        Ok(Shape::new(Kind::Sphere { radius }))
    }

    /// An ellipsoid about the origin with semi-axes along x, y and z [m].
    ///
    /// # Errors
    /// `ShapeError::BadLength` on a semi-axis that is not positive and finite.
    pub fn ellipsoid(semi: DVec3) -> Result<Shape, ShapeError> {
        let semi = lengths(
            "ellipsoid",
            ["semi-axis x", "semi-axis y", "semi-axis z"],
            semi,
        )?;
        Ok(Shape::new(Kind::Ellipsoid { semi }))
    }

    /// An ellipsoid about the origin of which only the part with y >= `cut` [m] is left, -semi.y < `cut` < 0.
    ///
    /// A pin that is one ellipsoid stands on the flat that the cut leaves. Flat and ellipsoid share their rim and
    /// are one convex body with a continuous support point, so there is no seam for a contact to jump across.
    ///
    /// # Errors
    /// `ShapeError::BadLength` on a bad semi-axis, `ShapeError::BadCut` on a plane outside that range.
    pub fn truncated_ellipsoid(semi: DVec3, cut: f64) -> Result<Shape, ShapeError> {
        let names = ["semi-axis x", "semi-axis y", "semi-axis z"];
        let semi = lengths("truncated ellipsoid", names, semi)?;
        if !(cut > -semi.y && cut < 0.0) {
            return Err(ShapeError::BadCut {
                cut,
                semi_axis: semi.y,
            });
        }
        let shrink = (1.0 - (cut / semi.y) * (cut / semi.y)).sqrt();
        let rim = DVec3::new(semi.x * shrink, 0.0, semi.z * shrink);
        Ok(Shape::new(Kind::TruncatedEllipsoid { semi, cut, rim }))
    }

    /// All points within `radius` [m] of the segment from y = -`half_height` to y = `half_height` [m].
    ///
    /// # Errors
    /// `ShapeError::BadLength` on a size that is not positive and finite.
    pub fn capsule(radius: f64, half_height: f64) -> Result<Shape, ShapeError> {
        let radius = length("capsule", "radius", radius)?;
        let half_height = length("capsule", "half height", half_height)?;
        Ok(Shape::new(Kind::Capsule {
            radius,
            segment: Profile::new(0.0, 0.0, half_height),
        }))
    }

    /// A cylinder about the origin: `radius` and `half_height` along y [m].
    ///
    /// # Errors
    /// `ShapeError::BadLength` on a size that is not positive and finite.
    pub fn cylinder(radius: f64, half_height: f64) -> Result<Shape, ShapeError> {
        let radius = length("cylinder", "radius", radius)?;
        let half_height = length("cylinder", "half height", half_height)?;
        let profile = Profile::new(radius, radius, half_height);
        Ok(Shape::new(Kind::Frustum(profile)))
    }

    /// A cone about the origin: a disc of `radius` at y = -`half_height`, the apex at y = `half_height` [m].
    ///
    /// # Errors
    /// `ShapeError::BadLength` on a size that is not positive and finite.
    pub fn cone(radius: f64, half_height: f64) -> Result<Shape, ShapeError> {
        let radius = length("cone", "radius", radius)?;
        let half_height = length("cone", "half height", half_height)?;
        let profile = Profile::new(radius, 0.0, half_height);
        Ok(Shape::new(Kind::Frustum(profile)))
    }

    /// A cone cut at both ends: radii at y = -`half_height` and y = `half_height` [m]; one of them may be zero.
    ///
    /// # Errors
    /// `ShapeError::BadLength` on a negative or non-finite radius, on two zero radii, or on a bad height.
    pub fn frustum(bottom: f64, top: f64, half_height: f64) -> Result<Shape, ShapeError> {
        let half_height = length("frustum", "half height", half_height)?;
        if bottom != 0.0 {
            length("frustum", "bottom radius", bottom)?;
        }
        if top != 0.0 || bottom == 0.0 {
            length("frustum", "top radius", top)?;
        }
        let profile = Profile::new(bottom, top, half_height);
        Ok(Shape::new(Kind::Frustum(profile)))
    }

    /// A box about the origin with half extents along x, y and z [m].
    ///
    /// # Errors
    /// `ShapeError::BadLength` on a half extent that is not positive and finite.
    pub fn cuboid(half: DVec3) -> Result<Shape, ShapeError> {
        let half = lengths(
            "cuboid",
            ["half extent x", "half extent y", "half extent z"],
            half,
        )?;
        Ok(Shape::new(Kind::Cuboid { half }))
    }

    /// Everything below the plane through the origin with this outward `normal` (any length).
    ///
    /// # Errors
    /// `ShapeError::BadNormal` on a zero or non-finite normal.
    pub fn half_space(normal: DVec3) -> Result<Shape, ShapeError> {
        match normal.try_normalize() {
            Some(normal) if normal.is_finite() => Ok(Shape::new(Kind::HalfSpace { normal })),
            _ => Err(ShapeError::BadNormal(normal)),
        }
    }

    /// The hull of a cloud of vertices [m]; any number of them may coincide or lie on one line or in one plane.
    ///
    /// Takes time in proportion to the square of their number.
    ///
    /// # Errors
    /// `ShapeError::NoPoints` without any, `ShapeError::BadPoint` on one that is not finite.
    pub fn cloud(points: &[DVec3]) -> Result<Shape, ShapeError> {
        if points.is_empty() {
            return Err(ShapeError::NoPoints);
        }
        if let Some(index) = points.iter().position(|p| !p.is_finite()) {
            let point = points[index];
            return Err(ShapeError::BadPoint { index, point });
        }
        Ok(Shape::new(Kind::Cloud(Arc::new(Hull::new(points)))))
    }

    /// Farthest point of the shape along `direction` (any length), in the shape's frame [m].
    ///
    /// It is the paper's "furthest surface position in the direction of the vector" (§2.1). A half-space has none
    /// except along its normal; there and everywhere it answers with its origin.
    pub fn support(&self, direction: DVec3) -> DVec3 {
        match direction.try_normalize() {
            Some(n) => self.tip(n).point,
            None => self.tip(DVec3::Y).point,
        }
    }

    /// Radius of the smallest ball about the origin that holds the shape [m]; infinite for a half-space.
    #[inline]
    pub fn bounding_radius(&self) -> f64 {
        self.radius
    }

    /// Length that tolerances are measured against [m]: the bounding radius where there is one.
    pub(crate) fn size(&self) -> f64 {
        if self.radius.is_finite() {
            self.radius
        } else {
            1.0
        }
    }

    /// Whether a turn about the shape's own y axis leaves it as it is.
    pub fn is_axisymmetric(&self) -> bool {
        match self.kind {
            Kind::Sphere { .. } | Kind::Capsule { .. } | Kind::Frustum(_) => true,
            Kind::Ellipsoid { semi } | Kind::TruncatedEllipsoid { semi, .. } => semi.x == semi.z,
            Kind::Cuboid { .. } | Kind::HalfSpace { .. } | Kind::Cloud(_) => false,
        }
    }
}

/// Radius of the smallest ball about the origin that holds the shape [m].
fn bounding_radius(kind: &Kind) -> f64 {
    match kind {
        Kind::Sphere { radius } => *radius,
        Kind::Ellipsoid { semi } | Kind::TruncatedEllipsoid { semi, .. } => semi.max_element(),
        Kind::Capsule { radius, segment } => radius + segment.half_height(),
        Kind::Frustum(profile) => {
            let (r, h) = (
                profile.radius[0].max(profile.radius[1]),
                profile.half_height(),
            );
            (r * r + h * h).sqrt()
        }
        Kind::Cuboid { half } => half.length(),
        Kind::HalfSpace { .. } => f64::INFINITY,
        Kind::Cloud(hull) => hull.corners.iter().map(|p| p.length()).fold(0.0, f64::max),
    }
}
