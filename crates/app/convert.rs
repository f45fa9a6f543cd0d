//! From the game's things to the renderer's: models to meshes and materials, a head to two eyes.

mod eyes;
mod light;
mod stock;

use game::{Model, Visible};
use glam::{DQuat, Mat4, Quat, Vec3};
use physics::Pose;
use renderer::{Instance, Material, Scene};

pub use eyes::{bird, eyes, spectator, spectator_eyes};
pub use stock::Stock;

use stock::{Piece, box_material};

/// The scene of these things; the hand is drawn closed while it holds something.
pub fn scene<'a>(
    visible: impl IntoIterator<Item = &'a Visible>,
    stock: &Stock,
    hand_is_closed: bool,
) -> Scene {
    let mut instances: Vec<Instance> = stock
        .scenery
        .iter()
        .map(|piece| Instance {
            mesh: piece.mesh,
            material: piece.material,
            world_from_mesh: Mat4::IDENTITY,
        })
        .collect();
    instances.extend(
        visible
            .into_iter()
            .filter_map(|visible| instance(visible, stock, hand_is_closed)),
    );
    Scene {
        instances,
        light: Some(stock.light),
        lamps: stock.lamps.clone(),
        ..Scene::default()
    }
}

/// A hand at a share of its size, from 0 to 1.
pub fn shrunk_hand(hand: &Visible, stock: &Stock, is_closed: bool, share: f64) -> Option<Instance> {
    let mut instance = instance(hand, stock, is_closed)?;
    instance.world_from_mesh *= Mat4::from_scale(Vec3::splat(share as f32));
    Some(instance)
}

/// One thing; `None` for what the scenery shows already.
fn instance(visible: &Visible, stock: &Stock, hand_is_closed: bool) -> Option<Instance> {
    let (piece, piece_scale) = piece(visible, stock, hand_is_closed)?;
    let origin = match visible.model {
        // The mesh stands on its origin, the model has its origin in its middle.
        Model::RedButton | Model::BlueButton => Vec3::new(0.0, -0.5, 0.0),
        _ => Vec3::ZERO,
    };
    Some(Instance {
        mesh: piece.mesh,
        material: highlighted(piece.material, visible),
        world_from_mesh: world_from(&visible.pose, piece_scale) * Mat4::from_translation(origin),
    })
}

/// Mesh and look of a thing, and what its mesh is scaled by.
fn piece(visible: &Visible, stock: &Stock, hand_is_closed: bool) -> Option<(Piece, Vec3)> {
    let size = visible.size.as_vec3();
    Some(match visible.model {
        // Of a pin, the shape that collides may be an ellipsoid; what is seen stays a pin, or the eye
        // would tell the conditions apart before anything has moved.
        Model::Pin(_) => (stock.pin, Vec3::ONE),
        Model::Ball(number) => {
            let ball = Piece {
                mesh: stock.ball,
                material: stock.balls[usize::from(number) % stock.balls.len()],
            };
            (ball, 0.5 * size)
        }
        Model::Hand if hand_is_closed => (stock.hand_closed, Vec3::ONE),
        Model::Hand => (stock.hand_open, Vec3::ONE),
        Model::RedButton => (stock.buttons[0], size * BUTTON_SCALE),
        Model::BlueButton => (stock.buttons[1], size * BUTTON_SCALE),
        model => {
            let material = box_material(model)?;
            let mesh = stock.cuboid;
            (Piece { mesh, material }, 0.5 * size)
        }
    })
}

/// From the full extents of a button to its mesh, of radius 1 and height 1.
const BUTTON_SCALE: Vec3 = Vec3::new(0.5, 1.0, 0.5);

/// A faint glow marks what the hand can take or what is pressed.
fn highlighted(material: Material, visible: &Visible) -> Material {
    let is_hand = visible.model == Model::Hand;
    let emission = if visible.is_highlighted && !is_hand {
        0.25
    } else {
        material.emission
    };
    Material {
        emission,
        ..material
    }
}

fn world_from(pose: &Pose, scale: Vec3) -> Mat4 {
    Mat4::from_scale_rotation_translation(scale, rotation(pose.rotation), pose.position.as_vec3())
}

fn rotation(rotation: DQuat) -> Quat {
    rotation.as_quat().normalize()
}

#[cfg(test)]
pub(crate) mod tests {
    use std::path::Path;

    use super::*;
    use game::Config;
    use glam::DVec3;
    use renderer::{BackendChoice, Gpu, Renderer, RendererSettings};

    use stock::BALL_TEXTURES;

    /// The shipped settings.
    pub(crate) fn config() -> Config {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("config");
        Config::load(&folder, "alley", None, &[]).expect("the shipped settings")
    }

    fn visible(model: Model, size: DVec3) -> Visible {
        let pose = Pose {
            position: DVec3::new(1.0, 2.0, -3.0),
            rotation: DQuat::IDENTITY,
        };
        Visible {
            model,
            pose,
            size,
            is_highlighted: false,
        }
    }

    /// A stock of triangles and single pixels: what is tested here is where things go, not how they look.
    fn stock() -> Stock {
        let root = tempfile::tempdir().expect("a temporary folder");
        let folder = |name: &str| {
            let path = root.path().join("assets").join(name);
            std::fs::create_dir_all(&path).expect("writable");
            path
        };
        let (meshes, textures) = (folder("meshes"), folder("textures"));
        let others = [
            "pin",
            "ball",
            "hand_open",
            "hand_closed",
            "button_round",
            "button_square",
            "box",
        ];
        for name in others {
            let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
            std::fs::write(meshes.join(format!("{name}.obj")), triangle).expect("writable");
        }
        for name in BALL_TEXTURES
            .iter()
            .chain(&["pin", "lane_boards", "approach_boards"])
        {
            let pixel = renderer::RgbaImage::new(1, 1);
            pixel
                .save(textures.join(format!("{name}.png")))
                .expect("writable");
        }
        let gpu = Gpu::new(BackendChoice::Noop).expect("it needs no driver");
        let mut renderer =
            Renderer::new(&gpu, RendererSettings::default()).expect("plain settings");
        Stock::load(&mut renderer, root.path(), &config()).expect("every asset is there")
    }

    #[test]
    fn instance_scales_meshes_to_the_size_that_is_seen() {
        let stock = stock();
        let extent = |model, size: DVec3, corner: Vec3| {
            let instance = instance(&visible(model, size), &stock, false).expect("it is drawn");
            instance.world_from_mesh.transform_point3(corner) - Vec3::new(1.0, 2.0, -3.0)
        };
        let ball = extent(Model::Ball(0), DVec3::splat(0.2), Vec3::X);
        assert!(ball.abs_diff_eq(Vec3::X * 0.1, 1e-6), "{ball}");
        let bar = extent(Model::SweepBar, DVec3::new(1.0, 0.2, 0.1), Vec3::ONE);
        assert!(bar.abs_diff_eq(Vec3::new(0.5, 0.1, 0.05), 1e-6), "{bar}");
        let button = extent(Model::RedButton, DVec3::new(0.12, 0.04, 0.12), Vec3::Y);
        assert!(button.abs_diff_eq(Vec3::Y * 0.02, 1e-6), "{button}");
    }

    #[test]
    fn scene_shows_the_hand_open_or_closed_and_no_lane_twice() {
        let stock = stock();
        let things = [
            visible(Model::Hand, DVec3::ONE),
            visible(Model::Lane, DVec3::ONE),
        ];
        let open = scene(&things, &stock, false);
        let closed = scene(&things, &stock, true);
        assert_eq!(open.instances.len(), stock.scenery.len() + 1);
        let last = |scene: &Scene| scene.instances.last().expect("the hand").mesh;
        assert_ne!(last(&open), last(&closed));
    }
}
