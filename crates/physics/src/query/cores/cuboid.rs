//! Boxes: eight corners, three great circles on which one coordinate of the support point jumps.

use glam::{DMat3, DVec3};

use super::{Circle, Core, SQUARE, Symmetric, Tip};

pub(in crate::query) struct CuboidCore {
    axes: [DVec3; 3],
    half: [f64; 3],
}

impl CuboidCore {
    pub fn new(rotation: &DMat3, half: DVec3) -> CuboidCore {
        CuboidCore {
            axes: [rotation.x_axis, rotation.y_axis, rotation.z_axis],
            half: half.to_array(),
        }
    }
}

impl Core for CuboidCore {
    const CIRCLES: usize = 3;
    const DISCS: bool = false;

    #[inline(always)]
    fn tip_held(&self, n: DVec3, held: u8, sides: u8) -> Tip {
        let above = |i: usize| u8::from(n.dot(self.axes[i]) > 0.0) << i;
        let natural = above(0) | above(1) | above(2);
        let sides = natural & !held | sides & held;
        let corner = |i: usize| {
            let half = if sides >> i & 1 == 1 {
                self.half[i]
            } else {
                -self.half[i]
            };
            self.axes[i] * half
        };
        Tip {
            point: corner(0) + corner(1) + corner(2),
            sides,
            inverse: 0.0,
        }
    }

    #[inline(always)]
    fn reach(&self, n: DVec3) -> f64 {
        let reach = |i: usize| n.dot(self.axes[i]).abs() * self.half[i];
        reach(0) + reach(1) + reach(2)
    }

    #[inline(always)]
    fn circle(&self, index: usize) -> Circle {
        Circle {
            axis: self.axes[index],
            height: 0.0,
            radius: 1.0,
            jump: 2.0 * self.half[index],
        }
    }

    #[cold]
    #[inline(never)]
    fn face_point(&self, n: DVec3, target: DVec3) -> DVec3 {
        let mut point = DVec3::ZERO;
        for (axis, half) in self.axes.into_iter().zip(self.half) {
            let slope = n.dot(axis);
            let along = if slope.abs() < SQUARE {
                target.dot(axis).clamp(-half, half)
            } else {
                half.copysign(slope)
            };
            point += axis * along;
        }
        point
    }

    fn extents(&self) -> Symmetric {
        let half = DVec3::from_array(self.half);
        let axes = DMat3::from_cols(self.axes[0], self.axes[1], self.axes[2]);
        // A box reaches farther than the ellipsoid in it, towards its corners.
        Symmetric::turned(&axes, half * half * 1.5)
    }

    fn size(&self) -> f64 {
        self.half[0].max(self.half[1]).max(self.half[2])
    }
}
