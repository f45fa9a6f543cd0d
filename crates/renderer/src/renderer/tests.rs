//! The renderer on a device that draws nothing: what it makes and what it refuses.

use glam::{Mat4, Vec3};
use image::{Rgba, RgbaImage};

use super::*;
use crate::passes::hidden::HiddenMesh;
use crate::scene::{Instance, Light, LightSource, Material, MeshId, Occluder, TextureId, Vignette};
use crate::{BackendChoice, Fov, MeshData};

fn renderer(settings: RendererSettings) -> Renderer {
    let gpu = Gpu::new(BackendChoice::Noop).expect("the test backend needs no driver");
    Renderer::new(&gpu, settings).expect("good settings")
}

fn view() -> View {
    View::looking_at(Vec3::Z * 3.0, Vec3::ZERO, Fov::symmetric(1.0, 1.0))
}

fn instance(mesh: MeshId) -> Instance {
    Instance {
        mesh,
        material: Material::new([0.5; 3]),
        world_from_mesh: Mat4::IDENTITY,
    }
}

fn sun() -> Light {
    Light {
        source: LightSource::Directional {
            direction: Vec3::NEG_Y,
            shadow_min: Vec3::splat(-2.0),
            shadow_max: Vec3::splat(2.0),
        },
        color: [1.0; 3],
        softness_m: 0.01,
    }
}

/// Every pipeline, layout and bind group is checked by the validation of a device that draws nothing.
#[test]
fn every_pass_validates_on_a_device_without_pixels() {
    let lights = [(0, None), (0, Some(sun())), (256, Some(sun())), (256, None)];
    for (index, (shadow_size, light)) in (0..).zip(lights.into_iter().cycle().take(32)) {
        let is_on = |bit: u32| index & bit != 0;
        let mut renderer = renderer(RendererSettings {
            samples: if is_on(4) { 4 } else { 1 },
            shadow_size,
            reflection: is_on(8),
            occlusion: is_on(16),
            filtered: is_on(1),
            flat: index == 31,
        });
        let mesh = renderer.add_mesh(&MeshData::quad(1.0, 1.0)).expect("good");
        let scene = called_for(vec![instance(mesh); 100], light);
        for size in [32, 48] {
            let images = renderer.render(&scene, &[view(), view()], size, 16);
            assert_eq!(images.expect("drawn").len(), 2);
        }
    }
}

/// A scene that calls for everything.
fn called_for(mut instances: Vec<Instance>, light: Option<Light>) -> Scene {
    for (index, instance) in instances.iter_mut().enumerate() {
        instance.material.mirror = if index == 0 { 1.0 } else { 0.0 };
        instance.material.is_mirrored = index > 50;
    }
    Scene {
        instances,
        light,
        occluders: vec![Occluder {
            position: Vec3::Y,
            radius_m: 0.1,
        }],
        ..Scene::default()
    }
}

#[test]
fn what_is_off_or_not_called_for_has_no_pass() {
    let passes = |settings: RendererSettings, calls: bool| {
        let mut renderer = renderer(settings);
        let mesh = renderer.add_mesh(&MeshData::quad(1.0, 1.0)).expect("good");
        let mut scene = called_for(vec![instance(mesh); 2], Some(sun()));
        if !calls {
            scene = Scene {
                instances: vec![instance(mesh)],
                ..Scene::default()
            };
        }
        renderer.render(&scene, &[view()], 8, 8).expect("drawn");
        renderer.passes()
    };
    let all = RendererSettings::default();
    assert_eq!(
        passes(all, true),
        ["shadow", "mirror", "lit with occlusion"]
    );
    assert_eq!(passes(all, false), ["lit"]);
    let no_shadows = RendererSettings {
        shadow_size: 0,
        ..all
    };
    assert_eq!(passes(no_shadows, true), ["mirror", "lit with occlusion"]);
    let no_reflection = RendererSettings {
        reflection: false,
        ..all
    };
    assert_eq!(
        passes(no_reflection, true),
        ["shadow", "lit with occlusion"]
    );
    let no_occlusion = RendererSettings {
        occlusion: false,
        ..all
    };
    assert_eq!(passes(no_occlusion, true), ["shadow", "mirror", "lit"]);
    let flat = RendererSettings { flat: true, ..all };
    assert_eq!(passes(flat, true), ["flat"]);
}

#[test]
fn pictures_among_flat_faces_have_a_pass_from_the_first_on() {
    for samples in [1, 4] {
        let mut renderer = renderer(RendererSettings {
            samples,
            flat: true,
            ..RendererSettings::default()
        });
        let mesh = renderer.add_mesh(&MeshData::quad(1.0, 1.0)).expect("good");
        let sign = RgbaImage::from_pixel(2, 2, Rgba([9; 4]));
        let sign = renderer.add_texture(&sign).expect("good");
        let bare = called_for(vec![instance(mesh); 3], Some(sun()));
        let mut signed = bare.clone();
        signed.instances[1].material.texture = Some(sign);
        let mut drawn = |scene: &Scene| {
            renderer.render(scene, &[view()], 8, 8).expect("drawn");
            renderer.passes()
        };
        assert_eq!(drawn(&bare), ["flat"]);
        assert_eq!(drawn(&signed), ["flat", "flat with pictures"]);
        assert_eq!(drawn(&bare), ["flat", "flat with pictures"]);
    }
}

/// A headset's depth and hidden corners have passes of their own, from the frame on that wants them.
#[test]
fn depth_and_hidden_corners_are_drawn_where_they_are_wanted() {
    for samples in [1, 4] {
        let settings = RendererSettings {
            samples,
            ..RendererSettings::default()
        };
        let mut renderer = renderer(settings);
        let mesh = renderer.add_mesh(&MeshData::quad(1.0, 1.0)).expect("good");
        let scene = called_for(vec![instance(mesh); 2], None);
        let device = renderer.gpu.device.clone();
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let image = |format| {
            let texture = texture::single(&device, "eye", [8, 8], 1, format, usage);
            texture.create_view(&Default::default())
        };
        let color = image(crate::passes::lit::COLOR_FORMAT);
        let hidden = HiddenMesh::new(&device, &[[-1.0, 1.0], [0.0, 1.0], [-1.0, 0.0]]);
        let formats = [
            wgpu::TextureFormat::Depth32Float,
            wgpu::TextureFormat::Depth16Unorm,
        ];
        for format in formats {
            let depth = image(format);
            let eye = EyeTarget {
                color: &color,
                depth: Some(&depth),
                hidden: Some(&hidden),
            };
            let mut encoder = device.create_command_encoder(&Default::default());
            let recorded = renderer.record_eyes(&mut encoder, &scene, &[(view(), eye)], [8, 8]);
            recorded.expect("drawn");
            renderer.gpu.queue.submit([encoder.finish()]);
        }
        let passes = renderer.passes();
        assert!(
            passes.contains(&"depth") && passes.contains(&"hidden"),
            "{passes:?}"
        );
    }
}

#[test]
fn a_scene_with_other_effects_draws_again_with_the_maps_of_its_size() {
    let mut renderer = renderer(RendererSettings::default());
    let mesh = renderer.add_mesh(&MeshData::quad(1.0, 1.0)).expect("good");
    let rich = called_for(vec![instance(mesh); 2], Some(sun()));
    let poor = Scene {
        light: None,
        ..rich.clone()
    };
    for (scene, size) in [(&rich, 8), (&poor, 16), (&rich, 16), (&poor, 8), (&rich, 8)] {
        let images = renderer.render(scene, &[view()], size, size);
        assert_eq!(images.expect("drawn").len(), 1);
    }
}

#[test]
fn instances_of_one_mesh_and_texture_are_one_batch() {
    let mut renderer = renderer(RendererSettings::default());
    let a = renderer.add_mesh(&MeshData::quad(1.0, 1.0)).expect("good");
    let b = renderer.add_mesh(&MeshData::quad(2.0, 1.0)).expect("good");
    let picture = RgbaImage::from_pixel(5, 3, Rgba([9; 4]));
    let texture = renderer.add_texture(&picture).expect("good");
    let mut scene = Scene::default();
    for at in 0..12 {
        let mut one = instance(if at % 2 == 0 { a } else { b });
        if at % 3 == 0 {
            one.material.texture = Some(texture);
        }
        scene.instances.push(one);
    }
    renderer.pack_instances(&scene);
    assert_eq!(renderer.frame.batches.len(), 4);
    let drawn: u32 = renderer.frame.batches.iter().map(|batch| batch.count).sum();
    assert_eq!(drawn, 12);
}

#[test]
fn bad_scenes_are_refused_in_a_sentence() {
    let mut renderer = renderer(RendererSettings::default());
    let mesh = renderer.add_mesh(&MeshData::quad(1.0, 1.0)).expect("good");
    let mut reason = |instance: Instance| {
        let scene = Scene {
            instances: vec![instance],
            ..Scene::default()
        };
        let error = renderer.render(&scene, &[view()], 8, 8);
        error.expect_err("it is broken").to_string()
    };
    let mut bad = instance(MeshId(7));
    assert!(reason(bad).contains("instance 0 uses a mesh"));
    bad = instance(mesh);
    bad.world_from_mesh.w_axis.x = f32::NAN;
    assert!(reason(bad).contains("not a number"));
    bad = instance(mesh);
    bad.world_from_mesh = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    assert!(reason(bad).contains("mirrors"));
    bad = instance(mesh);
    bad.material.texture = Some(TextureId(0));
    assert!(reason(bad).contains("uses a texture"));
}

#[test]
fn bad_settings_and_sizes_are_refused() {
    let gpu = Gpu::new(BackendChoice::Noop).expect("the test backend needs no driver");
    let with = |samples, shadow_size| {
        Renderer::new(
            &gpu,
            RendererSettings {
                samples,
                shadow_size,
                ..RendererSettings::default()
            },
        )
    };
    assert!(with(3, 0).is_err());
    assert!(with(4, u32::MAX).is_err());
    let mut renderer = with(4, 0).expect("good settings");
    let error = renderer.render(&Scene::default(), &[view()], 0, 8);
    assert!(error.expect_err("no pixels").to_string().contains("0 x 8"));
}

#[test]
fn update_texture_takes_another_size() {
    let mut renderer = renderer(RendererSettings::default());
    let small = RgbaImage::from_pixel(4, 4, Rgba([1; 4]));
    let id = renderer.add_texture(&small).expect("good");
    renderer.update_texture(id, &small).expect("same size");
    let large = RgbaImage::from_pixel(9, 2, Rgba([1; 4]));
    renderer.update_texture(id, &large).expect("other size");
    assert!(renderer.update_texture(TextureId(5), &small).is_err());
    assert!(renderer.add_texture(&RgbaImage::new(0, 3)).is_err());
}

/// What no scene calls for has no pass; what one calls for draws over every view.
#[test]
fn a_vignette_is_made_when_a_scene_calls_for_it() {
    let mut renderer = renderer(RendererSettings::default());
    let mesh = renderer.add_mesh(&MeshData::quad(1.0, 1.0)).expect("good");
    let mut scene = called_for(vec![instance(mesh)], None);
    let mut drawn = |vignette: Option<Vignette>| {
        scene.vignette = vignette;
        let images = renderer.render(&scene, &[view(), view()], 32, 16);
        assert_eq!(images.expect("drawn").len(), 2);
        renderer.passes().contains(&"vignette")
    };
    let with = |strength| Vignette {
        clear: 0.3,
        strength,
    };
    assert!(!drawn(None));
    assert!(!drawn(Some(with(0.0))));
    assert!(drawn(Some(with(0.8))));
}
