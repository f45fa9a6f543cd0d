//! People who stand, walk and duck, and things that fly at them.

use std::f64::consts::TAU;

use super::*;
use crate::random::SplitMix64;

const RATE: f64 = 90.0;
const SECONDS: f64 = 6.0;

/// What somebody does besides standing or walking.
#[derive(Clone, Copy)]
enum Dodge {
    No,
    /// How far and after how long since the flight began [m, s].
    Yes([f64; 3], f64),
}

/// A person's head: sway of 8 mm in slow waves, half a millimetre of a tracker's noise, a gait of 1.8 steps a second while walking.
fn person(random: &mut SplitMix64, walks: bool, dodge: Dodge) -> Vec<HeadSample> {
    let waves: Vec<[f64; 3]> = (0..9)
        .map(|wave| {
            [
                0.15 + 0.1 * f64::from(wave),
                TAU * random.uniform(),
                0.0065 * random.normal(),
            ]
        })
        .collect();
    let heading = TAU * random.uniform();
    let pace = if walks {
        0.4 + 0.8 * random.uniform()
    } else {
        0.0
    };
    let phase = TAU * random.uniform();
    let height = 1.5 + 0.3 * random.uniform();
    let sample = |frame: u32| {
        let t = f64::from(frame) / RATE;
        let sway = |axis: usize| -> f64 {
            let own = waves.iter().skip(axis * 3).take(3);
            own.map(|[hz, phase, size]| size * (TAU * hz * t + phase).sin())
                .sum()
        };
        let steps = TAU * 1.8 * t + phase;
        let (bob, side) = if walks {
            (0.02 * steps.sin(), 0.02 * (steps / 2.0).sin())
        } else {
            (0.0, 0.0)
        };
        let moved = match dodge {
            Dodge::No => [0.0; 3],
            Dodge::Yes(way, from) => {
                // Minimum jerk over 0.35 s (T. Flash and N. Hogan 1985).
                let s = ((t - from) / 0.35).clamp(0.0, 1.0);
                way.map(|axis| axis * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s))
            }
        };
        let (along, across) = (pace * t, side);
        let floor = [
            along * heading.cos() - across * heading.sin(),
            0.0,
            along * heading.sin() + across * heading.cos(),
        ];
        let base = [0.0, height + bob, 0.0];
        let noise: [f64; 3] = [
            0.0005 * random.normal(),
            0.0005 * random.normal(),
            0.0005 * random.normal(),
        ];
        HeadSample {
            time_s: t,
            position: Some(std::array::from_fn(|axis| {
                base[axis] + floor[axis] + sway(axis) + moved[axis] + noise[axis]
            })),
        }
    };
    let mut frame = sample;
    (0..(SECONDS * RATE) as u32).map(&mut frame).collect()
}

/// A thing that is at `target` at `hit_s`, having flown under gravity since `from_s`; before that it lies where it began.
fn thrown(target: [f64; 3], velocity: [f64; 3], from_s: f64, hit_s: f64) -> Vec<BodySample> {
    let at = |t: f64| -> [f64; 3] {
        let back = t - hit_s;
        let fall = [0.0, -4.903_325 * back * back, 0.0];
        std::array::from_fn(|axis| target[axis] + velocity[axis] * back + fall[axis])
    };
    (0..(SECONDS * RATE) as u32)
        .map(|frame| f64::from(frame) / RATE)
        .map(|t| BodySample {
            time_s: t,
            centre: at(t.max(from_s)),
        })
        .collect()
}

/// Something flies at the head of somebody; returns what was found of it, and when it set out.
fn scene(seed: u64, walks: bool, dodges: bool) -> Episodes {
    let mut random = SplitMix64::new(seed);
    let from_s = 2.5 + random.uniform();
    let flight_s = 0.5 + 0.4 * random.uniform();
    let away = TAU * random.uniform();
    let reach = 0.15 + 0.25 * random.uniform();
    let down = 0.4 + 0.6 * random.uniform();
    let way = [
        reach * away.cos() * (1.0 - down),
        -reach * down,
        reach * away.sin() * (1.0 - down),
    ];
    let size = reach / length(way);
    let dodge = if dodges {
        Dodge::Yes(
            way.map(|axis| axis * size),
            from_s + 0.2 + 0.15 * random.uniform(),
        )
    } else {
        Dodge::No
    };
    let mut double = random.clone();
    let unmoved = person(&mut double, walks, Dodge::No);
    let head = person(&mut random, walks, dodge);
    let hit_s = from_s + flight_s;
    let target = object::position_at(&unmoved, hit_s).unwrap();
    let speed = 4.0 + 4.0 * random.uniform();
    let velocity = [speed * 0.3 * (random.uniform() - 0.5), 1.0, speed];
    let samples = thrown(target, velocity, from_s, hit_s);
    episodes(
        &head,
        &Body {
            radius_m: 0.1,
            samples: &samples,
        },
        &Settings::default(),
    )
}

/// Of `count` scenes, the share in which an answer was found.
fn answered(walks: bool, dodges: bool, count: u64) -> f64 {
    let mut found = 0;
    for seed in 0..count {
        let episodes = scene(seed, walks, dodges);
        assert_eq!(
            (episodes.scored.len(), episodes.unscored),
            (1, 0),
            "seed {seed}, walks {walks}, dodges {dodges}"
        );
        found += usize::from(episodes.scored[0].response.onset_s.is_some());
    }
    found as f64 / count as f64
}

#[test]
fn ducks_are_found_and_people_who_do_not_duck_are_not() {
    for (walks, dodges, least, most) in [
        (false, true, 0.98, 1.0),
        (false, false, 0.0, 0.01),
        (true, true, 0.9, 1.0),
        (true, false, 0.0, 0.02),
    ] {
        let share = answered(walks, dodges, 500);
        println!(
            "walks {walks}, dodges {dodges}: an answer in {share:.3} of 500 scenes, seeds 0 to 499"
        );
        assert!(
            (least..=most).contains(&share),
            "walks {walks}, dodges {dodges}: {share}"
        );
    }
}

#[test]
fn response_is_measured_as_it_was_made() {
    let mut random = SplitMix64::new(3);
    let way = [0.0, -0.3, 0.0];
    let (from_s, hit_s, starts_s) = (3.0, 3.8, 3.3);
    let head = person(&mut random, false, Dodge::Yes(way, starts_s));
    let target = [0.0, head[0].position.unwrap()[1], 0.0];
    let samples = thrown(target, [0.0, 1.0, 6.0], from_s, hit_s);
    let found = episodes(
        &head,
        &Body {
            radius_m: 0.1,
            samples: &samples,
        },
        &Settings::default(),
    );
    let episode = found.scored[0];
    // Foreseen as soon as five samples of flight and two more are there: within 0.1 s of setting out.
    assert!((3.0..3.1).contains(&episode.onset_s), "{episode:?}");
    let response = episode.response;
    assert!(
        (response.time_to_contact_s - (hit_s - episode.onset_s)).abs() < 0.03,
        "{response:?}"
    );
    assert!(response.miss_distance_m < 0.05, "{response:?}");
    assert!((response.displacement_m - 0.3).abs() < 0.03, "{response:?}");
    // A minimum-jerk movement is at its fastest 1.875 times its mean speed.
    assert!(
        (response.speed_mps - 1.875 * 0.3 / 0.35).abs() < 0.12,
        "{response:?}"
    );
    let onset = response.onset_s.unwrap() + episode.onset_s;
    assert!(
        (starts_s - 0.02..starts_s + 0.1).contains(&onset),
        "{onset}"
    );
    assert!(
        response.gain_m > 0.15 && response.score > 8.0,
        "{response:?}"
    );
}

#[test]
fn things_that_do_not_come_are_no_episodes() {
    let mut random = SplitMix64::new(4);
    let head = person(&mut random, false, Dodge::No);
    let found = |target: [f64; 3], velocity: [f64; 3]| {
        let samples = thrown(target, velocity, 3.0, 3.8);
        episodes(
            &head,
            &Body {
                radius_m: 0.1,
                samples: &samples,
            },
            &Settings::default(),
        )
    };
    let height = head[0].position.unwrap()[1];
    assert_eq!(found([0.0, height, 0.0], [0.0, 1.0, 6.0]).scored.len(), 1);
    // Past the head by a metre, away from it, and too slow.
    assert_eq!(
        found([1.2, height, 0.0], [0.0, 1.0, 6.0]),
        Episodes::default()
    );
    let rolling: Vec<BodySample> = (0..540)
        .map(|frame| f64::from(frame) / RATE)
        .map(|t| BodySample {
            time_s: t,
            centre: [0.0, 0.11, -6.0 + 4.0 * t],
        })
        .collect();
    let rolls = Body {
        radius_m: 0.11,
        samples: &rolling,
    };
    assert_eq!(
        episodes(&head, &rolls, &Settings::default()),
        Episodes::default()
    );
    let struck: Vec<BodySample> = (0..540)
        .map(|frame| f64::from(frame) / RATE)
        // Shaking to and fro beside the head, a new way every other sample.
        .map(|t| BodySample {
            time_s: t,
            centre: [0.8 + 0.05 * (t * 140.0).sin(), height, 0.0],
        })
        .collect();
    let shakes = Body {
        radius_m: 0.1,
        samples: &struck,
    };
    assert_eq!(
        episodes(&head, &shakes, &Settings::default()),
        Episodes::default()
    );
}

#[test]
fn episode_without_a_head_is_not_scored() {
    let mut random = SplitMix64::new(5);
    let mut head = person(&mut random, false, Dodge::No);
    let height = head[0].position.unwrap()[1];
    let samples = thrown([0.0, height, 0.0], [0.0, 1.0, 6.0], 3.0, 3.8);
    let body = Body {
        radius_m: 0.1,
        samples: &samples,
    };
    for sample in head
        .iter_mut()
        .filter(|sample| (2.1..2.9).contains(&sample.time_s))
    {
        sample.position = None;
    }
    let found = episodes(&head, &body, &Settings::default());
    assert_eq!((found.scored.len(), found.unscored), (0, 1));
    head.iter_mut().for_each(|sample| sample.position = None);
    assert_eq!(
        episodes(&head, &body, &Settings::default()),
        Episodes::default()
    );
    assert_eq!(
        episodes(&[], &body, &Settings::default()),
        Episodes::default()
    );
}

#[test]
fn walker_who_stops_has_not_dodged() {
    // One metre a second until 3.25 s, then to a stand within 0.3 s; a gait of 2 cm.
    let way = |t: f64| {
        t.min(3.25) + 0.3 * (0.5 - (1.0 - ((t - 3.25) / 0.3).clamp(0.0, 1.0)).powi(2) / 2.0) - 0.15
    };
    let walker = |aside: f64| -> Vec<HeadSample> {
        (0..540)
            .map(|frame| f64::from(frame) / RATE)
            .map(|t| {
                let gait = 0.02 * (TAU * 1.8 * t).sin();
                let s = ((t - 3.25) / 0.35).clamp(0.0, 1.0);
                HeadSample {
                    time_s: t,
                    position: Some([way(t), 1.6 + gait, aside * s * s * (3.0 - 2.0 * s)]),
                }
            })
            .collect()
    };
    let found = |aside: f64| {
        let target = [way(3.8), 1.6, 0.0];
        let samples = thrown(target, [-1.0, 1.0, 6.0], 3.0, 3.8);
        let body = Body {
            radius_m: 0.1,
            samples: &samples,
        };
        let found = episodes(&walker(aside), &body, &Settings::default());
        assert_eq!(found.scored.len(), 1);
        found.scored[0].response
    };
    let (stopped, dodged) = (found(0.0), found(0.3));
    assert_eq!(stopped.onset_s, None, "{stopped:?}");
    assert!(dodged.onset_s.is_some(), "{dodged:?}");
}
