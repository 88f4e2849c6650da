//! Pictures as PNG files and animations as GIF files.

use crate::{Picture, RenderError};
use color_quant::NeuQuant;
use std::io::{Error, Write};

/// Writes a PNG with 8 bits per channel.
///
/// # Errors
/// Errors of `out`.
pub fn write_png(out: impl Write, picture: &Picture) -> Result<(), RenderError> {
    let mut encoder = png::Encoder::new(out, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::High);
    let data = picture.pixels.as_flattened();
    let mut writer = encoder.write_header().map_err(Error::from)?;
    writer.write_image_data(data).map_err(Error::from)?;
    Ok(writer.finish().map_err(Error::from)?)
}

/// Writes a PNG of 256 colors. It is a third of the size, for pictures that are kept in a repository.
///
/// # Errors
/// Errors of `out`.
pub fn write_small_png(out: impl Write, picture: &Picture) -> Result<(), RenderError> {
    let palette = Palette::new(std::slice::from_ref(picture), 256);
    let mut encoder = png::Encoder::new(out, picture.width, picture.height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette.colors.as_flattened().to_vec());
    encoder.set_compression(png::Compression::High);
    // Neighboring indices are unrelated colors, so a filter that predicts one from another would only add
    // noise.
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header().map_err(Error::from)?;
    writer.write_image_data(&palette.indices(picture)).map_err(Error::from)?;
    Ok(writer.finish().map_err(Error::from)?)
}

/// Writes an animation that repeats for ever. All frames share one palette, so that nothing flickers. Each
/// frame holds only the rectangle in which it differs from the frame before it.
///
/// The delays of the frames are rounded to a hundredth of a second, the unit of the format.
/// `frames_per_second` is clamped to at most 50, the fastest that viewers play.
///
/// # Errors
/// No frame, frames of different sizes or larger than the format allows, and errors of `out`.
pub fn write_gif(out: impl Write, pictures: &[Picture], frames_per_second: f64) -> Result<(), RenderError> {
    let failure = |message: String| RenderError::Encode(Error::other(message));
    let first = pictures.first().ok_or_else(|| failure("an animation needs a frame".to_owned()))?;
    let (width, height) = (first.width, first.height);
    if pictures.iter().any(|p| (p.width, p.height) != (width, height)) {
        return Err(failure("the frames of an animation differ in size".to_owned()));
    }
    let side = |length: u32| {
        u16::try_from(length).map_err(|_| failure(format!("{length} pixels; a GIF has at most {}", u16::MAX)))
    };
    let (w, h) = (side(width)?, side(height)?);
    let convert = |error: gif::EncodingError| match error {
        gif::EncodingError::Io(error) => RenderError::Encode(error),
        other => failure(other.to_string()),
    };

    let palette = Palette::new(pictures, 256);
    let mut encoder = gif::Encoder::new(out, w, h, palette.colors.as_flattened()).map_err(convert)?;
    encoder.set_repeat(gif::Repeat::Infinite).map_err(convert)?;
    let rate = frames_per_second.clamp(0.1, 50.0);
    let due = |frame: usize| (frame as f64 * 100.0 / rate).round() as u64;
    let mut last: Option<Vec<u8>> = None;
    for (index, picture) in pictures.iter().enumerate() {
        let indices = palette.indices(picture);
        let [x0, y0, x1, y1] = last.as_ref().map_or([0, 0, width, height], |l| changed(l, &indices, width));
        let rows = (y0..y1).flat_map(|y| &indices[(y * width + x0) as usize..(y * width + x1) as usize]);
        let frame = gif::Frame {
            delay: (due(index + 1) - due(index)) as u16,
            left: x0 as u16,
            top: y0 as u16,
            width: (x1 - x0) as u16,
            height: (y1 - y0) as u16,
            buffer: rows.copied().collect::<Vec<u8>>().into(),
            dispose: gif::DisposalMethod::Keep,
            ..gif::Frame::default()
        };
        encoder.write_frame(&frame).map_err(convert)?;
        last = Some(indices);
    }
    Ok(())
}

/// The smallest rectangle in which two pictures differ, as its first and its one past last column and row;
/// one pixel if they are equal.
fn changed(a: &[u8], b: &[u8], width: u32) -> [u32; 4] {
    let mut found = [u32::MAX, u32::MAX, 0, 0];
    for (k, _) in a.iter().zip(b).enumerate().filter(|(_, (p, q))| p != q) {
        let (x, y) = (k as u32 % width, k as u32 / width);
        found = [found[0].min(x), found[1].min(y), found[2].max(x + 1), found[3].max(y + 1)];
    }
    if found[2] == 0 { [0, 0, 1, 1] } else { found }
}

/// The colors that indexed pictures are made of.
struct Palette {
    colors: Vec<[u8; 3]>,
    /// Index of the nearest color for each of [`LEVELS`] cubed colors.
    nearest: Vec<u8>,
}

/// Levels per channel of the table of nearest colors.
const LEVELS: usize = 64;
/// Approximate number of pixels that a palette is made from.
const SAMPLES: usize = 200_000;

impl Palette {
    /// A palette from evenly spaced pixels of all pictures (Dekker, "Kohonen neural networks for optimal
    /// color quantization", 1994).
    fn new(pictures: &[Picture], count: usize) -> Self {
        let total: usize = pictures.iter().map(|p| p.pixels.len()).sum();
        // An odd step, so that the samples do not line up in columns of a picture of even width.
        let step = (total / SAMPLES).max(1) | 1;
        let samples: Vec<u8> = pictures
            .iter()
            .flat_map(|p| &p.pixels)
            .step_by(step)
            .flat_map(|&[r, g, b]| [r, g, b, 255])
            .collect();
        let network = NeuQuant::new(1, count, &samples);
        let colors: Vec<[u8; 3]> = network.color_map_rgb().as_chunks::<3>().0.to_vec();
        let scale = 255.0 / (LEVELS as f64 - 1.0);
        let level = |l: usize| (l as f64 * scale).round() as i32;
        let nearest = (0..LEVELS * LEVELS * LEVELS)
            .map(|k| {
                let wanted = [k / (LEVELS * LEVELS), k / LEVELS % LEVELS, k % LEVELS].map(level);
                // Approximate sensitivity of the eye to the channels.
                let distance = |color: &[u8; 3]| {
                    (0..3).map(|c| [3, 6, 2][c] * (wanted[c] - i32::from(color[c])).pow(2)).sum::<i32>()
                };
                let best = colors.iter().enumerate().min_by_key(|(_, color)| distance(color));
                best.map_or(0, |(index, _)| index as u8)
            })
            .collect();
        Self { colors, nearest }
    }

    /// The nearest color of each pixel, after ordered dithering (Bayer, 1973). Parts of a picture that do
    /// not move keep their pattern from frame to frame, which error diffusion would change.
    fn indices(&self, picture: &Picture) -> Vec<u8> {
        const BAYER: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
        // About the spacing of the table's levels: it hides steps and is too small to show as grain.
        const AMPLITUDE: f32 = 4.0;
        let level =
            |value: f32| (value * (LEVELS as f32 - 1.0) / 255.0).round().clamp(0.0, LEVELS as f32 - 1.0);
        picture
            .pixels
            .iter()
            .enumerate()
            .map(|(k, pixel)| {
                let (x, y) = (k % picture.width as usize, k / picture.width as usize);
                let shift = (f32::from(BAYER[y % 4][x % 4]) / 15.0 - 0.5) * AMPLITUDE;
                let [r, g, b] = pixel.map(|v| level(f32::from(v) + shift) as usize);
                self.nearest[(r * LEVELS + g) * LEVELS + b]
            })
            .collect()
    }
}

#[cfg(test)]
mod tests;
