// One colour a face, as the graphics machines of the nineties drew at their fastest: the face's own normal, one light without
// shadow, a sky of two colours; no texture but on pictures (picture.wgsl), no gloss, no smoothing.

struct FlatVarying {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) @interpolate(flat) base_color: vec3f,
    @location(2) @interpolate(flat) emission: f32,
}

@vertex
fn flat_vertex(
    @location(0) position_in_mesh: vec3f,
    instance: InstanceInput,
    @location(9) base_color: vec4f,
    @location(10) surface: vec4f,
) -> FlatVarying {
    var out: FlatVarying;
    out.position = world_position(instance, position_in_mesh);
    out.clip = eye.clip_from_world * vec4f(out.position, 1.0);
    out.base_color = base_color.rgb;
    out.emission = surface.y;
    return out;
}

// What a face of this colour shows at a place in it.
fn flat_color(position: vec3f, base: vec3f, emission: f32) -> vec4f {
    let across = cross(dpdx(position), dpdy(position));
    let to_eye = eye.position.xyz - position;
    // Faces are seen from outside, whichever way the driver counts its rows.
    let facing = select(-1.0, 1.0, dot(across, to_eye) >= 0.0);
    let normal = facing * across * inverseSqrt(max(dot(across, across), 1e-30));
    let sky = mix(lighting.ground.rgb, lighting.sky.rgb, 0.5 + 0.5 * normal.y);
    let from_point = lighting.light_position.xyz - position * lighting.light_position.w;
    let light = lighting.light_color.rgb * max(dot(normal, normalize(from_point)), 0.0);
    return vec4f(tone_map(base * (emission + sky + light)), 1.0);
}

@fragment
fn flat_fragment(in: FlatVarying) -> @location(0) vec4f {
    return flat_color(in.position, in.base_color, in.emission);
}
