// Stands in for occlusion.wgsl when nothing hides the sky.

fn openness(s: Surface) -> f32 {
    return 1.0;
}
