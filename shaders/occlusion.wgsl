// How much of the sky a point sees past spheres near it and the corners of the room.
//
// A sphere of radius r at distance d, seen in direction c from a surface with normal n, takes (n . c) (r / d)^2 of a sky of one
// colour: the configuration factor of a sphere wholly above the surface (Howell, catalogue of configuration factors, B-39).
// In the frame of the world, not of the screen: both eyes see the same, and nothing changes at the picture's edge.

// Deepest shade of one sphere: where the surface cuts it, the formula would go on beyond what there is.
const DEEPEST: f32 = 0.8;

fn openness(s: Surface) -> f32 {
    var open = 1.0;
    for (var group = 0u; group < lighting.occluder_groups; group++) {
        let bounds = lighting.groups[group];
        let off = bounds.xyz - s.position;
        // A loop of no turns, not a branch: drivers on the processor leave out the one and carry out the other.
        let count = select(0u, GROUP_SIZE, dot(off, off) < bounds.w * bounds.w);
        for (var i = 0u; i < count; i++) {
            let sphere = lighting.occluders[group * GROUP_SIZE + i];
            let offset = sphere.xyz - s.position;
            let distance_2 = dot(offset, offset);
            let radius_2 = sphere.w * sphere.w;
            // Nearer than its radius: the sphere's own skin, or what it stands for.
            let outside = step(1.03 * radius_2, distance_2);
            let cosine = max(dot(s.normal, offset) * inverseSqrt(distance_2), 0.0);
            open *= 1.0 - outside * min(cosine * radius_2 / distance_2, DEEPEST);
        }
    }
    return open * corner_openness(s);
}

// Near the edge of two half planes half of the sky is hidden by the other one; walls are bright themselves and send half
// of that back. It fades over the reach in `room_min.w`; a room of no size has no corners.
fn corner_openness(s: Surface) -> f32 {
    let reach = max(lighting.room_min.w, 1e-3);
    let low = saturate(1.0 - (s.position - lighting.room_min.xyz) / reach);
    let high = saturate(1.0 - (lighting.room_max.xyz - s.position) / reach);
    // A wall does not hide the sky from what faces away from it, nor from itself.
    let facing = 1.0 - abs(s.normal);
    let near = 1.0 - 0.35 * facing * (low * low + high * high);
    return select(1.0, near.x * near.y * near.z, lighting.room_min.w > 0.0);
}
