//! Support points: the farthest point along a normal, which piece it lies on, and how it moves with the normal.
//!
//! A *piece* is `centre + diag(semi) u` for unit `u`: an ellipsoid, a flat elliptic disc (one semi-axis zero) or a
//! point (all zero). Its support height `n.centre + |semi n|`, its support point and the derivative of that point
//! by the normal have one closed form each, so sphere, ellipsoid, rim and corner need no code of their own.

use glam::DVec3;

use crate::shape::{Kind, Shape};

/// The farthest point along a normal and the piece that it lies on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tip {
    pub point: DVec3,
    pub piece: u32,
}

/// One smooth part of a shape's boundary: centre and semi-axes in the shape's frame [m].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub centre: DVec3,
    pub semi: DVec3,
}

impl Piece {
    fn point_only(centre: DVec3) -> Piece {
        Piece {
            centre,
            semi: DVec3::ZERO,
        }
    }

    /// Support point along the unit normal `n`. At the pole of a disc, where every point is as far, its centre.
    pub fn point(&self, n: DVec3) -> DVec3 {
        let stretched = self.semi * n;
        let h = stretched.length();
        if h > 1e-30 {
            self.centre + self.semi * stretched / h
        } else {
            self.centre
        }
    }

    /// Derivative of the support point by the normal, applied to the tangent vector `t` [m].
    ///
    /// `(A^2 t - q (q.t)) / h` with `q` the support point from the centre and `h = |A n|`.
    pub fn curvature(&self, n: DVec3, t: DVec3) -> DVec3 {
        let h = (self.semi * n).length();
        if h <= 1e-30 {
            return DVec3::ZERO;
        }
        let square = self.semi * self.semi;
        let q = square * n / h;
        (square * t - q * q.dot(t)) / h
    }
}

impl Shape {
    /// The piece with number `piece`.
    pub(crate) fn piece(&self, piece: u32) -> Piece {
        match self.kind {
            Kind::Sphere { radius } => Piece {
                centre: DVec3::ZERO,
                semi: DVec3::splat(radius),
            },
            Kind::Ellipsoid { semi } => Piece {
                centre: DVec3::ZERO,
                semi,
            },
            Kind::TruncatedEllipsoid { semi, cut, rim } => {
                if piece == 0 {
                    Piece {
                        centre: DVec3::ZERO,
                        semi,
                    }
                } else {
                    Piece {
                        centre: DVec3::new(0.0, cut, 0.0),
                        semi: rim,
                    }
                }
            }
            Kind::Capsule { radius, segment } => Piece {
                centre: DVec3::new(0.0, segment.height[piece as usize], 0.0),
                semi: DVec3::splat(radius),
            },
            Kind::Frustum(profile) => {
                let r = profile.radius[piece as usize];
                Piece {
                    centre: DVec3::new(0.0, profile.height[piece as usize], 0.0),
                    semi: DVec3::new(r, 0.0, r),
                }
            }
            Kind::Cuboid { half } => {
                let sign = |bit: u32, h: f64| if piece >> bit & 1 == 1 { h } else { -h };
                Piece::point_only(DVec3::new(
                    sign(0, half.x),
                    sign(1, half.y),
                    sign(2, half.z),
                ))
            }
            Kind::HalfSpace { .. } => Piece::point_only(DVec3::ZERO),
            Kind::Cloud(ref hull) => Piece::point_only(hull.corners[piece as usize]),
        }
    }

    /// Sense along y of the axis of a flat round piece, where all of its points are equally far.
    pub(crate) fn pole(&self, piece: u32) -> Option<f64> {
        match (&self.kind, piece) {
            (Kind::Frustum(profile), 0) if profile.radius[0] > 0.0 => Some(-1.0),
            (Kind::Frustum(profile), 1) if profile.radius[1] > 0.0 => Some(1.0),
            (Kind::TruncatedEllipsoid { .. }, 1) => Some(-1.0),
            _ => None,
        }
    }

    /// The piece that the search should follow from `piece` at the normal `n`.
    ///
    /// The two pieces of a truncated ellipsoid are not rivals of which the farther counts: they join smoothly, and
    /// only the one in charge at n may be used there. All others keep their piece.
    pub(crate) fn piece_in_charge(&self, piece: u32, n: DVec3) -> u32 {
        match self.kind {
            Kind::TruncatedEllipsoid { .. } => self.tip(n).piece,
            _ => piece,
        }
    }

    /// Support point along the unit normal `n` with its piece.
    ///
    /// The piece is decided once and the point computed from that very decision: two comparisons that round
    /// differently would let a point and its piece disagree on an edge.
    pub(crate) fn tip(&self, n: DVec3) -> Tip {
        let piece = match self.kind {
            Kind::Sphere { .. } | Kind::Ellipsoid { .. } | Kind::HalfSpace { .. } => 0,
            Kind::TruncatedEllipsoid { semi, cut, .. } => {
                // Beyond the cut the farthest point left is on the rim. The two points meet there: no kink.
                let stretched = semi * n;
                u32::from(semi.y * stretched.y < cut * stretched.length())
            }
            Kind::Capsule { .. } => u32::from(n.y > 0.0),
            Kind::Frustum(profile) => {
                let across = (n.x * n.x + n.z * n.z).sqrt();
                u32::from(profile.mantle.0 * n.y > profile.mantle.1 * across)
            }
            Kind::Cuboid { .. } => {
                u32::from(n.x > 0.0) | u32::from(n.y > 0.0) << 1 | u32::from(n.z > 0.0) << 2
            }
            Kind::Cloud(ref hull) => hull.farthest(n) as u32,
        };
        Tip {
            point: self.piece(piece).point(n),
            piece,
        }
    }

    /// Point nearest to `target` among all points of the shape that are (almost) farthest along `n`.
    ///
    /// Where the shape is flat or straight under `n` that is a whole face, disc or line; elsewhere the support
    /// point. `slack` [rad] decides what counts as flat.
    pub(crate) fn face_point(&self, n: DVec3, target: DVec3, slack: f64) -> DVec3 {
        match self.kind {
            Kind::Cuboid { half } => {
                let along = |n: f64, h: f64, t: f64| {
                    if n.abs() <= slack {
                        t.clamp(-h, h)
                    } else {
                        h.copysign(n)
                    }
                };
                DVec3::new(
                    along(n.x, half.x, target.x),
                    along(n.y, half.y, target.y),
                    along(n.z, half.z, target.z),
                )
            }
            Kind::Frustum(profile) => {
                let across = (n.x * n.x + n.z * n.z).sqrt();
                if across <= slack {
                    return self.disc_point(u32::from(n.y > 0.0), target);
                }
                let slope = profile.mantle.0 * n.y - profile.mantle.1 * across;
                if slope.abs() <= slack {
                    let (p, q) = (self.piece(0).point(n), self.piece(1).point(n));
                    let along =
                        ((target - p).dot(q - p) / (q - p).length_squared()).clamp(0.0, 1.0);
                    return p + (q - p) * along;
                }
                self.piece(u32::from(slope > 0.0)).point(n)
            }
            Kind::TruncatedEllipsoid { .. } => {
                let across = (n.x * n.x + n.z * n.z).sqrt();
                if n.y < 0.0 && across <= slack {
                    self.disc_point(1, target)
                } else {
                    self.tip(n).point
                }
            }
            Kind::Capsule { radius, segment } => {
                if n.y.abs() <= slack {
                    let y = target.y.clamp(segment.height[0], segment.height[1]);
                    n * radius + DVec3::Y * y
                } else {
                    self.tip(n).point
                }
            }
            Kind::HalfSpace { normal } => target - normal * normal.dot(target),
            Kind::Cloud(ref hull) => {
                let points = &hull.corners;
                let top = n.dot(points[hull.farthest(n)]);
                let floor = top - slack * self.size();
                nearest_in_hull(
                    points.iter().copied().filter(|p| n.dot(*p) >= floor),
                    target,
                )
            }
            Kind::Sphere { .. } | Kind::Ellipsoid { .. } => self.tip(n).point,
        }
    }

    /// Point of the flat end `piece` nearest to `target` (exact for round discs, radial for elliptic ones).
    fn disc_point(&self, piece: u32, target: DVec3) -> DVec3 {
        let disc = self.piece(piece);
        let mut offset = target - disc.centre;
        offset.y = 0.0;
        let mut scaled = DVec3::ZERO;
        if disc.semi.x > 0.0 && disc.semi.z > 0.0 {
            scaled = DVec3::new(offset.x / disc.semi.x, 0.0, offset.z / disc.semi.z);
        }
        let outside = scaled.length();
        if disc.semi.x == 0.0 {
            disc.centre
        } else if outside > 1.0 {
            disc.centre + offset / outside
        } else {
            disc.centre + offset
        }
    }
}

/// The point nearest to `target` in the hull of a few points that lie in one plane, on one line or at one place.
///
/// It is one of the points, or lies on a line between two, or within a triangle of three.
fn nearest_in_hull(points: impl Iterator<Item = DVec3> + Clone, target: DVec3) -> DVec3 {
    let mut best = (f64::INFINITY, target);
    let mut offer = |p: DVec3| {
        let square = (p - target).length_squared();
        if square < best.0 {
            best = (square, p);
        }
    };
    for (i, p) in points.clone().enumerate() {
        offer(p);
        for (j, q) in points.clone().enumerate().skip(i + 1) {
            let edge = q - p;
            let along = (target - p).dot(edge) / edge.length_squared();
            if (0.0..=1.0).contains(&along) {
                offer(p + edge * along);
            }
            for r in points.clone().skip(j + 1) {
                let (other, to) = (r - p, target - p);
                let normal = edge.cross(other);
                let square = normal.length_squared();
                let u = to.cross(other).dot(normal) / square;
                let v = edge.cross(to).dot(normal) / square;
                if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
                    offer(p + edge * u + other * v);
                }
            }
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shapes() -> Vec<Shape> {
        vec![
            Shape::sphere(0.3).unwrap(),
            Shape::ellipsoid(DVec3::new(0.2, 0.5, 0.3)).unwrap(),
            Shape::truncated_ellipsoid(DVec3::new(0.2, 0.5, 0.3), -0.35).unwrap(),
            Shape::capsule(0.2, 0.4).unwrap(),
            Shape::cylinder(0.3, 0.2).unwrap(),
            Shape::frustum(0.3, 0.1, 0.4).unwrap(),
            Shape::frustum(0.3, 0.0, 0.4).unwrap(),
            Shape::cuboid(DVec3::new(0.2, 0.3, 0.4)).unwrap(),
        ]
    }

    fn directions() -> Vec<DVec3> {
        let golden = 2.399_963_229_728_653;
        (0..400)
            .map(|i| {
                let y = 1.0 - 2.0 * (f64::from(i) + 0.5) / 400.0;
                let r = (1.0 - y * y).sqrt();
                let (s, c) = (golden * f64::from(i)).sin_cos();
                DVec3::new(r * c, y, r * s)
            })
            .chain([
                DVec3::X,
                DVec3::Y,
                DVec3::Z,
                -DVec3::X,
                -DVec3::Y,
                -DVec3::Z,
            ])
            .collect()
    }

    #[test]
    fn support_maximises_the_dot_product() {
        for shape in shapes() {
            let points: Vec<DVec3> = directions().iter().map(|n| shape.support(*n)).collect();
            for n in directions() {
                let best = n.dot(shape.support(n));
                for p in &points {
                    assert!(
                        n.dot(*p) <= best + 1e-14,
                        "{shape:?} along {n}: {p} beats the support"
                    );
                }
            }
        }
    }

    #[test]
    fn truncated_ellipsoid_support_never_lies_below_the_cut() {
        let shape = Shape::truncated_ellipsoid(DVec3::new(0.06, 0.2, 0.06), -0.18).unwrap();
        for n in directions() {
            assert!(shape.support(n).y >= -0.18 - 1e-15);
        }
        assert!((shape.support(DVec3::new(0.1, -1.0, 0.0)).y + 0.18).abs() < 1e-15);
    }

    #[test]
    fn curvature_is_the_derivative_of_the_support_point() {
        for shape in shapes() {
            for n in directions().into_iter().step_by(17) {
                let tip = shape.tip(n);
                let piece = shape.piece(tip.piece);
                let t = n.any_orthonormal_vector();
                let h = 1e-6;
                let ahead = piece.point((n + t * h).normalize_or(n));
                let behind = piece.point((n - t * h).normalize_or(n));
                let numeric = (ahead - behind) / (2.0 * h);
                let exact = piece.curvature(n, t);
                assert!(
                    (numeric - exact).length() < 1e-4 * (1.0 + exact.length()),
                    "{shape:?} {n}"
                );
            }
        }
    }

    #[test]
    fn bad_sizes_are_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Shape::sphere(bad).is_err());
            assert!(Shape::cylinder(bad, 1.0).is_err());
            assert!(Shape::cylinder(1.0, bad).is_err());
            assert!(Shape::capsule(bad, 1.0).is_err());
            assert!(Shape::cuboid(DVec3::new(1.0, bad, 1.0)).is_err());
            assert!(Shape::ellipsoid(DVec3::new(1.0, 1.0, bad)).is_err());
            assert!(Shape::truncated_ellipsoid(DVec3::new(bad, 1.0, 1.0), -0.5).is_err());
            assert!(Shape::half_space(DVec3::splat(bad)).is_err() || bad == -1.0);
        }
        assert!(Shape::frustum(0.0, 0.0, 1.0).is_err());
        assert!(Shape::frustum(-0.1, 1.0, 1.0).is_err());
        assert!(Shape::frustum(1.0, 0.0, 1.0).is_ok());
        for cut in [0.0, 0.2, -1.0, -2.0, f64::NAN] {
            assert!(Shape::truncated_ellipsoid(DVec3::ONE, cut).is_err());
        }
    }
}
