use std::path::Path;

use bowling_app::look::{Stage, places};
use renderer::{BackendChoice, Gpu, Instance, Renderer, Scene, TextureId};

use crate::support::bowling;

const SCENES: [&str; 3] = ["alley", "plain-1996", "test"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A scene on the device that draws nothing, but makes everything that a frame needs.
fn open(scene: &str, settings: &[&str]) -> Stage {
    let gpu = Gpu::new(BackendChoice::Noop).expect("it needs no driver");
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_owned()).collect();
    Stage::open(&gpu, root(), scene, &settings).expect("a shipped scene")
}

/// What one picture of it holds, after it was drawn.
fn drawn(stage: &mut Stage) -> (Scene, Vec<&'static str>) {
    let place = &places(&stage.config)[0];
    let eyes = place.eyes(&stage.config.display, 1.5);
    let scene = place.scene(&stage.room, &stage.stock);
    let images = stage.renderer.render(&scene, &eyes, 12, 8).expect("drawn");
    assert_eq!(images.len(), 2);
    (scene, stage.renderer.passes())
}

#[test]
fn scenes_keep_their_budget_of_triangles() {
    for (scene, most) in SCENES.into_iter().zip([60_000, 5_000, 5_000]) {
        let triangles = open(scene, &[]).triangles();
        assert!(triangles <= most, "{scene} has {triangles} triangles");
        assert!(triangles > 1_000, "{scene} has {triangles} triangles");
    }
}

#[test]
fn what_a_scene_does_not_show_has_no_pass_and_no_texture() {
    let passes = |scene: &str, settings: &[&str]| drawn(&mut open(scene, settings)).1;
    let all = ["shadow", "mirror", "lit with occlusion"];
    assert_eq!(passes("alley", &[]), all);
    assert_eq!(passes("plain-1996", &[]), ["flat"]);
    assert_eq!(passes("test", &[]), ["flat"]);
    assert_eq!(passes("alley", &["shows.shadows=false"]), all[1..]);
    assert_eq!(
        passes("alley", &["shows.reflection=false"]),
        ["shadow", "lit with occlusion"]
    );
    assert_eq!(
        passes("alley", &["shows.ambient_occlusion=false"]),
        ["shadow", "mirror", "lit"]
    );
    let textures = |scene: &str| {
        let (scene, _) = drawn(&mut open(scene, &[]));
        let mut textures: Vec<TextureId> = scene
            .instances
            .iter()
            .filter_map(|instance| instance.material.texture)
            .collect();
        textures.sort_unstable();
        textures.dedup();
        textures.len()
    };
    // Pin, grain, panel, scoreboard, and the four kinds of balls.
    assert_eq!((textures("alley"), textures("test")), (8, 0));
    assert_eq!(textures("plain-1996"), 0);
}

#[test]
fn neighbours_and_furnishings_are_instances_that_are_there_or_not() {
    let count = |settings: &[&str]| drawn(&mut open("alley", settings)).0.instances.len();
    let all = count(&[]);
    let alone = count(&["shows.neighbouring_lanes=false"]);
    // Four lanes of six surfaces and ten pins each, and the mesh of their screens.
    assert_eq!(all - alone, 4 * 16 + 1);
    let bare = count(&["shows.neighbouring_lanes=false", "shows.furnishings=false"]);
    assert!(alone > bare + 15, "{alone} {bare}");
}

#[test]
fn every_scene_can_be_looked_at() {
    let folder = crate::support::fresh_folder("look");
    for scene in SCENES {
        let file = folder.join(format!("{scene}.png"));
        let path = file.to_str().expect("a plain name");
        let output = bowling(&["look", "--scene", scene, "--width", "64", "--out", path]);
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(output.status.success(), "{output:?}");
        assert!(text.contains(" triangles\nPasses: "), "{text}");
        assert!(text.contains("Both eyes, 704x480: "), "{text}");
        let sheet = image::open(&file).expect("a picture").to_rgb8();
        assert_eq!(sheet.width(), 4 * 64);
    }
    let output = bowling(&["look", "--scene", "beach"]);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    let named = text.contains("alley") && text.contains("plain-1996") && text.contains("test");
    assert!(output.status.code() == Some(1) && named, "{text}");
}

/// Pictures of the distant pins while a head sways: how much each value jumps back and forth, beside what it moves
/// steadily. A picture that is sampled well changes smoothly when it is moved by less than a pixel; one that is not flickers,
/// and flicker is what the second difference in time keeps.
fn flicker(renderer: &mut Renderer, scene: &Scene) -> f64 {
    use renderer::glam::Vec3;
    use renderer::{Fov, View};
    const PICTURES: usize = 14;
    const SIZE: [u32; 2] = [240, 120];
    let views: Vec<View> = (0..PICTURES)
        .map(|i| {
            // A millimetre a picture, sideways and a little down: at 20 m a twentieth of a pixel, at 5 m a fifth.
            let way = i as f32 * 0.001;
            let from = Vec3::new(0.1 + way, 1.6 - 0.4 * way, 1.0);
            // 16 degrees by 8: 15 pixels a degree.
            let fov = Fov::symmetric(16.0_f32.to_radians(), 8.0_f32.to_radians());
            let at = Vec3::new(0.1, 0.25, -17.5);
            let straight = View::looking_at(Vec3::new(0.1, 1.6, 1.0), at, fov);
            View {
                position: from,
                ..straight
            }
        })
        .collect();
    let mut pictures = Vec::new();
    for view in views {
        let mut images = renderer
            .render(scene, &[view], SIZE[0], SIZE[1])
            .expect("drawn");
        pictures.push(images.pop().expect("one view"));
    }
    let mut sum = 0.0;
    let mut count = 0.0;
    for three in pictures.windows(3) {
        let values = three[0].as_raw().iter().zip(three[1].as_raw());
        for ((a, b), c) in values.zip(three[2].as_raw()) {
            let second = f64::from(*a) - 2.0 * f64::from(*b) + f64::from(*c);
            sum += second * second;
            count += 1.0;
        }
    }
    (sum / count).sqrt()
}

#[test]
fn distant_pins_do_not_flicker_while_a_head_sways() {
    let gpu =
        Gpu::new(BackendChoice::Auto).expect("a graphics driver: install mesa-vulkan-drivers");
    let measured = |settings: &[&str]| {
        let settings: Vec<String> = settings.iter().map(|text| (*text).to_owned()).collect();
        let mut stage = Stage::open(&gpu, root(), "alley", &settings).expect("a shipped scene");
        let place = &places(&stage.config)[0];
        let mut scene = place.scene(&stage.room, &stage.stock);
        // Things near the eye would move by whole pixels; they are not what is looked at.
        let near = |instance: &Instance| {
            let at = instance.world_from_mesh.w_axis;
            at.z > -1.0 && at.truncate().length() > 0.01
        };
        scene.instances.retain(|instance| !near(instance));
        flicker(&mut stage.renderer, &scene)
    };
    let smooth = measured(&[]);
    let jagged = measured(&["shows.smooth_edges=false"]);
    println!("flicker: {smooth:.2} of 255, without smooth edges {jagged:.2}");
    assert!(smooth < FLICKER, "{smooth} of 255");
    assert!(
        jagged > 1.4 * FLICKER,
        "the measure does not tell: {jagged}"
    );
}

/// Most that a value of the picture may jump back and forth, root mean square [1/255].
const FLICKER: f64 = 3.0;
