//! A picture in memory.

use crate::colormap::{to_linear, to_srgb};

/// Pixels in sRGB, row by row from the upper left.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Picture {
    /// Width [pixels].
    pub width: u32,
    /// Height [pixels].
    pub height: u32,
    /// Red, green and blue; `width * height` entries.
    pub pixels: Vec<[u8; 3]>,
}

impl Picture {
    /// A picture of one color.
    pub fn new(width: u32, height: u32, color: [u8; 3]) -> Self {
        Self { width, height, pixels: vec![color; width as usize * height as usize] }
    }

    /// The pixel in column `x` and row `y`.
    ///
    /// # Panics
    /// If it lies outside of the picture.
    pub fn at(&self, x: u32, y: u32) -> [u8; 3] {
        assert!(x < self.width && y < self.height, "pixel ({x}, {y}) of {} x {}", self.width, self.height);
        self.pixels[(y * self.width + x) as usize]
    }

    /// Blends a color into a pixel, with opacity `coverage` in [0, 1]. Pixels outside of the picture are
    /// ignored.
    pub fn blend(&mut self, x: i64, y: i64, color: [u8; 3], coverage: f32) {
        if (0..i64::from(self.width)).contains(&x) && (0..i64::from(self.height)).contains(&y) {
            let pixel = &mut self.pixels[(y * i64::from(self.width) + x) as usize];
            for c in 0..3 {
                let (old, new) = (f32::from(pixel[c]), f32::from(color[c]));
                pixel[c] = (old + (new - old) * coverage.clamp(0.0, 1.0)).round() as u8;
            }
        }
    }

    /// Fills a rectangle, given its upper left corner and its size. The part outside of the picture is
    /// ignored.
    pub fn fill(&mut self, [x, y]: [i64; 2], [width, height]: [i64; 2], color: [u8; 3]) {
        for row in y..y + height {
            for column in x..x + width {
                self.blend(column, row, color, 1.0);
            }
        }
    }

    /// The picture reduced to a `factor`-th of its size by means of linear light. Incomplete blocks at the
    /// right and lower edges are dropped.
    pub fn shrink(&self, factor: u32) -> Self {
        if factor <= 1 {
            return self.clone();
        }
        let linear: Vec<f64> = (0..256).map(|v| to_linear(f64::from(v) / 255.0)).collect();
        let (width, height) = (self.width / factor, self.height / factor);
        let count = f64::from(factor * factor);
        let mut pixels = Vec::with_capacity((width * height) as usize);
        for y in 0..height {
            for x in 0..width {
                let mut sum = [0.0; 3];
                for row in y * factor..(y + 1) * factor {
                    for column in x * factor..(x + 1) * factor {
                        let pixel = self.pixels[(row * self.width + column) as usize];
                        (0..3).for_each(|c| sum[c] += linear[pixel[c] as usize]);
                    }
                }
                pixels.push(sum.map(|s| (to_srgb(s / count) * 255.0).round() as u8));
            }
        }
        Self { width, height, pixels }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shrinking_averages_light() {
        let mut board = Picture::new(4, 4, [255; 3]);
        for y in 0..4 {
            for x in 0..4 {
                if (x + y) % 2 == 0 {
                    board.blend(x, y, [0; 3], 1.0);
                }
            }
        }
        // Half the light is 188, not 128, of 255.
        assert_eq!(board.shrink(2), Picture::new(2, 2, [188; 3]));
        assert_eq!(Picture::new(6, 6, [17, 130, 250]).shrink(3), Picture::new(2, 2, [17, 130, 250]));
    }

    #[test]
    fn blending_outside_does_nothing() {
        let mut picture = Picture::new(2, 2, [0; 3]);
        picture.fill([-5, -5], [4, 20], [255; 3]);
        picture.blend(7, 0, [255; 3], 1.0);
        assert_eq!(picture, Picture::new(2, 2, [0; 3]));
    }
}
