//! What one frame costs: scene, physics, recording and submitting both eyes, in processor time of the thread that does it;
//! and, on request, in the device's own time at a headset's size.
//!
//! A frame of the game is a 90th of a second of a scripted game, with hand, pins, pinsetter and shadows. Processor time is the
//! thread's: a software driver draws in threads of its own, and what they take is not the program's. Criterion gives means; a
//! missed picture is a percentile.
//!
//! `cargo bench --bench frame`, or with `-- gpu` behind it for the device's time of two eyes of 2064 x 2208.

use std::path::Path;
use std::time::Instant;

use bowling_app::again::Again;
use bowling_app::convert::{self, Stock};
use bowling_app::devices::Device;
use bowling_app::devices::script::{Script, Velocities};
use bowling_app::hints::Grip;
use bowling_app::lettering::{LastWord, Scribe};
use bowling_app::signs::SignStock;
use bowling_app::words::Words;
use bowling_app::{labels, thread_seconds};
use game::{Button, Conditions, Game, Phase};
use renderer::{BackendChoice, EyeTargets, Gpu, Renderer};

/// Most processor time of a frame that 99 of 100 may take [ms].
const BUDGET_MS: f64 = 2.0;
/// An eye that costs next to nothing to fill [pixels].
const TINY: [u32; 2] = [16, 16];
/// An eye of the headsets that a desktop card serves [pixels].
const HEADSET: [u32; 2] = [2064, 2208];
/// Frames of the bowling game that is played.
const FRAMES: u32 = 2;

fn main() {
    let is_test = !std::env::args().any(|argument| argument == "--bench");
    let wants_gpu = std::env::args().any(|argument| argument == "gpu");
    let gpu = Gpu::new(BackendChoice::Auto).expect("a graphics driver is installed");
    println!("{gpu}");
    if wants_gpu {
        on_the_device(&gpu);
        return;
    }
    // `cargo test --benches` only wants to know that it runs.
    let most = if is_test { 20 } else { usize::MAX };
    let mut alley = Alley::open(&gpu, TINY);
    let mut parts: [Vec<f64>; 4] = Default::default();
    // The first frames make buffers and pipelines, which a session does before anybody looks.
    let mut warm_up = 10;
    while !alley.script.is_done() && parts[0].len() < most {
        let times = alley.frame();
        alley.targets.wait().expect("the device works");
        if warm_up > 0 && !is_test {
            warm_up -= 1;
            continue;
        }
        for (part, time) in parts.iter_mut().zip(times) {
            part.push(time * 1e3);
        }
    }
    println!(
        "{} frames, processor time of the thread [ms]",
        parts[0].len()
    );
    for (name, times) in ["physics", "scene", "drawing", "frame"]
        .into_iter()
        .zip(&mut parts)
    {
        println!("{name:8} {}", percentiles(times));
    }
    let p99 = at(&parts[3], 0.99);
    let verdict = if p99 <= BUDGET_MS { "held" } else { "missed" };
    println!("budget of {BUDGET_MS} ms at the 99th percentile: {verdict}");
    alley.close().wait();
}

/// The device's own time of frames in the middle of a game, at a headset's size.
fn on_the_device(gpu: &Gpu) {
    let mut alley = Alley::open(gpu, HEADSET);
    // Played without pictures up to where pins fall.
    while alley.game.phase() != Phase::Rolling || !alley.pins_are_falling() {
        alley.play();
    }
    // A software driver draws for seconds.
    let count = if gpu.is_software() { 5 } else { 300 };
    let (mut device_ms, mut wall_ms) = (Vec::new(), Vec::new());
    for _ in 0..count {
        let begun = Instant::now();
        alley.frame();
        let taken = alley.targets.wait().expect("the device works");
        wall_ms.push(begun.elapsed().as_secs_f64() * 1e3);
        device_ms.extend(taken.map(|seconds| seconds * 1e3));
    }
    let [width, height] = HEADSET;
    println!("{count} frames, two eyes of {width} x {height}, 4 samples [ms]");
    if device_ms.is_empty() {
        println!("device   has no clock");
    } else {
        println!("device   {}", percentiles(&mut device_ms));
    }
    println!("wall     {}", percentiles(&mut wall_ms));
    alley.close().wait();
}

/// A scripted game and what draws it.
struct Alley {
    game: Game,
    script: Script,
    renderer: Renderer,
    stock: Stock,
    signs: SignStock,
    words: Words,
    again: Option<Again>,
    targets: EyeTargets,
    conditions: Conditions,
    last_word: LastWord,
}

impl Alley {
    fn open(gpu: &Gpu, size: [u32; 2]) -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let conditions = Conditions::load(&root.join("config"), "alley", &[]).expect("as shipped");
        let mut renderer =
            Renderer::new(gpu, convert::settings(&conditions.lobby.shows)).expect("as shipped");
        // All that hangs in the room, as a headset's session has it.
        let (scribe, last_word) = Scribe::begin().expect("a graphics driver is installed");
        let config = &conditions.lobby;
        let mut stock = Stock::load(&mut renderer, root, config).expect("as shipped");
        let screen = stock.add_screen(&mut renderer, root, config);
        screen.expect("as shipped");
        stock.paint_apart(&scribe);
        let mut signs = SignStock::new(gpu, &mut renderer).expect("a plain mesh");
        signs.paint_apart(&scribe);
        let games = [Button::Red, Button::Blue];
        Self {
            game: Game::new(conditions.clone(), FRAMES).expect("as shipped"),
            script: Script::new(&conditions.lobby, 1, Velocities::Measured, &games),
            targets: EyeTargets::new(gpu, size, 2).expect("a common size"),
            words: Words::load(root, config).expect("as shipped"),
            again: Again::of(config),
            renderer,
            stock,
            signs,
            last_word,
            conditions,
        }
    }

    /// Drops all that asks for texts: who paints them has nothing more to do.
    fn close(self) -> LastWord {
        self.last_word
    }

    fn pins_are_falling(&self) -> bool {
        let pins = self.game.observe().pins;
        pins.iter().filter(|pin| !pin.is_standing).count() >= 3
    }

    fn play(&mut self) {
        let input = self.script.next(&self.game);
        self.game.step(&input);
    }

    /// Plays, converts and submits one frame: processor time of the physics, the scene, the drawing and of all three [s].
    fn frame(&mut self) -> [f64; 4] {
        let input = self.script.next(&self.game);
        let begun = thread_seconds();
        self.game.step(&input);
        let stepped = thread_seconds();
        let visible = self.game.visible();
        let scores = convert::Scores::of(&self.game);
        self.stock
            .show_scores(&mut self.renderer, &scores)
            .expect("it is painted in every session");
        let moment = self.again.as_mut().and_then(|again| {
            again.notice(&self.game);
            again.at(self.game.time())
        });
        self.stock
            .show_again(moment)
            .expect("it is drawn in every session");
        let hand = convert::HandLook::of(&self.game);
        let mut scene = convert::scene(visible.iter(), &self.stock, hand);
        let texts = labels::signs(&self.game, Grip::Trigger, &self.words);
        let signs = self.signs.instances(&texts, &mut self.renderer);
        scene
            .instances
            .extend(signs.expect("they are painted in every session"));
        let head = input
            .head
            .map(|head| self.game.world_from_tracking() * head.pose);
        let head = head.expect("a script has a head");
        let views = convert::eyes(&head, &self.conditions.lobby.display);
        let seen = thread_seconds();
        self.targets
            .draw(&mut self.renderer, &scene, &views)
            .expect("it is drawn in every session");
        let ended = thread_seconds();
        [stepped - begun, seen - stepped, ended - seen, ended - begun]
    }
}

/// The value below which a share of sorted times lies.
fn at(times: &[f64], share: f64) -> f64 {
    times[((times.len() - 1) as f64 * share) as usize]
}

/// Sorts the times and says what they are.
fn percentiles(times: &mut [f64]) -> String {
    times.sort_by(f64::total_cmp);
    format!(
        "median {:.3}  p99 {:.3}  longest {:.3}",
        at(times, 0.5),
        at(times, 0.99),
        at(times, 1.0)
    )
}
