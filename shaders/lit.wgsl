// Lit surfaces with their patterns, one pass per eye.

// False draws highlights as narrow as the material says, however fast the normal turns within a pixel.
override WIDEN_HIGHLIGHTS: bool = true;

// Square of alpha, widened by the normal's variance over the pixel: where a pin turns away within a pixel, its highlight would
// come and go with every movement of the head (Tokuyoshi and Kaplanyan 2019, "Improved geometric specular antialiasing":
// a Gaussian of half a pixel's standard deviation, the widening limited to 0.18).
fn widened(alpha: f32, normal: vec3f) -> f32 {
    if !WIDEN_HIGHLIGHTS || !GLOSS {
        return alpha;
    }
    let dx = dpdx(normal);
    let dy = dpdy(normal);
    let variance = 0.25 * (dot(dx, dx) + dot(dy, dy));
    return sqrt(alpha * alpha + min(2.0 * variance, 0.18));
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4f {
    let texel = pattern(in.uv);
    var s: Surface;
    s.position = in.position;
    s.normal = normalize(in.normal);
    s.to_eye = normalize(eye.position.xyz - in.position);
    s.base = in.base_color.rgb * texel;
    s.f0 = in.surface.x;
    let roughness = in.base_color.w;
    s.alpha = widened(roughness * roughness, s.normal);
    s.mirror = mirror_share(in.mirror);
    let seen = mirror_image(s, in.clip.xy);
    let open = openness(s);
    let color = s.base * in.surface.y + ambient(s, roughness, open, seen) + direct(s);
    return vec4f(tone_map(color), 1.0);
}
