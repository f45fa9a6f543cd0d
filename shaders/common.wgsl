// Shared by every pass that draws the scene. Names are `target_from_source`, as in the Rust code.
// World frame: right-handed, +Y up, metres. Colours are linear; the target's format encodes sRGB.

// What one pass looks through: an eye, or the shadowing light.
struct Eye {
    clip_from_world: mat4x4f,
    // xyz: position of the eye [m]; w is unused.
    position: vec4f,
    // xy: one over the size of the picture [pixels]; z: pixels of the mirror's image per radian; w is unused.
    mirror: vec4f,
}

// The instance's transform arrives as the three rows of an affine matrix.
struct InstanceInput {
    @location(3) world_from_mesh_x: vec4f,
    @location(4) world_from_mesh_y: vec4f,
    @location(5) world_from_mesh_z: vec4f,
}

fn world_position(instance: InstanceInput, position_in_mesh: vec3f) -> vec3f {
    let p = vec4f(position_in_mesh, 1.0);
    return vec3f(
        dot(instance.world_from_mesh_x, p),
        dot(instance.world_from_mesh_y, p),
        dot(instance.world_from_mesh_z, p),
    );
}

@group(0) @binding(0) var<uniform> eye: Eye;
