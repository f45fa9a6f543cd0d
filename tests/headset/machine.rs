use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// What the environment says instead of a folder where the system can have no runtime.
const NONE: &str = "none";

/// The folder of the unpacked runtime, or none where this machine cannot run it: then this says which test is skipped.
///
/// # Panics
/// In continuous integration, which must have it, unless the environment says that the system can have none.
pub fn runtime() -> Option<PathBuf> {
    let asked = std::env::var_os("BOWLING_XR_RUNTIME").map(PathBuf::from);
    let can_have_none = asked.as_deref() == Some(Path::new(NONE));
    let found = find(asked).and_then(|folder| is_by_itself().map(|()| folder));
    let why = match found {
        Ok(folder) => return Some(folder),
        Err(why) => why,
    };
    assert!(can_have_none || std::env::var_os("CI").is_none(), "{why}");
    let thread = std::thread::current();
    let name = thread.name().unwrap_or("a test of the headset");
    // Past the harness, which keeps what a passing test prints to itself.
    let _ = writeln!(std::io::stderr(), "skipped: {name} ({why})");
    None
}

/// The folder that was asked for, or the one that the script fills by itself.
fn find(asked: Option<PathBuf>) -> Result<PathBuf, String> {
    let cache = || {
        let cache = std::env::var_os("XDG_CACHE_HOME").map(PathBuf::from);
        let cache = cache.or_else(|| Some(PathBuf::from(std::env::var_os("HOME")?).join(".cache")));
        cache.map(|cache| cache.join("bowling/xr-runtime"))
    };
    match asked.or_else(cache) {
        Some(folder) if is_whole(&folder) => Ok(folder),
        _ => Err("no OpenXR runtime for tests is unpacked: run scripts/xr-runtime.sh".to_owned()),
    }
}

/// Whether everything is there that the script listed, which it does last.
fn is_whole(folder: &Path) -> bool {
    fs::read_to_string(folder.join("manifest")).is_ok_and(|manifest| {
        let mut parts = manifest.lines().filter_map(|line| line.split_once("  "));
        folder.join("ld").is_file() && parts.all(|(_, part)| folder.join(part).is_file())
    })
}

/// The remote driver listens on every address and asks nobody who they are: nobody else may reach it. An error when there is
/// a network interface beside the loopback, unless `BOWLING_XR_SHARED_NET=1` says that this is fine.
fn is_by_itself() -> Result<(), String> {
    if std::env::var_os("BOWLING_XR_SHARED_NET").is_some_and(|value| value == "1") {
        return Ok(());
    }
    let table = fs::read_to_string("/proc/net/dev").expect("Linux lists its network interfaces");
    let outside = outside_interfaces(&table);
    if outside.is_empty() {
        return Ok(());
    }
    Err(format!(
        "the OpenXR runtime opens a port to every network, here {}: run the tests as \
         `scripts/in-own-network.sh cargo test`, or set BOWLING_XR_SHARED_NET=1 where nobody else can reach this machine",
        outside.join(", ")
    ))
}

/// Interfaces other than the loopback in the text of `/proc/net/dev`, proc_pid_net(5): two lines of head, then a line each.
fn outside_interfaces(table: &str) -> Vec<&str> {
    let names = table
        .lines()
        .skip(2)
        .filter_map(|line| line.split_once(':'));
    names
        .map(|(name, _)| name.trim())
        .filter(|name| *name != "lo")
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outside_interfaces_names_all_but_the_loopback() {
        // The example of proc_pid_net(5), shortened.
        let table = "Inter-|   Receive                            |  Transmit\n \
                     face |bytes    packets errs drop fifo frame|bytes    packets errs\n    \
                     lo: 2776770   11307    0    0    0     0          0\n  \
                     eth0: 1215645    2751    0    0    0     0          0\n  \
                     tap0:    7714      81    0    0    0     0          0\n";
        assert_eq!(outside_interfaces(table), ["eth0", "tap0"]);
    }

    #[test]
    fn is_whole_wants_every_part_that_the_manifest_lists() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let write = |name: &str, text: &str| {
            fs::write(folder.path().join(name), text).expect("a fresh folder");
        };
        write("ld", "");
        write("service", "");
        assert!(!is_whole(folder.path()), "unpacking was cut short");
        // As sha256sum writes it.
        write("manifest", "0f3a  service\n9c41  library\n");
        assert!(!is_whole(folder.path()), "a part is gone");
        write("library", "");
        assert!(is_whole(folder.path()));
        fs::remove_file(folder.path().join("ld")).expect("it was written");
        assert!(!is_whole(folder.path()), "nothing starts a program");
    }
}
