//! The order in which the runtime is called, as the layer that writes every call down has it.

use std::ffi::{OsStr, OsString};

use crate::loss::play_in;
use crate::validation::CORE_VALIDATION;

/// What makes a frame.
const FRAME: [&str; 7] = [
    "xrWaitFrame",
    "xrBeginFrame",
    "xrAcquireSwapchainImage",
    "xrWaitSwapchainImage",
    "xrLocateViews",
    "xrReleaseSwapchainImage",
    "xrEndFrame",
];

/// The calls in the layer's text, which begins each with its type and name, and its parameters with blanks.
fn calls(text: &str) -> Vec<&str> {
    let begins = text.lines().filter(|line| line.starts_with("XrResult xr"));
    begins.map(|line| &line["XrResult ".len()..]).collect()
}

/// One frame's calls in the order that the specification has, with a picture of `images` images or without one.
fn frame(images: usize) -> Vec<&'static str> {
    let mut calls = vec!["xrWaitFrame", "xrBeginFrame"];
    for _ in 0..images {
        calls.extend(["xrAcquireSwapchainImage", "xrWaitSwapchainImage"]);
    }
    if images > 0 {
        // As late as can be, since the wait for the images may have been a long one: how many there are, and then where they are.
        calls.extend(["xrLocateViews"; 2]);
    }
    calls.extend(std::iter::repeat_n("xrReleaseSwapchainImage", images));
    calls.push("xrEndFrame");
    calls
}

#[test]
fn every_frame_calls_the_runtime_in_its_order_and_nothing_is_called_behind_the_end() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("calls.txt");
    let layers = OsString::from(format!("{CORE_VALIDATION}:XR_APILAYER_LUNARG_api_dump"));
    let environment: [(&str, &OsStr); 3] = [
        ("XR_ENABLE_API_LAYERS", &layers),
        ("XR_API_DUMP_EXPORT_TYPE", OsStr::new("text")),
        ("XR_API_DUMP_FILE_NAME", file.as_os_str()),
    ];
    let Some(mut played) = play_in(&environment) else {
        return;
    };
    let room = &mut played.room;
    room.wait_until("forty pictures", |room| {
        let frames = room.device("frame");
        frames.iter().filter(|frame| frame["shown"] == true).count() >= 40
    });
    played.end();

    // Among the parameters are bytes of structures that are no text.
    let text = std::fs::read(&file).expect("the layer has written");
    let text = String::from_utf8_lossy(&text);
    let all = calls(&text);
    let of_frames = all.iter().copied().filter(|call| FRAME.contains(call));
    let mut frames: Vec<Vec<&str>> = Vec::new();
    for call in of_frames {
        match frames.last_mut().filter(|_| call != "xrWaitFrame") {
            Some(frame) => frame.push(call),
            None => frames.push(vec![call]),
        }
    }
    // Colours and depth of two eyes; none, where the runtime wants no picture.
    let known = [frame(4), frame(0)];
    for (number, frame) in frames.iter().enumerate() {
        assert!(known.contains(frame), "frame {number}: {frame:?}");
    }
    let pictures = frames.iter().filter(|frame| **frame == known[0]).count();
    assert!(pictures >= 40, "{pictures} of {} frames", frames.len());

    let destroyed = all.iter().position(|call| *call == "xrDestroySession");
    let destroyed = destroyed.expect("a session that was ended is destroyed");
    assert_eq!(all[destroyed + 1..], ["xrDestroyInstance"]);
    let ended = all.iter().position(|call| *call == "xrEndSession");
    let last = all.iter().rposition(|call| *call == "xrEndFrame");
    assert!(
        last < ended && ended < Some(destroyed),
        "{last:?} {ended:?}"
    );
}
