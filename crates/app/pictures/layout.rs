//! Puts pictures and captions side by side.

use image::{Pixel, Rgba, RgbaImage};

/// Behind and between pictures.
pub const PAPER: Rgba<u8> = Rgba([24, 24, 26, 255]);

/// An empty picture.
pub fn paper(width: u32, height: u32) -> RgbaImage {
    RgbaImage::from_pixel(width, height, PAPER)
}

/// Lays `picture` on `paper` with its upper left corner at (x, y), blending by its alpha; what
/// would stick out is left off.
pub fn place(paper: &mut RgbaImage, picture: &RgbaImage, x: u32, y: u32) {
    let width = picture.width().min(paper.width().saturating_sub(x));
    let height = picture.height().min(paper.height().saturating_sub(y));
    for row in 0..height {
        for column in 0..width {
            paper
                .get_pixel_mut(x + column, y + row)
                .blend(picture.get_pixel(column, row));
        }
    }
}

/// Size of one eye's picture of about `area` pixels whose angles have the given `aspect`.
///
/// Even in both directions, because video codecs halve the colours' resolution.
pub fn eye_size(area: f32, aspect: f32) -> (u32, u32) {
    let even = |length: f32| ((length / 2.0).round() as u32).max(8) * 2;
    (even((area * aspect).sqrt()), even((area / aspect).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eye_size_keeps_area_and_aspect() {
        let (width, height) = eye_size(40_000.0, 2.0);
        assert_eq!((width % 2, height % 2), (0, 0));
        assert!((width * height).abs_diff(40_000) < 600, "{width} {height}");
        assert!((width as f32 / height as f32 - 2.0).abs() < 0.05);
    }

    #[test]
    fn place_leaves_off_what_sticks_out() {
        let mut page = paper(4, 4);
        place(
            &mut page,
            &RgbaImage::from_pixel(3, 3, Rgba([255, 0, 0, 255])),
            2,
            2,
        );
        assert_eq!(page.get_pixel(3, 3)[0], 255);
        assert_eq!(*page.get_pixel(1, 1), PAPER);
    }
}
