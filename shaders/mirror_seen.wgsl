// The image in the glossy floor. It is sharp where things stand on the floor and blurs with their height: a lobe of width
// alpha seen over the distance behind the mirror. Each smaller copy of the image is blurred twice as far.

@group(0) @binding(4) var mirror_map: texture_2d<f32>;
@group(0) @binding(5) var mirror_sampler: sampler;

// `HIGHEST_M` of mirror.wgsl.
const MIRROR_HIGHEST_M: f32 = 4.0;

override MIRROR: bool = true;

fn mirror_share(share: f32) -> f32 {
    return select(0.0, share, MIRROR);
}

fn mirror_image(s: Surface, pixel: vec2f) -> vec4f {
    if !MIRROR {
        return vec4f(0.0);
    }
    let uv = pixel * eye.mirror.xy;
    // How high is what is seen there: a blurred look first, so that the blur has no edge where heights jump.
    let height = MIRROR_HIGHEST_M * textureSampleLevel(mirror_map, mirror_sampler, uv, 2.0).a;
    let behind = height / max(s.to_eye.y, 0.02);
    let before = distance(eye.position.xyz, s.position);
    let radius_px = s.alpha * eye.mirror.z * behind / (behind + before);
    let level = max(log2(max(radius_px, 1.0)), 0.6);
    return vec4f(textureSampleLevel(mirror_map, mirror_sampler, uv, level).rgb, s.mirror);
}
