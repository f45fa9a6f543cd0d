//! Procedural textures: the grain of wood, the panel over the pins, a pin's stripes, marbled balls. Colours are sRGB bytes.

use image::{Rgb, RgbImage};

use crate::pieces::BANDS;

/// Value noise in 0..1 on a lattice that repeats every `period` cells in x; smooth between lattice points.
fn noise(x: f32, y: f32, period: u32, seed: u32) -> f32 {
    let lattice = |ix: i32, iy: i32| {
        let wrapped = ix.rem_euclid(period as i32) as u32;
        // Integer hash (Wang 2007 style mixing): the same bytes on every system.
        let mut h =
            wrapped.wrapping_mul(0x9E37_79B9) ^ (iy as u32).wrapping_mul(0x85EB_CA6B) ^ seed;
        h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
        h = (h ^ (h >> 12)).wrapping_mul(0x297A_2D39);
        (h ^ (h >> 15)) as f32 / u32::MAX as f32
    };
    let (ix, iy) = (x.floor(), y.floor());
    let smooth = |t: f32| t * t * (3.0 - 2.0 * t);
    let (fx, fy) = (smooth(x - ix), smooth(y - iy));
    let (ix, iy) = (ix as i32, iy as i32);
    let row = |iy: i32| lattice(ix, iy) + (lattice(ix + 1, iy) - lattice(ix, iy)) * fx;
    row(iy) + (row(iy + 1) - row(iy)) * fy
}

/// Four octaves of [`noise`], 0..1.
fn turbulence(x: f32, y: f32, period: u32, seed: u32) -> f32 {
    let mut sum = 0.0;
    for octave in 0..4 {
        let scale = (1 << octave) as f32;
        sum += noise(x * scale, y * scale, period << octave, seed + octave) / scale;
    }
    sum / 1.875
}

fn mix(a: [f32; 3], b: [f32; 3], t: f32) -> [f32; 3] {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t.clamp(0.0, 1.0))
}

fn rgb(c: [f32; 3]) -> Rgb<u8> {
    Rgb(c.map(|x| x.clamp(0.0, 255.0).round() as u8))
}

/// Grain of wood along v, grey about a half, that repeats both ways: fine lines, and wider bands of early and late wood.
pub fn grain() -> RgbImage {
    let size = 256;
    RgbImage::from_fn(size, size, |x, y| {
        let (u, v) = (x as f32 / size as f32, y as f32 / size as f32);
        // Periods along v in the first argument, which is the one that repeats; blended over u so that it repeats too.
        let at = |u: f32| {
            let bands = turbulence(v * 2.0, u * 26.0, 2, 5);
            let lines = noise(v * 4.0, u * 120.0, 4, 77);
            let pores = noise(v * 32.0, u * 256.0, 32, 131);
            0.5 + 0.85 * (bands - 0.5) + 0.28 * (lines - 0.5) - 0.30 * (pores - 0.72).max(0.0)
        };
        let grey = at(u) * (1.0 - u) + at(u - 1.0) * u;
        // The image is sRGB, the shader reads linear: what is a half there is 188 here.
        let linear = (0.5 + 1.15 * (grey - 0.5)).clamp(0.0, 1.0);
        rgb([255.0 * linear.powf(1.0 / 2.2); 3])
    })
}

/// What is painted on the panel over the pins: an evening sky with a low sun, and hills; twice as much at each side.
pub fn masking() -> RgbImage {
    let (width, height) = (1024, 256);
    RgbImage::from_fn(width, height, |x, y| {
        let across = (x as f32 + 0.5) / width as f32;
        let up = 1.0 - (y as f32 + 0.5) / height as f32;
        let from_middle = (across - 0.5) * width as f32 / height as f32;
        let sky = if up > 0.45 {
            mix([150.0, 44.0, 118.0], [16.0, 18.0, 62.0], (up - 0.45) / 0.5)
        } else {
            mix([246.0, 128.0, 62.0], [150.0, 44.0, 118.0], up / 0.45)
        };
        let sun = glam::Vec2::new(from_middle, up - 0.40).length();
        // The sun in stripes, wider towards the horizon.
        let stripe = (up * 26.0).fract() < 0.25 + 0.9 * (0.62 - up);
        let mut color = sky;
        if sun < 0.27 && !stripe {
            color = mix(
                [252.0, 214.0, 96.0],
                [250.0, 120.0, 70.0],
                (0.67 - up) / 0.5,
            );
        }
        for (far, tone) in [(0.0_f32, [92.0, 30.0, 92.0]), (1.0, [40.0, 16.0, 58.0])] {
            let crest = turbulence(across * (14.0 + 10.0 * far), 3.7 + far, 4096, 9);
            if up < 0.30 - 0.12 * far + 0.34 * (crest - 0.5) {
                color = tone;
            }
        }
        rgb(color)
    })
}

/// A pin's coat, v from base to crown: white, two red rings on the neck, a grey base ring.
pub fn pin(height_m: f32) -> RgbImage {
    let rows = 256;
    RgbImage::from_fn(32, rows, |_, y| {
        let h = (1.0 - (y as f32 + 0.5) / rows as f32) * height_m;
        let red = BANDS.iter().any(|(low, high)| (*low..*high).contains(&h));
        if red {
            Rgb([190, 24, 32])
        } else if h < 0.008 {
            Rgb([120, 120, 118])
        } else {
            Rgb([244, 241, 232])
        }
    })
}

/// Middles of the finger holes and of the thumb hole on a ball, as (longitude, latitude) [rad], longitude 0 at +x: where the game
/// has the hand's fingers (`game::HALF_SPAN`), and 24 mm between the two fingers.
pub const HOLES: [(f32, f32); 3] = [
    (-0.12, game::HALF_SPAN as f32),
    (0.12, game::HALF_SPAN as f32),
    (0.0, -(game::HALF_SPAN as f32)),
];

/// Radius of a finger hole, in radii of the ball: 23 mm across.
pub const HOLE_RADIUS: f32 = 0.105;

/// The point of a ball of radius 1 at a longitude and a latitude [rad].
pub fn on_ball((longitude, latitude): (f32, f32)) -> glam::Vec3 {
    let glam::Vec2 { x: cy, y: sy } = glam::Vec2::from_angle(latitude);
    let glam::Vec2 { x: cx, y: sx } = glam::Vec2::from_angle(longitude);
    glam::Vec3::new(cy * cx, sy, -cy * sx)
}

/// A marbled ball: veins of `vein` in `base`, and three dark finger holes, so that rotation can be seen.
pub fn ball(base: [f32; 3], vein: [f32; 3], seed: u32) -> RgbImage {
    let (width, height) = (512, 256);
    let holes = HOLES.map(on_ball);
    RgbImage::from_fn(width, height, |x, y| {
        let round = (x as f32 + 0.5) / width as f32;
        let longitude = round * std::f32::consts::TAU;
        let latitude = (0.5 - (y as f32 + 0.5) / height as f32) * std::f32::consts::PI;
        let here = on_ball((longitude, latitude));
        let nearest = holes
            .iter()
            .map(|hole| here.distance(*hole))
            .fold(f32::INFINITY, f32::min);
        if nearest < HOLE_RADIUS {
            return Rgb([12, 11, 11]);
        }
        // The holes' bevelled rims are worn a little paler.
        let rim = (1.0 - (nearest - HOLE_RADIUS) / 0.02).clamp(0.0, 1.0);
        let (u, v) = (
            x as f32 / width as f32 * 8.0,
            y as f32 / height as f32 * 4.0,
        );
        let swirl = turbulence(u, v, 8, seed) * 5.0;
        let t = (turbulence(u, v + swirl, 8, seed + 17) * 2.6 - 0.8).clamp(0.0, 1.0);
        rgb(mix(mix(base, vein, t), [200.0; 3], 0.35 * rim))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_repeats_around_a_ball_so_that_no_seam_shows() {
        for y in 0..20 {
            let y = y as f32 * 0.37;
            assert_eq!(noise(0.0, y, 8, 3), noise(8.0, y, 8, 3));
        }
    }

    #[test]
    fn grain_repeats_along_and_across_and_is_grey_about_a_half() {
        let image = grain();
        let linear = |x: u32, y: u32| (f32::from(image.get_pixel(x, y).0[0]) / 255.0).powf(2.2);
        let step = |a: f32, b: f32| (a - b).abs();
        let (mut seam, mut inside, mut sum) = (0.0, 0.0, 0.0);
        for i in 0..256 {
            seam += step(linear(i, 0), linear(i, 255)) + step(linear(0, i), linear(255, i));
            inside += step(linear(i, 100), linear(i, 101)) + step(linear(100, i), linear(101, i));
            sum += linear(i, (i * 7) % 256);
        }
        assert!(seam < 1.6 * inside, "{seam} {inside}");
        assert!((sum / 256.0 - 0.5).abs() < 0.06, "{}", sum / 256.0);
    }

    #[test]
    fn pin_is_white_with_red_rings_on_the_neck() {
        let image = pin(0.381);
        let at = |h: f32| image.get_pixel(5, ((1.0 - h / 0.381) * 256.0) as u32).0;
        assert!(at(0.1143)[1] > 200, "belly is white");
        assert!(at(0.235)[0] > 150 && at(0.235)[1] < 60, "lower ring is red");
        assert!(at(0.256)[0] > 150 && at(0.256)[1] < 60, "upper ring is red");
    }
}
