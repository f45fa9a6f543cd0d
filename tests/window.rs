//! The window, opened under Xvfb and driven with real key and mouse events through a frame of bowling.
//!
//! The driver sees what a person sees: it follows the journal, re-simulates it, and so knows where hand, ball and foul
//! line are; it acts through the X server alone.

/// The experimenter's window beside the participant's.
mod experimenter;
/// Ten frames, from a cold start to the final score.
mod whole_game;

use std::f64::consts::FRAC_PI_2;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use bowling_app::journal::Entry;
use game::{EventKind, Game, Input, Model, Phase};
use glam::DVec3;

use crate::shared::ask_until;
use crate::shared::process::Process;
use crate::shared::screen::{Screen, colours};
use crate::support;

/// Longest wait for anything that a person would see happen.
const PATIENCE: Duration = Duration::from_secs(120);
/// Size of the virtual screen [pixels].
const SCREEN: [u32; 2] = [640, 400];
/// Shoulder from the eyes [m], and the cursor's gains, as the desk has them: a person learns these by looking.
const SHOULDER: DVec3 = DVec3::new(0.18, -0.28, 0.0);
const SIDE_PER_HALF_WIDTH: f64 = 0.55;
const ANGLE_PER_HALF_HEIGHT: f64 = 1.375;
const LOWEST_ANGLE: f64 = -0.75;
/// A notch of the wheel moves the hand this far, more or less [m].
const ARM_PER_NOTCH: f64 = 0.08;
const LOOK_PER_PIXEL: f64 = 0.004;

/// Follows a session from its journal.
struct Eyes {
    journal: BufReader<File>,
    line: String,
    game: Game,
    seen: Vec<EventKind>,
}

impl Eyes {
    fn open(path: &Path) -> Self {
        let mut journal = BufReader::new(wait_for("the journal", || File::open(path).ok()));
        let mut line = String::new();
        wait_for("the journal's first line", || {
            journal
                .read_line(&mut line)
                .expect("the journal can be read");
            line.ends_with('\n').then_some(())
        });
        let Entry::Header(header) = entry(&line) else {
            panic!("the journal begins with {line}");
        };
        let conditions = header.conditions.expect("no study");
        let game = Game::new(conditions, header.frames).expect("what the program plays");
        Self {
            journal,
            line: String::new(),
            game,
            seen: Vec::new(),
        }
    }

    /// Looks until `found` finds what it looks for.
    fn look_for<T>(
        &mut self,
        what: &str,
        mut found: impl FnMut(&Game, &[EventKind]) -> Option<T>,
    ) -> T {
        wait_for(what, || {
            self.catch_up();
            found(&self.game, &self.seen)
        })
    }

    fn catch_up(&mut self) {
        while self
            .journal
            .read_line(&mut self.line)
            .expect("the journal can be read")
            > 0
        {
            if !self.line.ends_with('\n') {
                return;
            }
            if let Entry::Input(input) = entry(&self.line) {
                self.game.step(&Input::from(&input));
                self.seen
                    .extend(self.game.events().iter().map(|event| event.kind.clone()));
            }
            self.line.clear();
        }
    }
}

/// What a line says, without its number and check.
fn entry(line: &str) -> Entry {
    let mut fields: serde_json::Value = serde_json::from_str(line).expect("a journal line is JSON");
    let object = fields.as_object_mut().expect("a journal line is an object");
    object.remove("line");
    object.remove("check");
    serde_json::from_value(fields).expect("a journal line holds an entry")
}

/// Waits for whatever a person would see happen.
fn wait_for<T>(what: &str, ask: impl FnMut() -> Option<T>) -> T {
    ask_until(PATIENCE, ask).unwrap_or_else(|| panic!("waited {PATIENCE:?} for {what}"))
}

/// A person at the desk.
struct Person {
    screen: Screen,
    eyes: Eyes,
    cursor: (f64, f64),
}

impl Person {
    /// Somebody who sits down before a window that records into `recording`.
    fn before(screen: Screen, recording: &Path) -> Self {
        let eyes = Eyes::open(&recording.join("journal.jsonl"));
        Self {
            screen,
            eyes,
            cursor: (0.0, 0.0),
        }
    }

    /// Bowls until the game is over; keeps what was seen after a throw in `folder`.
    fn play_to_the_end(&mut self, folder: &Path) {
        let is_over = |kind: &EventKind| matches!(kind, EventKind::GameOver { .. });
        let games_before = self.count(is_over);
        while self.count(is_over) == games_before {
            self.eyes.look_for("the pins to be ready", |game, _| {
                (game.phase() == Phase::Ready).then_some(())
            });
            self.take_ball();
            self.bowl();
            self.wait_for_pins();
            let picture = self.screen.shot();
            picture
                .save(folder.join("after-throw.png"))
                .expect("the picture can be kept");
        }
    }

    /// Until the pins of a ball that was let go are counted. One that does not reach the lane counts for nothing, and is seen on the
    /// rack again: then another is taken.
    fn wait_for_pins(&mut self) {
        self.eyes
            .look_for("the pins to be counted, or the ball back", |game, seen| {
                let last = |is_it: &dyn Fn(&EventKind) -> bool| seen.iter().rposition(is_it);
                let let_go = last(&|kind| matches!(kind, EventKind::Released(_)));
                let counted = last(&|kind| matches!(kind, EventKind::Settled { .. }));
                let Some(EventKind::Released(release)) = let_go.map(|at| &seen[at]) else {
                    panic!("a ball was let go");
                };
                let balls = game.observe().balls;
                let is_back = balls
                    .iter()
                    .any(|ball| Model::Ball(ball.index) == release.model && ball.is_on_rack);
                (counted > let_go || is_back).then_some(())
            });
    }

    fn heading(&mut self) -> f64 {
        self.eyes.catch_up();
        let head = self
            .eyes
            .game
            .head_pose_world()
            .expect("the desk tracks the head");
        let ahead = head.rotation * DVec3::NEG_Z;
        (-ahead.x).atan2(-ahead.z)
    }

    /// Moves the cursor to -1..1, y up.
    fn point(&mut self, x: f64, y: f64) {
        self.cursor = (x.clamp(-0.98, 0.98), y.clamp(-0.98, 0.98));
        let (x, y) = pixels(self.cursor.0, self.cursor.1);
        self.screen.act(&["mousemove", &x, &y]);
    }

    /// Turns to `heading` [rad, 0 down the lane, positive to the left] by dragging with the right button.
    fn turn_to(&mut self, heading: f64) {
        while (self.heading() - heading).abs() > 0.01 {
            let pixels = (-(heading - self.heading()) / LOOK_PER_PIXEL).round();
            let pixels = pixels.clamp(-200.0, 200.0) as i32;
            // From the middle, so that the screen's edge does not stop the drag.
            self.point(0.0, self.cursor.1);
            self.screen.act(&["mousedown", "3"]);
            let before = self.heading();
            self.screen
                .act(&["mousemove_relative", "--", &pixels.to_string(), "0"]);
            self.eyes.look_for("the head to turn", |game, _| {
                let ahead = game.head_pose_world()?.rotation * DVec3::NEG_Z;
                ((-ahead.x).atan2(-ahead.z) - before)
                    .abs()
                    .gt(&1e-6)
                    .then_some(())
            });
            self.screen.act(&["mouseup", "3"]);
        }
    }

    /// Walks until `distance`, which shrinks ahead, is small: in one go while it is far, then step by step.
    fn walk_until(&mut self, what: &str, distance: impl Fn(DVec3) -> f64) {
        let left = |game: &Game| {
            distance(
                game.head_pose_world()
                    .expect("the desk tracks the head")
                    .position,
            )
        };
        for _ in 0..30 {
            self.eyes.catch_up();
            let from = left(&self.eyes.game);
            if from.abs() < 0.12 {
                return;
            }
            let key = if from > 0.0 { "w" } else { "s" };
            // A person lets go early, because the walk slows down gently; a small step ends as soon as it is seen.
            let enough = (from.abs() - 0.02).min(from.abs().max(0.5));
            self.screen.act(&["keydown", key]);
            self.eyes.look_for(what, |game, _| {
                let now = left(game);
                let is_near = if from.abs() > 0.6 {
                    now.abs() < 0.5
                } else {
                    now.abs() < enough
                };
                (is_near || now * from < 0.0).then_some(())
            });
            self.screen.act(&["keyup", key]);
            self.stand_still();
        }
        panic!("cannot walk to {what}");
    }

    fn stand_still(&mut self) {
        let mut last = DVec3::INFINITY;
        let mut time = 0.0;
        self.eyes.look_for("walking to end", |game, _| {
            let now = game.world_from_tracking().position;
            let is_still = now == last && game.time() > time + 0.1;
            if now != last {
                (last, time) = (now, game.time());
            }
            is_still.then_some(())
        });
    }

    /// Brings the hand towards `target` until it is `there`, as a person does: looks how far off it is, and corrects,
    /// `gently` at most at a time.
    fn reach(&mut self, target: DVec3, gently: f64, there: impl Fn(&Game, DVec3) -> bool) {
        for _ in 0..60 {
            let before = self.eyes.game.time();
            self.eyes.look_for("the hand to follow", |game, _| {
                (game.time() > before + 0.3).then_some(())
            });
            let game = &self.eyes.game;
            let head = game.head_pose_world().expect("the desk tracks the head");
            let hand = game.hand_pose_world().expect("the desk tracks the hand");
            if there(game, hand.position) {
                return;
            }
            let heading = glam::DQuat::from_rotation_y(self.heading());
            let from_shoulder = |p: DVec3| heading.inverse() * (p - head.position) - SHOULDER;
            let (is, should) = (from_shoulder(hand.position), from_shoulder(target));
            let arm = |p: DVec3| p.z.hypot(p.y);
            let angle = |p: DVec3| (-p.z).atan2(-p.y);
            let longer = arm(should) - arm(is);
            if longer.abs() > ARM_PER_NOTCH {
                self.screen
                    .act(&["click", if longer > 0.0 { "4" } else { "5" }]);
            }
            // Gently: a hand that darts knocks the balls off the rack.
            let (x, y) = self.cursor;
            let side = (should.x - is.x) / SIDE_PER_HALF_WIDTH;
            let up = (angle(should) - angle(is)) / ANGLE_PER_HALF_HEIGHT;
            self.point(
                x + side.clamp(-gently, gently),
                y + up.clamp(-gently, gently),
            );
        }
        panic!(
            "the hand does not reach {target}: it is at {:?}",
            self.eyes.game.hand_pose_world()
        );
    }

    /// Takes a ball from the rack; a hand that closes on nothing is opened, and tries again.
    fn take_ball(&mut self) {
        for _ in 0..5 {
            self.reach_for_ball();
            self.screen.act(&["mousedown", "1"]);
            let closed = self.eyes.game.time() + 0.5;
            let is_held = |game: &Game| matches!(game.held(), Some(Model::Ball(_)));
            let is_held = self.eyes.look_for("a ball in the hand", |game, _| {
                (is_held(game) || game.time() > closed).then(|| is_held(game))
            });
            if is_held {
                return;
            }
            self.screen.act(&["mouseup", "1"]);
        }
        panic!("five balls slip out of the hand");
    }

    /// Walks up to a ball with the hand raised and reaches down from above, until it shows that it could be taken.
    fn reach_for_ball(&mut self) {
        let ball = self.eyes.look_for("a ball on the rack", |game, _| {
            game.observe()
                .balls
                .into_iter()
                .find(|ball| ball.is_on_rack)
        });
        self.point(0.0, 0.5);
        self.turn_to(0.0);
        self.walk_until("beside the ball", |head| {
            head.z - ball.position.z - SHOULDER.x
        });
        self.turn_to(-FRAC_PI_2);
        self.walk_until("before the ball", |head| ball.position.x - 0.55 - head.x);
        let over = |height: f64| ball.position + DVec3::Y * (ball.radius + height);
        let above = over(0.25);
        self.reach(above, 0.3, |_, hand| hand.distance(above) < 0.1);
        let glows = |game: &Game| {
            let mut seen = game.visible().into_iter();
            seen.any(|it| matches!(it.model, Model::Ball(_)) && it.is_highlighted)
        };
        self.reach(over(0.06), 0.05, |game, _| glows(game));
    }

    /// Carries the ball to the foul line with the arm over the lane's middle, swings and lets go.
    fn bowl(&mut self) {
        self.point(0.0, 0.1);
        self.turn_to(FRAC_PI_2);
        self.walk_until("the lane's middle", |head| head.x + SHOULDER.x);
        self.turn_to(0.0);
        self.walk_until("the foul line", |head| head.z - 0.7);
        let height = |angle: f64| (angle - LOWEST_ANGLE) / ANGLE_PER_HALF_HEIGHT - 1.0;
        let game = &self.eyes.game;
        let head = game
            .head_pose_world()
            .expect("the desk tracks the head")
            .position;
        let side = -(head.x + SHOULDER.x) / SIDE_PER_HALF_WIDTH;
        let thrown = self.count(|kind| matches!(kind, EventKind::Released(_)));
        // The swing itself, at a person's pace: back slowly, forward in a quarter of a second, and on after the release.
        let (back, low, forward) = (-0.7, 0.1, 0.9);
        for i in 0..=20 {
            self.point(
                side,
                height(forward + (back - forward) * f64::from(i) / 20.0),
            );
        }
        let mut swing: Vec<String> = Vec::new();
        for i in 0..=25 {
            let angle = back + (forward - back) * f64::from(i) / 25.0;
            let (x, y) = pixels(side, height(angle));
            swing.extend(["mousemove".into(), x, y]);
            if (0.0..(forward - back) / 25.0).contains(&(angle - low)) {
                swing.extend(["mouseup".into(), "1".into()]);
            }
            swing.extend(["sleep".into(), "0.01".into()]);
        }
        self.screen
            .act(&swing.iter().map(String::as_str).collect::<Vec<_>>());
        self.eyes.look_for("the ball to be let go", |_, seen| {
            let now = seen
                .iter()
                .filter(|kind| matches!(kind, EventKind::Released(_)))
                .count();
            (now > thrown).then_some(())
        });
    }

    fn count(&mut self, is_it: impl Fn(&EventKind) -> bool) -> usize {
        self.eyes.catch_up();
        self.eyes.seen.iter().filter(|kind| is_it(kind)).count()
    }
}

/// The pixel, as `xdotool` wants it, of a place from -1 to 1 with y up.
fn pixels(x: f64, y: f64) -> (String, String) {
    let pixel = |at: f64, size: u32| (0.5 * (at + 1.0) * f64::from(size)).round().to_string();
    (pixel(x, SCREEN[0]), pixel(-y, SCREEN[1]))
}

/// The program in a window that fills the screen, recording into a folder.
fn open_window(screen: &Screen, recording: &Path, arguments: &[&str]) -> Process {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bowling"));
    command
        .args(["play", "--device", "desk", "--no-video"])
        .args(arguments)
        .arg("--out")
        .arg(recording)
        .env("DISPLAY", screen.display())
        .env_remove("WAYLAND_DISPLAY")
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let program = Process::start("bowling", &mut command);
    let window = screen.act(&["search", "--sync", "--name", "^Bowling$"]);
    screen.act(&[
        "windowsize",
        &window,
        &SCREEN[0].to_string(),
        &SCREEN[1].to_string(),
    ]);
    screen.act(&["windowmove", &window, "0", "0"]);
    screen.act(&["windowfocus", "--sync", &window]);
    program
}

/// Letters on the dark ground of a text in the lower right corner: nearly white pixels there.
fn letters(screen: &Screen) -> usize {
    let picture = screen.shot();
    let corner = picture
        .enumerate_pixels()
        .filter(|(x, y, _)| *x > 330 && *y > 200);
    corner
        .filter(|(_, _, pixel)| pixel.0.iter().all(|part| *part > 200))
        .count()
}

/// A game of one frame.
const ONE_FRAME: [&str; 2] = ["--frames", "1"];

/// What the program has said when it has ended in order.
fn ended(mut program: Process) -> String {
    let status = program.ended_within(PATIENCE);
    let status = status.expect("the program ends");
    let mut said = [String::new(), String::new()];
    let [output, errors] = &mut said;
    let mut stdout = program.child().stdout.take().expect("piped");
    stdout.read_to_string(output).expect("text");
    let mut stderr = program.child().stderr.take().expect("piped");
    stderr.read_to_string(errors).expect("text");
    assert!(status.success(), "{output}\n{errors}");
    std::mem::take(output)
}

#[test]
fn f3_shows_what_it_costs_and_hides_it_again() {
    let folder = support::fresh_folder("window-cost");
    let screen = Screen::open(SCREEN);
    let recording = folder.join("recording");
    let _program = open_window(&screen, &recording, &ONE_FRAME);
    let mut eyes = Eyes::open(&recording.join("journal.jsonl"));
    eyes.look_for("the first second", |game, _| {
        (game.time() > 1.0).then_some(())
    });
    wait_for("the picture without letters in the corner", || {
        (colours(&screen.shot()) > 20 && letters(&screen) < 50).then_some(())
    });
    screen.act(&["key", "F3"]);
    // Twelve lines and more, of letters of some ten pixels each.
    wait_for("the figures", || (letters(&screen) > 800).then_some(()));
    let picture = screen.shot();
    picture
        .save(folder.join("cost.png"))
        .expect("the picture can be kept");
    screen.act(&["key", "F3"]);
    wait_for("the figures to go", || {
        (letters(&screen) < 50).then_some(())
    });
}

#[test]
fn a_person_bowls_a_frame_with_mouse_and_keys() {
    let folder = support::fresh_folder("window");
    let screen = Screen::open(SCREEN);
    let recording = folder.join("recording");
    let program = open_window(&screen, &recording, &ONE_FRAME);
    let mut person = Person::before(screen, &recording);
    person.screen.act(&["key", "F1"]);
    person.screen.act(&["key", "1"]);
    person.eyes.look_for("a game under Red", |game, _| {
        (game.phase() == Phase::Ready).then_some(())
    });
    let help = person.screen.shot();
    help.save(folder.join("help.png"))
        .expect("the picture can be kept");
    assert!(
        colours(&help) > 60,
        "the window shows {} colours: nothing was drawn",
        colours(&help)
    );
    person.screen.act(&["key", "F1"]);

    person.play_to_the_end(&folder);
    person.screen.act(&["key", "Escape"]);
    let output = ended(program);
    let released = person.eyes.seen.iter().find_map(|kind| match kind {
        EventKind::Released(release) => Some(release.speed),
        _ => None,
    });
    assert!(
        released.is_some_and(|speed| speed > 2.0),
        "let go at {released:?} m/s"
    );
    assert!(recording.join("red-score.txt").is_file(), "{output}");
    assert!(
        recording.join("red-contact-sheet.png").is_file(),
        "{output}"
    );
    let replay = support::bowling(&["replay", recording.to_str().expect("a plain path")]);
    assert!(
        replay.status.success(),
        "{}",
        String::from_utf8_lossy(&replay.stderr)
    );
}

#[test]
fn p_pauses_and_r_leads_back_to_the_start() {
    let folder = support::fresh_folder("window-pause");
    let screen = Screen::open(SCREEN);
    let recording = folder.join("recording");
    let program = open_window(&screen, &recording, &ONE_FRAME);
    let mut person = Person::before(screen, &recording);
    person.eyes.look_for("somebody at the desk", |game, _| {
        game.head_pose_world().map(|_| ())
    });
    person.turn_to(1.0);
    person.screen.act(&["key", "p"]);
    person
        .eyes
        .look_for("a pause", |game, _| game.is_paused().then_some(()));
    let steps = person.eyes.game.steps();
    person.screen.act(&["key", "r"]);
    person.eyes.look_for("the way back", |_, seen| {
        seen.contains(&EventKind::WentToStart).then_some(())
    });
    assert!(person.heading().abs() < 1e-9, "down the lane");
    assert_eq!(person.eyes.game.steps(), steps, "time stands still");
    person.screen.act(&["key", "p"]);
    person.eyes.look_for("time to go on", |game, seen| {
        (game.steps() > steps && seen.contains(&EventKind::Resumed)).then_some(())
    });
    person.screen.act(&["key", "Escape"]);
    ended(program);
    let replay = support::bowling(&["replay", recording.to_str().expect("a plain path")]);
    assert!(
        replay.status.success(),
        "{}",
        String::from_utf8_lossy(&replay.stderr)
    );
}
