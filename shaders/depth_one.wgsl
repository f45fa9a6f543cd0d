// One sample to a pixel.

@group(0) @binding(0) var drawn: texture_depth_2d;

fn nearest(pixel: vec2u) -> f32 {
    return textureLoad(drawn, pixel, 0);
}
