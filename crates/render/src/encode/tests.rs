use super::*;

/// A shaded ball on a light ground, shifted by some pixels.
fn ball(shift: i64) -> Picture {
    let mut picture = Picture::new(64, 48, [240, 241, 243]);
    for y in 0..48 {
        for x in 0..64 {
            let (dx, dy) = (x - 24 - shift, y - 24);
            if dx * dx + dy * dy < 200 {
                picture.blend(x, y, [200 - (dy as u8).wrapping_mul(4) % 50, 100, (90 + dx) as u8], 1.0);
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

/// An independent decoder restores the frames.
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
