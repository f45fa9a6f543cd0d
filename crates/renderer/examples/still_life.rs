//! Draws a few solids on a varnished floor for two eyes, with a caption, into a PNG file or a window.
//!
//! `cargo run -p renderer --example still_life -- OUT.png [vulkan|gl]`
//! `cargo run -p renderer --example still_life -- --window [vulkan|gl]` (closes on any key)

use std::sync::Arc;

use renderer::glam::{Mat4, Quat, Vec3};
use renderer::{
    Anchor, BackendChoice, Fov, Gpu, Instance, Lamp, Light, LightSource, Material, MeshData,
    RenderError, Renderer, RendererSettings, RgbaImage, Scene, TextBlock, TextPainter, View,
    WindowTarget,
};
use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::window::{Window, WindowId};

type AnyError = Box<dyn std::error::Error>;

const SIZE: [u32; 2] = [704, 480];

fn main() -> Result<(), AnyError> {
    let mut arguments = std::env::args().skip(1);
    let out = arguments.next().unwrap_or("still_life.png".to_owned());
    let choice = match arguments.next().as_deref() {
        Some("gl") => BackendChoice::Gl,
        Some("vulkan") => BackendChoice::Vulkan,
        _ => BackendChoice::Auto,
    };
    if out == "--window" {
        let mut shown = Shown {
            choice,
            parts: None,
            failure: None,
        };
        EventLoop::new()?.run_app(&mut shown)?;
        return shown.failure.map_or(Ok(()), |error| Err(error.into()));
    }
    let gpu = Gpu::new(choice)?;
    println!("{gpu}");
    let mut renderer = Renderer::new(&gpu, RendererSettings::default())?;
    let mut text = TextPainter::new(&gpu);
    let scene = still_life(&mut renderer, &mut text)?;
    let [width, height] = SIZE;
    let images = renderer.render(&scene, &eyes(width as f32 / height as f32), width, height)?;
    let caption = text.caption("A still life: left eye, right eye.", 2 * width)?;
    let mut sheet = RgbaImage::new(2 * width, height + caption.height());
    image::imageops::replace(&mut sheet, &images[0], 0, 0);
    image::imageops::replace(&mut sheet, &images[1], i64::from(width), 0);
    image::imageops::overlay(&mut sheet, &caption, 0, i64::from(height));
    sheet.save(&out)?;
    println!("wrote {out}");
    Ok(())
}

fn eyes(aspect: f32) -> [View; 2] {
    let head = View::looking_at(
        Vec3::new(0.0, 1.5, 2.6),
        Vec3::new(0.0, 0.35, -0.6),
        Fov::from_aspect(0.75, aspect),
    );
    View::stereo(head.position, head.rotation, 0.063, head.fov)
}

fn still_life(renderer: &mut Renderer, text: &mut TextPainter) -> Result<Scene, RenderError> {
    let floor = renderer.add_mesh(&MeshData::cuboid(Vec3::new(4.0, 0.1, 6.0)))?;
    let wall = renderer.add_mesh(&MeshData::quad(4.0, 2.6))?;
    let ball = renderer.add_mesh(&MeshData::sphere(0.25, 64))?;
    let block = renderer.add_mesh(&MeshData::cuboid(Vec3::new(0.3, 0.8, 0.3)))?;
    let board = renderer.add_mesh(&MeshData::quad(1.6, 0.5))?;
    let boards = renderer.add_texture(&planks())?;
    let letters = text.block(&TextBlock {
        size_px: 56.0,
        width: Some(640),
        height: Some(200),
        padding_px: 30,
        background: [10, 14, 40, 255],
        color: [255, 214, 120, 255],
        ..TextBlock::new("Frame 3   X  7/  81\nRed        48")
    })?;
    let letters = renderer.add_texture(&letters)?;
    let at = |x, y, z| Mat4::from_translation(Vec3::new(x, y, z));
    let place = |mesh, material, world_from_mesh| Instance {
        mesh,
        material,
        world_from_mesh,
    };
    let varnish = Material {
        roughness: 0.18,
        texture: Some(boards),
        texture_repeat: [2.0, 2.0],
        ..Material::new([1.0; 3])
    };
    let glossy = |color| Material {
        roughness: 0.15,
        ..Material::new(color)
    };
    let turned =
        Mat4::from_rotation_translation(Quat::from_rotation_y(0.6), Vec3::new(-0.75, 0.4, -0.9));
    let screen = Material {
        texture: Some(letters),
        ..Material::unlit([1.0; 3])
    };
    Ok(Scene {
        instances: vec![
            place(floor, varnish, at(0.0, -0.05, 0.0)),
            place(wall, Material::new([0.55, 0.42, 0.32]), at(0.0, 1.3, -2.0)),
            place(ball, glossy([0.55, 0.03, 0.04]), at(-0.15, 0.25, 0.1)),
            place(ball, glossy([0.03, 0.06, 0.45]), at(0.5, 0.25, -0.35)),
            place(block, Material::new([0.85, 0.83, 0.78]), turned),
            place(
                block,
                Material::new([0.85, 0.83, 0.78]),
                at(0.95, 0.4, -1.0),
            ),
            place(board, screen, at(0.0, 1.6, -1.9)),
        ],
        light: Some(Light {
            source: LightSource::Directional {
                direction: Vec3::new(0.35, -1.0, -0.45),
                shadow_min: Vec3::new(-2.0, -0.1, -3.0),
                shadow_max: Vec3::new(2.0, 2.6, 3.0),
            },
            color: [0.75, 0.66, 0.52],
            softness_m: 0.02,
        }),
        lamps: vec![Lamp {
            position: Vec3::new(0.0, 2.2, -1.2),
            color: [0.5, 0.36, 0.2],
            range_m: 4.0,
        }],
        ..Scene::default()
    })
}

/// Strips of slightly different browns.
fn planks() -> RgbaImage {
    RgbaImage::from_fn(256, 256, |x, y| {
        let tone = [0, 18, 6, 26, 10, 30, 2, 14][(x / 32) as usize];
        let seam = u8::from(x % 32 == 0) * 50;
        let grain = ((x * 7 + (y / 9) * 13) % 11) as u8;
        image::Rgba([
            205 - tone - seam + grain,
            160 - tone - seam + grain,
            105 - tone - seam,
            255,
        ])
    })
}

/// The window and what is shown in it.
struct Shown {
    choice: BackendChoice,
    parts: Option<(WindowTarget, Renderer, Scene)>,
    failure: Option<RenderError>,
}

impl Shown {
    fn open(&mut self, window: Window) -> Result<(), RenderError> {
        let (gpu, mut target) = WindowTarget::new(Arc::new(window), self.choice)?;
        println!("{gpu}");
        let mut renderer = Renderer::new(&gpu, RendererSettings::default())?;
        let mut text = TextPainter::new(&gpu);
        let scene = still_life(&mut renderer, &mut text)?;
        let help = text.block(&TextBlock::new("Any key closes the window."))?;
        target.set_overlays(&[(Anchor::TopLeft, &help)])?;
        self.parts = Some((target, renderer, scene));
        Ok(())
    }

    fn draw(&mut self) -> Result<(), RenderError> {
        if let Some((target, renderer, scene)) = &mut self.parts {
            let eyes = eyes(target.view_aspect(2));
            target.draw(renderer, scene, &eyes)?;
            target.window().request_redraw();
        }
        Ok(())
    }
}

impl ApplicationHandler for Shown {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        let size = winit::dpi::PhysicalSize::new(1280, 480);
        let attributes = Window::default_attributes()
            .with_title("still life")
            .with_inner_size(size);
        let opened = match event_loop.create_window(attributes) {
            Ok(window) => self.open(window),
            Err(error) => Err(RenderError::Window(error.to_string())),
        };
        if let Err(error) = opened {
            self.failure = Some(error);
            event_loop.exit();
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested | WindowEvent::KeyboardInput { .. } => event_loop.exit(),
            WindowEvent::Resized(size) => {
                if let Some((target, ..)) = &mut self.parts {
                    target.resize(size.width, size.height);
                }
            }
            WindowEvent::RedrawRequested => {
                if let Err(error) = self.draw() {
                    self.failure = Some(error);
                    event_loop.exit();
                }
            }
            _ => {}
        }
    }
}
