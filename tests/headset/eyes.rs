//! What both eyes show, against the offscreen renderer; and the validation layers, which watch and are watched.

use std::path::Path;
use std::time::{Duration, Instant};

use renderer::glam::{Mat4, Quat, Vec3};
use renderer::headset::{HeadsetSession, HeadsetSettings};
use renderer::{
    Gpu, Instance, Material, MeshData, MeshId, Renderer, RendererSettings, RgbaImage, Scene, View,
};

use crate::machine::runtime;
use crate::play::start_in;
use crate::room::{Hand, PATIENCE, Room};
use crate::service::{Compositor, Service};

/// Set for the tests that run inside the runtime's libraries, as a client of the service that their parent started.
const INSIDE: &str = "BOWLING_XR_INSIDE";
/// Distance between the remote driver's eyes [m].
const EYE_DISTANCE: f32 = 0.063;
/// Where the participant's space lies in the world: turned, so that a forgotten turn shows.
const RIG: (Vec3, f32) = (Vec3::new(1.0, 0.0, 4.0), 0.4);

/// Runs the test `name` of this file again, with the runtime's libraries, and returns what it said.
fn run_inside(service: &Service, name: &str, environment: &[(&str, &Path)]) -> String {
    let program = std::env::current_exe().expect("a test knows its program");
    let output = service
        .client_command(&program)
        .args(["--exact", name, "--nocapture"])
        .env(INSIDE, "1")
        .envs(environment.iter().copied())
        .output()
        .expect("the runner starts");
    let said = [output.stdout, output.stderr].concat();
    let said = String::from_utf8_lossy(&said).into_owned();
    assert!(output.status.success(), "{said}");
    assert!(said.contains("1 passed"), "no such test inside: {said}");
    said
}

fn is_inside() -> bool {
    std::env::var_os(INSIDE).is_some()
}

/// Two balls that shine by themselves, one near and one far, in the participant's space.
fn scene(ball: MeshId) -> (Scene, [Vec3; 2]) {
    let rig = rig();
    let places = [Vec3::new(-0.25, 1.55, -1.2), Vec3::new(0.5, 1.7, -3.0)]
        .map(|place| rig.0 + rig.1 * place);
    let mut scene = Scene::default();
    for (place, color) in places.into_iter().zip([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]) {
        scene.instances.push(Instance {
            mesh: ball,
            material: Material::unlit(color),
            world_from_mesh: Mat4::from_translation(place),
        });
    }
    (scene, places)
}

fn rig() -> (Vec3, Quat) {
    (RIG.0, Quat::from_rotation_y(RIG.1))
}

fn renderer_on(gpu: &Gpu) -> (Renderer, MeshId) {
    let mut renderer = Renderer::new(gpu, RendererSettings::default()).expect("plain settings");
    let ball = renderer
        .add_mesh(&MeshData::sphere(0.08, 48))
        .expect("a ball");
    (renderer, ball)
}

/// The first picture that the runtime wants, with its views.
fn picture() -> ([View; 2], Vec<RgbaImage>) {
    let mut headset = HeadsetSession::open(HeadsetSettings::default()).expect("a headset");
    let (mut renderer, ball) = renderer_on(headset.gpu());
    let (scene, _) = scene(ball);
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
        let (views, images) = headset
            .show(frame, &mut renderer, &scene, rig(), true)
            .expect("a picture");
        if let ([left, right], Some(images)) = (views.as_slice(), images) {
            return ([*left, *right], images);
        }
    }
}

/// Middle of the pixels in which one channel is strong and the others are weak.
fn middle_of(image: &RgbaImage, channel: usize) -> [f32; 2] {
    let is_it = |pixel: &[u8; 4]| (0..3).all(|at| (pixel[at] > 128) == (at == channel));
    let (mut sum, mut count) = ([0.0, 0.0], 0.0);
    for (x, y, pixel) in image.enumerate_pixels() {
        if is_it(&pixel.0) {
            sum = [sum[0] + x as f32 + 0.5, sum[1] + y as f32 + 0.5];
            count += 1.0;
        }
    }
    assert!(count > 20.0, "the ball is not seen");
    sum.map(|axis| axis / count)
}

#[test]
fn both_eyes_show_what_the_offscreen_renderer_draws() {
    if !is_inside() {
        let Some(runtime) = runtime() else { return };
        let service = Service::start(&runtime, Compositor::Null);
        let name = "eyes::both_eyes_show_what_the_offscreen_renderer_draws";
        run_inside(&service, name, &[]);
        return;
    }
    let (views, images) = picture();
    let [width, height] = [images[0].width(), images[0].height()];
    // The right eye is at the right, in the participant's own axes.
    let apart = rig().1.inverse() * (views[1].position - views[0].position);
    let head = rig().1.inverse() * views[0].rotation;
    let apart = head.inverse() * apart;
    assert!(apart.abs_diff_eq(Vec3::X * EYE_DISTANCE, 1e-4), "{apart}");

    let gpu = Gpu::new(renderer::BackendChoice::Vulkan).expect("the same driver");
    let (mut offscreen, ball) = renderer_on(&gpu);
    let (scene, places) = scene(ball);
    let drawn = offscreen
        .render(&scene, &views, width, height)
        .expect("the same views");
    for (eye, (seen, drawn)) in images.iter().zip(&drawn).enumerate() {
        let off = seen
            .iter()
            .zip(drawn.iter())
            .map(|(a, b)| a.abs_diff(*b))
            .max();
        assert!(off <= Some(2), "eye {eye} differs by {off:?} of 255");
    }
    for (channel, place) in [(0, places[0]), (2, places[1])] {
        let seen = [0, 1].map(|eye| middle_of(&images[eye], channel));
        let expected = views.map(|view| view.pixel_of(place, width, height).expect("in front"));
        let disparity = [seen, expected].map(|[left, right]: [[f32; 2]; 2]| left[0] - right[0]);
        assert!(
            disparity[0] > 1.0,
            "the left eye sees a near thing farther right: {seen:?}"
        );
        let off = disparity[0] - disparity[1];
        assert!(off.abs() < 0.5, "disparity {disparity:?}: {off} pixels off");
        let high = seen[0][1] - seen[1][1];
        assert!(high.abs() < 0.5, "the eyes are level: {high} pixels apart");
    }
}

/// What the layers write, by their environment.
fn watched(log: &Path) -> [(&'static str, &Path); 4] {
    [
        (
            "XR_ENABLE_API_LAYERS",
            Path::new("XR_APILAYER_LUNARG_core_validation"),
        ),
        ("XR_CORE_VALIDATION_EXPORT_TYPE", Path::new("text")),
        ("XR_CORE_VALIDATION_FILE_NAME", log),
        (
            "VK_INSTANCE_LAYERS",
            Path::new("VK_LAYER_KHRONOS_validation"),
        ),
    ]
}

/// What OpenXR's layer found wrong: everything but its own beginning and end.
fn complaints(log: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(log).expect("the layer writes its log");
    assert!(
        text.contains("Core Validation Layer is initialized"),
        "{text}"
    );
    let lines = text.lines().filter(|line| !line.contains("VALID_DEBUG"));
    lines
        .filter(|line| !line.trim().is_empty())
        .map(str::to_owned)
        .collect()
}

/// Playing, walking, holding and letting go under both layers: not a word from either.
#[test]
fn the_validation_layers_find_nothing() {
    let Some(runtime) = runtime() else { return };
    let service = Service::start(&runtime, Compositor::Null);
    let out = tempfile::tempdir().expect("a temporary folder");
    let (folder, log) = (out.path().join("session"), out.path().join("layer.txt"));
    let environment = watched(&log).map(|(name, value)| (name, value.as_os_str()));
    let mut client = start_in(&service, &folder, &environment);
    let mut room = Room::enter(&service, &mut client, &folder);
    room.take_ball(Hand::Right);
    room.walk_to(Hand::Right, 0.2, 1.6);
    room.hand(Hand::Right).trigger = 0.0;
    room.send();
    room.wait_until("the release", |room| room.count("released") == 1);
    let (status, said) = client.finish();
    assert!(status.success(), "{said}");
    assert_eq!(complaints(&log), Vec::<String>::new());
    assert!(!said.contains("VUID"), "Vulkan's layer complains: {said}");
    assert!(
        !said.contains("Validation Error"),
        "Vulkan's layer complains: {said}"
    );
}

/// The layers are really there: each names a mistake that is made on purpose.
#[test]
fn the_validation_layers_catch_a_planted_mistake() {
    if is_inside() {
        plant_in_openxr();
        plant_in_vulkan();
        return;
    }
    let Some(runtime) = runtime() else { return };
    let service = Service::start(&runtime, Compositor::Null);
    let out = tempfile::tempdir().expect("a temporary folder");
    let log = out.path().join("layer.txt");
    let name = "eyes::the_validation_layers_catch_a_planted_mistake";
    let said = run_inside(&service, name, &watched(&log));
    assert!(
        complaints(&log)
            .iter()
            .any(|line| line.contains("VUID-XrSystemGetInfo-formFactor")),
        "{:?}",
        complaints(&log)
    );
    assert!(said.contains("VUID-VkBufferCreateInfo-size"), "{said}");
}

#[expect(unsafe_code, reason = "the loader is a foreign library")]
fn plant_in_openxr() {
    use openxr as xr;
    // SAFETY: the loader of the runner.
    let entry = unsafe { xr::Entry::load(&()) }.expect("a loader");
    let application = xr::ApplicationInfo {
        application_name: "mistaken",
        ..Default::default()
    };
    let instance = entry
        .create_instance(&application, &xr::ExtensionSet::default(), &[], &())
        .expect("an instance");
    // No such form factor.
    let _ = instance.system(xr::FormFactor::from_raw(999));
}

#[expect(unsafe_code, reason = "a wrong call is what the layer must see")]
fn plant_in_vulkan() {
    use ash::vk;
    // SAFETY: the calls but the last are right, and nothing outlives what it came from.
    unsafe {
        let entry = ash::Entry::load().expect("a loader");
        let instance = entry
            .create_instance(&vk::InstanceCreateInfo::default(), None)
            .expect("an instance");
        let physical = instance.enumerate_physical_devices().expect("a device")[0];
        let queue = [vk::DeviceQueueCreateInfo::default().queue_priorities(&[1.0])];
        let create = vk::DeviceCreateInfo::default().queue_create_infos(&queue);
        let device = instance
            .create_device(physical, &create, None)
            .expect("a device");
        // A buffer of no bytes.
        let wrong = vk::BufferCreateInfo::default().usage(vk::BufferUsageFlags::TRANSFER_SRC);
        if let Ok(buffer) = device.create_buffer(&wrong, None) {
            device.destroy_buffer(buffer, None);
        }
        device.destroy_device(None);
        instance.destroy_instance(None);
    }
}
