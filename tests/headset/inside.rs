//! Tests that are clients of the runtime themselves: each runs again in a process with the runtime's libraries.

use std::ffi::OsStr;
use std::time::{Duration, Instant};

use renderer::glam::{Quat, Vec3};
use renderer::headset::{Found, Frame, HeadsetSession, HeadsetSettings, Seen};
use renderer::{Gpu, MeshData, MeshId, Renderer, RendererSettings, Scene, View};

use crate::room::PATIENCE;
use crate::service::Service;
use crate::validation::Layers;

/// Set in the process of a test that runs inside.
const INSIDE: &str = "BOWLING_XR_INSIDE";
/// Where the participant's space lies in the world: turned, so that a forgotten turn shows.
const RIG: (Vec3, f32) = (Vec3::new(1.0, 0.0, 4.0), 0.4);

/// Runs the test `name` again, with the runtime's libraries and under the validation layers, which must find nothing; what it
/// said.
///
/// # Panics
/// When it fails, or when the layers complain.
pub fn run_inside(service: &Service, name: &str) -> String {
    let (said, layers) = run_watched(service, name, &[]);
    assert_eq!(layers.complaints(&said), Vec::<String>::new());
    said
}

/// As [`run_inside`], with more in its environment, and whatever the layers say.
///
/// # Panics
/// When it fails.
pub fn run_watched(
    service: &Service,
    name: &str,
    environment: &[(&str, &OsStr)],
) -> (String, Layers) {
    let layers = Layers::new();
    let program = std::env::current_exe().expect("a test knows its program");
    let output = service
        .client_command(&program)
        .args(["--exact", name, "--nocapture"])
        .env(INSIDE, "1")
        .envs(layers.environment())
        .envs(environment.iter().copied())
        .output()
        .expect("the runner starts");
    let said = [output.stdout, output.stderr].concat();
    let said = String::from_utf8_lossy(&said).into_owned();
    let complaints = layers.complaints(&said);
    assert!(output.status.success(), "{said}\n{complaints:?}");
    assert!(said.contains("1 passed"), "no such test inside: {said}");
    (said, layers)
}

/// Whether this process is the one with the runtime's libraries.
pub fn is_inside() -> bool {
    std::env::var_os(INSIDE).is_some()
}

/// The participant's space in the world.
pub fn rig() -> (Vec3, Quat) {
    (RIG.0, Quat::from_rotation_y(RIG.1))
}

/// A renderer with a ball of a radius of 8 cm and a wall of 40 by 40 m that faces +z.
pub fn renderer_on(gpu: &Gpu) -> (Renderer, [MeshId; 2]) {
    let mut renderer = Renderer::new(gpu, RendererSettings::default()).expect("plain settings");
    let meshes = [MeshData::sphere(0.08, 48), MeshData::quad(40.0, 40.0)];
    let meshes = meshes.map(|mesh| renderer.add_mesh(&mesh).expect("a plain mesh"));
    (renderer, meshes)
}

/// The service's headset.
pub fn found() -> Found {
    Found::look().expect("a headset")
}

/// The first picture that the runtime wants of a scene, with its views.
pub fn picture(scene: impl Fn([MeshId; 2]) -> Scene) -> ([View; 2], Vec<Seen>) {
    let mut headset = HeadsetSession::open(found(), HeadsetSettings::default()).expect("a headset");
    let (mut renderer, meshes) = renderer_on(headset.gpu());
    let scene = scene(meshes);
    let mut show = |headset: &mut HeadsetSession, frame| {
        let shown = headset
            .show(frame, &mut renderer, &scene, rig(), true)
            .expect("a picture");
        let [left, right] = shown.views[..] else {
            return None;
        };
        Some(([left, right], shown.seen))
    };
    first_frame(&mut headset, &mut show)
}

/// Runs a session until a frame that is to be shown gives an answer.
pub fn first_frame<T>(
    headset: &mut HeadsetSession,
    mut answer: impl FnMut(&mut HeadsetSession, Frame) -> Option<T>,
) -> T {
    let begun = Instant::now();
    loop {
        assert!(begun.elapsed() < PATIENCE, "no picture was wanted");
        headset.poll().expect("the service runs");
        if !headset.is_running() {
            std::thread::sleep(Duration::from_millis(2));
            continue;
        }
        let frame = headset.wait().expect("the service runs");
        if !frame.should_render() {
            headset.skip(frame).expect("the service runs");
            continue;
        }
        if let Some(answer) = answer(headset, frame) {
            return answer;
        }
    }
}
