//! From the game's things to the renderer's: models to meshes and materials, a head to two eyes.

pub(crate) mod board;
mod eyes;
mod hand;
mod light;
mod screen;
mod shape;
mod stock;

use game::{Game, Model, Visible};
use glam::{DQuat, Mat4, Quat, Vec3};
use physics::Pose;
use renderer::{Instance, MAX_OCCLUDERS, Material, Occluder, Scene, Vignette};

pub use board::Scores;
pub use eyes::{bird, eyes, spectator, spectator_eyes};
pub use hand::shrunk_hand;
pub use shape::{HandLook, HandShape};
pub use stock::{Stock, settings};

use stock::box_material;

/// The scene of these things, with the hand as it looks.
pub fn scene<'a>(
    visible: impl IntoIterator<Item = &'a Visible>,
    stock: &Stock,
    hand: HandLook,
) -> Scene {
    let visible: Vec<Visible> = visible.into_iter().copied().collect();
    let mut instances = stock.scenery.clone();
    fit_rack_stand(&mut instances, &visible, stock);
    instances.extend(stock.screen_instance());
    for thing in &visible {
        match thing.model {
            Model::Hand => instances.extend(hand::instances(thing, &visible, stock, hand)),
            _ => add_thing(&mut instances, thing, stock),
        }
    }
    Scene {
        instances,
        light: stock.light,
        lamps: stock.lamps.clone(),
        occluders: occluders(&visible, stock),
        enclosure: stock.enclosure,
        ..Scene::default()
    }
}

/// The dark edge of the picture while the participant walks by button, where the settings have one.
pub fn vignette(game: &Game) -> Option<Vignette> {
    let config = game.config();
    let comfort = &config.comfort;
    let strength = game.walking_speed() / config.walking.speed_mps;
    (comfort.vignette && strength > 0.0).then(|| Vignette {
        clear: comfort.vignette_clear_deg.to_radians() as f32,
        strength: strength.min(1.0) as f32,
    })
}

/// Stretches the stand under the rack to where the rack is.
fn fit_rack_stand(instances: &mut [Instance], visible: &[Visible], stock: &Stock) {
    let stand = &stock.rack_stand;
    let top = |thing: &Visible| (thing.pose.position.y + 0.5 * thing.size.y) as f32;
    let rack = visible.iter().filter(|thing| thing.model == Model::Rack);
    let raised = rack.map(top).fold(0.0, f32::max) - stand.rims;
    // As the settings have it, or a scene without a rack.
    if raised.abs() < 1e-4 || raised <= -stand.rims {
        return;
    }
    if let Some(instance) = stand.place.and_then(|place| instances.get_mut(place)) {
        let share = (stand.height + raised) / stand.height;
        instance.world_from_mesh *= Mat4::from_scale(Vec3::new(1.0, share, 1.0));
    }
}

/// Nothing for what the scenery shows already.
fn add_thing(instances: &mut Vec<Instance>, thing: &Visible, stock: &Stock) {
    let size = thing.size.as_vec3();
    let mut add = |mesh, material, scale, origin| {
        instances.push(Instance {
            mesh,
            material: highlighted(material, thing),
            world_from_mesh: world_from(&thing.pose, scale) * Mat4::from_translation(origin),
        });
    };
    match thing.model {
        // Of a pin, the shape that collides may be an ellipsoid; what is seen stays a pin, or the eye
        // would tell the conditions apart before anything has moved.
        Model::Pin(_) => {
            for piece in &stock.pin {
                add(piece.mesh, piece.material, Vec3::ONE, Vec3::ZERO);
            }
        }
        Model::Ball(number) => {
            let material = stock.balls[usize::from(number) % stock.balls.len()];
            add(stock.ball, material, 0.5 * size, Vec3::ZERO);
            if let Some(holes) = &stock.ball_holes {
                add(holes.mesh, holes.material, 0.5 * size, Vec3::ZERO);
            }
        }
        Model::RedButton | Model::BlueButton => {
            let button = &stock.buttons[usize::from(thing.model == Model::BlueButton)];
            // The mesh stands on its origin, the model has its origin in its middle.
            let origin = Vec3::new(0.0, -0.5, 0.0);
            add(button.mesh, button.material, size * BUTTON_SCALE, origin);
        }
        model => {
            if let Some(material) = box_material(model) {
                add(stock.cuboid, material, 0.5 * size, Vec3::ZERO);
            }
        }
    }
}

/// Height of the middle and radius of the balls that stand for a pin when it hides the sky [m].
const PIN_BALLS: [(f64, f32); 2] = [(0.055, 0.045), (0.115, 0.06)];

/// What hides the sky: balls, and pins as two balls each, the first as many as a scene may have.
fn occluders(visible: &[Visible], stock: &Stock) -> Vec<Occluder> {
    let mut occluders = Vec::new();
    if !stock.shows.ambient_occlusion {
        return occluders;
    }
    for thing in visible {
        match thing.model {
            Model::Ball(_) => occluders.push(Occluder {
                position: thing.pose.position.as_vec3(),
                radius_m: 0.5 * thing.size.x as f32,
            }),
            Model::Pin(_) => occluders.extend(PIN_BALLS.map(|(height, radius_m)| {
                let at = thing.pose.transform_point(glam::DVec3::Y * height);
                Occluder {
                    position: at.as_vec3(),
                    radius_m,
                }
            })),
            _ => {}
        }
    }
    occluders.truncate(MAX_OCCLUDERS);
    occluders
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

    pub(crate) fn visible(model: Model, size: DVec3) -> Visible {
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
    pub(crate) fn stock() -> Stock {
        let root = tempfile::tempdir().expect("a temporary folder");
        let folder = |name: &str| {
            let path = root.path().join("assets").join(name);
            std::fs::create_dir_all(&path).expect("writable");
            path
        };
        let (meshes, textures) = (folder("meshes"), folder("textures"));
        let others = [
            "pin",
            "pin_low",
            "ball",
            "button_round",
            "button_square",
            "box",
        ];
        for name in others {
            let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
            std::fs::write(meshes.join(format!("{name}.obj")), triangle).expect("writable");
        }
        for name in BALL_TEXTURES.iter().chain(&["pin", "grain", "masking"]) {
            let pixel = renderer::RgbaImage::new(1, 1);
            pixel
                .save(textures.join(format!("{name}.png")))
                .expect("writable");
        }
        let words = root.path().join("config");
        std::fs::create_dir_all(&words).expect("writable");
        let shipped = include_str!("../../config/words.toml");
        std::fs::write(words.join("words.toml"), shipped).expect("writable");
        let gpu = Gpu::new(BackendChoice::Noop).expect("it needs no driver");
        let mut renderer =
            Renderer::new(&gpu, RendererSettings::default()).expect("plain settings");
        Stock::load(&mut renderer, root.path(), &config()).expect("every asset is there")
    }

    #[test]
    fn instance_scales_meshes_to_the_size_that_is_seen() {
        let stock = stock();
        let extent = |model, size: DVec3, corner: Vec3| {
            let mut instances = Vec::new();
            add_thing(&mut instances, &visible(model, size), &stock);
            let instance = instances.first().expect("it is drawn");
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
    fn scene_shows_the_hand_in_its_shape_and_no_lane_twice() {
        let stock = stock();
        let things = [
            visible(Model::Hand, DVec3::ONE),
            visible(Model::Lane, DVec3::ONE),
        ];
        let last = |shape| {
            let scene = scene(&things, &stock, HandLook::right(shape));
            assert_eq!(scene.instances.len(), stock.scenery.len() + 1);
            *scene.instances.last().expect("the hand")
        };
        let open = last(HandShape::Closing(0.0));
        assert_ne!(open.mesh, last(HandShape::Closing(0.3)).mesh);
        assert_ne!(open.mesh, last(HandShape::Pointing).mesh);
        assert_eq!(
            open.world_from_mesh,
            last(HandShape::Pointing).world_from_mesh
        );
    }

    #[test]
    fn the_stand_follows_a_rack_that_was_raised() {
        let stock = stock();
        let rack = &config().rack;
        let place = stock.rack_stand.place.expect("the alley has one");
        let stretched = |tray: f64| {
            let mut thing = visible(Model::Rack, DVec3::splat(rack.rim_height_m));
            thing.pose.position.y = tray + 0.5 * rack.rim_height_m;
            let scene = scene(&[thing], &stock, HandLook::right(HandShape::Closing(0.0)));
            let top = Vec3::Y * stock.rack_stand.height;
            scene.instances[place]
                .world_from_mesh
                .transform_point3(top)
                .y
        };
        for tray in [rack.tray_height_m, 0.5, 0.93] {
            let top = f64::from(stretched(tray));
            assert!((top - (tray - 0.04)).abs() < 1e-4, "{tray}: {top}");
        }
    }
}
