//! Geometry of one contact at the bodies' current poses, and impulses at it.

use glam::{DMat3, DVec3};

use super::pairs::Key;
use crate::body::Body;
use crate::compound::Part;
use crate::pose::Pose;
use crate::query::{self, Limits, Placed, Separation};
use crate::response::{Coefficients, Response, compliance};
use crate::shape::Kind;
use crate::world::World;

/// Rise of a flat base across its width up to which it counts as parallel to the face below [m].
const PARALLEL: f64 = 2e-6;

/// Tilt of a flat base up to which its edge presses on an arc rather than on a point [rad]: a pin tips at 0.17.
const ON_EDGE: f64 = 0.2;

/// Overlap in which the way out is looked for again, and not along the face that showed it last [m].
const DEEP: f64 = 1e-3;

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

/// A contact between two parts at the bodies' current poses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    pub key: Key,
    pub a: usize,
    pub b: usize,
    /// Unit normal from a to b.
    pub normal: DVec3,
    pub gap: f64,
    pub point: DVec3,
    pub arm_a: DVec3,
    pub arm_b: DVec3,
    pub base: Option<Base>,
    /// Whether it is a flat base, lying or a little tilted, on a flat face: friction then also takes the turn on it.
    pub on_base: bool,
}

/// A pose with its rotation as a matrix, from which parts are placed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    rotation: DMat3,
    position: DVec3,
}

impl Frame {
    pub fn new(pose: &Pose) -> Frame {
        Frame {
            rotation: DMat3::from_quat(pose.rotation),
            position: pose.position,
        }
    }

    /// A part of the body whose pose this is.
    pub fn place<'a>(&self, part: &'a Part) -> Placed<'a> {
        Placed {
            shape: &part.shape,
            rotation: if part.is_square {
                self.rotation
            } else {
                self.rotation * part.rotation
            },
            position: self.position + self.rotation * part.pose.position,
        }
    }
}

/// A part of a body at a pose.
pub(crate) fn place<'a>(part: &'a Part, pose: &Pose) -> Placed<'a> {
    Frame::new(pose).place(part)
}

impl Touch {
    pub fn set_point(&mut self, point: DVec3, bodies: &[Body]) {
        self.point = point;
        self.arm_a = point - bodies[self.a].position;
        self.arm_b = point - bodies[self.b].position;
    }

    /// Velocity of a's contact point relative to b's, Eq. (8) [m/s].
    pub fn slip(&self, bodies: &[Body]) -> DVec3 {
        let (a, b) = (&bodies[self.a], &bodies[self.b]);
        a.linear_now() + a.angular_velocity().cross(self.arm_a)
            - b.linear_now()
            - b.angular_velocity().cross(self.arm_b)
    }

    /// `K`, the change of the slip per impulse.
    pub fn compliance(&self, bodies: &[Body]) -> DMat3 {
        let (a, b) = (&bodies[self.a], &bodies[self.b]);
        let mut k = DMat3::ZERO;
        if a.is_dynamic() {
            k += compliance(a.inv_mass(), &a.inv_inertia(), self.arm_a);
        }
        if b.is_dynamic() {
            k += compliance(b.inv_mass(), &b.inv_inertia(), self.arm_b);
        }
        k
    }

    /// Applies `impulse` to a and its opposite to b.
    pub fn push(&self, bodies: &mut [Body], impulse: DVec3) {
        bodies[self.a].push(self.arm_a, impulse);
        bodies[self.b].push(self.arm_b, -impulse);
    }
}

impl World {
    /// A pair's coefficients: products of the objects' (§2.2), or Coulomb's from his table.
    pub(crate) fn coefficients(&self, a: usize, b: usize) -> Coefficients {
        let (a, b) = (&self.bodies[a].material, &self.bodies[b].material);
        if self.settings.response == Response::Coulomb {
            let pair = self.contacts.get(a.surface, b.surface);
            return Coefficients {
                elasticity: pair.restitution,
                friction: pair.friction,
            };
        }
        Coefficients {
            elasticity: a.elasticity * b.elasticity,
            friction: a.friction_rate * b.friction_rate,
        }
    }

    pub(crate) fn limits(&self) -> Limits {
        Limits {
            iteration_cap: self.settings.iteration_cap,
            ..Limits::default()
        }
    }

    /// Exact search between two parts at given poses.
    pub(crate) fn search(&self, a: &Placed, b: &Placed, normal: DVec3) -> Separation {
        if let Some(answer) = query::on_face(a, b, normal)
            && answer.gap > -DEEP
        {
            return answer;
        }
        let start = (normal != DVec3::ZERO).then_some(normal);
        query::separation_placed(a, b, start, self.limits())
    }

    /// The contact `key` at the bodies' current poses; remembers its normal.
    pub(crate) fn touch(&mut self, key: Key) -> Touch {
        let (a, b) = (key.a as usize, key.b as usize);
        let (body_a, body_b) = (&self.bodies[a], &self.bodies[b]);
        let ways = (body_a.path, body_b.path);
        if let Some(touch) = self.pairs.seen(key, ways) {
            return touch;
        }
        let known = self.pairs.part(key);
        let part_a = &body_a.compound.parts()[known.part_a as usize];
        let part_b = &body_b.compound.parts()[known.part_b as usize];
        let (placed_a, placed_b) = (place(part_a, &body_a.pose()), place(part_b, &body_b.pose()));
        let found = self.search(&placed_a, &placed_b, known.normal);
        let base = base(&placed_a, &placed_b, found.normal);
        let mut touch = Touch {
            key,
            a,
            b,
            normal: found.normal,
            gap: found.gap,
            point: DVec3::ZERO,
            arm_a: DVec3::ZERO,
            arm_b: DVec3::ZERO,
            base,
            on_base: base.is_some() || is_on_edge(&placed_a, &placed_b, found.normal),
        };
        touch.set_point((found.point_a + found.point_b) * 0.5, &self.bodies);
        self.pairs.part_mut(key).normal = found.normal;
        self.pairs.remember(key, ways, touch);
        touch
    }
}

/// The flat base of one shape on a flat face of the other, if they are parallel under `normal`.
fn base(a: &Placed, b: &Placed, normal: DVec3) -> Option<Base> {
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

/// Whether the edge of one shape's flat base, a little tilted, stands on a flat face of the other.
fn is_on_edge(a: &Placed, b: &Placed, normal: DVec3) -> bool {
    let (round, down) = match (is_flat(b), is_flat(a)) {
        (Some(_), _) if has_disc(a) => (a, normal),
        (_, Some(_)) if has_disc(b) => (b, -normal),
        _ => return false,
    };
    let piece = round.shape.tip(round.local(down)).piece;
    let Some(sense) = round.shape.pole(piece) else {
        return false;
    };
    let axis = round.rotation.y_axis * sense;
    axis.dot(down) > 0.0 && axis.cross(down).length() < ON_EDGE
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
