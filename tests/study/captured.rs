//! Any moment of a session as a picture, any span as a video.

use std::fs;

use super::{journals, said, simulated, text};
use crate::support::{bowling, fresh_folder};

#[test]
fn any_moment_of_a_session_can_be_drawn_and_any_span_filmed() {
    let journal = journals(simulated()).remove(0);
    let session = text(journal.parent().expect("a folder")).to_owned();
    let folder = fresh_folder("study-captured");
    for (view, profile) in [("eye", "1996"), ("bird", "modern")] {
        let picture = folder.join(format!("{view}.png"));
        said(&[
            "capture",
            &session,
            "--at",
            "20",
            "--profile",
            profile,
            "--view",
            view,
            "--out",
            text(&picture),
        ]);
        let image = image::open(&picture).expect("a picture").to_rgb8();
        let mean = |channel: usize| {
            let sum: u64 = image
                .pixels()
                .map(|pixel| u64::from(pixel.0[channel]))
                .sum();
            sum as f64 / f64::from(image.width() * image.height())
        };
        assert!(mean(0) > 10.0 && mean(0) < 245.0, "{view}: {}", mean(0));
    }
    let film = folder.join("span.avi");
    said(&[
        "capture",
        &session,
        "--at",
        "20",
        "--until",
        "20.2",
        "--profile",
        "1996",
        "--out",
        text(&film),
    ]);
    let bytes = fs::read(&film).expect("a video");
    // Seven pictures at 30 a second from 20 to 20.2 s: the main header counts them.
    assert_eq!(&bytes[..4], b"RIFF");
    assert_eq!(
        u32::from_le_bytes([bytes[48], bytes[49], bytes[50], bytes[51]]),
        7
    );
    // And with each goes the sound of a thirtieth second.
    let sound = [&b"01wb"[..], &6400u32.to_le_bytes()].concat();
    let tracks = bytes.windows(8).filter(|word| **word == sound);
    assert_eq!(tracks.count(), 7);
    let output = bowling(&["capture", &session, "--at", "99999", "--out", "x.png"]);
    assert_eq!(output.status.code(), Some(2));
    let refused = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(refused.contains("the session ends at"), "{refused}");
}
