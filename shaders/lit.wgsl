// Surfaces under one shadowing light, a few lamps and a two-colour sky.
//
// Diffuse: Lambert. Specular: Trowbridge-Reitz (GGX) distribution with Smith visibility in the form of
// Hammon (2017) and Schlick's Fresnel (1994). A light's colour is the value that a white matte surface facing it
// shows, so the factor 1/pi is inside the colour and the specular term carries pi.

const PI: f32 = 3.14159265;
const MAX_LAMPS: u32 = 8u;

struct Lamp {
    position: vec3f,
    // Distance at which it has faded to nothing [m].
    range_m: f32,
    // Value of a white matte surface facing the lamp at 1 m.
    color: vec3f,
    padding: f32,
}

struct Lighting {
    light_clip_from_world: mat4x4f,
    // Parallel light: unit direction towards it, w = 0. Spot light: its position [m], w = 1.
    light_position: vec4f,
    // Spot light: unit direction of its axis; w = cosine of the outer half angle.
    light_axis: vec4f,
    // rgb; w = cosine of the inner half angle.
    light_color: vec4f,
    // Light from straight above and from straight below.
    sky: vec4f,
    ground: vec4f,
    // Step between two taps of the shadow filter, in texture coordinates.
    shadow_step_uv: vec2f,
    // Half the width of the whole shadow filter [m], at 1 m for a spot light.
    shadow_reach_m: f32,
    lamp_count: u32,
    lamps: array<Lamp, MAX_LAMPS>,
}

@group(0) @binding(1) var<uniform> lighting: Lighting;
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
}

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
    @location(3) @interpolate(flat) base_color: vec4f,
    @location(4) @interpolate(flat) surface: vec4f,
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
    return out;
}

struct Surface {
    normal: vec3f,
    to_eye: vec3f,
    base: vec3f,
    // Square of the roughness that the material states (Burley 2012).
    alpha: f32,
    f0: f32,
}

fn schlick(f0: f32, cosine: f32) -> f32 {
    // Materials below 2 % reflect nothing at grazing angles either: f0 = 0 is a purely matte surface.
    let f90 = saturate(50.0 * f0);
    let x = 1.0 - cosine;
    let x2 = x * x;
    return f0 + (f90 - f0) * x2 * x2 * x;
}

// Light of `color` that a surface sends to the eye when it arrives from `to_light`.
fn reflected(s: Surface, to_light: vec3f, color: vec3f) -> vec3f {
    let n_l = dot(s.normal, to_light);
    if n_l <= 0.0 {
        return vec3f(0.0);
    }
    let half_way = normalize(to_light + s.to_eye);
    let n_v = max(dot(s.normal, s.to_eye), 1e-3);
    let n_h = saturate(dot(s.normal, half_way));
    let fresnel = schlick(s.f0, saturate(dot(to_light, half_way)));
    let a2 = s.alpha * s.alpha;
    let d = n_h * n_h * (a2 - 1.0) + 1.0;
    let distribution = a2 / (PI * d * d);
    let visibility = 0.5 / mix(2.0 * n_l * n_v, n_l + n_v, s.alpha);
    let specular = PI * distribution * visibility * fresnel;
    return (s.base * (1.0 - fresnel) + specular) * color * n_l;
}

fn sky_color(direction_y: f32) -> vec3f {
    return mix(lighting.ground.rgb, lighting.sky.rgb, 0.5 + 0.5 * direction_y);
}

// Light from all round. The specular part is Karis' fit of the environment integral (2014), with the sky
// looked up along the mirror direction, flattened towards the normal where the surface is rough.
fn ambient(s: Surface, roughness: f32) -> vec3f {
    let n_v = saturate(dot(s.normal, s.to_eye));
    let r = roughness * vec4f(-1.0, -0.0275, -0.572, 0.022) + vec4f(1.0, 0.0425, 1.04, -0.04);
    let a = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
    let scale_bias = vec2f(-1.04, 1.04) * a + r.zw;
    let specular = max(s.f0 * scale_bias.x + saturate(50.0 * s.f0) * scale_bias.y, 0.0);
    let mirror = reflect(-s.to_eye, s.normal);
    let along = mix(mirror.y, s.normal.y, roughness);
    return s.base * (1.0 - specular) * sky_color(s.normal.y) + specular * sky_color(along);
}

fn shadowing_light(s: Surface, position: vec3f) -> vec3f {
    let from_point = lighting.light_position.xyz - position * lighting.light_position.w;
    let to_light = normalize(from_point);
    var color = lighting.light_color.rgb;
    if lighting.light_position.w > 0.0 {
        let cosine = dot(-to_light, lighting.light_axis.xyz);
        color *= smoothstep(lighting.light_axis.w, lighting.light_color.w, cosine) / dot(from_point, from_point);
    }
    if dot(s.normal, to_light) <= 0.0 || max(color.r, max(color.g, color.b)) <= 0.0 {
        return vec3f(0.0);
    }
    return reflected(s, to_light, color * light_visibility(position, s.normal, to_light));
}

fn lamp_light(s: Surface, position: vec3f, lamp: Lamp) -> vec3f {
    let offset = lamp.position - position;
    let distance_2 = dot(offset, offset);
    let ratio_2 = distance_2 / (lamp.range_m * lamp.range_m);
    if ratio_2 >= 1.0 {
        return vec3f(0.0);
    }
    // Inverse square, windowed so that it ends at the range without an edge (Karis 2013).
    let window = (1.0 - ratio_2 * ratio_2) * (1.0 - ratio_2 * ratio_2);
    // A lamp is a hand wide: nearer than that the inverse square would only burn out.
    let color = lamp.color * window / max(distance_2, 0.01);
    return reflected(s, offset * inverseSqrt(max(distance_2, 1e-6)), color);
}

// Straight up to the knee, then an exponential shoulder with the same slope that never passes 1.
// Mirrored by `passes::lit::tone_map`, which the background colour goes through.
fn tone_map(color: vec3f) -> vec3f {
    let knee = 0.6;
    let over = max(color - knee, vec3f(0.0)) / (1.0 - knee);
    return min(color, vec3f(knee)) + (1.0 - knee) * (1.0 - exp(-over));
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4f {
    let texel = textureSample(base_texture, base_sampler, in.uv).rgb;
    var s: Surface;
    s.normal = normalize(in.normal);
    s.to_eye = normalize(eye.position.xyz - in.position);
    s.base = in.base_color.rgb * texel;
    s.f0 = in.surface.x;
    let roughness = in.base_color.w;
    s.alpha = roughness * roughness;
    var color = s.base * in.surface.y + ambient(s, roughness) + shadowing_light(s, in.position);
    for (var i = 0u; i < lighting.lamp_count; i++) {
        color += lamp_light(s, in.position, lighting.lamps[i]);
    }
    return vec4f(tone_map(color), 1.0);
}
