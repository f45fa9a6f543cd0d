// An eye's depth in an image with one sample to a pixel, for a compositor that wants to know how far things are.

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    // One triangle that covers the picture.
    let corner = vec2f(vec2u(index & 1u, index >> 1u)) * 4.0 - 1.0;
    return vec4f(corner, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) at: vec4f) -> @builtin(frag_depth) f32 {
    return nearest(vec2u(at.xy));
}
