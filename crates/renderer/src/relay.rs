//! Bringing an image to another number of pixels, as a video scaler between renderer and display does.

use image::{Rgba, RgbaImage};

/// The image with another number of pixels, seen under the same angles.
///
/// Each new pixel is the mean of the area that it covers, taken in linear light, so that brightness is kept; the
/// sides are independent, so pixels need not stay square. Enlarging therefore keeps hard pixel edges.
///
/// # Panics
/// If a side of either image is zero.
pub fn relay(image: &RgbaImage, width: u32, height: u32) -> RgbaImage {
    assert!(
        width > 0 && height > 0 && image.width() > 0 && image.height() > 0,
        "an image has at least one pixel"
    );
    if image.dimensions() == (width, height) {
        return image.clone();
    }
    let columns = coverage(image.width(), width);
    let rows = coverage(image.height(), height);
    let to_linear: [f32; 256] = std::array::from_fn(|byte| linear_from_srgb(byte as f32 / 255.0));
    RgbaImage::from_fn(width, height, |x, y| {
        let mut sum = [0.0_f32; 4];
        for &(from_y, weight_y) in &rows[y as usize] {
            for &(from_x, weight_x) in &columns[x as usize] {
                let Rgba([r, g, b, a]) = *image.get_pixel(from_x, from_y);
                let weight = weight_x * weight_y;
                for (sum, byte) in sum.iter_mut().zip([r, g, b]) {
                    *sum += weight * to_linear[byte as usize];
                }
                sum[3] += weight * f32::from(a);
            }
        }
        let [r, g, b] = [sum[0], sum[1], sum[2]].map(|value| byte(255.0 * srgb_from_linear(value)));
        Rgba([r, g, b, byte(sum[3])])
    })
}

/// For each new pixel of a side: the old pixels under it and the share of it that each covers.
fn coverage(old: u32, new: u32) -> Vec<Vec<(u32, f32)>> {
    let scale = f64::from(old) / f64::from(new);
    (0..new)
        .map(|at| {
            let (from, to) = (f64::from(at) * scale, f64::from(at + 1) * scale);
            (from as u32..(to.ceil() as u32).min(old))
                .map(|i| {
                    let overlap = to.min(f64::from(i + 1)) - from.max(f64::from(i));
                    (i, (overlap / scale) as f32)
                })
                .collect()
        })
        .collect()
}

fn byte(value: f32) -> u8 {
    // `as` saturates, so rounding errors beyond 255 are harmless.
    value.round() as u8
}

/// IEC 61966-2-1, both ways, on 0 to 1.
pub(crate) fn linear_from_srgb(value: f32) -> f32 {
    if value <= 0.04045 {
        value / 12.92
    } else {
        ((value + 0.055) / 1.055).powf(2.4)
    }
}

/// Inverse of [`linear_from_srgb`].
pub(crate) fn srgb_from_linear(value: f32) -> f32 {
    if value <= 0.003_130_8 {
        12.92 * value
    } else {
        1.055 * value.powf(1.0 / 2.4) - 0.055
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relay_averages_in_linear_light() {
        let stripes =
            RgbaImage::from_fn(704, 4, |x, _| Rgba([if x % 2 == 0 { 255 } else { 0 }; 4]));
        let small = relay(&stripes, 352, 2);
        // Half the light is sRGB 188, not 128.
        assert_eq!(*small.get_pixel(100, 1), Rgba([188, 188, 188, 128]));
    }

    #[test]
    fn relay_keeps_every_byte_of_an_even_image() {
        for value in [0, 1, 7, 128, 254, 255] {
            let even = RgbaImage::from_pixel(704, 480, Rgba([value; 4]));
            let small = relay(&even, 360, 240);
            assert!(small.pixels().all(|p| *p == Rgba([value; 4])), "{value}");
        }
    }

    #[test]
    fn relay_places_an_edge_where_it_was() {
        // An edge at 45.5 % of the width of the 704 columns falls inside column 163 of the 360.
        let edge = RgbaImage::from_fn(704, 1, |x, _| Rgba([if x < 320 { 0 } else { 255 }; 4]));
        let small = relay(&edge, 360, 1);
        assert_eq!(small.get_pixel(162, 0)[3], 0);
        assert_eq!(small.get_pixel(164, 0)[3], 255);
        assert!((1..255).contains(&small.get_pixel(163, 0)[3]));
    }

    #[test]
    fn coverage_shares_add_up() {
        for (old, new) in [(704, 360), (480, 240), (3, 7), (7, 3), (1, 1)] {
            for shares in coverage(old, new) {
                let sum: f32 = shares.iter().map(|&(_, share)| share).sum();
                assert!((sum - 1.0).abs() < 1e-5, "{old} to {new}: {sum}");
            }
        }
    }
}
