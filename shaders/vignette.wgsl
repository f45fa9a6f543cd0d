// Darkens the edge of a finished picture, while somebody walks who does not move. Stands alone.

struct Vignette {
    // Tangents of the view's edges: left, right, down, up.
    tangents: vec4f,
    // Angle from straight ahead up to which nothing is darkened, and the one from which all is [rad].
    clear: f32,
    dark: f32,
    // 0 to 1.
    strength: f32,
    padding: f32,
}

@group(0) @binding(0) var<uniform> vignette: Vignette;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) tangent: vec2f,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Varying {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    var out: Varying;
    out.clip = vec4f(2.0 * corner - 1.0, 0.0, 1.0);
    out.tangent = mix(vignette.tangents.xz, vignette.tangents.yw, corner);
    return out;
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4f {
    let angle = atan(length(in.tangent));
    let share = smoothstep(vignette.clear, vignette.dark, angle);
    return vec4f(0.0, 0.0, 0.0, share * vignette.strength);
}
