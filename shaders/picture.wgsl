// A picture where faces have one colour, a sign or a scoreboard: it multiplies the colour of its face.

@fragment
fn picture_fragment(in: Varying) -> @location(0) vec4f {
    let texel = textureSample(base_texture, base_sampler, in.uv).rgb;
    return flat_color(in.position, in.base_color.rgb * texel, in.surface.y);
}
