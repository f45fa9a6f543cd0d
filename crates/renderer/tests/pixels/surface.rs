use image::Rgba;
use renderer::glam::Vec3;
use renderer::{
    Fov, Material, MeshData, RendererSettings, RgbaImage, Scene, TextBlock, TextPainter, View,
};

use crate::support::*;

fn ahead(fov: f32) -> View {
    View::looking_at(Vec3::ZERO, Vec3::NEG_Z, Fov::symmetric(fov, fov))
}

/// A quad of 1 m that shows the texture, `distance` ahead.
fn shown(
    renderer: &mut renderer::Renderer,
    texture: renderer::TextureId,
    view: View,
    distance: f32,
) -> RgbaImage {
    let quad = add(renderer, &MeshData::quad(1.0, 1.0));
    let material = Material {
        texture: Some(texture),
        ..Material::unlit([1.0; 3])
    };
    let scene = Scene {
        instances: vec![instance(quad, material, Vec3::NEG_Z * distance)],
        ..dark()
    };
    one(renderer, &scene, view, [32, 32])
}

/// Four quarters: dark, red, green, blue-ish from the upper left, by rows.
fn quarters() -> RgbaImage {
    RgbaImage::from_fn(32, 32, |x, y| match (x < 16, y < 16) {
        (true, true) => Rgba([40, 40, 40, 255]),
        (false, true) => Rgba([200, 20, 20, 255]),
        (true, false) => Rgba([20, 120, 20, 255]),
        (false, false) => Rgba([20, 20, 130, 255]),
    })
}

#[test]
fn texture_stands_upright_and_keeps_its_bytes() {
    on_each_driver(|gpu| {
        let flat = RendererSettings {
            flat: true,
            ..PLAIN
        };
        for settings in [PLAIN, flat] {
            let mut renderer = renderer(gpu, settings);
            let picture = quarters();
            let id = renderer.add_texture(&picture).expect("a good texture");
            // One texel per pixel, so that the bytes come back; none is above the knee of the tone curve.
            let image = shown(&mut renderer, id, ahead(2.0 * 0.5_f32.atan()), 1.0);
            for (x, y) in [(4, 4), (28, 4), (4, 28), (28, 28)] {
                let (seen, given) = (image.get_pixel(x, y), picture.get_pixel(x, y));
                let off = (0..3).map(|i| seen[i].abs_diff(given[i])).max();
                let flat = settings.flat;
                assert!(
                    off <= Some(1),
                    "({x}, {y}), flat {flat}: {seen:?}, {given:?}"
                );
            }
        }
    });
}

fn assert_shows(renderer: &mut renderer::Renderer, id: renderer::TextureId, expected: i32) {
    let seen = value(&shown(renderer, id, ahead(0.5), 1.0), 16, 16);
    assert!(close(seen, expected), "{seen} instead of {expected}");
}

#[test]
fn updated_texture_shows_the_new_picture() {
    on_each_driver(|gpu| {
        let mut renderer = renderer(gpu, PLAIN);
        let grey = |value| RgbaImage::from_pixel(8, 8, Rgba([value, value, value, 255]));
        let id = renderer.add_texture(&grey(50)).expect("a good texture");
        assert_eq!(
            value(&shown(&mut renderer, id, ahead(0.5), 1.0), 16, 16),
            50
        );
        renderer.update_texture(id, &grey(90)).expect("a good one");
        assert_eq!(
            value(&shown(&mut renderer, id, ahead(0.5), 1.0), 16, 16),
            90
        );
        let wide = RgbaImage::from_pixel(64, 4, Rgba([120, 120, 120, 255]));
        renderer.update_texture(id, &wide).expect("another size");
        assert_shows(&mut renderer, id, 120);
    });
}

#[test]
fn distant_stripes_become_their_mean_in_linear_light() {
    on_each_driver(|gpu| {
        let mut renderer = renderer(gpu, PLAIN);
        // A quarter of each pixel's eight texels is bright, but none in its middle.
        let stripes = RgbaImage::from_fn(256, 256, |x, _| {
            let byte = if x % 8 < 2 { 160 } else { 0 };
            Rgba([byte, byte, byte, 255])
        });
        let id = renderer.add_texture(&stripes).expect("a good texture");
        // 256 texels on 32 pixels.
        let image = shown(&mut renderer, id, ahead(2.0 * 0.5_f32.atan()), 1.0);
        let linear = ((160.0 / 255.0 + 0.055) / 1.055_f64).powf(2.4);
        let expected = srgb(0.25 * linear);
        for (x, y) in [(5, 5), (16, 20), (27, 9)] {
            let seen = value(&image, x, y);
            assert!((seen - expected).abs() <= 2, "{seen}, {expected}");
        }
    });
}

#[test]
fn caption_fills_its_width_and_wraps() {
    on_each_driver(|gpu| {
        let mut text = TextPainter::new(gpu);
        let short = text.caption("Release", 400).expect("drawable");
        assert_eq!(short.width(), 400);
        assert!((16..40).contains(&short.height()), "{}", short.height());
        let long = text.caption(&"release ".repeat(40), 400).expect("drawable");
        assert!(long.height() > 3 * short.height(), "{}", long.height());
        // Ground and letters: translucent and dark, opaque and light.
        let ground = short.get_pixel(399, 0).0.map(i32::from);
        let given = TextBlock::new("").background.map(i32::from);
        assert!((0..4).all(|i| close(ground[i], given[i])), "{ground:?}");
        assert!(
            short
                .pixels()
                .any(|pixel| pixel[0] > 220 && pixel[3] == 255)
        );
    });
}

#[test]
fn block_takes_the_size_that_it_is_given_or_needs() {
    on_each_driver(|gpu| {
        let mut text = TextPainter::new(gpu);
        let mut size = |block: &TextBlock| text.block(block).expect("drawable").dimensions();
        let free = size(&TextBlock::new("X  7/"));
        let longer = size(&TextBlock::new("X  7/  81  300"));
        let two_lines = size(&TextBlock::new("X  7/\n81"));
        assert!(longer.0 > free.0 && longer.1 == free.1);
        assert!(two_lines.1 > free.1 + 10);
        let fixed = TextBlock {
            width: Some(64),
            height: Some(32),
            ..TextBlock::new("X")
        };
        assert_eq!(size(&fixed), (64, 32));
        let monospace = |text: &str| TextBlock {
            monospace: true,
            ..TextBlock::new(text)
        };
        assert_eq!(size(&monospace("iiii")), size(&monospace("MMMM")));
    });
}

#[test]
fn text_that_cannot_be_drawn_is_refused() {
    on_each_driver(|gpu| {
        let mut text = TextPainter::new(gpu);
        assert!(text.caption("x", 0).is_err());
        let huge = TextBlock {
            size_px: f32::NAN,
            ..TextBlock::new("x")
        };
        assert!(text.block(&huge).is_err());
        assert!(text.caption("x", 100).is_ok(), "the painter still works");
    });
}

#[test]
fn same_text_gives_the_same_bytes() {
    on_each_driver(|gpu| {
        let first = TextPainter::new(gpu).caption("Frame 3", 200);
        let mut text = TextPainter::new(gpu);
        let other = text.caption("Frame 4", 200).expect("drawable");
        let again = text.caption("Frame 3", 200).expect("drawable");
        let first = first.expect("drawable");
        assert_eq!(first, again);
        assert_ne!(first, other);
    });
}

#[test]
fn egui_contents_are_painted() {
    on_each_driver(|gpu| {
        let mut text = TextPainter::new(gpu);
        let image = text.paint(120, 40, [0, 0, 60, 255], |ui| {
            ui.painter().rect_filled(
                egui::Rect::from_min_max(egui::pos2(60.0, 0.0), egui::pos2(120.0, 40.0)),
                0.0,
                egui::Color32::from_rgb(10, 200, 30),
            );
        });
        let image = image.expect("drawable");
        assert_eq!(image.get_pixel(10, 20).0, [0, 0, 60, 255]);
        assert_eq!(image.get_pixel(100, 20).0, [10, 200, 30, 255]);
    });
}
