//! The committed meshes and textures are what the generator writes.

use std::process::Command;

#[test]
fn assets_are_up_to_date() {
    let output = Command::new(env!("CARGO_BIN_EXE_make-assets"))
        .arg("--check")
        .output()
        .expect("the generator starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
}
