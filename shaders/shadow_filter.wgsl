// How much of the shadowing light reaches a point: a 3 x 3 grid of bilinear depth comparisons.
// The grid is fixed, not jittered per pixel, so that both eyes see the same penumbra.

@group(0) @binding(2) var shadow_map: texture_depth_2d;
@group(0) @binding(3) var shadow_sampler: sampler_comparison;

const SHADOW_TAPS: i32 = 3;

fn light_visibility(position: vec3f, normal: vec3f, to_light: vec3f) -> f32 {
    // A spot light's filter widens with distance, which is what clip w holds; for a parallel light it is 1.
    let reach = lighting.shadow_reach_m * (lighting.light_clip_from_world * vec4f(position, 1.0)).w;
    // A sloping surface rises above its own shadow map by up to the filter's reach times the slope; moving along
    // the normal by reach times the sine clears just that, and nothing where the surface faces the light, so that
    // shadows stay attached at the contact. The tenth covers rounding.
    let cosine = clamp(dot(normal, to_light), 0.0, 1.0);
    let moved = position + reach * (normal * sqrt(1.0 - cosine * cosine) + 0.1 * to_light);
    let clip = lighting.light_clip_from_world * vec4f(moved, 1.0);
    let ndc = clip.xyz / clip.w;
    let uv = vec2f(0.5, -0.5) * ndc.xy + 0.5;
    if clip.w <= 0.0 || any(uv < vec2f(0.0)) || any(uv > vec2f(1.0)) || ndc.z > 1.0 || ndc.z < 0.0 {
        return 1.0;
    }
    var sum = 0.0;
    for (var row = 0; row < SHADOW_TAPS; row++) {
        for (var column = 0; column < SHADOW_TAPS; column++) {
            let step = vec2f(f32(column), f32(row)) - 0.5 * f32(SHADOW_TAPS - 1);
            sum += textureSampleCompareLevel(shadow_map, shadow_sampler, uv + step * lighting.shadow_step_uv, ndc.z);
        }
    }
    return sum / f32(SHADOW_TAPS * SHADOW_TAPS);
}
