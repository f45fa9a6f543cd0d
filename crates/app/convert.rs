//! From the game's things to the renderer's: models to meshes and materials, a head to two eyes.

use std::path::Path;

use anyhow::{Context, Result};
use game::{DisplayConfig, Model, Visible};
use glam::{DQuat, DVec3, Mat4, Quat, Vec3};
use physics::Pose;
use renderer::{
    Fov, Instance, Lamp, Light, LightSource, Material, MeshId, Renderer, Scene, TextureId, View,
};

/// Scenery that is drawn where it was made, in the world frame: file stem and look.
const SCENERY: [(&str, Look); 12] = [
    ("lane", Look::Boards),
    ("approach", Look::Approach),
    ("markings", Look::Plain([0.05, 0.03, 0.02], 0.6)),
    ("gutters", Look::Plain([0.10, 0.10, 0.11], 0.45)),
    ("sides", Look::Plain([0.16, 0.12, 0.10], 0.6)),
    ("pit", Look::Plain([0.035, 0.035, 0.04], 0.9)),
    ("masking", Look::Plain([0.10, 0.13, 0.20], 0.7)),
    ("floor", Look::Plain([0.13, 0.12, 0.15], 0.85)),
    ("walls", Look::Plain([0.42, 0.38, 0.33], 0.9)),
    ("ceiling", Look::Plain([0.50, 0.49, 0.47], 0.95)),
    ("lamps", Look::Shining([1.0, 0.96, 0.88])),
    ("rack", Look::Plain([0.12, 0.12, 0.13], 0.5)),
];

/// Balls of the rack in their order; later ones begin again.
const BALL_TEXTURES: [&str; 4] = ["ball_blue", "ball_green", "ball_orange", "ball_violet"];

/// Vertical field of view of the spectator's eyes [rad].
const SPECTATOR_FOV: f32 = 0.85;

/// How a surface looks: linear colour and roughness, or a texture.
#[derive(Debug, Clone, Copy)]
enum Look {
    Plain([f32; 3], f32),
    Shining([f32; 3]),
    Boards,
    Approach,
}

/// Everything that is drawn, held by a renderer.
#[derive(Debug)]
pub struct Stock {
    scenery: Vec<(MeshId, Material)>,
    pin: (MeshId, Material),
    balls: Vec<Material>,
    ball: MeshId,
    hand_open: MeshId,
    hand_closed: MeshId,
    /// Round for Red, square for Blue: told apart without colours.
    buttons: [(MeshId, Material); 2],
    cuboid: MeshId,
}

impl Stock {
    /// Loads meshes and textures from `assets/` in `root`.
    ///
    /// # Errors
    /// A sentence with the file, and the line of a malformed mesh.
    pub fn load(renderer: &mut Renderer, root: &Path) -> Result<Self> {
        let mesh = |renderer: &mut Renderer, name: &str| {
            let path = root.join(format!("assets/meshes/{name}.obj"));
            renderer.load_obj(&path).context("cannot load a mesh")
        };
        let texture = |renderer: &mut Renderer, name: &str| {
            let path = root.join(format!("assets/textures/{name}.png"));
            renderer
                .load_texture(&path)
                .context("cannot load a texture")
        };
        let boards = texture(renderer, "lane_boards")?;
        let approach = texture(renderer, "approach_boards")?;
        let mut scenery = Vec::new();
        for (name, look) in SCENERY {
            scenery.push((mesh(renderer, name)?, look.material(boards, approach)));
        }
        let mut balls = Vec::new();
        for name in BALL_TEXTURES {
            balls.push(Material {
                roughness: 0.18,
                texture: Some(texture(renderer, name)?),
                ..Material::new([1.0; 3])
            });
        }
        let pin_texture = texture(renderer, "pin")?;
        let button = |color| Material {
            roughness: 0.3,
            ..Material::new(color)
        };
        Ok(Stock {
            scenery,
            pin: (
                mesh(renderer, "pin")?,
                Material {
                    roughness: 0.25,
                    texture: Some(pin_texture),
                    ..Material::new([0.92; 3])
                },
            ),
            balls,
            ball: mesh(renderer, "ball")?,
            hand_open: mesh(renderer, "hand_open")?,
            hand_closed: mesh(renderer, "hand_closed")?,
            buttons: [
                (mesh(renderer, "button_round")?, button([0.55, 0.02, 0.02])),
                (mesh(renderer, "button_square")?, button([0.02, 0.06, 0.55])),
            ],
            cuboid: mesh(renderer, "box")?,
        })
    }
}

impl Look {
    fn material(self, boards: TextureId, approach: TextureId) -> Material {
        match self {
            Look::Plain(color, roughness) => Material {
                roughness,
                ..Material::new(color)
            },
            Look::Shining(color) => Material::unlit(color),
            Look::Boards => Material {
                roughness: 0.22,
                texture: Some(boards),
                ..Material::new([0.95; 3])
            },
            Look::Approach => Material {
                roughness: 0.35,
                texture: Some(approach),
                ..Material::new([0.95; 3])
            },
        }
    }
}

/// The scene of these things; the hand is drawn closed while it holds something.
pub fn scene<'a>(
    visible: impl IntoIterator<Item = &'a Visible>,
    stock: &Stock,
    hand_is_closed: bool,
) -> Scene {
    let mut instances: Vec<Instance> = stock
        .scenery
        .iter()
        .map(|(mesh, material)| Instance {
            mesh: *mesh,
            material: *material,
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
        light: Some(light()),
        lamps: lamps(),
        ..Scene::default()
    }
}

/// The light over the approach and lane; a box of shadows from the room's back to the pit.
///
/// It leans across the lane and not along it: along 25 m even a small lean would bring the ceiling between the light and
/// one end of the box, and half of the approach into the ceiling's shadow.
fn light() -> Light {
    Light {
        source: LightSource::Directional {
            direction: Vec3::new(-0.25, -1.0, 0.0),
            shadow_min: Vec3::new(-1.6, -0.2, -21.0),
            shadow_max: Vec3::new(1.9, 1.9, 5.0),
        },
        color: [0.55, 0.52, 0.47],
        softness_m: 0.02,
    }
}

/// Warm light over the lane and a brighter one over the pins, as alleys have.
fn lamps() -> Vec<Lamp> {
    let lamp = |z: f32, strength: f32| Lamp {
        position: Vec3::new(0.0, 2.4, z),
        color: [strength, 0.95 * strength, 0.85 * strength],
        range_m: 6.0,
    };
    // Well in front of the masking panel, which it would bleach from nearby.
    let over_pins = Lamp {
        position: Vec3::new(0.0, 1.6, -16.2),
        color: [1.3, 1.28, 1.2],
        range_m: 5.0,
    };
    vec![lamp(2.5, 0.8), lamp(-4.0, 0.6), lamp(-10.0, 0.5), over_pins]
}

/// One thing; `None` for what the scenery's meshes show already.
fn instance(visible: &Visible, stock: &Stock, hand_is_closed: bool) -> Option<Instance> {
    let size = visible.size.as_vec3();
    // Of a pin, the shape that collides may be an ellipsoid; what is seen stays a pin, or the eye
    // would tell the conditions apart before anything has moved.
    let (mesh, material, scale) = match visible.model {
        Model::Pin(_) => (stock.pin.0, stock.pin.1, Vec3::ONE),
        Model::Ball(number) => (
            stock.ball,
            stock.balls[usize::from(number) % stock.balls.len()],
            0.5 * size,
        ),
        Model::Hand => {
            let mesh = if hand_is_closed {
                stock.hand_closed
            } else {
                stock.hand_open
            };
            (
                mesh,
                Material {
                    roughness: 0.6,
                    ..Material::new([0.62, 0.40, 0.29])
                },
                Vec3::ONE,
            )
        }
        Model::RedButton | Model::BlueButton => {
            let (mesh, material) = stock.buttons[usize::from(visible.model == Model::BlueButton)];
            // The mesh has radius 1 and stands on its origin, the model has its origin in its middle.
            let scale = Vec3::new(0.5 * size.x, size.y, 0.5 * size.z);
            let world_from_mesh = world_from(&visible.pose, scale)
                * Mat4::from_translation(Vec3::new(0.0, -0.5, 0.0));
            return Some(Instance {
                mesh,
                material: highlighted(material, visible),
                world_from_mesh,
            });
        }
        Model::FoulLine => (stock.cuboid, Material::new([0.02, 0.02, 0.02]), 0.5 * size),
        Model::Kickback => (stock.cuboid, Material::new([0.10, 0.09, 0.09]), 0.5 * size),
        Model::Rack => (
            stock.cuboid,
            Material {
                roughness: 0.4,
                ..Material::new([0.22, 0.22, 0.24])
            },
            0.5 * size,
        ),
        Model::Desk => (
            stock.cuboid,
            Material {
                roughness: 0.5,
                ..Material::new([0.30, 0.20, 0.12])
            },
            0.5 * size,
        ),
        Model::SweepBar => (
            stock.cuboid,
            Material {
                roughness: 0.4,
                ..Material::new([0.20, 0.21, 0.24])
            },
            0.5 * size,
        ),
        Model::Lane
        | Model::Approach
        | Model::Gutter
        | Model::Pit
        | Model::Cushion
        | Model::SideFloor
        | Model::Wall
        | Model::Ceiling => return None,
    };
    let world_from_mesh = world_from(&visible.pose, scale);
    Some(Instance {
        mesh,
        material: highlighted(material, visible),
        world_from_mesh,
    })
}

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

/// The two eyes of a head, left first, with the angles of the display profile in use.
pub fn eyes(world_from_head: &Pose, display: &DisplayConfig) -> [View; 2] {
    View::stereo(
        world_from_head.position.as_vec3(),
        rotation(world_from_head.rotation),
        display.eye_distance_m as f32,
        right_eye(display),
    )
}

/// The right eye's field of view: its outer edge is at the right.
fn right_eye(display: &DisplayConfig) -> Fov {
    let profile = display.current();
    let radians = |degrees: f64| degrees.to_radians() as f32;
    Fov {
        left: -radians(profile.inner_deg),
        right: radians(profile.outer_deg),
        up: radians(profile.up_deg),
        down: -radians(profile.down_deg),
    }
}

/// A spectator's two eyes before the pin deck, left first; narrower than a headset's, for the pins' sake.
pub fn spectator_eyes(headpin_z: f64, display: &DisplayConfig) -> [View; 2] {
    let [left, right] = eyes(&spectator(headpin_z), display);
    let fov = Fov::from_aspect(SPECTATOR_FOV, right.fov.aspect());
    [View { fov, ..left }, View { fov, ..right }]
}

/// `world_from_head` of a spectator before the pin deck, who looks at the pins from above the lane.
pub fn spectator(headpin_z: f64) -> Pose {
    let position = DVec3::new(0.25, 0.75, headpin_z + 1.3);
    let target = DVec3::new(0.0, 0.1, headpin_z - 0.4);
    let way = target - position;
    let yaw = libm::atan2(-way.x, -way.z);
    let pitch = libm::atan2(way.y, libm::sqrt(way.x * way.x + way.z * way.z));
    Pose {
        position,
        rotation: DQuat::from_rotation_y(yaw) * DQuat::from_rotation_x(pitch),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use game::{DisplayProfile, DisplayProfileName};
    use renderer::{BackendChoice, Gpu, RendererSettings};

    fn display(profile: DisplayProfileName) -> DisplayConfig {
        let angles = |outer_deg, inner_deg, up_deg, down_deg| DisplayProfile {
            outer_deg,
            inner_deg,
            up_deg,
            down_deg,
            width_px: 64,
            height_px: 64,
            relayed_width_px: 64,
            relayed_height_px: 64,
        };
        DisplayConfig {
            profile,
            eye_distance_m: 0.06,
            modern: angles(54.0, 44.0, 46.0, 50.0),
            of_1996: angles(37.5, 37.5, 20.0, 20.0),
        }
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
        for name in SCENERY.iter().map(|(name, _)| *name).chain(others) {
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
        Stock::load(&mut renderer, root.path()).expect("every asset is there")
    }

    #[test]
    fn eyes_lie_left_and_right_of_the_head_along_its_own_axis() {
        let quarter_left = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2);
        let head = Pose {
            position: DVec3::new(0.0, 1.6, 2.0),
            rotation: quarter_left,
        };
        let [left, right] = eyes(&head, &display(DisplayProfileName::Modern));
        // Facing -x, the right hand is at -z.
        assert!(
            right.position.abs_diff_eq(Vec3::new(0.0, 1.6, 1.97), 1e-5),
            "{}",
            right.position
        );
        assert!(
            left.position.abs_diff_eq(Vec3::new(0.0, 1.6, 2.03), 1e-5),
            "{}",
            left.position
        );
    }

    #[test]
    fn eyes_mirror_the_profile_and_keep_its_angles() {
        let [left, right] = eyes(&Pose::IDENTITY, &display(DisplayProfileName::Modern));
        let degrees = |angle: f32| angle.to_degrees().round();
        assert_eq!(
            (degrees(left.fov.left), degrees(left.fov.right)),
            (-54.0, 44.0)
        );
        assert_eq!(
            (degrees(right.fov.left), degrees(right.fov.right)),
            (-44.0, 54.0)
        );
        assert_eq!(
            (degrees(left.fov.up), degrees(left.fov.down)),
            (46.0, -50.0)
        );
        let [old, _] = eyes(&Pose::IDENTITY, &display(DisplayProfileName::Of1996));
        assert!(((old.fov.right - old.fov.left).to_degrees() - 75.0).abs() < 1e-3);
        assert!(((old.fov.up - old.fov.down).to_degrees() - 40.0).abs() < 1e-3);
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
        assert_eq!(open.instances.len(), SCENERY.len() + 1);
        let last = |scene: &Scene| scene.instances.last().expect("the hand").mesh;
        assert_ne!(last(&open), last(&closed));
    }

    #[test]
    fn spectator_looks_down_at_the_pins() {
        let pose = spectator(-18.288);
        let ahead = pose.rotation * DVec3::NEG_Z;
        let deck = (DVec3::new(0.0, 0.1, -18.688) - pose.position).normalize_or_zero();
        assert!(ahead.dot(deck) > 0.9999, "{ahead} {deck}");
    }
}
