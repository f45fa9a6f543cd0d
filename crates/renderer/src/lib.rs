//! Draws a [`Scene`] for any number of [`View`]s, into images or a window. Knows nothing of what it draws.
//!
//! World frame: right-handed, +Y up, -Z forward, metres; an eye looks along its own -Z, as in OpenXR. Colours are
//! linear, images sRGB. A light's colour is what a white matte surface facing it shows; values up to 0.6 are shown as
//! they are, brighter ones are rolled off towards white.
//!
//! One [`Gpu`] serves a [`Renderer`], a [`TextPainter`] and a [`WindowTarget`]. A frame is one shadow map for all eyes,
//! then for each eye the image in the glossy floor and one lit pass. What a scene or the settings do not call for has no
//! pass, pipeline or texture. Everything works alike through Vulkan and OpenGL, also on software drivers.
//!
//! ```no_run
//! use renderer::{BackendChoice, Fov, Gpu, Instance, Material, MeshData, Renderer, RendererSettings, Scene, View};
//! use renderer::glam::{Mat4, Vec3};
//!
//! let gpu = Gpu::new(BackendChoice::Auto)?;
//! let mut renderer = Renderer::new(&gpu, RendererSettings::default())?;
//! let ball = renderer.add_mesh(&MeshData::sphere(0.108, 48))?;
//! let mut scene = Scene::default();
//! scene.instances.push(Instance {
//!     mesh: ball,
//!     material: Material::new([0.6, 0.05, 0.05]),
//!     world_from_mesh: Mat4::IDENTITY,
//! });
//! let view = View::looking_at(Vec3::Z, Vec3::ZERO, Fov::symmetric(0.5, 0.4));
//! let images = renderer.render(&scene, &[view], 320, 240)?;
//! images[0].save("ball.png")?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod headset;

mod canvas;
mod error;
mod eye_targets;
mod gpu;
mod mesh;
mod obj;
mod offscreen;
mod passes;
mod relay;
mod renderer;
mod scene;
mod shaders;
mod text;
mod texture;
mod uniforms;
mod view;
mod window;

pub use egui;
pub use glam;
pub use image::RgbaImage;

pub use canvas::Canvas;
pub use error::RenderError;
pub use eye_targets::EyeTargets;
pub use gpu::{BackendChoice, Gpu};
pub use mesh::{MeshData, Vertex};
pub use relay::relay;
pub use renderer::{MAX_VIEWS, Renderer, RendererSettings};
pub use scene::{
    Enclosure, Instance, Lamp, Light, LightSource, MAX_LAMPS, MAX_OCCLUDERS, Material, MeshId,
    Occluder, Pattern, Scene, TextureId, Vignette,
};
pub use text::{TextBlock, TextPainter};
pub use texture::{Picture, load_image};
pub use view::{FAR_M, Fov, NEAR_M, View};
pub use window::{Anchor, WindowTarget};
