//! Studies: simulated whole, killed at any instant, damaged on purpose, and given away.

/// The disk, the folder and the clock while a session runs.
mod loss;
/// Studies of differences.
mod pairs;

use std::fs;
use std::io::Read;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::time::Duration;

use bowling_app::panel::{Choice, Panel, PanelStock};
use bowling_app::pictures::Wanted;
use bowling_app::session::Session;
use bowling_app::study::experimenter;
use bowling_app::study::seat::{self, Guest};
use bowling_app::words::Words;
use experiment::journal::Lines;
use experiment::protocol::{AnsweredIn, Place, Standing};
use experiment::questionnaire::Answer;
use experiment::random::SplitMix64;
use experiment::study::{ParticipantId, Study};
use game::{Input, Tracked};
use glam::DVec3;
use physics::Pose;
use renderer::{BackendChoice, Fov, Gpu, Renderer, RendererSettings, Scene, View};
use serde_json::Value;

use crate::support::{bowling, fresh_folder};

/// The program's output, which has to be a success.
fn said(arguments: &[&str]) -> String {
    let output = bowling(arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).expect("text")
}

fn refusal(arguments: &[&str]) -> String {
    let output = bowling(arguments);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}");
    let text = String::from_utf8(output.stderr).expect("text");
    assert_eq!(text.trim_end().lines().count(), 1, "one sentence: {text}");
    text
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a plain name")
}

/// Two simulated participants with a game of one frame each way; made once, read by several tests.
fn simulated() -> &'static Path {
    static STUDY: OnceLock<PathBuf> = OnceLock::new();
    STUDY.get_or_init(|| {
        let folder = fresh_folder("study").join("simulated");
        simulate(&folder, "2", "1");
        folder
    })
}

fn simulate(folder: &Path, subjects: &str, frames: &str) {
    said(&[
        "study",
        "simulate",
        text(folder),
        "--subjects",
        subjects,
        "--frames",
        frames,
        "--training",
        "1",
        "--seed",
        "7",
    ]);
}

/// A copy of the simulated study that a test may change.
fn copy(name: &str) -> PathBuf {
    // A folder for each: a fresh one takes what was in it away, also from a test beside this one.
    let to = fresh_folder(&format!("study-copy-{name}")).join("study");
    copy_folder(simulated(), &to);
    to
}

fn copy_folder(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("writable");
    for entry in fs::read_dir(from).expect("readable") {
        let entry = entry.expect("readable");
        let target = to.join(entry.file_name());
        if entry.file_type().expect("known").is_dir() {
            copy_folder(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), &target).expect("writable");
        }
    }
}

/// Every file below `folder`, by its path from there.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    for path in experiment::files::list(folder).expect("readable") {
        let name = path.strip_prefix(folder).expect("it is below").to_owned();
        found.push((name, fs::read(&path).expect("readable")));
    }
    found.sort();
    found
}

fn journals(study: &Path) -> Vec<PathBuf> {
    let mut paths = experiment::files::list(&study.join("data/sourcedata")).expect("readable");
    paths.sort();
    paths
}

#[test]
fn a_simulated_study_is_complete_and_its_tables_come_out_of_the_journals_again() {
    let study = copy("rebuilt");
    let status = said(&["study", "status", text(&study)]);
    assert_eq!(status.matches("  complete").count(), 2, "{status}");
    let before = files(&study.join("data"));
    for (name, _) in &before {
        if !name.starts_with("sourcedata") {
            fs::remove_file(study.join("data").join(name)).expect("writable");
        }
    }
    said(&["study", "rebuild", text(&study)]);
    let after = files(&study.join("data"));
    let names = |files: &[(PathBuf, Vec<u8>)]| -> Vec<PathBuf> {
        files.iter().map(|(name, _)| name.clone()).collect()
    };
    assert_eq!(names(&before), names(&after));
    for (one, other) in before.iter().zip(&after) {
        assert!(one == other, "{} has changed", one.0.display());
    }
}

/// Nobody answers everything at one instant: each answer comes 2 to 8 s after the one before it, and the questions behind a
/// game after its end.
#[test]
fn simulated_answers_take_their_time() {
    for journal in journals(simulated()) {
        let entries = entries(&journal);
        let at = |entry: &Value| entry["study"]["act"]["at_s"].as_f64();
        let times: Vec<f64> = entries.iter().filter_map(at).collect();
        assert!(times.len() > 8, "{times:?}");
        for two in times.windows(2) {
            assert!(two[1] - two[0] >= 2.0, "{times:?}");
        }
        let within = times.windows(2).filter(|two| two[1] - two[0] <= 8.1);
        // All but the first of each of the three forms.
        assert_eq!(within.count(), times.len() - 3, "{times:?}");
        let step = |entry: &&Value| entry["event"]["event"] == "game_over";
        let over = entries.iter().rfind(step).expect("two games");
        let over_s = over["event"]["step"].as_f64().expect("a number") / 720.0;
        assert!(times.last().is_some_and(|last| *last > over_s + 2.0));
    }
}

/// The terminal and the window say this and no more; typed lines do the same in both.
#[test]
fn the_experimenter_is_told_the_step_and_typed_lines_are_taken() {
    let (study, who, mut session) = seated("study-experimenter");
    let told = experimenter::told(&session).expect("a study");
    assert!(told.due.starts_with("[1/3]"), "{}", told.due);
    assert_eq!(told.parts[0].standing, Standing::On);
    assert_eq!(
        told.health,
        ["Head not tracked yet.", "Hand not tracked yet."]
    );
    let mut take = |line: &str| experimenter::take(line, &mut session).expect("writable");
    assert!(take("2").is_none());
    assert!(take("perhaps").is_some_and(|reply| reply.contains("no answer")));
    assert!(take("yes").is_none());
    assert!(take("6").is_some_and(|reply| reply.contains("advises to end here")));
    assert!(take("hello").is_some_and(|reply| reply.contains("Nothing is asked")));
    assert!(take("/note ").is_some_and(|reply| reply.contains("no words")));
    assert!(take("/note a lamp broke").is_some_and(|reply| reply.contains("kept")));
    assert!(take("/help").is_some_and(|reply| reply.contains("/stop REASON")));
    assert!(take("/status").is_some_and(|reply| reply.contains("Head")));
    let told = experimenter::told(&session).expect("a study");
    assert_eq!(told.due, "1 training throw to go");
    assert_eq!(told.parts[0].standing, Standing::Done);
    let words: Vec<&str> = told.parts.iter().map(|part| part.name.as_str()).collect();
    let words = words.join(" ").to_lowercase();
    for word in ["elastic", "friction", "shape", "presence", "condition"] {
        assert!(!words.contains(word), "{words}");
    }
    experimenter::take("/stop it is late", &mut session).expect("writable");
    assert!(session.is_over());
    session
        .finish(None, Wanted { video: false }, &mut |_| ())
        .expect("writable");
    let entries = entries(&study.journal_folder(&who, 1).join("session.jsonl"));
    let note = |kind: &str| {
        let mut notes = entries.iter().map(|entry| &entry["study"]);
        notes
            .find(|note| note["note"] == kind)
            .expect("it is noted")
    };
    assert_eq!(note("remark")["text"], "a lamp broke");
    assert_eq!(note("stopped")["reason"], "it is late");
}

#[test]
fn the_same_seed_simulates_the_same_study() {
    let again = fresh_folder("study-again").join("again");
    simulate(&again, "2", "1");
    let shared = |study: &Path| files(&study.join("data"));
    assert!(shared(simulated()) == shared(&again));
}

#[test]
fn a_session_of_a_study_replays_to_the_last_bit() {
    for journal in journals(simulated()) {
        let folder = journal.parent().expect("a folder");
        let text = said(&["replay", text(folder)]);
        assert!(text.contains("agree."), "{text}");
    }
}

#[test]
fn any_moment_of_a_session_can_be_drawn_and_any_span_filmed() {
    let journal = journals(simulated()).remove(0);
    let session = text(journal.parent().expect("a folder")).to_owned();
    let folder = fresh_folder("study-captured");
    for (view, profile) in [("eye", "1996"), ("bird", "modern")] {
        let picture = folder.join(format!("{view}.png"));
        said(&[
            "capture",
            &session,
            "--at",
            "20",
            "--profile",
            profile,
            "--view",
            view,
            "--out",
            text(&picture),
        ]);
        let image = image::open(&picture).expect("a picture").to_rgb8();
        let mean = |channel: usize| {
            let sum: u64 = image
                .pixels()
                .map(|pixel| u64::from(pixel.0[channel]))
                .sum();
            sum as f64 / f64::from(image.width() * image.height())
        };
        assert!(mean(0) > 10.0 && mean(0) < 245.0, "{view}: {}", mean(0));
    }
    let film = folder.join("span.avi");
    said(&[
        "capture",
        &session,
        "--at",
        "20",
        "--until",
        "20.2",
        "--profile",
        "1996",
        "--out",
        text(&film),
    ]);
    let bytes = fs::read(&film).expect("a video");
    // Seven pictures at 30 a second from 20 to 20.2 s: the main header counts them.
    assert_eq!(&bytes[..4], b"RIFF");
    assert_eq!(
        u32::from_le_bytes([bytes[48], bytes[49], bytes[50], bytes[51]]),
        7
    );
    // And with each goes the sound of a thirtieth second.
    let sound = [&b"01wb"[..], &6400u32.to_le_bytes()].concat();
    let tracks = bytes.windows(8).filter(|word| **word == sound);
    assert_eq!(tracks.count(), 7);
    let output = bowling(&["capture", &session, "--at", "99999", "--out", "x.png"]);
    assert_eq!(output.status.code(), Some(2));
    let refused = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(refused.contains("the session ends at"), "{refused}");
}

#[test]
fn data_can_be_read_by_their_owner_alone_and_tell_no_condition() {
    for path in experiment::files::list(simulated()).expect("readable") {
        let mode = fs::metadata(&path).expect("there").permissions().mode() & 0o777;
        assert_eq!(mode, 0o600, "{}", path.display());
    }
    for (name, bytes) in files(&simulated().join("data")) {
        let content = String::from_utf8(bytes).expect("text");
        for word in ["friction_rate", "ellipsoid", "objects."] {
            assert!(!content.contains(word), "{word} in {}", name.display());
        }
    }
}

#[test]
fn both_games_are_played_under_the_buttons_of_the_plan() {
    let plan = fs::read_to_string(simulated().join("plan/allocation.csv")).expect("readable");
    let assignments =
        fs::read_to_string(simulated().join("plan/assignments.csv")).expect("readable");
    for line in assignments.lines().skip(1) {
        let (slot, participant) = line.split_once(',').expect("two columns");
        let row = plan
            .lines()
            .find(|row| row.split(',').next() == Some(slot))
            .expect("the slot's row");
        let first = row.split(',').nth(5).expect("first_button");
        let journal = simulated().join(format!(
            "data/sourcedata/{participant}/ses-01/session.jsonl"
        ));
        let started: Vec<String> = entries(&journal)
            .iter()
            .filter(|entry| entry["event"]["event"] == "game_started")
            .map(|entry| {
                entry["event"]["button"]
                    .as_str()
                    .expect("a name")
                    .to_owned()
            })
            .collect();
        let other = if first == "Red" { "blue" } else { "red" };
        assert_eq!(started, [first.to_lowercase(), other.to_owned()]);
    }
}

/// The contents of a journal's whole lines.
fn entries(journal: &Path) -> Vec<Value> {
    let bytes = fs::read(journal).expect("readable");
    let mut lines = Lines::new(&bytes);
    let mut entries = Vec::new();
    while let Some(content) = lines.next_content().unwrap_or_else(|problem| {
        panic!("{} line {}: {problem}", journal.display(), lines.number())
    }) {
        entries.push(serde_json::from_str(&content).expect("JSON"));
    }
    entries
}

#[test]
fn the_dataset_passes_the_bids_validator() {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/bids-validate.sh");
    let output = Command::new(script)
        .arg(simulated().join("data"))
        .output()
        .expect("the script starts");
    let said = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    if output.status.code() == Some(3) && std::env::var_os("BOWLING_NO_BIDS").is_some() {
        println!("skipped: {errors}");
        return;
    }
    assert!(output.status.success(), "{said}{errors}");
}

#[test]
fn an_erased_participant_is_nowhere_and_the_slot_is_free() {
    let study = copy("erased");
    let journal = journals(&study).remove(0);
    let participant = journal
        .ancestors()
        .nth(2)
        .and_then(Path::file_name)
        .and_then(|name| name.to_str())
        .expect("an id")
        .to_owned();
    let label = participant.strip_prefix("sub-").expect("an id");
    let text = said(&[
        "study",
        "erase",
        text(&study),
        &participant,
        "--who",
        "nobody",
    ]);
    assert!(text.contains("is free again"), "{text}");
    for (name, bytes) in files(&study) {
        let content = String::from_utf8_lossy(&bytes);
        let is_there = content.contains(&participant) || name.to_string_lossy().contains(label);
        assert!(!is_there, "{}", name.display());
    }
}

#[test]
fn damage_is_named_and_nothing_is_overwritten() {
    let study = copy("damaged");
    let journal = journals(&study).remove(0);
    let bytes = fs::read(&journal).expect("readable");
    let middle = bytes.len() / 2;
    let mut flipped = bytes.clone();
    flipped[middle] ^= 1;
    let lines: Vec<&[u8]> = bytes.split_inclusive(|byte| *byte == b'\n').collect();
    let without: Vec<u8> = [&lines[..100], &lines[101..]].concat().concat();
    for (damaged, words) in [
        (flipped, "after it was recorded"),
        (without, "line 101"),
        (b"participant_id\tage\n".to_vec(), "not a journal"),
    ] {
        fs::write(&journal, &damaged).expect("writable");
        let output = bowling(&["study", "status", text(&study)]);
        assert_eq!(output.status.code(), Some(1));
        let listed = String::from_utf8_lossy(&output.stdout);
        assert!(
            listed.contains(words) && listed.contains("DAMAGED"),
            "{listed}"
        );
        let refused = refusal(&["study", "rebuild", text(&study)]);
        assert!(refused.contains(words), "{refused}");
        assert_eq!(fs::read(&journal).expect("readable"), damaged);
    }
}

#[test]
fn a_folder_that_holds_something_and_one_that_is_none_are_refused() {
    let folder = fresh_folder("study-full");
    fs::write(folder.join("mine.txt"), "mine").expect("writable");
    let refused = refusal(&["study", "simulate", text(&folder), "--subjects", "1"]);
    assert!(
        refused.contains("nothing in it is overwritten"),
        "{refused}"
    );
    let refused = refusal(&["study", "status", text(&folder)]);
    assert!(refused.contains("is no study"), "{refused}");
    assert_eq!(files(&folder).len(), 1);
}

/// A session of a new study, for a person at the desk.
fn seated(name: &str) -> (Study, ParticipantId, Session) {
    let folder = new_study(name, "1");
    let study = Study::open(&folder).expect("just made");
    let lock = study.lock().expect("nobody else has it");
    let who = study.admit(&lock, 1).expect("a free slot").participant;
    let guest = Guest {
        participant: &who,
        slot: 1,
        device: "desk",
        seed: 1,
        notes: Vec::new(),
        before: None,
    };
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let setup = seat::setup(&study, &lock, guest, root).expect("the shipped settings");
    let session = Session::start(setup).expect("a session");
    (study, who, session)
}

#[test]
fn no_throw_is_shown_again_in_a_study() {
    let (_, _, session) = seated("no-replay");
    assert!(!session.game().config().shows.replay);
    let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("config");
    let play = game::Conditions::load(&config, "alley", &[]).expect("the shipped settings");
    assert!(play.lobby.shows.replay, "what play shows by default");
}

#[test]
fn a_study_helps_nobody_unless_its_plan_says_so() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let shown = |name: &str, asked: &[&str]| {
        let folder = fresh_folder(name).join("study");
        let mut arguments = vec!["study", "new", text(&folder), "--subjects", "1"];
        arguments.extend(["--withdrawal-until", "2030-01-01"]);
        arguments.extend(["--retention-until", "2031-01-01"]);
        arguments.extend(asked);
        said(&arguments);
        let study = Study::open(&folder).expect("just made");
        let conditions = seat::conditions(&study, 1, root).expect("the shipped settings");
        let of = |config: &game::Config| {
            let guidance = &config.guidance;
            let gesture = config.calibration.gesture;
            [guidance.glow, guidance.hints, guidance.feedback, gesture]
        };
        let lobby = of(&conditions.lobby);
        assert_eq!((of(&conditions.red), of(&conditions.blue)), (lobby, lobby));
        lobby
    };
    assert_eq!(shown("study-unguided", &[]), [false; 4]);
    let asked = ["--guidance", "hints,feedback"];
    assert_eq!(shown("study-guided", &asked), [false, true, true, false]);
}

#[test]
fn the_panel_is_seen_where_it_is_pointed_at() {
    let (_, _, mut session) = seated("study-seen");
    let words = Words::shipped();
    let mut panel = Panel::new(AnsweredIn::Headset, words.clone());
    let head = Pose::from_position(DVec3::new(0.0, 1.7, 0.0));
    let input = Input {
        head: Some(Tracked::at(head)),
        steps: 8,
        ..Input::default()
    };
    session.frame(input).expect("writable");
    panel.attend(&mut session).expect("writable");
    let gpu = Gpu::new(BackendChoice::Auto).expect("a driver");
    let mut renderer = Renderer::new(&gpu, RendererSettings::default()).expect("it draws");
    let mut stock = PanelStock::new(&gpu, &mut renderer, &words).expect("it draws");
    let instances = stock.instances(&panel, &mut renderer).expect("it paints");
    let scene = Scene {
        instances,
        ..Scene::default()
    };
    let world = session.game().head_pose_world().expect("it is tracked");
    let view = View {
        position: world.position.as_vec3(),
        rotation: world.rotation.as_quat(),
        fov: Fov::from_aspect(0.8, 1.5),
    };
    let (width, height) = (900, 600);
    let images = renderer
        .render(&scene, &[view], width, height)
        .expect("drawn");
    let folder = fresh_folder("study-seen-picture");
    images[0].save(folder.join("panel.png")).expect("writable");
    let color = |at: DVec3| {
        let [x, y] = view
            .pixel_of(at.as_vec3(), width, height)
            .expect("in sight");
        images[0].get_pixel(x as u32, y as u32).0
    };
    let answer = |id: &str| {
        Choice::Answer(Answer::Choice {
            chosen: vec![id.to_owned()],
            other: String::new(),
        })
    };
    // The box's edge, beside its words, is lighter than the ground between two boxes, and Stop is red.
    let place = |choice: &Choice| panel.place_of(choice).expect("it is shown");
    let (one, two) = (place(&answer("18-24")), place(&answer("25-34")));
    let box_edge = color(one - DVec3::X * 0.3);
    let between = color(0.5 * (one + two) - DVec3::X * 0.3);
    assert!(box_edge[2] > between[2] + 20, "{box_edge:?} {between:?}");
    let stop = color(place(&Choice::Stop) - DVec3::X * 0.12);
    assert!(stop[0] > 2 * stop[2], "{stop:?}");
}

#[test]
fn a_hand_answers_by_pointing_and_stops_at_the_sign() {
    let (study, who, mut session) = seated("study-panel");
    let mut panel = Panel::new(AnsweredIn::Headset, Words::shipped());
    let item = |session: &Session| {
        let form = session.form()?;
        Some(form.current()?.id.clone())
    };
    let frame = |session: &mut Session, panel: &mut Panel, aim: Option<DVec3>, trigger: f64| {
        let head = Pose::from_position(DVec3::new(0.0, 1.7, 0.0));
        // The hand is on the way from the eye to what it points at; both in the tracking space.
        let to_tracking = session.game().world_from_tracking().inverse();
        let at = aim.map_or(DVec3::new(0.3, 1.0, -0.2), |aim| {
            head.position.lerp(to_tracking.transform_point(aim), 0.25)
        });
        let input = Input {
            head: Some(Tracked::at(head)),
            hand: Some(Tracked::at(Pose::from_position(at))),
            trigger,
            steps: 8,
            ..Input::default()
        };
        session.frame(input).expect("writable");
        panel.attend(session).expect("writable");
    };
    frame(&mut session, &mut panel, None, 0.0);
    let answers = [
        (
            "age_band",
            Answer::Choice {
                chosen: vec!["35-44".to_owned()],
                other: String::new(),
            },
        ),
        ("vr_before", Answer::YesNo(true)),
        ("sick_before", Answer::Scale(2)),
    ];
    for (id, answer) in answers {
        assert_eq!(item(&session).as_deref(), Some(id));
        let choice = Choice::Answer(answer);
        let aim = panel.place_of(&choice).expect("it is shown");
        // Pointing alone chooses nothing, nor does a trigger that was closed before.
        frame(&mut session, &mut panel, Some(aim), 0.0);
        assert_eq!(item(&session).as_deref(), Some(id));
        frame(&mut session, &mut panel, Some(aim), 1.0);
        assert_ne!(item(&session).as_deref(), Some(id), "{choice:?}");
        let next = item(&session);
        frame(&mut session, &mut panel, Some(aim), 1.0);
        assert_eq!(item(&session), next, "one pull answers one question");
        frame(&mut session, &mut panel, None, 0.0);
    }
    // The form is filled in and the panel is gone.
    assert_eq!(panel.place_of(&Choice::Stop), None);
    let course = session.course().expect("a study's");
    assert_eq!(course.protocol().place(), Place::Training { left: 1 });
    // The stop sign hangs while balls are thrown: a glance at it does nothing, nor does a short pull.
    let sign = panel.stop_sign().expect("it hangs");
    for trigger in [0.0, 1.0, 1.0, 0.0] {
        frame(&mut session, &mut panel, Some(sign), trigger);
    }
    assert!(!session.is_over());
    for _ in 0..100 {
        frame(&mut session, &mut panel, Some(sign), 1.0);
    }
    assert!(session.is_over());
    session
        .finish(None, Wanted { video: false }, &mut |_| ())
        .expect("writable");
    let journal = study.journal_folder(&who, 1).join("session.jsonl");
    let given: Vec<Value> = entries(&journal)
        .into_iter()
        .filter(|entry| entry["study"]["note"] == "form")
        .collect();
    assert_eq!(given.len(), 3);
    for note in given {
        assert_eq!(note["study"]["answered_in"], "headset");
    }
}

/// A study for one participant, without a session.
fn new_study(name: &str, frames: &str) -> PathBuf {
    new_study_in(&fresh_folder(name).join("study"), frames)
}

/// The same in a folder that is named.
fn new_study_in(folder: &Path, frames: &str) -> PathBuf {
    said(&[
        "study",
        "new",
        text(folder),
        "--subjects",
        "1",
        "--frames",
        frames,
        "--training",
        "1",
        "--laboratory",
        "a test",
        "--contact",
        "nobody",
        "--withdrawal-until",
        "2099-12-31",
        "--retention-until",
        "2099-12-31",
    ]);
    folder.to_owned()
}

/// What goes on with a study of one participant: its first session, one whose program was killed before the first line, or
/// one that was broken off.
fn go_on(study: &Path) -> Vec<String> {
    let listed = said(&["study", "status", text(study)]);
    let participant = listed.lines().nth(1).map(str::trim);
    let words = match participant.and_then(|line| line.split_once("  ")) {
        None => vec!["run"],
        Some((id, "has not begun")) => vec!["run", "--participant", id],
        Some(_) => vec!["resume"],
    };
    words.into_iter().map(str::to_owned).collect()
}

/// Starts a scripted session in the background.
fn begin(command: &[String], study: &Path) -> Child {
    Command::new(env!("CARGO_BIN_EXE_bowling"))
        .args(["study", &command[0], text(study), "--device", "script"])
        .args(&command[1..])
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts")
}

#[test]
fn two_programs_do_not_share_a_study() {
    let study = new_study("study-shared", "10");
    let mut first = begin(&["run".to_owned()], &study);
    let journal =
        || experiment::files::list(&study.join("data")).is_ok_and(|files| !files.is_empty());
    while !journal() {
        assert!(first.try_wait().expect("known").is_none(), "it ended");
        std::thread::yield_now();
    }
    let refused = refusal(&["study", "run", text(&study), "--device", "script"]);
    assert!(refused.contains("in use by another program"), "{refused}");
    first.kill().expect("it runs");
    first.wait().expect("it ended");
    // A killed program leaves no lock behind.
    said(&["study", "status", text(&study)]);
    let refused = refusal(&["study", "run", text(&study), "--device", "script"]);
    assert!(refused.contains("all 1 slots"), "{refused}");
}

/// Kills of running sessions in all, half of them by each of two threads.
const KILLS: u32 = 200;

#[test]
fn two_hundred_kills_lose_nothing() {
    let seed = 2026;
    std::thread::scope(|scope| {
        for half in 0..2 {
            scope.spawn(move || {
                let mut left = KILLS / 2;
                for session in (half..).step_by(2) {
                    left -= kill_again_and_again(seed, session, left);
                    if left == 0 {
                        return;
                    }
                }
            });
        }
    });
}

/// Kills one session over and over, at most `most` times, resumes it each time, and plays it to its end; returns how often
/// it was killed.
fn kill_again_and_again(seed: u64, session: u32, most: u32) -> u32 {
    let study = new_study(&format!("study-killed-{session}"), "2");
    let mut random = SplitMix64::for_index(seed, u64::from(session));
    let mut kept: Vec<(PathBuf, Vec<u8>)> = Vec::new();
    let mut kills = 0;
    while kills < most {
        let kill = kills;
        let context = format!("seed {seed}, session {session}, kill {kill}");
        let mut child = begin(&go_on(&study), &study);
        // No synchronisation: the instant of the kill is what is random.
        let wait = Duration::from_secs_f64(0.02 + 0.5 * random.uniform().powi(2));
        std::thread::sleep(wait);
        let seen = whole_lines(&study);
        if child
            .try_wait()
            .expect("known")
            .is_some_and(|status| status.success())
        {
            // Played to its end before the kill.
            break;
        }
        child.kill().expect("it runs or has ended");
        kills += 1;
        let mut errors = String::new();
        let status = child.wait().expect("it ended");
        let mut stream = child.stderr.take().expect("a pipe");
        stream.read_to_string(&mut errors).expect("text");
        assert!(
            status.code().is_none_or(|code| code == 0),
            "{context}: {errors}"
        );
        // What was there before is there still, to the byte, and what was seen of the new journal too.
        for (path, bytes) in kept.iter().chain(&seen) {
            let now = fs::read(path).expect("a journal stays");
            assert!(now.starts_with(bytes), "{context}: {}", path.display());
        }
        kept = if journals_of(&study).is_empty() {
            Vec::new()
        } else {
            whole_lines(&study)
        };
        let listed = said(&["study", "status", text(&study)]);
        assert!(!listed.contains("DAMAGED"), "{context}: {listed}");
        resumes_at_the_last_frame(&study, &context);
    }
    let listed = said(&["study", "status", text(&study)]);
    if !listed.contains("complete") {
        let finished = begin(&go_on(&study), &study);
        let output = finished.wait_with_output().expect("it ended");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(
            output.status.success(),
            "seed {seed}, session {session}: {errors}"
        );
    }
    said(&["study", "rebuild", text(&study)]);
    let listed = said(&["study", "status", text(&study)]);
    assert!(listed.contains("  complete"), "seed {seed}: {listed}");
    kills
}

fn journals_of(study: &Path) -> Vec<PathBuf> {
    let folder = study.join("data/sourcedata");
    if folder.exists() {
        journals(study)
    } else {
        Vec::new()
    }
}

/// Every journal with its whole lines.
fn whole_lines(study: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let read = |path: PathBuf| {
        let mut bytes = fs::read(&path).expect("readable");
        let end = bytes
            .iter()
            .rposition(|byte| *byte == b'\n')
            .map_or(0, |at| at + 1);
        bytes.truncate(end);
        (path, bytes)
    };
    journals_of(study).into_iter().map(read).collect()
}

/// Every journal that goes on begins where the one before it had its last complete frame, game or training throw.
fn resumes_at_the_last_frame(study: &Path, context: &str) {
    let folder = journals_of(study)
        .first()
        .and_then(|path| path.parent())
        .map(Path::to_owned);
    let Some(folder) = folder else { return };
    let part = |number: usize| match number {
        1 => folder.join("session.jsonl"),
        _ => folder.join(format!("session_part-{number}.jsonl")),
    };
    // How many inputs count before each part, and where its last mark is.
    let mut mark = 0;
    for number in (1..).take_while(|number| part(*number).exists()) {
        let entries = entries(&part(number));
        // A program that was killed before its first lines did nothing.
        let Some(header) = entries.first() else {
            continue;
        };
        if entries.len() == 1 && header["header"]["continues"].is_null() {
            continue;
        }
        let begins = header["header"]["continues"]["inputs"]
            .as_u64()
            .unwrap_or(0);
        assert_eq!(begins, mark, "{context}: part {number}");
        let mut inputs = begins;
        let mut games = 0;
        for entry in &entries {
            inputs += u64::from(entry.get("input").is_some());
            let kind = entry["event"]["event"].as_str().unwrap_or_default();
            games += u32::from(kind == "game_started");
            let is_training = kind == "settled" && begins == 0 && games == 0;
            if is_training || ["game_started", "frame_scored", "game_over"].contains(&kind) {
                mark = inputs;
            }
        }
    }
}
