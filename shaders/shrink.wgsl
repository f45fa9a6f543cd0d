// Half the size of an image: four bilinear looks half a pixel apart, a tent of 4 x 4 texels in all (the downward half of the dual
// filter of Martin and others, SIGGRAPH 2015), so that a point that moves through the grid fades and does not jump.

@group(0) @binding(0) var larger: texture_2d<f32>;
@group(0) @binding(1) var larger_sampler: sampler;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    // One triangle that covers the target.
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let texel = 1.0 / vec2f(textureDimensions(larger));
    let uv = 2.0 * pixel.xy * texel;
    var sum = vec4f(0.0);
    for (var i = 0u; i < 4u; i++) {
        let corner = vec2f(f32(i & 1u), f32(i >> 1u)) * 2.0 - 1.0;
        sum += textureSampleLevel(larger, larger_sampler, uv + corner * texel, 0.0);
    }
    return 0.25 * sum;
}
