//! The innermost formulas, written once for both precisions: what the physics crate would do in `f32`.

/// The formulas in one precision.
macro_rules! kernels {
    ($name:ident, $real:ident, $vector:ident, $matrix:ident, $about:literal) => {
        #[doc = $about]
        pub mod $name {
            use glam::{$matrix as Matrix, $vector as Vector};

            /// Its real numbers.
            pub type Real = $real;

            /// A support point and its derivative by the normal, of an ellipsoid with this square of semi-axes.
            fn tip(square: Matrix, n: Vector) -> (Vector, Matrix) {
                let stretched = square * n;
                let height = n.dot(stretched).sqrt();
                let point = stretched / height;
                let outer = Matrix::from_cols(point * point.x, point * point.y, point * point.z);
                (point, (square - outer) * (1.0 / height))
            }

            /// Signed gap and normal of two ellipsoids by the second-order search on the sphere of normals.
            pub fn ellipsoids(squares: [Matrix; 2], between: Vector) -> (Real, Vector) {
                let gap = |n: Vector| {
                    let of = |square: Matrix| n.dot(square * n).sqrt();
                    n.dot(between) - of(squares[0]) - of(squares[1])
                };
                let mut n = between / between.length();
                let mut s = gap(n);
                for _ in 0..12 {
                    let ((a, of_a), (b, of_b)) = (tip(squares[0], n), tip(squares[1], n));
                    let d = between - a - b;
                    let (u, v) = n.any_orthonormal_pair();
                    let bend = of_a + of_b;
                    let (bu, bv) = (bend * u, bend * v);
                    let (uu, uv, vv) = (u.dot(bu) + s, u.dot(bv), v.dot(bv) + s);
                    let (gu, gv) = (u.dot(d), v.dot(d));
                    let determinant = uu * vv - uv * uv;
                    let step = u * ((vv * gu - uv * gv) / determinant)
                        + v * ((uu * gv - uv * gu) / determinant);
                    let mut share: Real = 1.0;
                    let (before, mut moved) = (s, n);
                    while share > 1e-3 {
                        moved = n + step * share;
                        moved /= moved.length();
                        s = gap(moved);
                        if s >= before {
                            break;
                        }
                        share *= 0.5;
                    }
                    if s < before {
                        return (before, n);
                    }
                    n = moved;
                    if s == before {
                        break;
                    }
                }
                (s, n)
            }

            /// Distance of a point from a frustum about the y axis, with radii at the lower and the upper end.
            pub fn frustum(point: Vector, radii: [Real; 2], half: Real) -> Real {
                let across = (point.x * point.x + point.z * point.z).sqrt();
                let edge = |(r0, y0): (Real, Real), (r1, y1): (Real, Real)| {
                    let (dr, dy) = (r1 - r0, y1 - y0);
                    let along = ((across - r0) * dr + (point.y - y0) * dy) / (dr * dr + dy * dy);
                    let along = along.clamp(0.0, 1.0);
                    let (r, y) = (across - r0 - along * dr, point.y - y0 - along * dy);
                    (r * r + y * y).sqrt()
                };
                let (low, high) = ((radii[0], -half), (radii[1], half));
                let (below, above) = ((0.0, -half), (0.0, half));
                edge(below, low).min(edge(low, high)).min(edge(high, above))
            }

            /// Eq. (9) with F00, F10 = 2 F00 and F01, the elastic rough term left out.
            pub fn impulse(n: Vector, dv: Vector, k: Matrix, e: Real, mu: Real) -> Vector {
                let smooth = n * (-n.dot(dv) / n.dot(k * n)) * (1.0 + e);
                let rough = -(k.inverse() * dv);
                smooth * (1.0 - mu) + rough * mu
            }

            /// Where a body is after so many steps on its parabola.
            pub fn flight(
                from: Vector,
                velocity: Vector,
                gravity: Real,
                dt: Real,
                steps: u32,
            ) -> Vector {
                let (mut place, mut velocity) = (from, velocity);
                let fall = Vector::new(0.0, -gravity, 0.0);
                for _ in 0..steps {
                    place += velocity * dt + fall * (0.5 * dt * dt);
                    velocity += fall * dt;
                }
                place
            }
        }
    };
}

kernels!(double, f64, DVec3, DMat3, "In `f64`.");
kernels!(single, f32, Vec3, Mat3, "In `f32`.");
