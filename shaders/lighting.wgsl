// Light on a surface: one shadowing light, a few lamps and a two-colour sky. Shared by the eyes' pass and the mirror's.
//
// Diffuse: Lambert. Specular: Trowbridge-Reitz (GGX) distribution with Smith visibility in the form of
// Hammon (2017) and Schlick's Fresnel (1994). A light's colour is the value that a white matte surface facing it
// shows, so the factor 1/pi is inside the colour and the specular term carries pi.

// What a pipeline is made for; the software drivers of Mesa carry out both sides of a branch, so what a surface has not must not
// be in its pipeline.
override GLOSS: bool = true;
override SHADOWED: bool = true;

const PI: f32 = 3.14159265;
const MAX_LAMPS: u32 = 8u;
const OCCLUDER_GROUPS: u32 = 6u;
const GROUP_SIZE: u32 = 8u;

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
    // The inside of the room whose corners are dim, and w of the first: how far that reaches [m].
    room_min: vec4f,
    room_max: vec4f,
    // Step between two taps of the shadow filter, in texture coordinates.
    shadow_step_uv: vec2f,
    // Half the width of the whole shadow filter [m], at 1 m for a spot light.
    shadow_reach_m: f32,
    lamp_count: u32,
    occluder_groups: u32,
    padding_a: u32,
    padding_b: u32,
    padding_c: u32,
    lamps: array<Lamp, MAX_LAMPS>,
    // Middle of a group and how far it reaches [m].
    groups: array<vec4f, OCCLUDER_GROUPS>,
    // Middle and radius [m]; a group's places that are left over have no radius.
    occluders: array<vec4f, 48>,
}

@group(0) @binding(1) var<uniform> lighting: Lighting;

struct Surface {
    position: vec3f,
    normal: vec3f,
    to_eye: vec3f,
    base: vec3f,
    // Square of the roughness that the material states (Burley 2012).
    alpha: f32,
    f0: f32,
    // Share of its gloss that shows the mirror's image of lamps and things instead of the lamps' own highlights.
    mirror: f32,
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
    if !GLOSS {
        return s.base * color * n_l;
    }
    let half_way = normalize(to_light + s.to_eye);
    let n_v = max(dot(s.normal, s.to_eye), 1e-3);
    let n_h = saturate(dot(s.normal, half_way));
    let fresnel = schlick(s.f0, saturate(dot(to_light, half_way)));
    let a2 = s.alpha * s.alpha;
    let d = n_h * n_h * (a2 - 1.0) + 1.0;
    let distribution = a2 / (PI * d * d);
    let visibility = 0.5 / mix(2.0 * n_l * n_v, n_l + n_v, s.alpha);
    let specular = PI * distribution * visibility * fresnel * (1.0 - s.mirror);
    return (s.base * (1.0 - fresnel) + specular) * color * n_l;
}

fn sky_color(direction_y: f32) -> vec3f {
    return mix(lighting.ground.rgb, lighting.sky.rgb, 0.5 + 0.5 * direction_y);
}

// Light from all round, of which `open` (0 to 1) arrives. The specular part is Karis' fit of the environment integral
// (2014), with the sky looked up along the mirror direction, flattened towards the normal where the surface is rough;
// `seen` (rgb and weight) takes the sky's place where a mirror knows better.
fn ambient(s: Surface, roughness: f32, open: f32, seen: vec4f) -> vec3f {
    if !GLOSS {
        return open * s.base * sky_color(s.normal.y);
    }
    let n_v = saturate(dot(s.normal, s.to_eye));
    let r = roughness * vec4f(-1.0, -0.0275, -0.572, 0.022) + vec4f(1.0, 0.0425, 1.04, -0.04);
    let a = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
    let scale_bias = vec2f(-1.04, 1.04) * a + r.zw;
    let specular = max(s.f0 * scale_bias.x + saturate(50.0 * s.f0) * scale_bias.y, 0.0);
    let mirror = reflect(-s.to_eye, s.normal);
    let along = mix(mirror.y, s.normal.y, roughness);
    let around = mix(open * sky_color(along), seen.rgb, seen.a);
    return open * s.base * (1.0 - specular) * sky_color(s.normal.y) + specular * around;
}

fn shadowing_light(s: Surface) -> vec3f {
    let position = s.position;
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
    if SHADOWED {
        color *= light_visibility(position, s.normal, to_light);
    }
    return reflected(s, to_light, color);
}

fn lamp_light(s: Surface, lamp: Lamp) -> vec3f {
    let offset = lamp.position - s.position;
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

// Everything that reaches the surface from lights that have a place.
fn direct(s: Surface) -> vec3f {
    var color = shadowing_light(s);
    for (var i = 0u; i < lighting.lamp_count; i++) {
        color += lamp_light(s, lighting.lamps[i]);
    }
    return color;
}

// Straight up to the knee, then an exponential shoulder with the same slope that never passes 1.
// Mirrored by `passes::lit::tone_map`, which the background colour goes through.
fn tone_map(color: vec3f) -> vec3f {
    let knee = 0.6;
    let over = max(color - knee, vec3f(0.0)) / (1.0 - knee);
    return min(color, vec3f(knee)) + (1.0 - knee) * (1.0 - exp(-over));
}
