// Patterns that are computed where they are seen: planks, carpet, panels.
//
// Each is averaged over the pixel's footprint in closed form, across and along separately (the box filter of
// Heckbert 1989 for what has one): what a mipmap blurs both ways at a grazing angle, a lane seen from the foul line, stays
// sharp across and does not sparkle along, on drivers without anisotropic filtering too.

override PATTERN: u32 = 0u;

const PLANKS: u32 = 1u;
const CARPET: u32 = 2u;
const PANELS: u32 = 3u;

// Length of a plank [m], the unit of v.
const PLANK_LENGTH: f32 = 2.7;
// Half the width of the joint between two planks, in widths of a plank.
const JOINT: f32 = 0.022;

// Integer hash of two cells to 0..1: multiply and fold, as in PCG (O'Neill 2014, RXS-M).
fn cell_hash(x: i32, y: i32) -> f32 {
    var h = u32(x) * 747796405u + u32(y) * 2891336453u + 1013904223u;
    h = ((h >> ((h >> 28u) + 4u)) ^ h) * 277803737u;
    h = (h >> 22u) ^ h;
    return f32(h & 0xffffffu) / 16777216.0;
}

// Share of a footprint `width` wide, `distance` from the middle of a line, that the line of `half` its width covers.
fn line_cover(distance: f32, half: f32, width: f32) -> f32 {
    let low = max(distance - 0.5 * width, -half);
    let high = min(distance + 0.5 * width, half);
    return saturate((high - low) / width);
}

// Distance to the nearest whole number.
fn to_whole(x: f32) -> f32 {
    return abs(x - round(x));
}

// How dark plank number `board` is at `v` along it, 0..1.
fn plank_tone(board: f32, v: f32) -> f32 {
    let number = i32(board);
    let piece = floor(v / PLANK_LENGTH + cell_hash(number, -7));
    return cell_hash(number, i32(piece));
}

// Planks along v [m], u counts them; the texture holds grain, stretched along them as grain is, which makes the footprint
// of a grazing look nearly round in it.
fn planks(uv: vec2f, du: vec2f, dv: vec2f) -> vec3f {
    let width = max(abs(du) + abs(dv), vec2f(1e-5));
    let across = min(width.x, 1.0);
    let left = floor(uv.x - 0.5 * across);
    let right = floor(uv.x + 0.5 * across);
    let share = saturate((uv.x + 0.5 * across - right) / across);
    var tone = mix(plank_tone(left, uv.y), plank_tone(right, uv.y), share);
    tone = mix(tone, 0.5, smoothstep(0.7, 2.0, width.x));
    let shift = vec2f(0.0, 0.37 * floor(uv.x));
    let scale = vec2f(0.25, 0.5);
    // Where two planks meet the shift leaps, and a blurred texel hides in the joint.
    let grain = textureSample(base_texture, base_sampler, (uv + shift) * scale).r;
    let phase = uv.y / PLANK_LENGTH + cell_hash(i32(floor(uv.x)), -7);
    let joints = max(
        line_cover(to_whole(uv.x), JOINT, width.x),
        line_cover(to_whole(phase), 0.0007, width.y / PLANK_LENGTH) * saturate(1.5 - width.x),
    );
    let dark = 0.62 * tone + 1.1 * (grain - 0.5);
    let wood = mix(vec3f(1.0), vec3f(0.66, 0.54, 0.40), saturate(dark));
    return wood * (1.0 - 0.45 * joints);
}

// A dark pile with coloured discs, one to a cell of the grid.
fn carpet(uv: vec2f, du: vec2f, dv: vec2f) -> vec3f {
    let width = max(max(length(du), length(dv)), 1e-5);
    let cell = floor(uv);
    let number = vec2i(cell);
    let size = 0.10 + 0.20 * cell_hash(number.x, number.y + 41);
    let room = 0.5 - size;
    let middle = 0.5 + room * (2.0 * vec2f(cell_hash(number.x + 17, number.y), cell_hash(number.x, number.y + 91)) - 1.0);
    let edge = length(uv - cell - middle) - size;
    let ring = abs(edge + 0.25 * size) - 0.18 * size;
    let cover = saturate(0.5 - ring / width) * saturate(1.6 - 1.2 * width);
    let hue = cell_hash(number.x + 5, number.y + 3);
    let color = select(select(vec3f(0.9, 2.6, 3.2), vec3f(3.6, 1.1, 1.9), hue < 0.66), vec3f(3.6, 2.6, 0.8), hue < 0.33);
    let pile = cell_hash(i32(floor(uv.x * 48.0)), i32(floor(uv.y * 48.0)));
    let near = saturate(1.0 - 40.0 * width);
    return mix(vec3f(1.0), color, 0.8 * cover) * (1.0 + 0.35 * near * (pile - 0.5));
}

// Panels with a dark joint round each; u and v count them.
fn panels(uv: vec2f, du: vec2f, dv: vec2f) -> vec3f {
    let width = max(abs(du) + abs(dv), vec2f(1e-5));
    let joint = max(line_cover(to_whole(uv.x), 0.012, width.x), line_cover(to_whole(uv.y), 0.012, width.y));
    let number = vec2i(floor(uv));
    let tone = mix(cell_hash(number.x, number.y), 0.5, smoothstep(0.4, 1.0, max(width.x, width.y)));
    return vec3f((0.94 + 0.12 * tone) * (1.0 - 0.6 * joint));
}

// What the base colour is multiplied by.
fn pattern(uv: vec2f) -> vec3f {
    let du = dpdx(uv);
    let dv = dpdy(uv);
    if PATTERN == PLANKS {
        return planks(uv, du, dv);
    }
    if PATTERN == CARPET {
        return carpet(uv, du, dv);
    }
    if PATTERN == PANELS {
        return panels(uv, du, dv);
    }
    return textureSample(base_texture, base_sampler, uv).rgb;
}
