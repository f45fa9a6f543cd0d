// Stands in for mirror_seen.wgsl when there is no mirror: gloss shows lamps and sky.

fn mirror_share(share: f32) -> f32 {
    return 0.0;
}

fn mirror_image(s: Surface, pixel: vec2f) -> vec4f {
    return vec4f(0.0);
}
