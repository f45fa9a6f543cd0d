use std::fs;
use std::path::{Path, PathBuf};

use crate::support::{bowling, fresh_folder};

/// Runs the program and returns its exit code and what it says on the error stream.
fn refused(arguments: &[&str]) -> (Option<i32>, String) {
    let output = bowling(arguments);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        !text.contains("panicked") && !text.contains("stack backtrace"),
        "{text}"
    );
    (output.status.code(), text)
}

/// A copy of the program's data that a test may damage.
fn data(name: &str) -> PathBuf {
    let root = fresh_folder(name).join("data");
    for folder in ["config", "assets"] {
        copy_folder(
            &Path::new(env!("CARGO_MANIFEST_DIR")).join(folder),
            &root.join(folder),
        );
    }
    root
}

fn copy_folder(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("writable");
    for entry in fs::read_dir(from).expect("the project's data") {
        let path = entry.expect("readable").path();
        let target = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copy_folder(&path, &target);
        } else {
            fs::copy(&path, &target).expect("writable");
        }
    }
}

/// Plays with the data in `root` and returns what is said; nothing may be left behind.
fn play_refused(root: &Path, more: &[&str]) -> String {
    let out = root.with_file_name("out");
    let (root, folder) = (root.display().to_string(), out.display().to_string());
    let mut arguments = vec![
        "play",
        "--offscreen",
        "--frames",
        "1",
        "--root",
        &root,
        "--out",
        &folder,
    ];
    arguments.extend(more);
    let (code, text) = refused(&arguments);
    assert_eq!(code, Some(1), "{text}");
    assert!(!out.exists(), "something was left behind in {folder}");
    text
}

#[test]
fn numbers_out_of_range_and_unknown_arguments_end_with_code_2() {
    let cases: [&[&str]; 7] = [
        &["play", "--device", "desk", "--offscreen"],
        &["play", "--device", "headset", "--offscreen"],
        &["play", "--frames", "0"],
        &["play", "--frames", "11"],
        &["play", "--seed", "-1"],
        &["play", "--device", "hands"],
        &["bowl"],
    ];
    for arguments in cases {
        let (code, text) = refused(arguments);
        assert_eq!(code, Some(2), "{arguments:?}: {text}");
        assert!(text.starts_with("error: "), "{text}");
    }
}

#[test]
fn without_arguments_the_help_is_shown() {
    let output = bowling(&[]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success());
    for word in ["play", "replay", "Examples:"] {
        assert!(text.contains(word), "no `{word}` in {text}");
    }
}

#[test]
fn an_unknown_setting_is_named_with_its_argument() {
    let root = data("unknown-setting");
    let text = play_refused(&root, &["--set", "lane.lenght_m=18"]);
    assert!(text.contains("lane.lenght_m"), "{text}");
    let text = play_refused(&root, &["--set", "objects.elasticity=7"]);
    assert!(text.contains("objects.elasticity"), "{text}");
    let text = play_refused(&root, &["--set", "objects=3"]);
    assert!(
        text.contains("3 does not fit; give a table of keys"),
        "{text}"
    );
    let text = play_refused(&root, &["--set", "lane.pin_spacing_m=0.4"]);
    assert!(
        text.starts_with("error: --set lane.pin_spacing_m=0.4: key"),
        "{text}"
    );
    let text = play_refused(
        &root,
        &["--set", &format!("lane.width_m=1{}.0", "0".repeat(300))],
    );
    assert!(
        text.contains("1e300 is out of range") && text.len() < 250,
        "{text}"
    );
}

#[test]
fn an_unknown_key_in_a_file_is_named_with_file_and_line() {
    let root = data("unknown-key");
    let file = root.join("config/blue.toml");
    fs::write(&file, "# Blue\n[objects]\nfrictoin_rate = 0.0\n").expect("writable");
    let text = play_refused(&root, &[]);
    for word in ["blue.toml, line 3", "frictoin_rate"] {
        assert!(text.contains(word), "no `{word}` in {text}");
    }
}

#[test]
fn a_file_that_is_not_text_is_named_with_its_line() {
    let root = data("not-text");
    fs::write(root.join("config/red.toml"), b"# Red\n# \xff\n").expect("writable");
    let text = play_refused(&root, &[]);
    assert!(
        text.contains("red.toml, line 2: is not UTF-8 text"),
        "{text}"
    );
}

#[test]
fn a_scene_that_is_not_there_is_named_with_those_that_are() {
    let root = data("scene");
    for scene in ["beach", "../red"] {
        let text = play_refused(&root, &["--scene", scene]);
        assert!(
            text.contains(scene) && text.contains("there are: alley"),
            "{text}"
        );
    }
}

#[test]
fn a_condition_cannot_change_the_room() {
    let root = data("other-room");
    fs::write(root.join("config/blue.toml"), "[lane]\nwidth_m = 1.2\n").expect("writable");
    let text = play_refused(&root, &[]);
    assert!(
        text.contains("lane must be the same under Red and Blue"),
        "{text}"
    );
}

/// With no driver to be found, the sentence says what to install and nothing of what libraries said.
#[cfg(target_os = "linux")]
#[test]
fn a_machine_without_a_driver_is_told_what_to_install() {
    let out = fresh_folder("no-driver").join("session");
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_bowling"))
        .args(["play", "--offscreen", "--out"])
        .arg(&out)
        .env("VK_DRIVER_FILES", "/nonexistent")
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .env("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent")
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the program starts");
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{text}");
    let install = "install mesa-vulkan-drivers, or libgl1-mesa-dri and libegl1\n";
    assert!(text.ends_with(install) && !text.contains('('), "{text}");
    assert!(!out.exists());
}

#[test]
fn a_missing_or_malformed_mesh_is_named() {
    let root = data("mesh");
    let mesh = root.join("assets/meshes/pin.obj");
    fs::write(&mesh, "v 0 0 0\nv 1 0 0\nv zero 1 0\nf 1 2 3\n").expect("writable");
    let text = play_refused(&root, &[]);
    assert!(
        text.contains("pin.obj:3") && text.contains("make-assets"),
        "{text}"
    );
    fs::remove_file(&mesh).expect("writable");
    let text = play_refused(&root, &[]);
    assert!(
        text.contains("pin.obj") && text.contains("make-assets"),
        "{text}"
    );
    fs::write(&mesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("writable");
    let texture = root.join("assets/textures/grain.png");
    fs::write(&texture, "no picture").expect("writable");
    let text = play_refused(&root, &[]);
    assert!(
        text.contains("grain.png") && text.contains("make-assets"),
        "{text}"
    );
}

#[test]
fn a_folder_that_cannot_be_written_is_named() {
    let file = fresh_folder("unwritable").join("file");
    fs::write(&file, "in the way").expect("writable");
    let out = file.join("session").display().to_string();
    let (code, text) = refused(&["play", "--offscreen", "--frames", "1", "--out", &out]);
    assert_eq!(code, Some(1));
    assert!(text.contains(&out) && text.contains("--out"), "{text}");
}

/// A limit of zero on the size of files stands for a full disk: nothing can be written, but files can be made.
#[cfg(unix)]
#[test]
fn a_full_disk_leaves_nothing_behind() {
    let outer = fresh_folder("full-disk");
    let out = outer.join("new/session").display().to_string();
    let output = std::process::Command::new("sh")
        .args(["-c", "trap '' XFSZ; ulimit -f 0; exec \"$0\" \"$@\""])
        .arg(env!("CARGO_BIN_EXE_bowling"))
        .args(["play", "--offscreen", "--frames", "1", "--out", &out])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the program starts");
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("journal.jsonl: is the disk full?"), "{text}");
    assert_eq!(fs::read_dir(&outer).expect("there").count(), 0);
}

#[test]
fn a_folder_without_a_recording_is_named() {
    let folder = fresh_folder("nothing").display().to_string();
    let (code, text) = refused(&["replay", &folder]);
    assert_eq!(code, Some(1));
    assert!(text.contains("journal.jsonl"), "{text}");
}
