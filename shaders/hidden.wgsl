// What no eye sees of a picture: depth at the near plane, which hides everything that is drawn later, and no colour.

@vertex
fn vertex(@location(0) corner: vec2f) -> @builtin(position) vec4f {
    return vec4f(corner, 0.0, 1.0);
}

@fragment
fn fragment() -> @location(0) vec4f {
    return vec4f(0.0, 0.0, 0.0, 1.0);
}
