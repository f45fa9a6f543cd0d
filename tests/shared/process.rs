use std::process::{Child, Command, ExitStatus};
use std::time::Duration;

use super::ask_until;

/// A process that is killed when its owner goes, however the test ends.
pub struct Process {
    child: Child,
    name: String,
}

impl Process {
    /// Starts `command`; `name` stands in the sentences of its failures.
    ///
    /// # Panics
    /// When it cannot be started.
    pub fn start(name: &str, command: &mut Command) -> Self {
        let child = command
            .spawn()
            .unwrap_or_else(|error| panic!("{name} does not start: {error} ({command:?})"));
        Self {
            child,
            name: name.to_owned(),
        }
    }

    /// The child, for its pipes.
    pub fn child(&mut self) -> &mut Child {
        &mut self.child
    }

    /// How it ended; none while it runs.
    pub fn ended(&mut self) -> Option<ExitStatus> {
        self.child
            .try_wait()
            .unwrap_or_else(|error| panic!("{} cannot be waited for: {error}", self.name))
    }

    /// How it ended; none when it still runs after `limit`.
    pub fn ended_within(&mut self, limit: Duration) -> Option<ExitStatus> {
        ask_until(limit, || self.ended())
    }

    /// Kills it and waits until it is gone, with all that it held open.
    pub fn kill(&mut self) {
        // An error says that it is gone already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.kill();
    }
}
