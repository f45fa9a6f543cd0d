// Several samples to a pixel: the nearest, so that what stands before something keeps its own depth up to its edge.

@group(0) @binding(0) var drawn: texture_depth_multisampled_2d;

fn nearest(pixel: vec2u) -> f32 {
    var depth = 1.0;
    for (var i = 0u; i < textureNumSamples(drawn); i++) {
        depth = min(depth, textureLoad(drawn, pixel, i));
    }
    return depth;
}
