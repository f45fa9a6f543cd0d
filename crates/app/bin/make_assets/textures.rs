//! Procedural textures: wood boards, a pin's stripes, marbled balls. Colours are sRGB bytes.

use image::{Rgb, RgbImage};

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

/// `boards` boards side by side (u), grain along v: maple if `pale`, else darker pine.
pub fn boards(boards: u32, pale: bool) -> RgbImage {
    let (width, height) = (boards * 16, 512);
    let (light, dark) = if pale {
        ([226.0, 188.0, 132.0], [190.0, 146.0, 92.0])
    } else {
        ([205.0, 160.0, 104.0], [160.0, 112.0, 64.0])
    };
    RgbImage::from_fn(width, height, |x, y| {
        let board = x / 16;
        let tone = noise(board as f32 * 7.3, 3.1, 4096, 11);
        let (u, v) = (x as f32 / 16.0, y as f32 / height as f32);
        let grain = turbulence(u * 6.0, v * 4.0 + board as f32 * 13.7, 4096, 29 + board);
        let seam = if x % 16 == 0 { 0.82 } else { 1.0 };
        let colour = mix(light, dark, 0.25 + 0.45 * tone + 0.6 * (grain - 0.5));
        rgb(colour.map(|c| c * seam))
    })
}

/// A pin's coat, v from base to crown: white, two red rings on the neck, a grey base ring.
pub fn pin(height_m: f32) -> RgbImage {
    let rows = 256;
    RgbImage::from_fn(32, rows, |_, y| {
        let h = (1.0 - (y as f32 + 0.5) / rows as f32) * height_m;
        let red = (0.2290..0.2410).contains(&h) || (0.2500..0.2620).contains(&h);
        if red {
            Rgb([190, 24, 32])
        } else if h < 0.008 {
            Rgb([120, 120, 118])
        } else {
            Rgb([244, 241, 232])
        }
    })
}

/// A marbled ball: veins of `vein` in `base`, and three dark finger holes, so that rotation can be seen.
pub fn ball(base: [f32; 3], vein: [f32; 3], seed: u32) -> RgbImage {
    let (width, height) = (256, 128);
    // Two fingers and the thumb, as (longitude, latitude) in radians.
    let holes = [(-0.13_f32, 1.05_f32), (0.13, 1.05), (0.0, 0.62)];
    let point = |longitude: f32, latitude: f32| {
        let glam::Vec2 { x: cy, y: sy } = glam::Vec2::from_angle(latitude);
        let glam::Vec2 { x: cx, y: sx } = glam::Vec2::from_angle(longitude);
        glam::Vec3::new(cy * cx, sy, cy * sx)
    };
    RgbImage::from_fn(width, height, |x, y| {
        let longitude = ((x as f32 + 0.5) / width as f32 - 0.5) * std::f32::consts::TAU;
        let latitude = (0.5 - (y as f32 + 0.5) / height as f32) * std::f32::consts::PI;
        let here = point(longitude, latitude);
        let in_hole = holes
            .iter()
            .any(|&(lon, lat)| here.distance(point(lon, lat)) < 0.105);
        if in_hole {
            return Rgb([16, 14, 14]);
        }
        let (u, v) = (
            x as f32 / width as f32 * 8.0,
            y as f32 / height as f32 * 4.0,
        );
        let swirl = turbulence(u, v, 8, seed) * 5.0;
        let t = (turbulence(u, v + swirl, 8, seed + 17) * 2.6 - 0.8).clamp(0.0, 1.0);
        rgb(mix(base, vein, t))
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
    fn pin_is_white_with_red_rings_on_the_neck() {
        let image = pin(0.381);
        let at = |h: f32| image.get_pixel(5, ((1.0 - h / 0.381) * 256.0) as u32).0;
        assert!(at(0.1143)[1] > 200, "belly is white");
        assert!(at(0.235)[0] > 150 && at(0.235)[1] < 60, "lower ring is red");
        assert!(at(0.256)[0] > 150 && at(0.256)[1] < 60, "upper ring is red");
    }
}
