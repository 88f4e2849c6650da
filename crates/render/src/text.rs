//! Text in pictures, in DejaVu Sans reduced to the characters that legends need.

use crate::Picture;
use ab_glyph::{Font, FontRef, PxScale, ScaleFont};

/// The font; its license is in the same folder.
const FONT: &[u8] = include_bytes!("../assets/DejaVuSans-subset.ttf");

/// Writes lines of one size.
#[derive(Debug)]
pub struct Pen {
    font: Option<FontRef<'static>>,
    size: f32,
}

impl Pen {
    /// A pen for text of this size, from the highest to the lowest letter [pixels].
    pub fn new(size: f32) -> Self {
        // The font is part of the program; a test checks that it can be read.
        Self { font: FontRef::try_from_slice(FONT).ok(), size }
    }

    /// Width of a text [pixels].
    pub fn width(&self, text: &str) -> f32 {
        let Some(font) = &self.font else { return 0.0 };
        let scaled = font.as_scaled(PxScale::from(self.size));
        text.chars().map(|c| scaled.h_advance(font.glyph_id(c))).sum()
    }

    /// Height of a capital letter [pixels].
    pub fn capital_height(&self) -> f32 {
        // In DejaVu Sans: 1493 of the 2384 units from ascent to descent.
        self.size * 0.626
    }

    /// Writes a text that begins at column `x` and whose capitals are centered on row `middle`.
    pub fn write(&self, picture: &mut Picture, x: f32, middle: f32, color: [u8; 3], text: &str) {
        let Some(font) = &self.font else { return };
        let scaled = font.as_scaled(PxScale::from(self.size));
        let baseline = (middle + self.capital_height() / 2.0).round();
        let mut pen = x;
        for character in text.chars() {
            let id = font.glyph_id(character);
            let glyph = id.with_scale_and_position(PxScale::from(self.size), ab_glyph::point(pen, baseline));
            if let Some(outline) = font.outline_glyph(glyph) {
                let corner = outline.px_bounds().min;
                outline.draw(|dx, dy, coverage| {
                    let (x, y) = (corner.x as i64 + i64::from(dx), corner.y as i64 + i64::from(dy));
                    picture.blend(x, y, color, coverage);
                });
            }
            pen += scaled.h_advance(id);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First and last column, first and last row that are not blank.
    fn extent(picture: &Picture) -> [u32; 4] {
        let mut extent = [u32::MAX, 0, u32::MAX, 0];
        for y in 0..picture.height {
            for x in 0..picture.width {
                if picture.at(x, y) != [255; 3] {
                    extent = [extent[0].min(x), extent[1].max(x), extent[2].min(y), extent[3].max(y)];
                }
            }
        }
        extent
    }

    #[test]
    fn text_stands_at_its_place() {
        let pen = Pen::new(40.0);
        let width = pen.width("H0.25");
        let mut picture = Picture::new(300, 100, [255; 3]);
        pen.write(&mut picture, 100.0, 50.0, [0; 3], "H0.25");
        let [x0, x1, y0, y1] = extent(&picture);
        assert!((x0 as f32 - 100.0).abs() < 6.0 && (x1 as f32 - 100.0 - width).abs() < 6.0, "{x0} to {x1}");
        // Capitals and digits are centered on row 50.
        assert!(((y0 + y1 + 1) as f32 / 2.0 - 50.0).abs() <= 1.5, "{y0} to {y1}");
        assert!(((y1 + 1 - y0) as f32 - pen.capital_height()).abs() < 2.5);
    }

    /// The font has every character that a legend writes.
    #[test]
    fn the_font_has_the_characters_of_legends() {
        let font = FontRef::try_from_slice(FONT).unwrap();
        let needed = (' '..='~').filter(|c| !"`'\"\\".contains(*c)).chain("µ×≥≤−°²³·".chars());
        for character in needed {
            assert_ne!(font.glyph_id(character).0, 0, "{character:?}");
        }
    }
}
