// What the glossy floor at y = 0 mirrors: the scene seen from below it, as an eye would that is mirrored by it.
// Alpha keeps the height above the floor, which tells how blurred the image is there.

// Largest height that alpha tells apart [m].
const HIGHEST_M: f32 = 4.0;

@fragment
fn mirror_fragment(in: Varying) -> @location(0) vec4f {
    let texel = textureSample(base_texture, base_sampler, in.uv).rgb;
    if in.position.y < 0.0 {
        discard;
    }
    var s: Surface;
    s.position = in.position;
    s.normal = normalize(in.normal);
    s.to_eye = normalize(eye.position.xyz - in.position);
    s.base = in.base_color.rgb * texel;
    s.f0 = 0.0;
    s.alpha = 1.0;
    s.mirror = 0.0;
    let color = s.base * in.surface.y + ambient(s, 1.0, 1.0, vec4f(0.0)) + direct(s);
    return vec4f(min(color, vec3f(8.0)), saturate(in.position.y / HIGHEST_M));
}
