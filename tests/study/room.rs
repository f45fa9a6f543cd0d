//! A session in the room: what the experimenter is told, the panel and the stop sign, and what a study leaves out.

use std::path::Path;

use bowling_app::panel::{Choice, Panel, PanelStock};
use bowling_app::pictures::Wanted;
use bowling_app::session::Session;
use bowling_app::study::experimenter;
use bowling_app::study::seat::{self, Guest};
use bowling_app::words::Words;
use experiment::protocol::{AnsweredIn, Place, Standing};
use experiment::questionnaire::Answer;
use experiment::study::{ParticipantId, Study};
use game::{Input, Tracked};
use glam::DVec3;
use physics::Pose;
use renderer::{BackendChoice, Fov, Gpu, Renderer, RendererSettings, Scene, View};
use serde_json::Value;

use super::{entries, new_study, said, text};
use crate::support::fresh_folder;

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
    let answer = |band| Choice::Answer(age(band));
    // The box's edge, beside its words, is lighter than the ground between two boxes, and Stop is red.
    let place = |choice: &Choice| panel.place_of(choice).expect("it is shown");
    let (one, two) = (place(&answer("18-24")), place(&answer("25-34")));
    let box_edge = color(one - DVec3::X * 0.3);
    let between = color(0.5 * (one + two) - DVec3::X * 0.3);
    assert!(box_edge[2] > between[2] + 20, "{box_edge:?} {between:?}");
    let stop = color(place(&Choice::Stop) - DVec3::X * 0.12);
    assert!(stop[0] > 2 * stop[2], "{stop:?}");
}

/// The item that is asked.
fn item(session: &Session) -> Option<String> {
    Some(session.form()?.current()?.id.clone())
}

fn age(band: &str) -> Answer {
    Answer::Choice {
        chosen: vec![band.to_owned()],
        other: String::new(),
    }
}

/// A frame of somebody who stands and points at `aim`.
fn frame(session: &mut Session, panel: &mut Panel, aim: Option<DVec3>, trigger: f64) {
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
}

#[test]
fn a_trigger_that_is_held_when_a_question_appears_answers_nothing() {
    let (_, _, mut session) = seated("study-held");
    let first = Choice::Answer(age("35-44"));
    // Where it will hang, as it hangs for who stands there already.
    let mut before = Panel::new(AnsweredIn::Headset, Words::shipped());
    frame(&mut session, &mut before, None, 0.0);
    let aim = before.place_of(&first).expect("it is shown");
    let head = Some(Tracked::at(Pose::from_position(DVec3::new(0.0, 1.7, 0.0))));
    let mut panel = Panel::new(AnsweredIn::Headset, Words::shipped());
    // They are there at once; head and hand were lost, while the trigger was held; the hand was lost with its trigger.
    for (head, trigger) in [(None, None), (None, Some(1.0)), (head, Some(0.0))] {
        if let Some(trigger) = trigger {
            let lost = Input {
                head,
                trigger,
                steps: 8,
                ..Input::default()
            };
            session.frame(lost).expect("writable");
            panel.attend(&mut session).expect("writable");
        }
        for _ in 0..2 {
            frame(&mut session, &mut panel, Some(aim), 1.0);
            assert_eq!(panel.place_of(&first), Some(aim));
            assert_eq!(item(&session).as_deref(), Some("age_band"));
        }
    }
    frame(&mut session, &mut panel, Some(aim), 0.0);
    panel.forget_trigger();
    frame(&mut session, &mut panel, Some(aim), 1.0);
    assert_eq!(item(&session).as_deref(), Some("age_band"));
    for trigger in [0.0, 1.0] {
        frame(&mut session, &mut panel, Some(aim), trigger);
    }
    assert_eq!(item(&session).as_deref(), Some("vr_before"));
}

#[test]
fn a_hand_answers_by_pointing_and_stops_at_the_sign() {
    let (study, who, mut session) = seated("study-panel");
    let mut panel = Panel::new(AnsweredIn::Headset, Words::shipped());
    frame(&mut session, &mut panel, None, 0.0);
    let answers = [
        ("age_band", age("35-44")),
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
