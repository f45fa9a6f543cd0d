use renderer::glam::{Mat4, Vec3};
use renderer::{
    Gpu, Instance, Lamp, Light, LightSource, Material, MeshData, Renderer, RendererSettings,
    RgbaImage, Scene,
};

use crate::support::*;

const SHADOWED: RendererSettings = RendererSettings {
    samples: 1,
    shadow_size: 512,
    ..RendererSettings::FULL
};

/// A matte floor of base colour 0.5 at y = 0, seen from 2 m above.
fn floor(renderer: &mut Renderer) -> Instance {
    let quad = add(renderer, &MeshData::quad(3.0, 3.0));
    Instance {
        world_from_mesh: lying(),
        ..instance(quad, matte(0.5), Vec3::ZERO)
    }
}

#[test]
fn unlit_surfaces_and_background_show_their_own_colour() {
    on_each_driver(|gpu| {
        let mut renderer = renderer(gpu, PLAIN);
        let quad = add(&mut renderer, &MeshData::quad(1.0, 1.0));
        let own = Material::unlit([0.214, 0.05, 0.5]);
        let scene = Scene {
            instances: vec![Instance {
                world_from_mesh: lying(),
                ..instance(quad, own, Vec3::ZERO)
            }],
            background: [0.1, 0.2, 0.3],
            ..dark()
        };
        let image = one(&mut renderer, &scene, from_above(2.0), [32, 32]);
        let shows = |x, y, expected: [f64; 3]| {
            let seen = image.get_pixel(x, y).0.map(i32::from);
            (0..3).all(|i| close(seen[i], srgb(expected[i]))) && seen[3] == 255
        };
        assert!(shows(16, 16, [0.214, 0.05, 0.5]));
        assert!(shows(0, 0, [0.1, 0.2, 0.3]));
    });
}

#[test]
fn sky_lights_what_faces_up_and_ground_what_faces_down() {
    on_each_driver(|gpu| {
        let mut renderer = renderer(gpu, PLAIN);
        let floor = floor(&mut renderer);
        let mut scene = Scene {
            instances: vec![floor],
            sky: [0.4; 3],
            ground: [0.1; 3],
            ..dark()
        };
        let image = one(&mut renderer, &scene, from_above(2.0), [8, 8]);
        assert!(close(value(&image, 4, 4), srgb(0.5 * 0.4)));
        // A wall takes half of each.
        scene.instances[0].world_from_mesh = Mat4::from_translation(Vec3::NEG_Z);
        let ahead =
            renderer::View::looking_at(Vec3::ZERO, Vec3::NEG_Z, renderer::Fov::symmetric(0.5, 0.5));
        let image = one(&mut renderer, &scene, ahead, [8, 8]);
        assert!(close(value(&image, 4, 4), srgb(0.5 * 0.25)));
    });
}

#[test]
fn matte_surface_shows_light_times_cosine() {
    on_each_driver(|gpu| {
        let mut renderer = renderer(gpu, PLAIN);
        let floor = floor(&mut renderer);
        for (direction, cosine) in [(Vec3::NEG_Y, 1.0), (Vec3::new(0.8, -0.6, 0.0), 0.6)] {
            let scene = Scene {
                instances: vec![floor],
                light: Some(sun(direction, 0.6)),
                ..dark()
            };
            let image = one(&mut renderer, &scene, from_above(2.0), [8, 8]);
            assert!(close(value(&image, 4, 4), srgb(0.5 * 0.6 * cosine)));
        }
    });
}

#[test]
fn bright_values_roll_off_below_white() {
    on_each_driver(|gpu| {
        let mut renderer = renderer(gpu, PLAIN);
        let floor = floor(&mut renderer);
        let mut shown = |color| {
            let scene = Scene {
                instances: vec![floor],
                light: Some(sun(Vec3::NEG_Y, color)),
                ..dark()
            };
            value(&one(&mut renderer, &scene, from_above(2.0), [8, 8]), 4, 4)
        };
        let (below, above, far_above) = (shown(1.2), shown(2.0), shown(20.0));
        assert!(close(below, srgb(0.6)), "{below}");
        let expected = 0.6 + 0.4 * (1.0 - (-1.0_f64).exp());
        assert!(close(above, srgb(expected)), "{above}");
        assert!(far_above >= 254, "{far_above}");
    });
}

#[test]
fn lamp_falls_with_the_square_of_the_distance_and_ends() {
    on_each_driver(|gpu| {
        let mut renderer = renderer(gpu, PLAIN);
        let floor = floor(&mut renderer);
        let mut under = |height: f32, range_m: f32| {
            let scene = Scene {
                instances: vec![floor],
                lamps: vec![Lamp {
                    position: Vec3::Y * height,
                    color: [0.8; 3],
                    range_m,
                }],
                ..dark()
            };
            // Looked at through the lamp, which is not a thing that hides.
            value(&one(&mut renderer, &scene, from_above(3.0), [9, 9]), 4, 4)
        };
        // A range so large that the window does not matter.
        assert!(close(under(1.0, 1000.0), srgb(0.5 * 0.8)));
        assert!(close(under(2.0, 1000.0), srgb(0.5 * 0.8 / 4.0)));
        assert_eq!(under(2.0, 1.9), 0);
    });
}

/// A floor with a cube of 0.4 m that hovers, and the picture of it from above.
fn cube_over_floor(gpu: &Gpu, settings: RendererSettings, light: Light) -> RgbaImage {
    let mut renderer = renderer(gpu, settings);
    let floor = floor(&mut renderer);
    let cube = add(&mut renderer, &MeshData::cuboid(Vec3::splat(0.4)));
    let scene = Scene {
        instances: vec![floor, instance(cube, matte(0.5), Vec3::Y * 0.5)],
        light: Some(light),
        sky: [0.2; 3],
        ground: [0.2; 3],
        ..dark()
    };
    one(&mut renderer, &scene, from_above(3.0), [96, 96])
}

/// Pixel of a floor point in that picture: 3 m above, half angle 0.5 rad.
fn floor_pixel(x: f32, z: f32) -> [u32; 2] {
    let to_pixel = |at: f32| (48.0 + 48.0 * at / 3.0 / 0.5_f32.tan()) as u32;
    [to_pixel(x), to_pixel(z)]
}

#[test]
fn shadow_falls_where_the_light_is_blocked_and_only_there() {
    // Along +x and down: the cube's middle, 0.5 m up, throws its shadow to x = +0.5.
    let light = sun(Vec3::new(1.0, -1.0, 0.0), 0.6);
    let ambient = 0.5 * 0.2;
    let lit = ambient + 0.5 * 0.6 * 0.5_f64.sqrt();
    on_each_driver(|gpu| {
        let shadowed = cube_over_floor(gpu, SHADOWED, light);
        let at = |image: &RgbaImage, x, z| {
            let [x, y] = floor_pixel(x, z);
            value(image, x, y)
        };
        assert!(close(at(&shadowed, 0.6, 0.0), srgb(ambient)));
        assert!(close(at(&shadowed, -0.6, 0.0), srgb(lit)), "the lit side");
        assert!(
            close(at(&shadowed, 0.6, 0.5), srgb(lit)),
            "beside the shadow"
        );
        let off = RendererSettings {
            shadow_size: 0,
            ..SHADOWED
        };
        let open = cube_over_floor(gpu, off, light);
        assert!(close(at(&open, 0.6, 0.0), srgb(lit)), "shadows are off");
    });
}

#[test]
fn shadow_edges_are_soft() {
    on_each_driver(|gpu| {
        let light = Light {
            softness_m: 0.05,
            ..sun(Vec3::new(1.0, -1.0, 0.0), 0.6)
        };
        let image = cube_over_floor(gpu, SHADOWED, light);
        // Across the shadow's far edge, at x = 0.5 + 0.2 + 0.2.
        let row: Vec<i32> = (70..90).map(|x| value(&image, x, 48)).collect();
        let (dark, bright) = (row[0], row[row.len() - 1]);
        assert!(bright > dark + 40, "{row:?}");
        assert!(row.is_sorted(), "from shadow to light: {row:?}");
        let between = row.iter().filter(|&&v| v > dark + 2 && v < bright - 2);
        assert!(between.count() >= 1, "{row:?}");
    });
}

#[test]
fn lit_surfaces_do_not_shadow_themselves() {
    // Grazing light over floor and sphere is where a shadow map speckles.
    on_each_driver(|gpu| {
        let mut renderer = renderer(gpu, SHADOWED);
        let mut open = crate::support::renderer(
            gpu,
            RendererSettings {
                shadow_size: 0,
                ..SHADOWED
            },
        );
        for direction in [Vec3::new(1.0, -0.35, 0.2), Vec3::new(0.1, -1.0, 0.2)] {
            let with = lone_sphere(&mut renderer, direction);
            let without = lone_sphere(&mut open, direction);
            // Nothing else throws a shadow on the sphere, so it may differ only at its own terminator.
            let darkened = with
                .pixels()
                .zip(without.pixels())
                .filter(|(a, b)| a[0].abs_diff(b[0]) > 12)
                .count();
            assert!(darkened < 25, "{darkened} pixels of 4096, {direction}");
        }
    });
}

fn lone_sphere(renderer: &mut Renderer, direction: Vec3) -> RgbaImage {
    let sphere = add(renderer, &MeshData::sphere(0.5, 48));
    let scene = Scene {
        instances: vec![instance(sphere, matte(0.6), Vec3::Y * 0.5)],
        light: Some(sun(direction, 0.8)),
        ..dark()
    };
    one(renderer, &scene, from_above(2.2), [64, 64])
}

#[test]
fn spot_light_has_a_cone_and_throws_shadows() {
    let spot = Light {
        source: LightSource::Spot {
            position: Vec3::new(-1.0, 2.0, 0.0),
            direction: Vec3::new(0.5, -1.0, 0.0),
            inner: 0.45,
            outer: 0.5,
            range_m: 6.0,
        },
        color: [2.0; 3],
        softness_m: 0.005,
    };
    on_each_driver(|gpu| {
        let image = cube_over_floor(gpu, SHADOWED, spot);
        let at = |x, z| {
            let [x, y] = floor_pixel(x, z);
            value(&image, x, y)
        };
        let ambient = srgb(0.5 * 0.2);
        // From (-1, 2) over the cube's middle at height 0.5 the ray reaches the floor at x = 1/3.
        assert!(close(at(0.33, 0.0), ambient), "in the cube's shadow");
        assert!(
            at(0.0, 0.6) > ambient + 20,
            "inside the cone, beside the cube"
        );
        assert!(close(at(-1.4, 1.4), ambient), "outside the cone");
        // 0.5 * 2 * cosine / distance squared, at the floor point under the axis of the light's cone rim.
        let offset = Vec3::new(-1.0, 2.0, 0.0) - Vec3::new(0.0, 0.0, 0.6);
        let distance = f64::from(offset.length());
        let expected = 0.5 * 0.2 + 0.5 * 2.0 * (2.0 / distance) / (distance * distance);
        let seen = at(0.0, 0.6);
        assert!((seen - srgb(expected)).abs() <= 2, "{seen}, {expected}");
    });
}

#[test]
fn gloss_adds_a_highlight_at_the_mirror_angle() {
    on_each_driver(|gpu| {
        let mut renderer = renderer(gpu, PLAIN);
        let mut floor = floor(&mut renderer);
        let mut shown = |specular: f32| {
            floor.material = Material {
                specular,
                roughness: 0.3,
                ..matte(0.1)
            };
            let scene = Scene {
                instances: vec![floor],
                light: Some(sun(Vec3::NEG_Y, 0.5)),
                ..dark()
            };
            one(&mut renderer, &scene, from_above(2.0), [33, 33])
        };
        let (dull, glossy) = (shown(0.0), shown(0.04));
        assert!(value(&glossy, 16, 16) > value(&dull, 16, 16) + 30);
        assert!(value(&glossy, 0, 0) < value(&glossy, 16, 16) - 30);
    });
}
