//! Play that goes on and on under the real compositor: what the program and the service hold must not grow.

use std::ffi::OsStr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use game::Phase;

use crate::client::Client;
use crate::machine::runtime;
use crate::play::start_alley;
use crate::room::{Hand, Room, Swing};
use crate::service::{Compositor, Service};

/// Time that is played [s]; `BOWLING_XR_ENDURANCE_S` asks for another.
const SECONDS: f64 = 20.0;
/// Time between two looks at what is held.
const INTERVAL: Duration = Duration::from_millis(500);
/// Growth of memory in the second half that caches of the driver explain [MiB], and that a minute may add to it.
const GROWTH_MIB: [f64; 2] = [4.0, 1.0];

/// What a process holds.
#[derive(Clone, Copy, Debug)]
struct Held {
    memory_mib: f64,
    handles: usize,
    /// Pieces of its address space: images that are shared with another process are one each.
    mapped: usize,
}

/// proc_pid_status(5), proc_pid_fd(5) and proc_pid_maps(5).
fn held(process: u32) -> Held {
    let folder = std::path::PathBuf::from(format!("/proc/{process}"));
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).expect("it runs");
    let status = read("status");
    let resident = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kib = resident.and_then(|kib| kib.trim().strip_suffix(" kB")?.parse().ok());
    let kib: f64 = kib.expect("Linux tells a process's memory in kB");
    Held {
        memory_mib: kib / 1024.0,
        handles: std::fs::read_dir(folder.join("fd"))
            .expect("it runs")
            .count(),
        mapped: read("maps").lines().count(),
    }
}

/// What was held over time, of the program and of the service.
#[derive(Default)]
struct Watch {
    looks: Vec<(f64, [Held; 2])>,
}

impl Watch {
    /// The looks in a share of the time, from 0 to 1.
    fn between(&self, from: f64, to: f64) -> Vec<[Held; 2]> {
        let last = self.looks.last().expect("there were some").0;
        let within = |at: &f64| (from * last..=to * last).contains(at);
        let looks = self.looks.iter().filter(|(at, _)| within(at));
        looks.map(|(_, held)| *held).collect()
    }

    /// The most of something in the third quarter of the time and in the last.
    fn most(&self, what: impl Fn(&[Held; 2]) -> f64) -> [f64; 2] {
        [(0.5, 0.75), (0.75, 1.0)].map(|(from, to)| {
            let looks = self.between(from, to);
            looks.iter().map(&what).fold(0.0, f64::max)
        })
    }

    /// A line for each twentieth of the time.
    fn print(&self) {
        println!("   time    program: MiB handles mapped    service: MiB handles mapped");
        let every = self.looks.len().div_ceil(20);
        for (at, [program, service]) in self.looks.iter().step_by(every) {
            println!(
                "{at:6.1} s {:14.1} {:7} {:6} {:15.1} {:7} {:6}",
                program.memory_mib,
                program.handles,
                program.mapped,
                service.memory_mib,
                service.handles,
                service.mapped
            );
        }
    }
}

/// Ends the watch, also when the play ends in a panic.
struct Ending<'a>(&'a AtomicBool);

impl Drop for Ending<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Looks at what processes hold until it is told to stop.
fn watch(processes: [u32; 2], stop: &AtomicBool) -> Watch {
    let (begun, mut watch) = (Instant::now(), Watch::default());
    while !stop.load(Ordering::Relaxed) {
        let at = begun.elapsed().as_secs_f64();
        watch.looks.push((at, processes.map(held)));
        std::thread::sleep(INTERVAL);
    }
    watch
}

/// Plays on, a ball after the other, as long as there is time; how many were thrown.
fn play(room: &mut Room, seconds: f64) -> usize {
    let begun = Instant::now();
    let is_left = || begun.elapsed().as_secs_f64() < seconds;
    let swing = Swing {
        speed: 6.5,
        release_at: 0.1,
    };
    let mut throws = 0;
    while is_left() {
        room.take_ball(Hand::Right);
        room.walk_to(Hand::Right, -0.2, 0.9);
        swing.throw(room, Hand::Right);
        throws += 1;
        while is_left() && room.game.phase() != Phase::Lobby {
            room.follow(Duration::from_millis(100));
        }
        if is_left() {
            room.walk_to(Hand::Right, 0.6, 2.3);
        }
    }
    throws
}

#[test]
fn play_goes_on_without_growing() {
    let Some(runtime) = runtime() else { return };
    let seconds = std::env::var("BOWLING_XR_ENDURANCE_S").ok();
    let seconds = seconds.map_or(SECONDS, |text| text.parse().expect("a number of seconds"));
    let mut service = Service::start(&runtime, Compositor::Xvfb { hz: 90 });
    let out = tempfile::tempdir().expect("a temporary folder");
    let folder = out.path().join("session");
    // What the layers hold themselves is not the program's.
    let bare = ["XR_ENABLE_API_LAYERS", "VK_INSTANCE_LAYERS"].map(|name| (name, OsStr::new("")));
    let mut client: Client = start_alley(&service, &folder, &bare);
    let mut room = Room::enter(&service, &mut client, &folder);
    let processes = [client.id(), service.id()];
    let stop = AtomicBool::new(false);
    let (throws, watch) = std::thread::scope(|scope| {
        let watching = scope.spawn(|| watch(processes, &stop));
        let ending = Ending(&stop);
        let throws = play(&mut room, seconds);
        drop(ending);
        (throws, watching.join().expect("both processes run"))
    });
    let images = room.device("swapchain_images")[0].clone();
    let (status, said) = client.finish();
    assert!(status.success(), "{said}");
    watch.print();
    room.follow(Duration::from_secs(1));
    println!(
        "{throws} throws; images of the swapchains: {images}; {}",
        room.device("frames").last().expect("a summary at the end")
    );
    let minutes = seconds / 60.0;
    for (index, who) in ["program", "service"].into_iter().enumerate() {
        let [before, after] = watch.most(|held| held[index].handles as f64);
        assert!(after <= before, "{who}: {before} handles, then {after}");
        let [before, after] = watch.most(|held| held[index].mapped as f64);
        assert!(
            after <= before + 8.0,
            "{who}: {before} pieces, then {after}"
        );
        let [before, after] = watch.most(|held| held[index].memory_mib);
        let allowed = GROWTH_MIB[0] + GROWTH_MIB[1] * minutes;
        assert!(
            after - before < allowed,
            "{who}: {before} MiB, then {after} MiB"
        );
    }
}
