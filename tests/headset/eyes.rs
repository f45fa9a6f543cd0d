//! What both eyes show, against the offscreen renderer and against geometry.

use renderer::glam::{Mat4, Vec3};
use renderer::headset::Seen;
use renderer::{FAR_M, Gpu, Instance, Material, MeshId, NEAR_M, RgbaImage, Scene, View};

use crate::inside::{is_inside, picture, renderer_on, rig, run_inside};
use crate::machine::runtime;
use crate::service::{Compositor, Service};

/// Distance between the remote driver's eyes [m].
const EYE_DISTANCE: f32 = 0.063;
/// Radius of the ball [m].
const RADIUS: f32 = 0.08;
/// How far in front of the participant the wall stands [m].
const WALL_M: f32 = 6.0;
/// Share of a side that Monado cuts off each corner: its mask for headsets that have none of their own, u_visibility_mask.c.
const CORNER: f32 = 0.125;

/// Middles of two balls before the participant, one near and one far, world frame.
fn places() -> [Vec3; 2] {
    let rig = rig();
    [Vec3::new(-0.25, 1.55, -1.2), Vec3::new(0.5, 1.7, -3.0)].map(|place| rig.0 + rig.1 * place)
}

/// The balls, which shine by themselves.
fn balls(ball: MeshId) -> Scene {
    let mut scene = Scene::default();
    for (place, color) in places().into_iter().zip([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]) {
        scene.instances.push(Instance {
            mesh: ball,
            material: Material::unlit(color),
            world_from_mesh: Mat4::from_translation(place),
        });
    }
    scene
}

/// The same before a green wall that fills the picture.
fn balls_before_a_wall([ball, wall]: [MeshId; 2]) -> Scene {
    let mut scene = balls(ball);
    let (position, rotation) = rig();
    let place = position + rotation * Vec3::new(0.0, 1.6, -WALL_M);
    scene.instances.push(Instance {
        mesh: wall,
        material: Material::unlit([0.0, 1.0, 0.0]),
        world_from_mesh: Mat4::from_rotation_translation(rotation, place),
    });
    scene
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
        run_inside(
            &service,
            "eyes::both_eyes_show_what_the_offscreen_renderer_draws",
        );
        return;
    }
    let (views, seen) = picture(|[ball, _]| balls(ball));
    let images: Vec<_> = seen.into_iter().map(|eye| eye.picture).collect();
    let [width, height] = [images[0].width(), images[0].height()];
    // The right eye is at the right, in the participant's own axes.
    let apart = rig().1.inverse() * (views[1].position - views[0].position);
    let head = rig().1.inverse() * views[0].rotation;
    let apart = head.inverse() * apart;
    assert!(apart.abs_diff_eq(Vec3::X * EYE_DISTANCE, 1e-4), "{apart}");

    let gpu = Gpu::new(renderer::BackendChoice::Vulkan).expect("the same driver");
    let (mut offscreen, [ball, _]) = renderer_on(&gpu);
    let drawn = offscreen
        .render(&balls(ball), &views, width, height)
        .expect("the same views");
    for (eye, (seen, drawn)) in images.iter().zip(&drawn).enumerate() {
        let off = seen
            .iter()
            .zip(drawn.iter())
            .map(|(a, b)| a.abs_diff(*b))
            .max();
        assert!(off <= Some(2), "eye {eye} differs by {off:?} of 255");
    }
    for (channel, place) in [(0, places()[0]), (2, places()[1])] {
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

/// How far a pixel lies from the nearest corner of its picture, both axes as shares of their sides added up.
fn from_corner(x: u32, y: u32, image: &RgbaImage) -> f32 {
    let from_edge = |at: u32, side: u32| {
        let share = (at as f32 + 0.5) / side as f32;
        share.min(1.0 - share)
    };
    from_edge(x, image.width()) + from_edge(y, image.height())
}

/// What the lenses do not show is left as it was before anything was drawn; everything else is drawn.
#[test]
fn what_the_lenses_hide_is_not_shaded() {
    if !is_inside() {
        let Some(runtime) = runtime() else { return };
        let service = Service::start(&runtime, Compositor::Null);
        run_inside(&service, "eyes::what_the_lenses_hide_is_not_shaded");
        return;
    }
    let (_, seen) = picture(balls_before_a_wall);
    for (eye, Seen { picture, .. }) in seen.iter().enumerate() {
        // One pixel is cut by the edge.
        let margin = 2.0 / picture.width().min(picture.height()) as f32;
        let (mut hidden, mut drawn) = (0, 0);
        for (x, y, pixel) in picture.enumerate_pixels() {
            let from_corner = from_corner(x, y, picture);
            let is_scene = pixel.0[..3].iter().any(|channel| *channel > 128);
            if from_corner < CORNER - margin {
                hidden += 1;
                assert!(!is_scene, "eye {eye} shades ({x}, {y}): {pixel:?}");
            } else if from_corner > CORNER + margin {
                drawn += 1;
                assert!(is_scene, "eye {eye} lacks ({x}, {y}): {pixel:?}");
            }
        }
        assert!(hidden > 100 && drawn > 20 * hidden, "{hidden}, {drawn}");
    }
}

/// Places in a pixel, and a little beyond its edges: a mesh's edge is not quite the ball's.
const WITHIN: [f32; 7] = [-0.1, 0.1, 0.3, 0.5, 0.7, 0.9, 1.1];

/// Least and largest depth that a pixel may have: of the rays through it, by the ball and the wall that they meet first.
fn depths(view: &View, pixel: [u32; 2], size: [u32; 2], places: &[Vec3; 2]) -> [f32; 2] {
    let tangents = [
        [view.fov.left.tan(), view.fov.right.tan()],
        [view.fov.up.tan(), view.fov.down.tan()],
    ];
    let along = |axis: usize, within: f32| {
        let [from, to] = tangents[axis];
        from + (to - from) * (pixel[axis] as f32 + within) / size[axis] as f32
    };
    let mut range = [f32::INFINITY, f32::NEG_INFINITY];
    for across in WITHIN {
        for down in WITHIN {
            let ray = view.rotation * Vec3::new(along(0, across), along(1, down), -1.0);
            let depth = depth_along(view, ray, places);
            range = [range[0].min(depth), range[1].max(depth)];
        }
    }
    range
}

/// Depth of what a ray meets first. The ray advances one metre before the eye for each of its own lengths.
fn depth_along(view: &View, ray: Vec3, places: &[Vec3; 2]) -> f32 {
    let (position, rotation) = rig();
    let normal = rotation * Vec3::Z;
    let wall = position - normal * WALL_M - view.position;
    let mut nearest = wall.dot(normal) / ray.dot(normal);
    for place in places {
        let to = *place - view.position;
        let (a, b) = (ray.length_squared(), ray.dot(to));
        let inside = b * b - a * (to.length_squared() - RADIUS * RADIUS);
        if inside >= 0.0 {
            nearest = nearest.min((b - inside.sqrt()) / a);
        }
    }
    // 0 at the near plane and 1 at the far one, as what the runtime is told says.
    FAR_M * (nearest - NEAR_M) / (nearest * (FAR_M - NEAR_M))
}

/// What the runtime gets of the depth is where the things are, by rays that know nothing of meshes and matrices.
#[test]
fn the_depth_that_is_handed_over_is_the_scenes() {
    if !is_inside() {
        let Some(runtime) = runtime() else { return };
        let service = Service::start(&runtime, Compositor::Null);
        run_inside(
            &service,
            "eyes::the_depth_that_is_handed_over_is_the_scenes",
        );
        return;
    }
    let (views, seen) = picture(balls_before_a_wall);
    let places = places();
    // Of a mesh of 48 sides the ball is at most 0.2 mm too deep, which is a little at 1.2 m.
    let tolerance = 2e-5;
    for (view, seen) in views.iter().zip(&seen) {
        let size = [seen.picture.width(), seen.picture.height()];
        let depth = seen.depth.as_ref().expect("this runtime takes depth");
        assert_eq!(depth.len(), (size[0] * size[1]) as usize);
        let mut on_balls = 0;
        for (x, y, _) in seen.picture.enumerate_pixels() {
            if from_corner(x, y, &seen.picture) < CORNER + 0.01 {
                continue;
            }
            let told = depth[(y * size[0] + x) as usize];
            let [least, largest] = depths(view, [x, y], size, &places);
            assert!(
                (least - tolerance..=largest + tolerance).contains(&told),
                "({x}, {y}): {told} is not from {least} to {largest}"
            );
            // The wall's is 0.992.
            on_balls += u32::from(told < 0.985);
        }
        assert!(on_balls > 100, "the balls have no depth: {on_balls}");
    }
}
