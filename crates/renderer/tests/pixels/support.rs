use std::sync::OnceLock;

use renderer::glam::{Mat4, Quat, Vec3};
use renderer::{
    BackendChoice, Fov, Gpu, Instance, Light, LightSource, Material, MeshData, Renderer,
    RendererSettings, RgbaImage, Scene, View,
};

/// The two drivers that this program supports on Linux, each opened once.
pub fn gpu(choice: BackendChoice) -> Option<&'static Gpu> {
    static VULKAN: OnceLock<Option<Gpu>> = OnceLock::new();
    static GL: OnceLock<Option<Gpu>> = OnceLock::new();
    let cell = match choice {
        BackendChoice::Gl => &GL,
        _ => &VULKAN,
    };
    cell.get_or_init(|| match Gpu::new(choice) {
        Ok(gpu) => Some(gpu),
        // Continuous integration installs both drivers, so a missing one is a failure there.
        Err(error) if std::env::var_os("CI").is_some() => panic!("{error}"),
        Err(error) => {
            eprintln!("skipped on {choice:?}: {error}");
            None
        }
    })
    .as_ref()
}

/// Runs a test on each installed driver.
pub fn on_each_driver(test: impl Fn(&Gpu)) {
    for choice in [BackendChoice::Vulkan, BackendChoice::Gl] {
        if let Some(gpu) = gpu(choice) {
            test(gpu);
        }
    }
}

pub const PLAIN: RendererSettings = RendererSettings {
    samples: 1,
    shadow_size: 0,
    ..RendererSettings::FULL
};

pub fn renderer(gpu: &Gpu, settings: RendererSettings) -> Renderer {
    Renderer::new(gpu, settings).expect("good settings")
}

/// A scene that no light reaches, on black.
pub fn dark() -> Scene {
    Scene {
        sky: [0.0; 3],
        ground: [0.0; 3],
        background: [0.0; 3],
        ..Scene::default()
    }
}

/// A surface that reflects nothing mirror-like, so that its value is base colour times light.
pub fn matte(value: f32) -> Material {
    Material {
        roughness: 1.0,
        specular: 0.0,
        ..Material::new([value; 3])
    }
}

pub fn add(renderer: &mut Renderer, mesh: &MeshData) -> renderer::MeshId {
    renderer.add_mesh(mesh).expect("a drawable mesh")
}

pub fn instance(mesh: renderer::MeshId, material: Material, at: Vec3) -> Instance {
    Instance {
        mesh,
        material,
        world_from_mesh: Mat4::from_translation(at),
    }
}

/// Lays a quad that faces +z down on the floor.
pub fn lying() -> Mat4 {
    Mat4::from_rotation_x(-std::f32::consts::FRAC_PI_2)
}

/// Straight down from `height` [m]; the world's -z is up in the picture.
pub fn from_above(height: f32) -> View {
    View {
        position: Vec3::Y * height,
        rotation: Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2),
        fov: Fov::symmetric(1.0, 1.0),
    }
}

pub fn sun(direction: Vec3, color: f32) -> Light {
    Light {
        source: LightSource::Directional {
            direction,
            shadow_min: Vec3::new(-2.0, -0.5, -2.0),
            shadow_max: Vec3::new(2.0, 2.0, 2.0),
        },
        color: [color; 3],
        softness_m: 0.01,
    }
}

pub fn one(renderer: &mut Renderer, scene: &Scene, view: View, size: [u32; 2]) -> RgbaImage {
    let mut images = renderer
        .render(scene, &[view], size[0], size[1])
        .expect("a good scene");
    images.pop().expect("one view")
}

/// Red at a pixel; the tests' surfaces are grey.
pub fn value(image: &RgbaImage, x: u32, y: u32) -> i32 {
    i32::from(image.get_pixel(x, y)[0])
}

/// sRGB byte of a linear value, IEC 61966-2-1.
pub fn srgb(linear: f64) -> i32 {
    let encoded = if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    };
    (255.0 * encoded).round() as i32
}

/// Equal but for the last bit, in which drivers round sRGB differently.
pub fn close(a: i32, b: i32) -> bool {
    (a - b).abs() <= 1
}

/// Centre of the lit pixels, weighted by their light, from the upper left corner [pixels].
pub fn centre_of_light(image: &RgbaImage) -> [f64; 2] {
    let mut sum = [0.0, 0.0, 0.0];
    for (x, y, pixel) in image.enumerate_pixels() {
        let encoded = f64::from(pixel[0]) / 255.0;
        // Near enough to the linear value for a weight.
        let weight = encoded.powf(2.2);
        sum[0] += weight * (f64::from(x) + 0.5);
        sum[1] += weight * (f64::from(y) + 0.5);
        sum[2] += weight;
    }
    assert!(sum[2] > 0.0, "nothing was drawn");
    [sum[0] / sum[2], sum[1] / sum[2]]
}

/// Largest difference of a channel between two images.
pub fn largest_difference(a: &RgbaImage, b: &RgbaImage) -> u8 {
    assert_eq!(a.dimensions(), b.dimensions());
    a.as_raw()
        .iter()
        .zip(b.as_raw())
        .map(|(a, b)| a.abs_diff(*b))
        .max()
        .expect("an image has pixels")
}
