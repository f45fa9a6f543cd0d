// A vertex with the look of its instance. Shared by every pass that colours the scene.

@group(1) @binding(0) var base_texture: texture_2d<f32>;
@group(1) @binding(1) var base_sampler: sampler;

struct LookInput {
    @location(6) normal_from_mesh_x: vec3f,
    @location(7) normal_from_mesh_y: vec3f,
    @location(8) normal_from_mesh_z: vec3f,
    // rgb: base colour; w: roughness.
    @location(9) base_color: vec4f,
    // x: reflectance at normal incidence; y: emission; zw: texture repeats.
    @location(10) surface: vec4f,
    // Share of the mirror's image in its gloss.
    @location(11) mirror: f32,
}

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
    @location(3) @interpolate(flat) base_color: vec4f,
    @location(4) @interpolate(flat) surface: vec4f,
    @location(5) @interpolate(flat) mirror: f32,
}

@vertex
fn vertex(
    @location(0) position_in_mesh: vec3f,
    @location(1) normal_in_mesh: vec3f,
    @location(2) uv: vec2f,
    instance: InstanceInput,
    look: LookInput,
) -> Varying {
    var out: Varying;
    out.position = world_position(instance, position_in_mesh);
    out.clip = eye.clip_from_world * vec4f(out.position, 1.0);
    out.normal = vec3f(
        dot(look.normal_from_mesh_x, normal_in_mesh),
        dot(look.normal_from_mesh_y, normal_in_mesh),
        dot(look.normal_from_mesh_z, normal_in_mesh),
    );
    out.uv = uv * look.surface.zw;
    out.base_color = look.base_color;
    out.surface = look.surface;
    out.mirror = look.mirror;
    return out;
}
