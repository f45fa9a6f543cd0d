use std::fs::{self, OpenOptions};
use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::Duration;

use rustix::process::Signal;
use tempfile::TempDir;

use crate::shared::ask_until;
use crate::shared::process::Process;
use crate::shared::screen::Screen;

/// Longest wait for the service: software Vulkan on a busy machine takes seconds to start.
pub const PATIENCE: Duration = Duration::from_secs(60);
/// The service's socket, in its runtime folder.
const SOCKET: &str = "monado_comp_ipc";

/// What shows the frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compositor {
    /// Nothing: frames are taken and dropped, 20 a second, which is built into Monado.
    Null,
    /// The real compositor in a window on a screen in memory.
    Xvfb {
        /// Frames a second.
        hz: u32,
    },
}

/// What moves head and hands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    /// The tests, through a port ([`super::remote`]): the controllers are Valve's Index.
    Remote,
    /// Keys and mouse, in a window on a screen in memory: the controllers are those of Windows Mixed Reality.
    Keys,
    /// Nobody: simple controllers that move by themselves.
    Simulated,
}

/// Monado's service with the remote driver, in folders and on a port of its own.
pub struct Service {
    // Before the screen: the service must not outlive what it draws on.
    process: Process,
    /// What the real compositor draws on, and how often [1/s].
    screen: Option<(Screen, u32)>,
    driver: Driver,
    /// Where the window of [`Driver::Keys`] is.
    keys: Option<Screen>,
    runtime: PathBuf,
    folder: TempDir,
    port: u16,
}

impl Service {
    /// Starts the service of the runtime in the folder `runtime` and waits until programs and [`super::remote::Remote`] can
    /// connect.
    ///
    /// # Panics
    /// With its log, when the service does not come up.
    pub fn start(runtime: &Path, compositor: Compositor) -> Self {
        Self::start_with(runtime, compositor, Driver::Remote)
    }

    /// As [`Self::start`], with another driver.
    ///
    /// # Panics
    /// As [`Self::start`].
    pub fn start_with(runtime: &Path, compositor: Compositor, driver: Driver) -> Self {
        // In the system's folder: a socket's path has room for 107 bytes only.
        let folder = tempfile::tempdir().expect("a temporary folder");
        let port = free_port();
        fs::create_dir(folder.path().join("run")).expect("a fresh folder");
        let settings = folder.path().join("config/monado");
        fs::create_dir_all(&settings).expect("a fresh folder");
        fs::write(
            settings.join("config_v0.json"),
            format!(
                r#"{{"active": "remote", "remote": {{"version": 0, "port": {port}, "view_count": 2}}}}"#
            ),
        )
        .expect("a fresh folder");
        let screen = match compositor {
            Compositor::Null => None,
            // Room for the compositor's window.
            Compositor::Xvfb { hz } => Some((Screen::open([960, 540]), hz)),
        };
        let keys = (driver == Driver::Keys).then(|| Screen::open([800, 600]));
        let place = Place {
            runtime,
            folder: folder.path(),
            port,
        };
        let process = launch(&place, screen.as_ref(), (driver, keys.as_ref()));
        Self {
            process,
            screen,
            driver,
            keys,
            runtime: runtime.to_owned(),
            folder,
            port,
        }
    }

    /// Starts it again after its end, in the same folder and on the same port, so that programs find it where it was.
    ///
    /// # Panics
    /// When it still runs, or, with its log, when it does not come up.
    pub fn restart(&mut self) {
        assert!(self.process.ended().is_some(), "the service still runs");
        let place = Place {
            runtime: &self.runtime,
            folder: self.folder.path(),
            port: self.port,
        };
        let driver = (self.driver, self.keys.as_ref());
        self.process = launch(&place, self.screen.as_ref(), driver);
    }

    /// Its process number.
    pub fn id(&mut self) -> u32 {
        self.process.id()
    }

    /// The folder of the runtime that it is part of.
    pub fn runtime(&self) -> &Path {
        &self.runtime
    }

    /// The remote driver's port.
    pub fn port(&self) -> u16 {
        self.port
    }

    /// The real compositor's screen.
    ///
    /// # Panics
    /// With the null compositor, which has none.
    pub fn screen(&self) -> &Screen {
        let (screen, _) = self.screen.as_ref().expect("a compositor with a screen");
        screen
    }

    /// Where the driver's keys are pressed.
    ///
    /// # Panics
    /// With a driver that has none.
    pub fn keys(&self) -> &Screen {
        self.keys.as_ref().expect("a driver with keys")
    }

    /// A command that runs `program` with the runtime's libraries, as a client of this service.
    pub fn client_command(&self, program: &Path) -> Command {
        let mut command = Command::new(self.runtime.join("ld"));
        command
            .arg(program)
            .env("XDG_RUNTIME_DIR", run_folder(self.folder.path()))
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .stdin(Stdio::null());
        command
    }

    /// What the service has said so far, over all its starts.
    pub fn log(&self) -> String {
        read_log(self.folder.path())
    }

    /// Kills it without a warning, and waits until it is gone.
    pub fn kill(&mut self) {
        self.process.kill();
    }

    /// Asks it to end; how it ended. Monado 25 leaves that to the system: by the signal, its socket left behind.
    ///
    /// # Panics
    /// When it does not end.
    pub fn terminate(&mut self) -> ExitStatus {
        self.process.signal(Signal::TERM);
        let ended = self.process.ended_within(PATIENCE);
        ended.expect("the service ends when it is asked to")
    }

    /// Stops all its threads where they stand, until [`Self::cont`].
    ///
    /// # Panics
    /// When it runs on.
    pub fn stop(&mut self) {
        self.process.signal(Signal::STOP);
        let stopped = ask_until(PATIENCE, || self.process.is_stopped().then_some(()));
        assert!(stopped.is_some(), "the service runs on");
    }

    /// Lets it go on after [`Self::stop`].
    pub fn cont(&mut self) {
        self.process.signal(Signal::CONT);
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("the service's log:\n{}", self.log());
        }
    }
}

fn run_folder(folder: &Path) -> PathBuf {
    folder.join("run")
}

fn read_log(folder: &Path) -> String {
    let bytes = fs::read(folder.join("service.log")).unwrap_or_default();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Where a service and its parts are.
struct Place<'a> {
    runtime: &'a Path,
    folder: &'a Path,
    port: u16,
}

/// Starts the service and waits until its socket is open, and the port of a remote driver.
fn launch(
    place: &Place,
    screen: Option<&(Screen, u32)>,
    (driver, keys): (Driver, Option<&Screen>),
) -> Process {
    let Place {
        runtime,
        folder,
        port,
    } = *place;
    let socket = run_folder(folder).join(SOCKET);
    // A killed service leaves its socket behind; the next one's must not be mistaken for it.
    if socket.exists() {
        fs::remove_file(&socket).expect("the service's own folder");
    }
    let before = read_log(folder).len();
    let log = OpenOptions::new()
        .create(true)
        .append(true)
        .open(folder.join("service.log"))
        .expect("the service's own folder");
    let mut command = Command::new(runtime.join("ld"));
    command
        .arg(runtime.join("root/usr/bin/monado-service"))
        .env("XDG_RUNTIME_DIR", run_folder(folder))
        .env("XDG_CONFIG_HOME", folder.join("config"))
        .env("XRT_NO_STDIN", "1")
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .stdin(Stdio::null());
    match screen {
        None => command.env("XRT_COMPOSITOR_NULL", "1"),
        Some((screen, hz)) => command
            .env("DISPLAY", screen.display())
            .env("XRT_COMPOSITOR_FORCE_XCB", "1")
            .env("XRT_COMPOSITOR_DEFAULT_FRAMERATE", hz.to_string())
            // At once, so that a screen that does not do fails the start and not the first frame.
            .env("XRT_COMPOSITOR_DISABLE_DEFERRED", "1")
            // A quarter of what it recommends, 240 by 270 for an eye: software Vulkan must hold the rate.
            .env("XRT_COMPOSITOR_SCALE_PERCENTAGE", "25")
            .env("XRT_COMPOSITOR_COMPUTE", "1"),
    };
    match driver {
        Driver::Remote => command.env("P_OVERRIDE_ACTIVE_CONFIG", "remote"),
        Driver::Keys => command
            .env("P_OVERRIDE_ACTIVE_CONFIG", "none")
            .env("QWERTY_ENABLE", "1")
            // The window that takes them.
            .env("XRT_DEBUG_GUI", "1"),
        Driver::Simulated => command
            .env("P_OVERRIDE_ACTIVE_CONFIG", "none")
            .env("SIMULATED_ENABLE", "1")
            .env("SIMULATED_LEFT", "simple")
            .env("SIMULATED_RIGHT", "simple"),
    };
    if let Some(keys) = keys {
        command.env("DISPLAY", keys.display());
    }
    command.stderr(log.try_clone().expect("an open file"));
    command.stdout(log);
    let mut process = Process::start("monado-service", &mut command);
    let listening = format!("Listening on port '{port}'");
    let up = ask_until(PATIENCE, || {
        let log = read_log(folder);
        let said = log[before..].contains("service has started")
            && (driver != Driver::Remote || log[before..].contains(&listening));
        if said && socket.exists() {
            return Some(true);
        }
        process.ended().map(|_| false)
    });
    assert!(
        up == Some(true),
        "the service does not come up, {}:\n{}",
        process
            .ended()
            .map_or("but runs".to_owned(), |ended| ended.to_string()),
        read_log(folder)
    );
    process
}

/// A port that nobody listens on now.
fn free_port() -> u16 {
    let listener = TcpListener::bind((Ipv4Addr::UNSPECIFIED, 0)).expect("a free port");
    listener.local_addr().expect("it is bound").port()
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::super::machine::runtime;
    use super::super::remote::{Packet, Remote};
    use super::*;

    #[test]
    fn the_service_stops_and_goes_on() {
        let Some(runtime) = runtime() else { return };
        let mut service = Service::start(&runtime, Compositor::Null);
        service.stop();
        // The system takes the connection for it, but nobody answers.
        let mut stream = std::net::TcpStream::connect((Ipv4Addr::LOCALHOST, service.port()))
            .expect("the port stays open");
        stream
            .set_read_timeout(Some(Duration::from_millis(200)))
            .expect("a time above zero");
        assert!(
            stream.read(&mut [0; 8]).is_err(),
            "a stopped service answers"
        );
        service.cont();
        stream
            .set_read_timeout(Some(PATIENCE))
            .expect("a time above zero");
        // Both of its packets: it dies of writing to a connection that was closed before it wrote.
        stream
            .read_exact(&mut [0; 2 * 376])
            .expect("the driver goes on");
    }

    #[test]
    fn the_service_comes_back_where_it_was() {
        let Some(runtime) = runtime() else { return };
        let mut service = Service::start(&runtime, Compositor::Null);
        let mut remote = Remote::connect(service.port()).expect("the driver listens");
        service.kill();
        // The first write may still go into the void; the answer to it closes the connection.
        let lost = ask_until(PATIENCE, || remote.send(&Packet::default()).err());
        assert!(lost.is_some(), "a killed service reads on");
        service.restart();
        Remote::connect(service.port()).expect("the driver listens again");
        service.terminate();
        assert!(
            Remote::connect(service.port()).is_err(),
            "it listens on after its end"
        );
    }

    #[test]
    fn the_real_compositor_starts_on_a_screen_in_memory() {
        let Some(runtime) = runtime() else { return };
        let service = Service::start(&runtime, Compositor::Xvfb { hz: 90 });
        Remote::connect(service.port()).expect("the driver listens");
        // What it prints when the screen has given it images to draw on.
        let log = service.log();
        assert!(log.contains("VkSwapchainCreateInfoKHR"), "{log}");
    }
}
