// Depth of the scene as the shadowing light sees it. There is no fragment stage: only depth is kept.

@vertex
fn vertex(@location(0) position_in_mesh: vec3f, instance: InstanceInput) -> @builtin(position) vec4f {
    return eye.clip_from_world * vec4f(world_position(instance, position_in_mesh), 1.0);
}
