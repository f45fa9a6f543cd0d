//! From the game's contacts to what is heard: on the card while somebody plays, and in the videos afterwards.
//!
//! The sound listens to [`Game::contacts`] and [`Game::rolling`], which come from the physics, and to refused presses. Where a scene
//! shows no `sound` nothing of this is built: no mixer, no thread, no list of events.

use game::{Config, EventKind, Game, Model, Phase};
use glam::DVec3;
use serde_json::json;
use sound::live::Live;
use sound::{Event, Impact, Listener, Material, Mixer, Rolling, Room, Settings, Sounding};

/// What sounded, as a film keeps it.
pub type Sounded = Event;

/// Seconds that are rendered before a clip and not heard, so that what rings or rolls at its start does.
const LEAD_IN_S: f64 = 0.6;
/// Time in which a clip fades in and out [s]: a cut in the middle of a wave clicks.
const FADE_S: f64 = 0.005;
/// Height above the deck at which the pinsetter's machine is heard [m].
const MACHINE_HEIGHT: f64 = 1.0;

/// How a scene sounds; `None` where it shows no `sound`.
pub fn settings(config: &Config) -> Option<Settings> {
    let sound = &config.sound;
    config.shows.sound.then(|| Settings {
        full_scale_pa: sound.full_scale_pa,
        room: Some(Room {
            size_m: DVec3::new(sound.hall_width_m, sound.hall_height_m, sound.hall_length_m),
            reverberation_s: sound.reverberation_s,
        }),
        is_delayed_by_distance: sound.is_delayed_by_distance,
        ..Settings::default()
    })
}

/// What a thing is made of.
fn material(model: Model) -> Material {
    match model {
        Model::Pin(_) => Material::Pin,
        Model::Ball(_) => Material::Ball,
        Model::Hand => Material::Hand,
        Model::RedButton | Model::BlueButton => Material::Button,
        Model::Lane | Model::Approach | Model::FoulLine => Material::Lane,
        Model::Gutter => Material::Gutter,
        Model::Kickback => Material::Kickback,
        Model::Pit => Material::Pit,
        Model::Cushion => Material::Cushion,
        Model::SideFloor | Model::Wall | Model::Ceiling => Material::Wall,
        Model::Rack | Model::SweepBar | Model::SettingTable => Material::Metal,
        Model::Desk => Material::Desk,
    }
}

/// Mass of a thing [kg]; infinite for what a blow does not move.
fn mass(model: Model, config: &Config) -> f64 {
    match model {
        Model::Pin(_) => config.pin.mass_kg,
        Model::Ball(number) => config
            .balls
            .get(usize::from(number))
            .map_or(f64::INFINITY, |ball| ball.mass_kg),
        _ => f64::INFINITY,
    }
}

/// Tells what sounded, frame by frame.
#[derive(Debug)]
pub struct Reporter {
    step_hz: f64,
    machine: DVec3,
    was_running: bool,
}

impl Reporter {
    /// A reporter of a scene; `None` where it shows no `sound`.
    pub fn of(config: &Config) -> Option<Self> {
        config.shows.sound.then(|| Reporter {
            step_hz: config.physics.step_hz,
            machine: DVec3::new(0.0, MACHINE_HEIGHT, config.lane.deck_end_z_m),
            was_running: false,
        })
    }

    /// What sounded in the frame that `game` has just finished; the head is not part of it.
    pub fn report(&mut self, game: &Game) -> Vec<Sounded> {
        let config = game.config();
        let mut sounded: Vec<Event> = game
            .contacts()
            .iter()
            .map(|contact| {
                let models = [contact.a, contact.b];
                let impact = Impact {
                    point: contact.point,
                    materials: models.map(material),
                    masses: models.map(|model| mass(model, config)),
                    impulse: contact.impulse,
                    approach_speed: contact.approach_speed,
                };
                // The contact fell somewhere within its step.
                let time_s = (contact.step as f64 - 0.5) / self.step_hz;
                let sounding = Sounding::Impact(impact);
                Event { time_s, sounding }
            })
            .collect();
        let time_s = game.time();
        let now = |sounding| Event { time_s, sounding };
        sounded.extend(game.rolling().into_iter().map(|ball| {
            now(Sounding::Rolling(Rolling {
                body: ball.ball,
                point: ball.point,
                speed: ball.speed,
                surface: material(ball.surface),
            }))
        }));
        let refused = game.events().iter().filter_map(|event| match event.kind {
            EventKind::Refused { button } => Some(button),
            _ => None,
        });
        sounded.extend(refused.map(|button| {
            let point = game.observe().buttons[button as usize].top;
            now(Sounding::Refusal { point })
        }));
        let is_running = game.phase() == Phase::Setting && !game.is_paused();
        if is_running != self.was_running {
            self.was_running = is_running;
            let point = self.machine;
            sounded.push(now(Sounding::Machine { is_running, point }));
        }
        sounded
    }
}

/// The participant's ears, while somebody plays: the sound card.
pub struct Ears {
    open: Option<(Live, Reporter)>,
    /// What sounded since the card was last told.
    untold: Vec<Event>,
}

impl Ears {
    /// Opens the card where the scene shows `sound`. Without a card there is silence, and no word about it: a game is not
    /// worth less for a machine without one.
    pub fn open(config: &Config) -> Self {
        let open = settings(config)
            .zip(Reporter::of(config))
            .and_then(|(settings, reporter)| {
                let live = Live::open(settings, config.sound.lookahead_s).ok()?;
                Some((live, reporter))
            });
        Ears {
            open,
            untold: Vec::new(),
        }
    }

    /// The journal's line of the card that plays: its latency from the contact to the card's output.
    pub fn line(&self) -> Option<serde_json::Value> {
        let (live, _) = self.open.as_ref()?;
        Some(json!({ "sound": {
            "latency_ms": live.latency_ms(),
            "sample_rate_hz": live.sample_rate(),
        }}))
    }

    /// Takes notice of the frame that the game has just finished.
    pub fn notice(&mut self, game: &Game) {
        if let Some((_, reporter)) = &mut self.open {
            self.untold.extend(reporter.report(game));
        }
    }

    /// Lets be heard what was noticed: once a picture, however many frames were due for it.
    pub fn hear(&mut self, game: &Game) {
        let Some((live, _)) = &mut self.open else {
            return;
        };
        let head = game.head_pose_world().map(|head| Event {
            time_s: game.time(),
            sounding: Sounding::Listener(Listener {
                position: head.position,
                orientation: head.rotation,
            }),
        });
        live.frame(game.time(), head.into_iter().chain(self.untold.drain(..)));
    }
}

/// The sound track of a video that is put together from clips.
pub struct Track {
    settings: Settings,
    /// Samples per second [Hz].
    pub sample_rate: u32,
    pictures_per_second: u32,
    samples: Vec<[f32; 2]>,
}

impl Track {
    /// An empty track.
    pub fn new(settings: Settings, pictures_per_second: u32) -> Self {
        // Whole samples for each picture: sound and pictures never drift apart.
        let sample_rate = settings.sample_rate.next_multiple_of(pictures_per_second);
        Track {
            settings: Settings {
                sample_rate,
                ..settings
            },
            sample_rate,
            pictures_per_second,
            samples: Vec::new(),
        }
    }

    /// Adds what is heard in a clip that begins at `from` [s]; each picture has its `heads`.
    ///
    /// `sounds` are those of the whole film.
    pub fn add(&mut self, sounds: &[Sounded], from: f64, heads: &[Listener]) {
        let rate = f64::from(self.sample_rate);
        let each = self.samples_per_picture();
        // The mixer's time zero; what a clip needs begins shortly before it.
        let zero = from - LEAD_IN_S;
        let to = from + (heads.len() * each) as f64 / rate;
        let mut mixer = Mixer::new(&self.settings);
        let lead_in = (LEAD_IN_S * rate) as usize;
        let heads = heads.iter().enumerate().map(|(number, head)| Event {
            time_s: (number * each) as f64 / rate + LEAD_IN_S,
            sounding: Sounding::Listener(*head),
        });
        let mut heads = heads.peekable();
        if let Some(first) = heads.peek().copied() {
            mixer.submit(Event {
                time_s: 0.0,
                ..first
            });
        }
        if let Some(event) = machine_before(sounds, zero) {
            mixer.submit(Event {
                time_s: 0.0,
                ..event
            });
        }
        let within = sounds
            .iter()
            .filter(|event| event.time_s >= zero && event.time_s < to)
            .map(|event| Event {
                time_s: event.time_s - zero,
                ..*event
            });
        let mut within = within.peekable();
        let mut heard = vec![[0.0; 2]; lead_in + (to * rate - from * rate).round() as usize];
        for block in heard.chunks_mut(each) {
            // Most a mixer lets wait is 2048: a picture's and the next one's.
            let end = mixer.time() + 2.0 * each as f64 / rate;
            while let Some(event) = heads.next_if(|event| event.time_s < end) {
                mixer.submit(event);
            }
            while let Some(event) = within.next_if(|event| event.time_s < end) {
                mixer.submit(event);
            }
            mixer.render(block);
        }
        let mut clip = heard.split_off(lead_in);
        fade(&mut clip, (FADE_S * rate) as usize);
        self.samples.extend(clip);
    }

    /// The samples that are heard while picture `number` is seen.
    pub fn of_picture(&self, number: usize) -> &[[f32; 2]] {
        let each = self.samples_per_picture();
        &self.samples[number * each..(number + 1) * each]
    }

    fn samples_per_picture(&self) -> usize {
        (self.sample_rate / self.pictures_per_second) as usize
    }
}

/// What the machine was last told before `time` [s].
fn machine_before(sounds: &[Sounded], time: f64) -> Option<Event> {
    let is_machine = |event: &&Event| matches!(event.sounding, Sounding::Machine { .. });
    let mut before = sounds.iter().filter(|event| event.time_s < time);
    before.rfind(is_machine).copied()
}

/// Fades the first and the last `length` samples.
fn fade(clip: &mut [[f32; 2]], length: usize) {
    let count = clip.len();
    let length = length.min(count / 2);
    for i in 0..length {
        let share = i as f32 / length as f32;
        clip[i] = clip[i].map(|x| x * share);
        clip[count - 1 - i] = clip[count - 1 - i].map(|x| x * share);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blow(time_s: f64) -> Event {
        Event {
            time_s,
            sounding: Sounding::Impact(Impact {
                point: DVec3::new(0.0, 0.1, -18.0),
                materials: [Material::Ball, Material::Pin],
                masses: [6.8, 1.59],
                impulse: 12.0,
                approach_speed: 7.0,
            }),
        }
    }

    #[test]
    fn a_scene_without_sound_builds_nothing() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("config");
        let load = |arguments: &[String]| {
            let conditions = game::Conditions::load(&folder, "alley", arguments);
            conditions.expect("the shipped configuration").lobby
        };
        let without = load(&["shows.sound=false".to_owned()]);
        assert!(settings(&without).is_none() && Reporter::of(&without).is_none());
        assert!(Ears::open(&without).open.is_none());
        let with = load(&["sound.hall_width_m=12.0".to_owned()]);
        let room = settings(&with).and_then(|settings| settings.room);
        assert_eq!(room.map(|room| room.size_m.x), Some(12.0));
        assert!(Reporter::of(&with).is_some());
    }

    /// A ball rolls, then the machine works: in a pause neither is told of, and afterwards both are again.
    #[test]
    fn a_pause_is_silent() {
        use crate::devices::Device;
        use crate::devices::script::{Script, Velocities};
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("config");
        let conditions = game::Conditions::load(&folder, "alley", &[]).expect("shipped");
        let mut script = Script::new(
            &conditions.lobby,
            3,
            Velocities::Measured,
            &[game::Button::Red],
        );
        let mut reporter = Reporter::of(&conditions.lobby).expect("it lists sound");
        let mut game = Game::new(conditions, 1).expect("an alley");
        let mut told = |game: &mut Game, input: &game::Input| {
            game.step(input);
            let sounded = reporter.report(game);
            let rolls = |event: &Event| matches!(event.sounding, Sounding::Rolling(_));
            let runs = sounded.iter().find_map(|event| match event.sounding {
                Sounding::Machine { is_running, .. } => Some(is_running),
                _ => None,
            });
            (sounded.iter().any(rolls), runs, sounded.len())
        };
        let (mut rolled, mut ran, mut rolled_again) = (false, false, false);
        while !(rolled && ran) {
            assert!(!script.is_done(), "nothing rolled, or no machine ran");
            let input = script.next(&game);
            let (rolls, runs, _) = told(&mut game, &input);
            let is_new = rolls && !rolled || runs == Some(true) && !ran;
            rolled_again |= rolls && rolled;
            (rolled, ran) = (rolled || rolls, ran || runs == Some(true));
            if !is_new {
                continue;
            }
            let paused = game::Input {
                paused: true,
                ..game::Input::default()
            };
            let (rolls_on, switched, _) = told(&mut game, &paused);
            assert!(!rolls_on && switched != Some(true));
            assert_eq!(switched, (runs == Some(true)).then_some(false));
            assert_eq!(told(&mut game, &paused), (false, None, 0), "silence");
            let input = script.next(&game);
            let (_, runs_again, _) = told(&mut game, &input);
            assert_eq!(runs_again, (runs == Some(true)).then_some(true));
        }
        assert!(rolled_again, "the ball is heard behind the pause");
    }

    #[test]
    fn a_refused_press_sounds_at_its_button_and_one_that_is_taken_does_not() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("config");
        let conditions = game::Conditions::load(&folder, "alley", &[]).expect("shipped");
        let mut reporter = Reporter::of(&conditions.lobby).expect("it lists sound");
        let mut game = Game::new(conditions, 1).expect("an alley");
        let mut press = |red, blue| {
            let input = game::Input {
                press_red: red,
                press_blue: blue,
                locked: [true, false],
                steps: 8,
                ..game::Input::default()
            };
            game.step(&input);
            let sounded = reporter.report(&game);
            let refusals: Vec<DVec3> = sounded
                .iter()
                .filter_map(|event| match event.sounding {
                    Sounding::Refusal { point } => Some(point),
                    _ => None,
                })
                .collect();
            let buttons = game.observe().buttons.map(|button| button.top);
            (refusals, buttons)
        };
        assert_eq!(press(false, false).0, []);
        let (refused, [red, blue]) = press(true, false);
        assert_eq!(refused, [red]);
        assert_ne!(red, blue);
        assert_eq!(press(true, false).0, [], "it is held, not pressed again");
        assert_eq!(press(false, true).0, [], "this one is not locked");
    }

    #[test]
    fn a_blow_in_the_second_clip_is_heard_in_its_picture_within_five_milliseconds() {
        let mut track = Track::new(Settings::default(), 30);
        let sounds = [blow(10.0), blow(50.5)];
        track.add(&sounds, 20.0, &[Listener::default(); 15]);
        track.add(&sounds, 50.0, &[Listener::default(); 30]);
        assert_eq!(track.samples.len(), 45 * 1600);
        let onset = track
            .samples
            .iter()
            .position(|[left, _]| left.abs() > 0.01)
            .expect("a blow");
        // Half a second into the second clip, which begins with picture 15.
        let late = onset as f64 / 48_000.0 - (0.5 + 0.5);
        assert!((0.0..0.005).contains(&late), "{late}");
        assert!(
            track
                .of_picture(30)
                .iter()
                .any(|[left, _]| left.abs() > 0.01)
        );
        assert!(
            track
                .of_picture(29)
                .iter()
                .all(|[left, _]| left.abs() < 0.01)
        );
    }

    #[test]
    fn a_clip_in_the_middle_of_a_hum_has_it_and_does_not_click() {
        let machine = |time_s, is_running| Event {
            time_s,
            sounding: Sounding::Machine {
                is_running,
                point: DVec3::new(0.0, 1.0, -2.0),
            },
        };
        let sounds = [machine(1.0, true), machine(9.0, false)];
        let mut track = Track::new(Settings::default(), 30);
        track.add(&sounds, 5.0, &[Listener::default(); 15]);
        assert!(
            track
                .of_picture(7)
                .iter()
                .any(|[left, _]| left.abs() > 1e-3)
        );
        assert_eq!(track.samples[0], [0.0; 2]);
        assert!(
            track
                .samples
                .last()
                .is_some_and(|[left, _]| left.abs() < 1e-4)
        );
    }
}
