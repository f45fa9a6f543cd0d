//! What comes and goes in a picture: each is there in one and not in the other, and agrees with its reference.

use std::path::{Path, PathBuf};

use bowling_app::convert::{self, HandLook, HandShape, Scores};
use bowling_app::fence::{self, Space};
use bowling_app::hints::Grip;
use bowling_app::labels;
use bowling_app::look::{Stage, places};
use bowling_app::practice::Track;
use bowling_app::signs::{Sign, SignStock};
use bowling_app::words::Words;
use bowling_app::wrist::{Arms, Wrist};
use game::{Conditions, Game, Input, MAX_FRAMES, Model, ThrowSeen, Tracked, Visible};
use glam::{DQuat, DVec3};
use image::{DynamicImage, RgbImage};
use physics::Pose;
use renderer::{BackendChoice, Fov, Gpu, Instance, Scene, View, Vignette};

use super::{agrees, check, conditions};
use crate::support::fresh_folder;

/// Size of a picture [pixels].
const WIDE: u32 = 200;
const HIGH: u32 = 150;

/// A scene on a device, and what was found wrong so far.
struct Album {
    gpu: Gpu,
    stage: Stage,
    kept: PathBuf,
    problems: Vec<String>,
}

impl Album {
    fn open(name: &str, settings: &[&str]) -> Self {
        Self::open_scene("alley", name, settings)
    }

    fn open_scene(scene: &str, name: &str, settings: &[&str]) -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let gpu =
            Gpu::new(BackendChoice::Auto).expect("a graphics driver: install mesa-vulkan-drivers");
        let settings: Vec<String> = settings.iter().map(|text| (*text).to_owned()).collect();
        let stage = Stage::open(&gpu, root, scene, &settings).expect("a shipped scene");
        Self {
            gpu,
            stage,
            kept: fresh_folder(name),
            problems: Vec::new(),
        }
    }

    /// The eyes of a place, and what is seen from there.
    fn at(&self, name: &str) -> ([View; 2], Scene) {
        let all = places(&self.stage.config);
        let place = all
            .iter()
            .find(|place| place.name == name)
            .expect("a place");
        let eyes = place.eyes(&self.stage.config.display, WIDE as f32 / HIGH as f32);
        (eyes, place.scene(&self.stage.room, &self.stage.stock))
    }

    /// The room with some of its things elsewhere.
    fn room_with(&self, change: impl Fn(&mut Visible)) -> Scene {
        let mut room = self.stage.room.clone();
        room.iter_mut().for_each(change);
        self.scene(&room, HandLook::right(HandShape::Closing(0.0)))
    }

    fn scene(&self, things: &[Visible], look: HandLook) -> Scene {
        convert::scene(things, &self.stage.stock, look)
    }

    fn draw(&mut self, scene: &Scene, view: View) -> RgbImage {
        let images = self.stage.renderer.render(scene, &[view], WIDE, HIGH);
        let image = images.expect("drawn").pop().expect("one view");
        DynamicImage::ImageRgba8(image).to_rgb8()
    }

    fn signs(&mut self, signs: &[Sign]) -> Vec<Instance> {
        let mut stock =
            SignStock::new(&self.gpu, &mut self.stage.renderer).expect("it takes a mesh");
        let painted = stock.instances(signs, &mut self.stage.renderer);
        painted.expect("painted")
    }

    /// Holds what is seen with the thing against its reference, and against what is seen without.
    fn compare(&mut self, name: &str, view: View, without: &Scene, with: &Scene) {
        let [without, with] = [without, with].map(|scene| self.draw(scene, view));
        assert!(!agrees(&without, &with), "{name}: on and off look the same");
        let problem = check(name, "left", &with, &self.kept);
        self.problems.extend(problem.err());
    }

    /// Holds this scene, from a place, against its reference and against the scene with its usual settings.
    fn compare_with_usual(&mut self, name: &str, place: &str) {
        let (eyes, with) = self.at(place);
        let mut usual = Self::open(&format!("golden-usual-{name}"), &[]);
        // Meshes are numbered by the renderer that holds them: each scene is drawn by its own.
        let (_, without) = usual.at(place);
        let [without, with] = [usual.draw(&without, eyes[0]), self.draw(&with, eyes[0])];
        assert!(!agrees(&without, &with), "{name}: on and off look the same");
        let problem = check(name, "left", &with, &self.kept);
        self.problems.extend(problem.err());
    }

    /// The buttons' names and the first hint, from the start.
    fn compare_names_and_hint(&mut self, name: &str) {
        let head = DVec3::new(0.0, 1.62, 0.0);
        let game = standing(conditions(), head, None, 0.0);
        let signs = labels::signs(&game, Grip::Trigger, &Words::shipped());
        let signs = self.signs(&signs);
        assert_eq!(signs.len(), 3, "two names and a hint");
        let (eyes, without) = self.at("start");
        let mut with = without.clone();
        with.instances.extend(signs);
        self.compare(name, eyes[0], &without, &with);
        // From where they are so large that one is not taken for the other.
        let near = looking(DVec3::new(-0.9, 1.25, 2.6), DVec3::new(-1.1, 1.0, 1.8));
        self.compare(&format!("{name}-near"), near, &without, &with);
    }

    /// The panel at the wrist, which is looked at.
    fn compare_wrist_panel(&mut self, name: &str) {
        let mut wrist = Wrist::default();
        let eye = DVec3::new(0.0, 1.62, 4.4);
        let at = DVec3::new(-0.1, 1.25, 4.0);
        let view = looking(eye, at + DVec3::Y * 0.1);
        let arms = Arms {
            head: Pose::new(eye, view.rotation.as_dquat()),
            wrist: Pose::from_position(at),
            pointer: None,
        };
        assert_eq!(wrist.attend(Some(arms), true, 0.0), None);
        let panel = self.signs(&wrist.signs(false, &Words::shipped().pause));
        assert_eq!(panel.len(), 2);
        let (_, without) = self.at("start");
        let mut with = without.clone();
        with.instances.extend(panel);
        self.compare(name, view, &without, &with);
    }

    fn close(self) {
        assert!(self.problems.is_empty(), "{}", self.problems.join("\n"));
    }
}

/// A game in which somebody stands, with the hand where it is given, in tracking space; it is where a session begins.
fn standing(
    conditions: Conditions,
    head: DVec3,
    hand: Option<(DVec3, bool)>,
    trigger: f64,
) -> Game {
    let mut game = Game::new(conditions, 10).expect("the project's configuration");
    let at = |position| Some(Tracked::at(Pose::from_position(position)));
    // Open, so that what is then closed on is grabbed.
    for trigger in [0.0, trigger] {
        game.step(&Input {
            head: at(head),
            hand: hand.and_then(|(hand, _)| at(hand)),
            is_left: hand.is_some_and(|(_, is_left)| is_left),
            trigger,
            steps: 8,
            ..Input::default()
        });
    }
    game
}

fn looking(from: DVec3, at: DVec3) -> View {
    let fov = Fov::from_aspect(1.0, WIDE as f32 / HIGH as f32);
    View::looking_at(from.as_vec3(), at.as_vec3(), fov)
}

#[test]
fn the_vignette_darkens_the_edges_of_both_eyes_and_leaves_the_middle() {
    let mut album = Album::open("golden-vignette", &[]);
    let (eyes, without) = album.at("foul line");
    let mut with = without.clone();
    with.vignette = Some(Vignette {
        clear: 20.0_f32.to_radians(),
        strength: 1.0,
    });
    for (eye, view) in ["left", "right"].into_iter().zip(eyes) {
        let [clear, dark] = [&without, &with].map(|scene| album.draw(scene, view));
        let problem = check("with-vignette", eye, &dark, &album.kept);
        album.problems.extend(problem.err());
        // 20 degrees are 0.67 of the way from the middle to the upper edge, 37 are beyond the corner of the picture by a third.
        for (x, y, pixel) in dark.enumerate_pixels() {
            let from_middle = |at: u32, size: u32| (at as f32 + 0.5) / size as f32 * 2.0 - 1.0;
            let tangent = 0.5_f32.tan();
            let (across, up) = (
                from_middle(x, WIDE) * tangent * WIDE as f32 / HIGH as f32,
                from_middle(y, HIGH) * tangent,
            );
            let degrees = across.hypot(up).atan().to_degrees();
            if degrees < 19.5 {
                assert_eq!(pixel, clear.get_pixel(x, y), "({x}, {y}) at {degrees}");
            } else if degrees > 37.5 {
                assert_eq!(pixel.0, [0; 3], "({x}, {y}) at {degrees}");
            }
        }
        assert!(!agrees(&clear, &dark), "{eye}");
    }
    album.close();
}

#[test]
fn glow_machine_and_a_pressed_button_are_seen() {
    let mut album = Album::open("golden-things", &[]);
    let untouched = album.room_with(|_| ());
    let (eyes, _) = album.at("ball return");
    let glowing = album.room_with(|thing| thing.is_highlighted = thing.model == Model::Ball(1));
    album.compare("with-glow", eyes[0], &untouched, &glowing);

    let (eyes, _) = album.at("desk");
    let pressed = album.room_with(|thing| {
        if thing.model == Model::RedButton {
            thing.pose.position.y -= 0.03;
            thing.is_highlighted = true;
        }
    });
    album.compare("with-red-pressed", eyes[0], &untouched, &pressed);

    let (eyes, _) = album.at("pins");
    let deck = album.stage.config.lane.headpin_z_m;
    let working = album.room_with(|thing| match thing.model {
        Model::SweepBar => thing.pose.position = DVec3::new(0.0, 0.13, deck + 0.3),
        Model::SettingTable => thing.pose.position.y = 0.55,
        _ => {}
    });
    album.compare("with-machine", eyes[0], &untouched, &working);
    album.close();
}

#[test]
fn signs_fence_and_oil_are_seen() {
    let mut album = Album::open("golden-signs", &[]);
    album.compare_names_and_hint("with-names-and-hint");

    // The head is 0.2 m before the edge of a space of 1.2 m, which lies before the eyes of the picture.
    let near = standing(conditions(), DVec3::new(0.0, 1.62, -0.4), None, 0.0);
    let space = Space::of_settings([1.2, 1.2]).expect("it has an end");
    let bars = fence::instances(&near, Some(&space), &[], &album.stage.stock);
    let (eyes, without) = album.at("start");
    let mut with = without.clone();
    with.instances.extend(bars);
    album.compare("with-fence", eyes[0], &without, &with);

    album.compare_wrist_panel("with-wrist-panel");
    album.close();

    let mut oiled = Album::open("golden-oil", &["practice.shows_lane=true"]);
    oiled.compare_with_usual("with-oil", "foul line");

    // A hook, as the last ball rolled it.
    let point = |step: u32| {
        let share = f64::from(step) / 60.0;
        DVec3::new(
            0.3 - 1.1 * share + 0.9 * share * share,
            0.0,
            -0.5 - 17.5 * share,
        )
    };
    let track = Track {
        points: (0..=60).map(point).collect(),
    };
    let (eyes, without) = oiled.at("foul line");
    let mut with = without.clone();
    with.instances.extend(track.instances(&oiled.stage.stock));
    oiled.compare("with-way-of-the-ball", eyes[0], &without, &with);
    oiled.close();
}

#[test]
fn a_helped_hand_has_another_colour() {
    let mut helped = Album::open("golden-helped", &["release.assist_share=0.5"]);
    helped.compare_with_usual("with-helped-hand", "desk");
    helped.close();
}

#[test]
fn the_scoreboard_tells_how_a_ball_was_let_go_and_with_how_much_help() {
    let mut album = Album::open("golden-board", &[]);
    let view = looking(DVec3::new(0.0, 1.7, 1.3), DVec3::new(0.0, 2.4, -0.9));
    let scene = album.room_with(|_| ());
    let mut scores = Scores::empty(MAX_FRAMES);
    let seen = |album: &mut Album, scores: &Scores| {
        let Stage {
            renderer, stock, ..
        } = &mut album.stage;
        stock.show_scores(renderer, scores).expect("painted");
        album.draw(&scene, view)
    };
    let mut earlier = seen(&mut album, &scores);
    scores.throw = Some(ThrowSeen {
        speed: 6.84,
        angle: -0.02,
        turns: 3.1,
        is_foul: false,
    });
    let told = seen(&mut album, &scores);
    scores.assist = 50;
    let helped = seen(&mut album, &scores);
    for (name, image) in [("with-throw-told", told), ("with-help-told", helped)] {
        assert!(!agrees(&earlier, &image), "{name}: looks as before");
        let problem = check(name, "left", &image, &album.kept);
        album.problems.extend(problem.err());
        earlier = image;
    }
    album.close();
}

#[test]
fn texts_are_read_where_faces_have_one_colour() {
    for scene in ["plain-1996", "test"] {
        let mut album = Album::open_scene(scene, &format!("golden-{scene}-signs"), &[]);
        album.compare_names_and_hint(&format!("{scene}-with-names-and-hint"));
        album.compare_wrist_panel(&format!("{scene}-with-wrist-panel"));
        assert_eq!(
            album.stage.renderer.passes(),
            ["flat", "flat with pictures"]
        );
        album.close();
    }
}

#[test]
fn a_throw_is_seen_again_on_the_screen() {
    let mut album = Album::open("golden-replay", &[]);
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let Stage {
        renderer,
        stock,
        config,
        room,
    } = &mut album.stage;
    stock
        .add_screen(renderer, root, config)
        .expect("it has one");
    let mut room = room.clone();
    for thing in &mut room {
        match thing.model {
            Model::Ball(0) => thing.pose.position = DVec3::new(0.05, 0.109, -18.1),
            Model::Pin(1) => thing.pose.rotation = DQuat::from_rotation_x(-0.9),
            _ => {}
        }
    }
    let seen = room.into_iter().filter(|thing| thing.model != Model::Hand);
    let moment = seen.collect();
    let view = looking(DVec3::new(0.0, 1.7, 1.3), DVec3::new(0.0, 2.4, -0.9));
    let without = album.room_with(|_| ());
    album.stage.stock.show_again(Some(moment)).expect("drawn");
    let with = album.room_with(|_| ());
    album.compare("with-replay", view, &without, &with);
    album.close();
}

#[test]
fn both_hands_are_seen_in_every_shape() {
    let mut album = Album::open("golden-hands", &[]);
    let empty: Vec<Visible> = {
        let room = album.stage.room.iter();
        room.filter(|thing| thing.model != Model::Hand)
            .copied()
            .collect()
    };
    let without = album.scene(&empty, HandLook::right(HandShape::Closing(0.0)));
    let mut with = without.clone();
    let shapes = [
        HandShape::Closing(0.0),
        HandShape::Closing(0.6),
        HandShape::Closing(1.0),
        HandShape::Pointing,
    ];
    for (index, shape) in shapes.into_iter().enumerate() {
        for (side, look) in [(-1.0, HandLook::left(shape)), (1.0, HandLook::right(shape))] {
            let hand = Visible {
                model: Model::Hand,
                pose: Pose::new(
                    DVec3::new(side * 0.12, 1.2, 3.4 - 0.2 * index as f64),
                    DQuat::from_rotation_x(0.2),
                ),
                size: DVec3::ONE,
                is_highlighted: false,
            };
            let mut things = empty.clone();
            things.push(hand);
            let scene = album.scene(&things, look);
            with.instances
                .extend(&scene.instances[without.instances.len()..]);
        }
    }
    let view = looking(DVec3::new(0.0, 1.75, 3.75), DVec3::new(0.0, 1.2, 3.15));
    album.compare("with-hands", view, &without, &with);
    album.close();
}

/// Fingers and thumb are in the holes, whichever hand took the ball: seen from over the thumb's side.
#[test]
fn a_ball_is_seen_in_either_hand() {
    let mut album = Album::open("golden-holding", &[]);
    let conditions = conditions();
    let start = &conditions.lobby.start;
    let rack = album
        .stage
        .room
        .iter()
        .find(|thing| thing.model == Model::Ball(1));
    let ball = rack.expect("the middle ball").pose.position;
    let tracked = ball - DVec3::new(start.x_m, 0.0, start.z_m);
    let over = tracked + DVec3::Y * 0.17;
    let head = DVec3::new(tracked.x, 1.6, tracked.z + 0.5);
    for (name, is_left) in [("held-by-left", true), ("held-by-right", false)] {
        let game = standing(conditions.clone(), head, Some((over, is_left)), 1.0);
        assert_eq!(game.held(), Some(Model::Ball(1)), "{name}");
        let things = game.visible();
        let without: Vec<Visible> = {
            let others = things.iter().filter(|thing| thing.model != Model::Hand);
            others.copied().collect()
        };
        let without = album.scene(&without, HandLook::of(&game));
        let with = album.scene(&things, HandLook::of(&game));
        let side = if is_left { 1.0 } else { -1.0 };
        let view = looking(
            ball + DVec3::new(side * 0.28, 0.3, 0.12),
            ball + DVec3::Y * 0.08,
        );
        album.compare(name, view, &without, &with);
    }
    album.close();
}
