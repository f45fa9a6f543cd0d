use renderer::glam::{Mat4, Quat, Vec3};
use renderer::{Fov, Instance, Material, MeshData, RendererSettings, Scene, View};

use crate::support::*;

const MULTISAMPLED: RendererSettings = RendererSettings {
    samples: 4,
    shadow_size: 0,
    ..RendererSettings::FULL
};

/// A white dot as seen by `view`, which must not be far off its axis: a small quad facing +z.
fn dot_at(gpu: &renderer::Gpu, point: Vec3, view: View, size: [u32; 2]) -> [f64; 2] {
    let mut renderer = renderer(gpu, MULTISAMPLED);
    let quad = add(&mut renderer, &MeshData::quad(0.1, 0.1));
    let scene = Scene {
        instances: vec![instance(quad, Material::unlit([1.0; 3]), point)],
        ..dark()
    };
    centre_of_light(&one(&mut renderer, &scene, view, size))
}

#[test]
fn points_land_on_their_pixels_through_an_asymmetric_field() {
    // Tangents of the half angles; the picture plane is 1.6 wide and 1.2 high.
    let [left, right, up, down]: [f32; 4] = [-1.0, 0.6, 0.5, -0.7];
    let fov = Fov {
        left: left.atan(),
        right: right.atan(),
        up: up.atan(),
        down: down.atan(),
    };
    let view = View {
        position: Vec3::new(0.3, 1.6, 2.0),
        rotation: Quat::IDENTITY,
        fov,
    };
    on_each_driver(|gpu| {
        for (x, y) in [(-0.8, 0.0), (0.5, 0.0), (0.0, 0.4), (0.0, -0.6), (0.0, 0.0)] {
            let point = view.position + 2.0 * Vec3::new(x, y, -1.0);
            let seen = dot_at(gpu, point, view, [160, 120]);
            // By hand, not by the code under test: the share of the picture plane left of and above the point.
            let expected = [
                f64::from((x - left) / (right - left)) * 160.0,
                f64::from((up - y) / (up - down)) * 120.0,
            ];
            for axis in 0..2 {
                let off = (seen[axis] - expected[axis]).abs();
                assert!(off < 0.5, "({x}, {y}): {seen:?} instead of {expected:?}");
            }
        }
    });
}

#[test]
fn a_turned_head_sees_what_lies_there() {
    let fov = Fov::symmetric(1.0, 1.0);
    on_each_driver(|gpu| {
        let mut renderer = renderer(gpu, PLAIN);
        let cube = add(&mut renderer, &MeshData::cuboid(Vec3::splat(0.2)));
        let scene = Scene {
            instances: vec![instance(cube, Material::unlit([1.0; 3]), Vec3::X * 2.0)],
            ..dark()
        };
        // Turned right by 80 degrees, what lies to the right is left of the middle... by ten degrees to the right.
        let rotation = Quat::from_rotation_y(-80.0_f32.to_radians());
        let view = View {
            position: Vec3::ZERO,
            rotation,
            fov,
        };
        let seen = centre_of_light(&one(&mut renderer, &scene, view, [100, 100]));
        let expected = 50.0 + 50.0 * 10.0_f64.to_radians().tan() / 0.5_f64.tan();
        assert!((seen[0] - expected).abs() < 0.7, "{seen:?}, {expected}");
        assert!((seen[1] - 50.0).abs() < 0.5, "{seen:?}");
    });
}

#[test]
fn eyes_part_by_the_computed_disparity() {
    let [left, right]: [f32; 2] = [-0.7, 0.9];
    let right_fov = Fov {
        left: left.atan(),
        right: right.atan(),
        up: 0.5,
        down: -0.5,
    };
    let eye_distance = 0.063;
    let [left_eye, right_eye] =
        View::stereo(Vec3::Y * 1.6, Quat::IDENTITY, eye_distance, right_fov);
    let width = 320.0;
    let plane = f64::from(right - left);
    on_each_driver(|gpu| {
        for distance in [1.0_f32, 4.0] {
            let point = Vec3::new(0.0, 1.6, -distance);
            let in_left = dot_at(gpu, point, left_eye, [320, 160]);
            let in_right = dot_at(gpu, point, right_eye, [320, 160]);
            // Straight ahead of the head, the point is off each eye's axis by half the distance of the eyes, and each
            // axis is off the middle of its image by the field's asymmetry, mirrored.
            let half = f64::from(0.5 * eye_distance / distance);
            let expected_left = (half + f64::from(right)) / plane * width;
            let expected_right = (-half - f64::from(left)) / plane * width;
            assert!((in_left[0] - expected_left).abs() < 0.5, "{in_left:?}");
            assert!((in_right[0] - expected_right).abs() < 0.5, "{in_right:?}");
            assert!(
                (in_left[1] - in_right[1]).abs() < 0.01,
                "no vertical parallax"
            );
        }
    });
}

#[test]
fn the_nearer_surface_hides_the_farther_in_either_order() {
    on_each_driver(|gpu| {
        let mut renderer = renderer(gpu, PLAIN);
        let quad = add(&mut renderer, &MeshData::quad(1.0, 1.0));
        let near = instance(quad, Material::unlit([0.5; 3]), Vec3::Z * -1.0);
        let far = instance(quad, Material::unlit([0.1; 3]), Vec3::Z * -1.02);
        let view = View::looking_at(Vec3::ZERO, Vec3::NEG_Z, Fov::symmetric(0.5, 0.5));
        for instances in [vec![near, far], vec![far, near]] {
            let scene = Scene {
                instances,
                ..dark()
            };
            let image = one(&mut renderer, &scene, view, [16, 16]);
            assert!(close(value(&image, 8, 8), srgb(0.5)));
        }
    });
}

#[test]
fn distant_surfaces_ten_millimetres_apart_are_kept_apart() {
    on_each_driver(|gpu| {
        let mut renderer = renderer(gpu, PLAIN);
        let quad = add(&mut renderer, &MeshData::quad(9.0, 9.0));
        let scene = Scene {
            instances: vec![
                instance(quad, Material::unlit([0.1; 3]), Vec3::Z * -20.01),
                instance(quad, Material::unlit([0.5; 3]), Vec3::Z * -20.0),
            ],
            ..dark()
        };
        let view = View::looking_at(Vec3::ZERO, Vec3::NEG_Z, Fov::symmetric(0.3, 0.3));
        let image = one(&mut renderer, &scene, view, [32, 32]);
        assert!(image.pixels().all(|p| close(p[0].into(), srgb(0.5))));
    });
}

#[test]
fn back_faces_are_not_drawn() {
    on_each_driver(|gpu| {
        let mut renderer = renderer(gpu, PLAIN);
        let quad = add(&mut renderer, &MeshData::quad(1.0, 1.0));
        let turned = Instance {
            world_from_mesh: Mat4::from_translation(Vec3::NEG_Z)
                * Mat4::from_rotation_y(std::f32::consts::PI),
            ..instance(quad, Material::unlit([1.0; 3]), Vec3::ZERO)
        };
        let view = View::looking_at(Vec3::ZERO, Vec3::NEG_Z, Fov::symmetric(0.5, 0.5));
        let scene = Scene {
            instances: vec![turned],
            ..dark()
        };
        let image = one(&mut renderer, &scene, view, [8, 8]);
        assert!(image.pixels().all(|pixel| pixel[0] == 0));
    });
}

/// Number of pixels that are neither the quad's value nor the background's.
fn edge_pixels(gpu: &renderer::Gpu, samples: u32) -> usize {
    let mut renderer = renderer(
        gpu,
        RendererSettings {
            samples,
            shadow_size: 0,
            ..RendererSettings::FULL
        },
    );
    let quad = add(&mut renderer, &MeshData::quad(1.0, 1.0));
    let slanted = Instance {
        world_from_mesh: Mat4::from_translation(Vec3::Z * -2.0) * Mat4::from_rotation_z(0.3),
        ..instance(quad, Material::unlit([0.5; 3]), Vec3::ZERO)
    };
    let scene = Scene {
        instances: vec![slanted],
        ..dark()
    };
    let view = View::looking_at(Vec3::ZERO, Vec3::NEG_Z, Fov::symmetric(1.0, 1.0));
    let image = one(&mut renderer, &scene, view, [64, 64]);
    let pure = [0, srgb(0.5)];
    image
        .pixels()
        .filter(|pixel| !pure.iter().any(|&value| close(value, pixel[0].into())))
        .count()
}

#[test]
fn four_samples_smooth_edges_and_one_does_not() {
    on_each_driver(|gpu| {
        assert_eq!(edge_pixels(gpu, 1), 0);
        assert!(edge_pixels(gpu, 4) > 40);
    });
}
