//! Cost of a frame of 20 000 triangles: the processor's share of recording it, and the whole frame on the driver at hand.
//!
//! Budgets: at 90 Hz a frame has 11.1 ms; recording must be a small part of it. On a software driver the whole frame
//! decides how long the pictures of a session take.

use criterion::{Criterion, criterion_group, criterion_main};
use renderer::glam::{Mat4, Vec3};
use renderer::{
    BackendChoice, Fov, Gpu, Instance, Light, LightSource, Material, MeshData, Renderer,
    RendererSettings, Scene, View,
};

/// Ten spheres of 2 000 triangles over a floor.
fn scene(renderer: &mut Renderer) -> Scene {
    let add = |renderer: &mut Renderer, mesh: &MeshData| renderer.add_mesh(mesh).expect("drawable");
    let ball_data = MeshData::sphere(0.12, 46);
    let ball = add(renderer, &ball_data);
    let floor = add(renderer, &MeshData::cuboid(Vec3::new(3.0, 0.1, 6.0)));
    let mut instances: Vec<Instance> = (0..10)
        .map(|i| {
            let (row, column) = (i / 5, i % 5);
            let x = 0.3 * column as f32 - 0.6;
            Instance {
                mesh: ball,
                material: Material::new([0.8, 0.75, 0.7]),
                world_from_mesh: Mat4::from_translation(Vec3::new(x, 0.12, -0.4 * row as f32)),
            }
        })
        .collect();
    assert!((19_000..21_000).contains(&(10 * ball_data.triangles())));
    instances.push(Instance {
        mesh: floor,
        material: Material::new([0.5, 0.35, 0.2]),
        world_from_mesh: Mat4::from_translation(Vec3::new(0.0, -0.05, 0.0)),
    });
    Scene {
        instances,
        light: Some(Light {
            source: LightSource::Directional {
                direction: Vec3::new(0.2, -1.0, -0.3),
                shadow_min: Vec3::new(-1.5, -0.1, -3.0),
                shadow_max: Vec3::new(1.5, 1.0, 3.0),
            },
            color: [0.7; 3],
            softness_m: 0.015,
        }),
        ..Scene::default()
    }
}

fn eyes(aspect: f32) -> [View; 2] {
    let head = View::looking_at(
        Vec3::new(0.0, 1.0, 1.6),
        Vec3::ZERO,
        Fov::from_aspect(0.8, aspect),
    );
    View::stereo(head.position, head.rotation, 0.063, head.fov)
}

fn recording(criterion: &mut Criterion) {
    // The backend that draws nothing leaves what the processor does before the driver.
    let gpu = Gpu::new(BackendChoice::Noop).expect("it needs no driver");
    let mut renderer = Renderer::new(&gpu, RendererSettings::default()).expect("good settings");
    let mut scene = scene(&mut renderer);
    criterion.bench_function("record 2 eyes, 11 instances", |bencher| {
        bencher.iter(|| renderer.render(&scene, &eyes(1.5), 8, 8).expect("drawn"));
    });
    let one = scene.instances[0];
    scene.instances.resize(200, one);
    criterion.bench_function("record 2 eyes, 200 instances", |bencher| {
        bencher.iter(|| renderer.render(&scene, &eyes(1.5), 8, 8).expect("drawn"));
    });
}

fn frame(criterion: &mut Criterion) {
    let gpu = Gpu::new(BackendChoice::Auto).expect("a graphics driver is installed");
    println!("{gpu}");
    let mut group = criterion.benchmark_group("frame of 20 000 triangles, 2 eyes");
    group.sample_size(10);
    for shadow_size in [0, 1024, 2048] {
        let settings = RendererSettings {
            samples: 4,
            shadow_size,
            ..RendererSettings::FULL
        };
        let mut renderer = Renderer::new(&gpu, settings).expect("good settings");
        let scene = scene(&mut renderer);
        for [width, height] in [[360, 240], [704, 480]] {
            let name = format!("{width}x{height}, shadow map {shadow_size}");
            let eyes = eyes(width as f32 / height as f32);
            group.bench_function(name, |bencher| {
                bencher.iter(|| {
                    renderer
                        .render(&scene, &eyes, width, height)
                        .expect("drawn")
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, recording, frame);
criterion_main!(benches);
