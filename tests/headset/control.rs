//! `monado-ctl`: who is connected to the service, who has the focus, whose input is cut.

use std::io::Read;
use std::process::Stdio;

use crate::service::{PATIENCE, Service};
use crate::shared::process::Process;

impl Service {
    /// Runs `monado-ctl`: without arguments it lists clients and devices, `-f ID` gives a client the focus, `-i ID` cuts a
    /// client's input or gives it back, `-p ID` makes it the one that is shown, `-c` recentres. What it says.
    ///
    /// # Panics
    /// When it fails, or gets no answer from the service.
    pub fn ctl(&self, arguments: &[&str]) -> String {
        let mut command = self.client_command(&self.runtime().join("root/usr/bin/monado-ctl"));
        command
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut process = Process::start("monado-ctl", &mut command);
        // It says a few lines, which a pipe holds: reading can wait for its end.
        let ended = process.ended_within(PATIENCE);
        let ended =
            ended.unwrap_or_else(|| panic!("the service does not answer monado-ctl {arguments:?}"));
        let mut said = String::new();
        let mut complaint = String::new();
        let child = process.child();
        let (output, errors) = (child.stdout.take(), child.stderr.take());
        output
            .expect("piped")
            .read_to_string(&mut said)
            .expect("monado-ctl writes text");
        errors
            .expect("piped")
            .read_to_string(&mut complaint)
            .expect("monado-ctl writes text");
        assert!(
            ended.success(),
            "monado-ctl {arguments:?}: {ended}\n{said}{complaint}"
        );
        said
    }

    /// The number by which `monado-ctl` knows the program that calls itself `name`; none while it is not connected.
    pub fn client_id(&self, name: &str) -> Option<u32> {
        client_id(&self.ctl(&[]), name)
    }
}

/// The number of the client called `name`, in what `monado-ctl` lists: fields between tabs, `id: 3` first, the name last.
fn client_id(listing: &str, name: &str) -> Option<u32> {
    let clients = listing
        .lines()
        .skip_while(|line| !line.starts_with("Clients"));
    let mut clients = clients.take_while(|line| !line.starts_with("Devices"));
    clients.find_map(|line| {
        let mut fields = line.trim().split('\t');
        let id = fields.next()?.strip_prefix("id: ")?;
        (fields.next_back() == Some(name)).then(|| id.parse().ok())?
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::runtime;
    use crate::service::Compositor;

    #[test]
    fn client_id_is_found_by_the_programs_name() {
        let listing = "Clients:\n\
             \tid: 1\tact: 0\tdisp: 0\tfoc: 0\tio: 1\tovly: 0\tz: 0\tpid: 7\tmonado-ctl\n\
             \tid: 12\tact: 1\tdisp: 1\tfoc: 1\tio: 1\tovly: 0\tz: 0\tpid: 8\tbowling\n\
             \nDevices:\n\tid: 0\tname: 1\t\"Remote HMD\"\n";
        assert_eq!(client_id(listing, "bowling"), Some(12));
        assert_eq!(client_id(listing, "bowl"), None);
        assert_eq!(client_id(listing, "\"Remote HMD\""), None);
    }

    #[test]
    fn the_service_lists_what_it_drives_and_who_asks() {
        let Some(runtime) = runtime() else { return };
        let service = Service::start(&runtime, Compositor::Null);
        let listing = service.ctl(&[]);
        assert!(listing.contains("\"Remote HMD\""), "{listing}");
        assert!(service.client_id("monado-ctl").is_some(), "{listing}");
        assert_eq!(service.client_id("nobody"), None);
    }
}
