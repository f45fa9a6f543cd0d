/// What comes and goes: glow, signs, fence, vignette, hands, machine.
mod things;

use std::path::{Path, PathBuf};

use bowling_app::convert::{self, HandLook, HandShape, Stock};
use bowling_app::look::{Stage, places};
use game::{Conditions, Game, Model, Visible};
use glam::{DQuat, DVec3};
use image::{Rgb, RgbImage, imageops};
use physics::Pose;
use renderer::{BackendChoice, Gpu, Renderer, RendererSettings, RgbaImage};

use crate::support::fresh_folder;

/// Width and height of one eye's picture [pixels].
const SIZE: u32 = 192;
/// Largest mean difference of a colour value [1/255]: drivers differ by 1 at edges.
const MEAN: f64 = 0.4;
/// Largest 99th percentile of the differences [1/255].
const PERCENTILE_99: u8 = 6;
/// Largest difference of all but one in a thousand [1/255]: the shadow of one ball covers two in a thousand.
const PERCENTILE_999: u8 = 12;

/// A hand-set state of the alley, so that no change of the physics changes a picture.
struct State {
    name: &'static str,
    /// `None`: seen by the spectator at the pins.
    head: Option<Pose>,
    visible: Vec<Visible>,
}

fn conditions() -> Conditions {
    let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("config");
    Conditions::load(&config, "alley", &[]).expect("the project's configuration")
}

/// The untouched room, with the hand where it is given.
fn room(conditions: &Conditions, hand: DVec3) -> Vec<Visible> {
    let game = Game::new(conditions.clone(), 10).expect("the project's configuration");
    let mut visible = game.visible();
    visible.retain(|thing| thing.model != Model::Hand);
    visible.push(Visible {
        model: Model::Hand,
        pose: Pose {
            position: hand,
            rotation: DQuat::from_rotation_x(-0.3),
        },
        size: DVec3::ONE,
        is_highlighted: false,
    });
    visible
}

fn head(x: f64, y: f64, z: f64, yaw: f64, pitch: f64) -> Option<Pose> {
    let rotation = DQuat::from_rotation_y(yaw) * DQuat::from_rotation_x(pitch);
    Some(Pose {
        position: DVec3::new(x, y, z),
        rotation,
    })
}

fn set(visible: &mut [Visible], model: Model, position: DVec3, rotation: DQuat) {
    let thing = visible
        .iter_mut()
        .find(|thing| thing.model == model)
        .expect("the model is in the room");
    thing.pose = Pose { position, rotation };
}

fn states() -> Vec<State> {
    let conditions = conditions();
    let hand = DVec3::new(0.3, 1.1, 0.3);
    // The ball is held out over the lane, so that this picture has a shadow too.
    let mut rack = room(&conditions, DVec3::new(0.25, 0.72, -0.65));
    set(
        &mut rack,
        Model::Ball(0),
        DVec3::new(0.25, 0.6, -0.75),
        DQuat::from_rotation_x(0.8),
    );

    let mut flight = room(&conditions, hand);
    set(
        &mut flight,
        Model::Ball(0),
        DVec3::new(0.12, 0.3, -1.0),
        DQuat::from_rotation_x(0.8),
    );

    let mut falling = room(&conditions, hand);
    set(
        &mut falling,
        Model::Ball(0),
        DVec3::new(0.07, 0.109, -18.6),
        DQuat::from_rotation_x(2.0),
    );
    for (number, (x, y, z), lean) in [
        (1, (-0.12, 0.05, -18.5), 1.2),
        (3, (0.3, 0.12, -18.7), -1.5),
        (5, (0.1, 0.2, -19.0), -0.9),
        (2, (-0.16, 0.0, -18.56), 0.25),
    ] {
        let axis = DVec3::new(0.6, 0.0, 0.8);
        set(
            &mut falling,
            Model::Pin(number),
            DVec3::new(x, y, z),
            DQuat::from_axis_angle(axis, lean),
        );
    }

    let buttons = room(&conditions, DVec3::new(-0.75, 1.05, 2.1));
    vec![
        State {
            name: "rack-from-foul-line",
            head: head(0.15, 1.55, 0.3, 0.0, -0.35),
            visible: rack,
        },
        State {
            name: "ball-in-flight",
            head: head(0.0, 1.4, 0.4, 0.0, -0.5),
            visible: flight,
        },
        State {
            name: "pins-falling",
            head: None,
            visible: falling,
        },
        State {
            name: "room-with-buttons",
            head: head(-0.5, 1.6, 3.1, 0.45, -0.45),
            visible: buttons,
        },
    ]
}

/// Both eyes of a state.
fn draw(state: &State, settings: RendererSettings) -> [RgbImage; 2] {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let gpu =
        Gpu::new(BackendChoice::Auto).expect("a graphics driver: install mesa-vulkan-drivers");
    let mut renderer = Renderer::new(&gpu, settings).expect("plain settings");
    let stock =
        Stock::load(&mut renderer, root, &conditions().lobby).expect("the project's assets");
    let look = HandLook::right(HandShape::Closing(0.0));
    let scene = convert::scene(&state.visible, &stock, look);
    let display = &conditions().lobby.display;
    let eyes = match state.head {
        Some(head) => convert::eyes(&head, display),
        None => convert::spectator_eyes(-18.288, display),
    };
    let images = renderer.render(&scene, &eyes, SIZE, SIZE).expect("drawn");
    let images: [RgbaImage; 2] = images.try_into().expect("two eyes");
    images.map(|image| image::DynamicImage::ImageRgba8(image).to_rgb8())
}

/// Mean, 99th and 99.9th percentile of the differences of colour values.
fn difference(a: &RgbImage, b: &RgbImage) -> (f64, u8, u8) {
    let mut differences: Vec<u8> = a
        .as_raw()
        .iter()
        .zip(b.as_raw())
        .map(|(a, b)| a.abs_diff(*b))
        .collect();
    differences.sort_unstable();
    let mean = differences
        .iter()
        .map(|value| f64::from(*value))
        .sum::<f64>()
        / differences.len() as f64;
    let percentile = |per_mille: usize| differences[differences.len() * per_mille / 1000];
    (mean, percentile(990), percentile(999))
}

fn agrees(a: &RgbImage, b: &RgbImage) -> bool {
    let (mean, percentile_99, percentile_999) = difference(a, b);
    a.dimensions() == b.dimensions()
        && mean <= MEAN
        && percentile_99 <= PERCENTILE_99
        && percentile_999 <= PERCENTILE_999
}

fn reference_path(name: &str, eye: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/golden/{name}-{eye}.png"))
}

/// Compares with the reference, or writes it when `UPDATE_GOLDEN=1`; says what is wrong and where to look.
fn check(name: &str, eye: &str, actual: &RgbImage, kept: &Path) -> Result<(), String> {
    let path = reference_path(name, eye);
    if std::env::var_os("UPDATE_GOLDEN").is_some_and(|value| value == "1") {
        actual
            .save(&path)
            .expect("the golden folder can be written to");
        return Ok(());
    }
    compare(name, eye, actual, kept)
}

fn compare(name: &str, eye: &str, actual: &RgbImage, kept: &Path) -> Result<(), String> {
    let path = reference_path(name, eye);
    let actual_path = kept.join(format!("{name}-{eye}-actual.png"));
    actual
        .save(&actual_path)
        .expect("the target folder can be written to");
    let Ok(reference) = image::open(&path) else {
        return Err(format!(
            "{} is missing; look at {} and run with UPDATE_GOLDEN=1 when it is right",
            path.display(),
            actual_path.display()
        ));
    };
    let reference = reference.to_rgb8();
    if agrees(actual, &reference) {
        return Ok(());
    }
    let difference_path = kept.join(format!("{name}-{eye}-difference.png"));
    let shown = RgbImage::from_fn(actual.width(), actual.height(), |x, y| {
        let other = reference
            .get_pixel_checked(x, y)
            .copied()
            .unwrap_or(Rgb([0; 3]));
        let pixel = actual.get_pixel(x, y);
        Rgb([0, 1, 2].map(|part| pixel[part].abs_diff(other[part]).saturating_mul(8)))
    });
    shown
        .save(&difference_path)
        .expect("the target folder can be written to");
    let (mean, percentile, _) = difference(actual, &reference);
    Err(format!(
        "{name}, {eye} eye: mean difference {mean:.2}, 99th percentile {percentile}; see {} and {}",
        actual_path.display(),
        difference_path.display()
    ))
}

#[test]
fn pictures_agree_with_their_references() {
    let kept = fresh_folder("golden");
    let mut problems = Vec::new();
    for state in states() {
        let eyes = draw(&state, RendererSettings::FULL);
        for (eye, image) in ["left", "right"].into_iter().zip(&eyes) {
            problems.extend(check(state.name, eye, image, &kept).err());
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

/// What the references are for: each of these mistakes must be seen in every picture.
#[test]
fn swapped_eyes_a_missing_shadow_and_a_mirrored_lane_are_all_seen() {
    let plain = RendererSettings::FULL;
    for state in states() {
        let [left, right] = draw(&state, plain);
        assert!(agrees(&left, &left));
        assert!(
            !agrees(&left, &right),
            "{}: swapped eyes look the same",
            state.name
        );
        // The left eye of a mirrored world sees what the right eye sees, mirrored.
        let mirrored = imageops::flip_horizontal(&right);
        assert!(
            !agrees(&left, &mirrored),
            "{}: a mirrored lane looks the same",
            state.name
        );
        let [flat, _] = draw(
            &state,
            RendererSettings {
                shadow_size: 0,
                ..plain
            },
        );
        assert!(
            !agrees(&left, &flat),
            "{}: without shadows it looks the same",
            state.name
        );
    }
}

/// Each thing that a scene may show, the place from which it is seen, and the setting that leaves it out.
const EFFECTS: [(&str, &str, &str); 8] = [
    ("shadows", "desk", "shows.shadows=false"),
    ("reflection", "foul line", "shows.reflection=false"),
    ("ambient-occlusion", "pins", "shows.ambient_occlusion=false"),
    (
        "neighbouring-lanes",
        "start",
        "shows.neighbouring_lanes=false",
    ),
    ("furnishings", "hall", "shows.furnishings=false"),
    ("materials", "ball return", "shows.materials=false"),
    ("smooth-edges", "pins", "shows.smooth_edges=false"),
    ("low-polygon", "ball return", "shows.low_polygon=true"),
];

/// The left eye's picture of a scene from a place.
fn seen(gpu: &Gpu, scene: &str, place: &str, settings: &[String]) -> RgbImage {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut stage = Stage::open(gpu, root, scene, settings).expect("a shipped scene");
    let all = places(&stage.config);
    let place = all.iter().find(|one| one.name == place).expect("a place");
    let [left, _] = place.eyes(&stage.config.display, 4.0 / 3.0);
    let scene = place.scene(&stage.room, &stage.stock);
    let mut images = stage
        .renderer
        .render(&scene, &[left], 200, 150)
        .expect("drawn");
    let image = images.pop().expect("one view");
    image::DynamicImage::ImageRgba8(image).to_rgb8()
}

#[test]
fn every_effect_agrees_with_its_references_on_and_off() {
    let kept = fresh_folder("golden-effects");
    let gpu =
        Gpu::new(BackendChoice::Auto).expect("a graphics driver: install mesa-vulkan-drivers");
    let mut problems = Vec::new();
    let mut check_one = |name: &str, image: &RgbImage| {
        problems.extend(check(name, "left", image, &kept).err());
    };
    let mut usual: Vec<(&str, RgbImage)> = Vec::new();
    for place in ["start", "foul line", "pins", "ball return", "desk", "hall"] {
        let image = seen(&gpu, "alley", place, &[]);
        check_one(&format!("alley-{}", place.replace(' ', "-")), &image);
        usual.push((place, image));
    }
    for (effect, place, setting) in EFFECTS {
        let image = seen(&gpu, "alley", place, &[setting.to_owned()]);
        check_one(&format!("without-{effect}"), &image);
        let (_, with) = usual
            .iter()
            .find(|(name, _)| *name == place)
            .expect("drawn");
        assert!(!agrees(with, &image), "{effect}: on and off look the same");
    }
    for scene in ["plain-1996", "test"] {
        check_one(&format!("{scene}-start"), &seen(&gpu, scene, "start", &[]));
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn a_missing_reference_fails_and_names_the_picture() {
    let kept = fresh_folder("golden-missing");
    let problem = compare("no-such-state", "left", &RgbImage::new(4, 4), &kept);
    let problem = problem.expect_err("there is no such reference");
    assert!(
        problem.contains("is missing") && problem.contains("UPDATE_GOLDEN=1"),
        "{problem}"
    );
}
