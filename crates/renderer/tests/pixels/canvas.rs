use renderer::glam::{Mat4, Vec3};
use renderer::{Fov, Instance, Material, MeshData, Scene, View};

use crate::support::{PLAIN, add, dark, instance, on_each_driver, one, renderer, value};

/// A view of a unit square at the origin that fills the picture.
fn straight_at_a_square() -> View {
    let angle = 2.0 * 0.25_f32.atan();
    View::looking_at(2.0 * Vec3::Z, Vec3::ZERO, Fov::symmetric(angle, angle))
}

/// The room's square shows the right way up what is painted, and then what is painted over it.
#[test]
fn a_canvas_shows_what_another_renderer_drew_on_it() {
    on_each_driver(|gpu| {
        let mut small = renderer(gpu, PLAIN);
        let card = add(&mut small, &MeshData::quad(1.0, 1.0));
        let corner = |brightness: f32, place: Vec3| Scene {
            instances: vec![instance(card, Material::unlit([brightness; 3]), place)],
            ..dark()
        };
        let mut room = renderer(gpu, PLAIN);
        let (texture, canvas) = room.add_canvas([64, 64]).expect("a small canvas");
        let square = add(&mut room, &MeshData::quad(1.0, 1.0));
        let shows_it = Material {
            texture: Some(texture),
            ..Material::unlit([1.0; 3])
        };
        let scene = Scene {
            instances: vec![Instance {
                mesh: square,
                material: shows_it,
                world_from_mesh: Mat4::IDENTITY,
            }],
            ..dark()
        };
        let view = straight_at_a_square();
        // A card whose lower left corner is the middle of the picture covers its upper right quarter.
        for (brightness, place, [x, y]) in [
            (0.5, Vec3::new(0.5, 0.5, 0.0), [48, 16]),
            (0.2, Vec3::new(-0.5, -0.5, 0.0), [16, 48]),
        ] {
            let drawn = corner(brightness, place);
            canvas.paint(&mut small, &drawn, view).expect("painted");
            let image = one(&mut room, &scene, view, [64, 64]);
            // The same by way of the processor.
            let carried = one(&mut small, &drawn, view, [64, 64]);
            let carried = room.add_texture(&carried).expect("a texture");
            let mut other = scene.clone();
            other.instances[0].material.texture = Some(carried);
            let expected = one(&mut room, &other, view, [64, 64]);
            assert_eq!(value(&image, x, y), value(&expected, x, y));
            assert!(value(&image, x, y) > 40);
            assert_eq!(value(&image, 63 - x, 63 - y), 0);
            assert_eq!(value(&image, 63 - x, y), 0);
        }
    });
}

#[test]
fn a_canvas_without_pixels_is_refused() {
    on_each_driver(|gpu| {
        let mut room = renderer(gpu, PLAIN);
        assert!(room.add_canvas([0, 64]).is_err());
        assert!(room.add_canvas([64, 1 << 20]).is_err());
    });
}
