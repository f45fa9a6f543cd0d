//! Flat round bases on flat faces: one contact over the whole patch, not points.

use glam::DVec3;

use crate::query::Placed;
use crate::shape::Kind;

/// Rise of a flat base across its width up to which it counts as parallel to the face below [m].
const PARALLEL: f64 = 5e-7;

/// How far hard surfaces yield where an edge presses [m].
const YIELD: f64 = 1e-6;

/// Largest height of the arc that presses, per radius: the load acts at the rim, and may not get outside the base by more.
const FLATTEST: f64 = 0.05;

/// Tilt of a flat base up to which its edge presses on an arc rather than on a point [rad]: a pin tips at 0.17.
const ON_EDGE: f64 = 0.2;

/// A flat round base that lies on a flat face: the contact is the whole patch, not a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Base {
    /// Whether the body with the base is `a`.
    pub of_a: bool,
    /// Unit normal from the face into the body with the base.
    pub up: DVec3,
    /// Middle of the base [m], world frame.
    pub centre: DVec3,
    pub radius: f64,
    /// The face, if it ends somewhere: its box.
    pub face: Option<Face>,
}

/// Face of a box: centre, two in-plane unit axes and half extents along them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    pub centre: DVec3,
    pub axes: [DVec3; 2],
    pub half: [f64; 2],
}

impl Base {
    /// The point of the patch (base within face) nearest to `target`, both [m] world frame.
    pub fn clamp(&self, target: DVec3) -> DVec3 {
        let mut point = target;
        for _ in 0..8 {
            let offset = point - self.centre;
            let flat = offset - self.up * self.up.dot(offset);
            let length = flat.length();
            let scale = if length > self.radius {
                self.radius / length
            } else {
                1.0
            };
            point = self.centre + flat * scale;
            let Some(face) = &self.face else { return point };
            let inside = face.clamp(point);
            if inside == point {
                return point;
            }
            point = inside;
        }
        point
    }

    /// The point of the base's plane under `point`.
    pub fn below(&self, point: DVec3) -> DVec3 {
        point - self.up * self.up.dot(point - self.centre)
    }

    /// Whether `point` lies in the patch.
    pub fn holds(&self, point: DVec3) -> bool {
        (self.clamp(point) - point).length_squared() < 1e-24
    }
}

impl Face {
    fn clamp(&self, point: DVec3) -> DVec3 {
        let offset = point - self.centre;
        let mut moved = point;
        for (axis, half) in self.axes.iter().zip(self.half) {
            let x = offset.dot(*axis);
            let excess = x - x.clamp(-half, half);
            if excess != 0.0 {
                moved -= *axis * excess;
            }
        }
        moved
    }
}

/// The flat base of one shape on a flat face of the other, if they are parallel under `normal`.
pub(crate) fn base(a: &Placed, b: &Placed, normal: DVec3) -> Option<Base> {
    let (of_a, round, flat, up) = match (is_flat(b), is_flat(a)) {
        (Some(_), _) if has_disc(a) => (true, a, b, -normal),
        (_, Some(_)) if has_disc(b) => (false, b, a, normal),
        _ => return None,
    };
    let face = is_flat(flat)?;
    let axis = round.rotation.y_axis;
    let below = axis.dot(up) > 0.0;
    let disc = round.shape.piece(u32::from(
        !below && matches!(round.shape.kind, Kind::Frustum(_)),
    ));
    let disc = match round.shape.kind {
        Kind::TruncatedEllipsoid { .. } if below => round.shape.piece(1),
        Kind::TruncatedEllipsoid { .. } => return None,
        _ => disc,
    };
    let (radius, tilt) = (disc.semi.x, axis.cross(up).length());
    if radius == 0.0 || disc.semi.x != disc.semi.z || 2.0 * radius * tilt > PARALLEL {
        return None;
    }
    let face = face_under(flat, face, up)?;
    let centre = round.position + round.rotation * disc.centre;
    Some(Base {
        of_a,
        up,
        centre,
        radius,
        face,
    })
}

/// Half the chord on which a flat base, a little tilted, stands on a flat face of the other shape [m], as a vector along
/// the face to where it stands; `None` if no base does.
///
/// All of the rim that comes as near to the face as surfaces yield presses there.
pub(crate) fn chord(a: &Placed, b: &Placed, normal: DVec3) -> Option<DVec3> {
    let (round, down) = match (is_flat(b), is_flat(a)) {
        (Some(_), _) if has_disc(a) => (a, normal),
        (_, Some(_)) if has_disc(b) => (b, -normal),
        _ => return None,
    };
    let piece = round.shape.tip(round.local(down)).piece;
    let axis = round.rotation.y_axis * round.shape.pole(piece)?;
    let upright = axis.dot(down);
    let outward = down * upright - axis;
    let tilt = outward.length();
    if upright <= 0.0 || tilt >= ON_EDGE {
        return None;
    }
    if tilt == 0.0 {
        return Some(DVec3::ZERO);
    }
    let radius = round.shape.piece(piece).semi.x;
    let rise = (YIELD / tilt).min(FLATTEST * radius);
    Some(outward * ((rise * (2.0 * radius - rise)).sqrt() / tilt))
}

fn has_disc(shape: &Placed) -> bool {
    matches!(
        shape.shape.kind,
        Kind::Frustum(_) | Kind::TruncatedEllipsoid { .. }
    )
}

/// Half extents where the shape has flat faces; `None` inside for a half-space.
fn is_flat(shape: &Placed) -> Option<Option<DVec3>> {
    match shape.shape.kind {
        Kind::Cuboid { half } => Some(Some(half)),
        Kind::HalfSpace { .. } => Some(None),
        _ => None,
    }
}

/// The face of `flat` with outward normal `up`; the outer `None` when `up` is on an edge or a corner.
fn face_under(flat: &Placed, half: Option<DVec3>, up: DVec3) -> Option<Option<Face>> {
    let Some(half) = half else { return Some(None) };
    let r = flat.rotation;
    let axes = [(r.x_axis, half.x), (r.y_axis, half.y), (r.z_axis, half.z)];
    let k = axes
        .iter()
        .position(|(axis, _)| axis.dot(up).abs() > 1.0 - 1e-12)?;
    let (axis, depth) = axes[k];
    let (first, second) = (axes[(k + 1) % 3], axes[(k + 2) % 3]);
    let centre = flat.position + axis * depth.copysign(axis.dot(up));
    let face = Face {
        centre,
        axes: [first.0, second.0],
        half: [first.1, second.1],
    };
    Some(Some(face))
}
