use renderer::glam::{Mat4, Quat, Vec3};
use renderer::{
    BackendChoice, Fov, Gpu, Instance, Lamp, Material, MeshData, RendererSettings, RgbaImage,
    Scene, TextPainter, View,
};

use crate::support::*;

/// A little of everything, seen by two eyes.
fn everything(gpu: &Gpu) -> Vec<RgbaImage> {
    let settings = RendererSettings {
        samples: 4,
        shadow_size: 512,
        ..RendererSettings::FULL
    };
    let mut renderer = renderer(gpu, settings);
    let floor = add(&mut renderer, &MeshData::quad(3.0, 3.0));
    let ball = add(&mut renderer, &MeshData::sphere(0.3, 32));
    let cube = add(&mut renderer, &MeshData::cuboid(Vec3::new(0.3, 0.8, 0.3)));
    let squares = RgbaImage::from_fn(64, 64, |x, y| {
        let byte = if (x / 8 + y / 8) % 2 == 0 { 190 } else { 110 };
        image::Rgba([byte, byte - 30, byte - 80, 255])
    });
    let squares = renderer.add_texture(&squares).expect("a good texture");
    let wood = Material {
        texture: Some(squares),
        roughness: 0.25,
        ..Material::new([0.9; 3])
    };
    let turned =
        Mat4::from_rotation_translation(Quat::from_rotation_y(0.5), Vec3::new(0.5, 0.4, -0.4));
    let scene = Scene {
        instances: vec![
            Instance {
                world_from_mesh: lying(),
                ..instance(floor, wood, Vec3::ZERO)
            },
            instance(ball, Material::new([0.5, 0.05, 0.05]), Vec3::Y * 0.3),
            Instance {
                world_from_mesh: turned,
                ..instance(cube, Material::new([0.8; 3]), Vec3::ZERO)
            },
        ],
        light: Some(sun(Vec3::new(0.4, -1.0, -0.3), 0.7)),
        lamps: vec![Lamp {
            position: Vec3::new(-0.6, 1.0, 0.3),
            color: [0.3, 0.2, 0.1],
            range_m: 3.0,
        }],
        ..Scene::default()
    };
    let head = View::looking_at(
        Vec3::new(0.0, 1.2, 1.8),
        Vec3::Y * 0.2,
        Fov::symmetric(0.9, 0.7),
    );
    let eyes = View::stereo(head.position, head.rotation, 0.063, head.fov);
    renderer.render(&scene, &eyes, 120, 80).expect("drawable")
}

#[test]
fn vulkan_and_gl_draw_the_same() {
    let (Some(vulkan), Some(gl)) = (gpu(BackendChoice::Vulkan), gpu(BackendChoice::Gl)) else {
        eprintln!("skipped: comparing Vulkan and GL needs both");
        return;
    };
    assert_eq!((vulkan.backend(), gl.backend()), ("vulkan", "gl"));
    for (a, b) in everything(vulkan).iter().zip(&everything(gl)) {
        let off = largest_difference(a, b);
        assert!(off <= 2, "{off} of 255");
    }
    let caption = |gpu| TextPainter::new(gpu).caption("Frame 3: X", 200);
    let (a, b) = (caption(vulkan), caption(gl));
    let off = largest_difference(&a.expect("drawable"), &b.expect("drawable"));
    assert!(off <= 2, "text: {off} of 255");
}

#[test]
fn the_same_scene_gives_the_same_bytes() {
    on_each_driver(|gpu| {
        let (first, second) = (everything(gpu), everything(gpu));
        assert!(first == second, "two runs differ");
        assert!(first[0] != first[1], "two eyes see the same");
    });
}

/// Debian 12's lavapipe mixes eyes up when they share layers; each must equal a frame of its own.
#[test]
fn an_eye_does_not_depend_on_the_other() {
    on_each_driver(|gpu| {
        let mut renderer = renderer(gpu, RendererSettings::default());
        let cube = add(&mut renderer, &MeshData::cuboid(Vec3::splat(0.4)));
        let scene = Scene {
            instances: vec![instance(cube, Material::new([0.6; 3]), Vec3::NEG_Z)],
            light: Some(sun(Vec3::new(0.4, -1.0, -0.3), 0.7)),
            ..Scene::default()
        };
        let eyes = View::stereo(Vec3::ZERO, Quat::IDENTITY, 0.2, Fov::symmetric(1.0, 1.0));
        let both = renderer.render(&scene, &eyes, 48, 48).expect("drawable");
        for (eye, image) in eyes.into_iter().zip(&both) {
            assert!(one(&mut renderer, &scene, eye, [48, 48]) == *image);
        }
    });
}
