// Stands in for shadow_filter.wgsl when shadows are off: the light reaches everything.

fn light_visibility(position: vec3f, normal: vec3f, to_light: vec3f) -> f32 {
    return 1.0;
}
