//! Pictures as files: PNG, and GIF for what moves.

use crate::{Picture, RenderError};
use color_quant::NeuQuant;
use std::io::{Error, Write};

/// Writes a PNG of 8 bits a channel.
///
/// # Errors
/// What the writer reports.
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

/// Writes a PNG of 256 colours, a third of the size: for pictures that are kept in a repository.
///
/// # Errors
/// What the writer reports.
pub fn write_small_png(out: impl Write, picture: &Picture) -> Result<(), RenderError> {
    let palette = Palette::new(std::slice::from_ref(picture), 256);
    let mut encoder = png::Encoder::new(out, picture.width, picture.height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette.colors.as_flattened().to_vec());
    encoder.set_compression(png::Compression::High);
    // Neighbouring indices are unrelated colours: predicting one from another only adds noise.
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header().map_err(Error::from)?;
    writer.write_image_data(&palette.indices(picture)).map_err(Error::from)?;
    Ok(writer.finish().map_err(Error::from)?)
}

/// Writes an animation that repeats for ever. All frames share one palette, so that nothing flickers, and hold only the
/// rectangle that differs from the frame before.
///
/// `frames_per_second` is met to a hundredth of a second, the format's unit; 50 is the most that viewers show.
///
/// # Errors
/// No frame, frames of different sizes or larger than the format allows, and what the writer reports.
pub fn write_gif(out: impl Write, pictures: &[Picture], frames_per_second: f64) -> Result<(), RenderError> {
    let fault = |message: String| RenderError::Encode(Error::other(message));
    let first = pictures.first().ok_or_else(|| fault("an animation needs a frame".to_owned()))?;
    let (width, height) = (first.width, first.height);
    if pictures.iter().any(|p| (p.width, p.height) != (width, height)) {
        return Err(fault("the frames of an animation differ in size".to_owned()));
    }
    let side = |length: u32| {
        u16::try_from(length).map_err(|_| fault(format!("{length} pixels; a GIF has at most {}", u16::MAX)))
    };
    let (w, h) = (side(width)?, side(height)?);
    let convert = |error: gif::EncodingError| match error {
        gif::EncodingError::Io(error) => RenderError::Encode(error),
        other => fault(other.to_string()),
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

/// The rectangle, from inclusive to exclusive, in which two pictures differ; one pixel if they do not.
fn changed(a: &[u8], b: &[u8], width: u32) -> [u32; 4] {
    let mut found = [u32::MAX, u32::MAX, 0, 0];
    for (k, _) in a.iter().zip(b).enumerate().filter(|(_, (p, q))| p != q) {
        let (x, y) = (k as u32 % width, k as u32 / width);
        found = [found[0].min(x), found[1].min(y), found[2].max(x + 1), found[3].max(y + 1)];
    }
    if found[2] == 0 { [0, 0, 1, 1] } else { found }
}

/// Colours that stand for all of some pictures.
struct Palette {
    colors: Vec<[u8; 3]>,
    /// Index of the nearest colour for each of 32 x 32 x 32 colours.
    nearest: Vec<u8>,
}

/// Levels of a channel that the table of nearest colours tells apart.
const LEVELS: usize = 64;
/// Pixels that a palette is made from, about.
const SAMPLES: usize = 200_000;

impl Palette {
    /// A palette from evenly spaced pixels of all pictures (Dekker, "Kohonen neural networks for optimal colour
    /// quantization", 1994).
    fn new(pictures: &[Picture], count: usize) -> Self {
        let total: usize = pictures.iter().map(|p| p.pixels.len()).sum();
        // A step without small factors, so that samples do not line up in columns.
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
                // Weights of the channels as the eye sees them, roughly.
                let distance = |color: &[u8; 3]| {
                    (0..3).map(|c| [3, 6, 2][c] * (wanted[c] - i32::from(color[c])).pow(2)).sum::<i32>()
                };
                let best = colors.iter().enumerate().min_by_key(|(_, color)| distance(color));
                best.map_or(0, |(index, _)| index as u8)
            })
            .collect();
        Self { colors, nearest }
    }

    /// The nearest colour of each pixel, after ordered dithering (Bayer, 1973): what does not move keeps its pattern from
    /// frame to frame, which error diffusion would not.
    fn indices(&self, picture: &Picture) -> Vec<u8> {
        const BAYER: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
        // Half the spacing of the table's levels: enough to hide steps, too little to be seen as grain.
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
mod tests {
    use super::*;

    /// A shaded ball on a light ground, shifted by some pixels.
    fn ball(shift: i64) -> Picture {
        let mut picture = Picture::new(64, 48, [240, 241, 243]);
        for y in 0..48 {
            for x in 0..64 {
                let (dx, dy) = (x - 24 - shift, y - 24);
                if dx * dx + dy * dy < 200 {
                    picture.blend(x, y, [200 - 4 * dy as u8 % 50, 100, (90 + dx) as u8], 1.0);
                }
            }
        }
        picture
    }

    #[test]
    fn png_reads_back_to_the_same_pixels() {
        let picture = ball(0);
        let mut bytes = Vec::new();
        write_png(&mut bytes, &picture).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut buffer).unwrap();
        assert_eq!((info.width, info.height, info.color_type), (64, 48, png::ColorType::Rgb));
        assert_eq!(&buffer[..info.buffer_size()], picture.pixels.as_flattened());
    }

    fn mean_error(a: &[[u8; 3]], b: &[[u8; 3]]) -> f64 {
        let sum: i64 = a
            .as_flattened()
            .iter()
            .zip(b.as_flattened())
            .map(|(p, q)| (i64::from(*p) - i64::from(*q)).abs())
            .sum();
        sum as f64 / a.as_flattened().len() as f64
    }

    #[test]
    fn small_png_is_near_and_smaller() {
        let picture = ball(0);
        let (mut small, mut full) = (Vec::new(), Vec::new());
        write_small_png(&mut small, &picture).unwrap();
        write_png(&mut full, &picture).unwrap();
        let mut decoder = png::Decoder::new(std::io::Cursor::new(&small));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut buffer).unwrap();
        let error = mean_error(buffer.as_chunks::<3>().0, &picture.pixels);
        assert!(error < 3.0, "{error}");
    }

    /// Another reader than ours puts the frames together to what they were.
    #[test]
    fn gif_plays_back() {
        let pictures: Vec<Picture> = (0..5).map(|k| ball(2 * k)).collect();
        let mut bytes = Vec::new();
        write_gif(&mut bytes, &pictures, 30.0).unwrap();
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(&bytes[..]).unwrap();
        assert_eq!((decoder.width(), decoder.height()), (64, 48));
        let mut screen = vec![[0; 3]; 64 * 48];
        let (mut frames, mut time) = (0, 0);
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            for (k, pixel) in frame.buffer.as_chunks::<4>().0.iter().enumerate() {
                let (x, y) = (k % frame.width as usize, k / frame.width as usize);
                if pixel[3] > 0 {
                    screen[(y + frame.top as usize) * 64 + x + frame.left as usize] =
                        [pixel[0], pixel[1], pixel[2]];
                }
            }
            assert!(frames == 0 || frame.width < 64, "only what changed is written");
            assert!(mean_error(&screen, &pictures[frames].pixels) < 3.0, "frame {frames}");
            frames += 1;
            time += frame.delay;
        }
        // Five frames at 30 a second last 17 hundredths, not five times 3.
        assert_eq!((frames, time), (5, 17));
        assert!(write_gif(Vec::new(), &[], 30.0).is_err());
        assert!(write_gif(Vec::new(), &[ball(0), Picture::new(3, 3, [0; 3])], 30.0).is_err());
    }
}
