// Draws one image into one rectangle of the window: a rendered view, or text over it.
// Stands alone: it shares nothing with the scene's passes.

struct Picture {
    // Corners in clip space: left, bottom, right, top.
    rectangle: vec4f,
    // 1: the target does not encode sRGB by itself, so this pass does.
    encode: u32,
}

@group(0) @binding(0) var<uniform> picture: Picture;
@group(0) @binding(1) var image: texture_2d<f32>;
@group(0) @binding(2) var image_sampler: sampler;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Varying {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    var out: Varying;
    out.clip = vec4f(mix(picture.rectangle.xy, picture.rectangle.zw, corner), 0.0, 1.0);
    out.uv = vec2f(corner.x, 1.0 - corner.y);
    return out;
}

// IEC 61966-2-1.
fn srgb_from_linear(color: vec3f) -> vec3f {
    let low = 12.92 * color;
    let high = 1.055 * pow(color, vec3f(1.0 / 2.4)) - 0.055;
    return select(high, low, color <= vec3f(0.0031308));
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4f {
    let texel = textureSample(image, image_sampler, in.uv);
    if picture.encode == 1u {
        return vec4f(srgb_from_linear(texel.rgb), texel.a);
    }
    return texel;
}
