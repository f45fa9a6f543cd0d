//! What is done to processes that must be stopped, ended and let go on.

use rustix::process::{Pid, Signal, kill_process};

use crate::shared::process::Process;
use crate::shared::screen::Screen;

impl Process {
    /// Its number.
    pub fn id(&mut self) -> u32 {
        self.child().id()
    }

    /// Sends `signal`, unless it has ended: its number may be another process's by then.
    pub fn signal(&mut self, signal: Signal) {
        if self.ended().is_some() {
            return;
        }
        let number = Pid::from_child(self.child());
        kill_process(number, signal)
            .unwrap_or_else(|error| panic!("process {number} takes no signal: {error}"));
    }

    /// Whether every thread of it is stopped.
    pub fn is_stopped(&mut self) -> bool {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.id()));
        // proc_pid_stat(5): "number (name) state ..."; the name may hold brackets and spaces itself.
        stat.is_ok_and(|line| {
            line.rsplit_once(") ")
                .is_some_and(|(_, rest)| rest.starts_with('T'))
        })
    }
}

impl Screen {
    /// Holds it up: whoever draws on it, or asks it anything, waits.
    pub fn stop(&mut self) {
        self._server.signal(Signal::STOP);
    }

    /// Lets it go on.
    pub fn cont(&mut self) {
        self._server.signal(Signal::CONT);
    }
}
