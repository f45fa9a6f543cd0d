use renderer::glam::{Mat4, Vec3};
use renderer::{
    Fov, Gpu, Instance, Material, MeshData, Occluder, Pattern, RendererSettings, RgbaImage, Scene,
    View,
};

use crate::support::{
    PLAIN, add, close, dark, from_above, instance, lying, matte, on_each_driver, one, renderer,
    srgb, value,
};

/// A black mirror as floor, and a glowing quad that stands on it or floats over it, facing the eye.
fn glow_over_floor(
    gpu: &Gpu,
    settings: RendererSettings,
    lowest: f32,
    roughness: f32,
) -> RgbaImage {
    let mut renderer = renderer(gpu, settings);
    let floor = add(&mut renderer, &MeshData::quad(8.0, 8.0));
    let card = add(&mut renderer, &MeshData::quad(0.5, 0.5));
    let varnish = Material {
        roughness,
        specular: 1.0,
        mirror: 1.0,
        ..Material::new([0.0; 3])
    };
    let glow = Material {
        is_mirrored: true,
        ..Material::unlit([0.5; 3])
    };
    let scene = Scene {
        instances: vec![
            Instance {
                mesh: floor,
                material: varnish,
                world_from_mesh: lying(),
            },
            instance(card, glow, Vec3::new(0.0, lowest + 0.25, -1.0)),
        ],
        ..dark()
    };
    let view = View::looking_at(
        Vec3::new(0.0, 0.8, 2.0),
        Vec3::new(0.0, 0.0, -0.6),
        Fov::symmetric(0.8, 0.8),
    );
    one(&mut renderer, &scene, view, [128, 128])
}

/// The pixel at which the mirror image of a point appears.
fn image_of(point: Vec3) -> [u32; 2] {
    let view = View::looking_at(
        Vec3::new(0.0, 0.8, 2.0),
        Vec3::new(0.0, 0.0, -0.6),
        Fov::symmetric(0.8, 0.8),
    );
    let below = point * Vec3::new(1.0, -1.0, 1.0);
    let [x, y] = view.pixel_of(below, 128, 128).expect("in front");
    [x as u32, y as u32]
}

#[test]
fn the_floor_mirrors_what_stands_on_it_where_it_has_to() {
    on_each_driver(|gpu| {
        let image = glow_over_floor(gpu, PLAIN, 0.0, 0.05);
        let [x, y] = image_of(Vec3::new(0.0, 0.25, -1.0));
        // A perfect mirror shows the glow as bright as it is; the fit of the lobe's integral loses two in a hundred.
        let seen = value(&image, x, y);
        assert!((seen - srgb(0.5)).abs() <= 5, "{seen}");
        let [x, y] = image_of(Vec3::new(0.5, 0.25, -1.0));
        assert!(
            value(&image, x, y) < 12,
            "beside it: {}",
            value(&image, x, y)
        );
        let off = RendererSettings {
            reflection: false,
            ..PLAIN
        };
        let without = glow_over_floor(gpu, off, 0.0, 0.05);
        let [x, y] = image_of(Vec3::new(0.0, 0.25, -1.0));
        assert!(value(&without, x, y) < 12, "{}", value(&without, x, y));
    });
}

/// Pixels between a tenth and nine tenths of the glow, down the column through its image.
fn blurred_pixels(image: &RgbaImage) -> usize {
    let [x, _] = image_of(Vec3::new(0.0, 0.2, -1.0));
    let [_, top] = image_of(Vec3::new(0.0, 0.0, -1.0));
    (top..128)
        .filter(|&y| (24..160).contains(&value(image, x, y)))
        .count()
}

#[test]
fn the_image_blurs_with_height_and_roughness() {
    on_each_driver(|gpu| {
        let low = blurred_pixels(&glow_over_floor(gpu, PLAIN, 0.0, 0.05));
        let rough = blurred_pixels(&glow_over_floor(gpu, PLAIN, 0.0, 0.35));
        let high = blurred_pixels(&glow_over_floor(gpu, PLAIN, 0.2, 0.35));
        assert!(low < rough && rough < high, "{low} {rough} {high}");
    });
}

/// Share of a uniform sky, weighted by the cosine, that a sphere hides from a point of a horizontal plane: counted on a grid of
/// directions (area of the unit disc below the sphere's outline), not by a formula.
fn hidden_share(middle: Vec3, radius: f32) -> f64 {
    let count = 400;
    let (mut hidden, mut all) = (0, 0);
    for i in 0..count {
        for j in 0..count {
            let at = |k: i32| 2.0 * (k as f32 + 0.5) / count as f32 - 1.0;
            let (x, z) = (at(i), at(j));
            let rest = 1.0 - x * x - z * z;
            if rest <= 0.0 {
                continue;
            }
            all += 1;
            let direction = Vec3::new(x, rest.sqrt(), z);
            let along = middle.dot(direction);
            let off = (middle - along * direction).length();
            hidden += i32::from(along > 0.0 && off < radius);
        }
    }
    f64::from(hidden) / f64::from(all)
}

#[test]
fn a_sphere_hides_its_share_of_the_sky() {
    on_each_driver(|gpu| {
        let mut renderer = renderer(gpu, PLAIN);
        let floor = add(&mut renderer, &MeshData::quad(3.0, 3.0));
        let middle = Vec3::new(0.1, 0.5, 0.0);
        let radius_m = 0.3;
        let scene = Scene {
            instances: vec![Instance {
                mesh: floor,
                material: matte(0.5),
                world_from_mesh: lying(),
            }],
            sky: [1.0; 3],
            ground: [1.0; 3],
            // Unseen itself: what is looked at is the floor below.
            occluders: vec![Occluder {
                position: middle,
                radius_m,
            }],
            ..dark()
        };
        let view = from_above(2.0);
        let image = one(&mut renderer, &scene, view, [64, 64]);
        for x in [0.1_f32, 0.4, 0.7] {
            let point = Vec3::new(x, 0.0, 0.0);
            let [px, py] = view.pixel_of(point, 64, 64).expect("in front");
            let seen = value(&image, px as u32, py as u32);
            let expected = srgb(0.5 * (1.0 - hidden_share(middle - point, radius_m)));
            assert!((seen - expected).abs() <= 4, "{x}: {seen} {expected}");
        }
        let off = RendererSettings {
            occlusion: false,
            ..PLAIN
        };
        let mut open = crate::support::renderer(gpu, off);
        let floor = add(&mut open, &MeshData::quad(3.0, 3.0));
        let scene = Scene {
            instances: vec![Instance {
                mesh: floor,
                material: matte(0.5),
                world_from_mesh: lying(),
            }],
            ..scene
        };
        let image = one(&mut open, &scene, view, [64, 64]);
        assert!(close(value(&image, 35, 32), srgb(0.5)));
    });
}

/// The mean of a row of pixels across a patterned floor that is seen from `height`.
fn pattern_mean(gpu: &Gpu, pattern: Pattern, height: f32) -> f64 {
    let mut renderer = renderer(gpu, PLAIN);
    let floor = add(&mut renderer, &MeshData::quad(1.0, 1.0));
    let material = Material {
        pattern,
        texture_repeat: [400.0, 400.0],
        ..Material::unlit([0.5; 3])
    };
    let scene = Scene {
        instances: vec![Instance {
            mesh: floor,
            material,
            world_from_mesh: Mat4::from_scale(Vec3::splat(20.0)) * lying(),
        }],
        ..dark()
    };
    let image = one(&mut renderer, &scene, from_above(height), [64, 64]);
    let values = image.pixels().map(|pixel| f64::from(pixel.0[1]));
    values.sum::<f64>() / 4096.0
}

#[test]
fn patterns_keep_their_mean_however_far_they_are() {
    on_each_driver(|gpu| {
        for pattern in [Pattern::Planks, Pattern::Panels] {
            let near = pattern_mean(gpu, pattern, 0.6);
            let far = pattern_mean(gpu, pattern, 9.0);
            assert!((near - far).abs() < 14.0, "{pattern:?}: {near} {far}");
        }
    });
}

#[test]
fn flat_faces_have_one_colour_each() {
    on_each_driver(|gpu| {
        let flat = RendererSettings {
            flat: true,
            ..PLAIN
        };
        let colours = |settings: RendererSettings| {
            let mut renderer = renderer(gpu, settings);
            let ball = add(&mut renderer, &MeshData::sphere(0.8, 8));
            let scene = Scene {
                instances: vec![instance(ball, matte(0.7), Vec3::ZERO)],
                sky: [0.8; 3],
                ground: [0.1; 3],
                ..dark()
            };
            let view = View::looking_at(Vec3::Z * 3.0, Vec3::ZERO, Fov::symmetric(0.6, 0.6));
            let image = one(&mut renderer, &scene, view, [64, 64]);
            let mut seen: Vec<[u8; 4]> = image.pixels().map(|pixel| pixel.0).collect();
            seen.sort_unstable();
            seen.dedup();
            seen.len()
        };
        // The half of an eight-sided ball of four rings that is seen has at most 32 triangles, and a background.
        let (few, many) = (colours(flat), colours(PLAIN));
        assert!(few <= 33, "{few}");
        assert!(many > 2 * few, "{many} {few}");
    });
}
