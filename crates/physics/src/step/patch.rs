//! Faces and lines that two bodies share: up to four points that carry, and the one at which an impact acts.

use glam::DVec3;

use super::touch::Touch;
use crate::body::Body;
use crate::query::{Placed, Separation, manifold_placed};
use crate::shape::Kind;

/// One point of a patch.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spot {
    /// World frame [m].
    pub point: DVec3,
    /// Gap between the surfaces there [m].
    pub gap: f64,
}

/// The ends of a line, or the corners of a face in their order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch {
    spots: [Spot; 4],
    count: u8,
}

impl Patch {
    pub fn spots(&self) -> &[Spot] {
        &self.spots[..usize::from(self.count)]
    }

    /// The point of the line or face nearest to `target`, both [m] world frame, `n` being its normal.
    fn clamp(&self, target: DVec3, n: DVec3) -> DVec3 {
        let spots = self.spots();
        let flat = target - n * n.dot(target - spots[0].point);
        let mut nearest = spots[0].point;
        let mut sides = (false, false);
        for (i, spot) in spots.iter().enumerate() {
            let next = spots[(i + 1) % spots.len()].point;
            let edge = next - spot.point;
            let offset = flat - spot.point;
            let share = offset.dot(edge) / edge.length_squared();
            let point = spot.point + edge * share.clamp(0.0, 1.0);
            if flat.distance_squared(point) < flat.distance_squared(nearest) {
                nearest = point;
            }
            if n.dot(edge.cross(offset)) > 0.0 {
                sides.0 = true;
            } else {
                sides.1 = true;
            }
        }
        let inside = spots.len() > 2 && !(sides.0 && sides.1);
        if inside { flat } else { nearest }
    }
}

/// The patch that two shapes share, if it is more than a point.
pub(crate) fn patch(a: &Placed, b: &Placed, found: &Separation) -> Option<Patch> {
    let curved = |s: &Placed| matches!(s.shape.kind, Kind::Sphere { .. } | Kind::Ellipsoid { .. });
    if curved(a) || curved(b) {
        return None;
    }
    let shared = manifold_placed(a, b, found);
    if shared.points().len() < 2 {
        return None;
    }
    let mut patch = Patch {
        spots: [Spot::default(); 4],
        count: shared.points().len() as u8,
    };
    for (spot, point) in patch.spots.iter_mut().zip(shared.points()) {
        (spot.point, spot.gap) = (point.point, -point.depth);
    }
    Some(patch)
}

/// Where a patch takes an impact [m]: where one impulse stops, or reflects, all of it at once if there is such a place.
///
/// The impulse `m v` along the normal has to take the angular momentum across it along, which decides its lever; at
/// the rim of the patch the body tips. Between two bodies that both move it is the middle of what approaches.
pub(crate) fn strike_point(touch: &Touch, patch: &Patch, bodies: &[Body]) -> DVec3 {
    let (a, b) = (&bodies[touch.a], &bodies[touch.b]);
    let n = touch.normal;
    let approach = |point: DVec3| n.dot(a.velocity_at(point) - b.velocity_at(point));
    let fastest = || {
        let spots = patch.spots().iter().map(|spot| spot.point);
        let worst = spots.max_by(|p, q| approach(*p).total_cmp(&approach(*q)));
        worst.unwrap_or(touch.point)
    };
    let point = match (a.is_dynamic(), b.is_dynamic()) {
        (true, true) => {
            let mut sum = (DVec3::ZERO, 0.0);
            for spot in patch.spots() {
                let speed = approach(spot.point).max(0.0);
                sum = (sum.0 + spot.point * speed, sum.1 + speed);
            }
            if sum.1 == 0.0 {
                return fastest();
            }
            sum.0 / sum.1
        }
        (a_moves, _) => {
            let (body, ground, up) = if a_moves { (a, b, -n) } else { (b, a, n) };
            let momentum = body.momentum_now();
            let across = momentum - up * up.dot(momentum);
            let closing = -up.dot(body.linear_now() - ground.velocity_at(touch.point));
            let lever = if closing > 0.0 {
                up.cross(across) / (body.mass.mass * closing)
            } else {
                up.cross(across).normalize_or_zero() * 1e3
            };
            patch.clamp(body.position - lever, up)
        }
    };
    if approach(point) > 0.0 {
        point
    } else {
        fastest()
    }
}
