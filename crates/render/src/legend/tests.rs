use super::*;

fn scale(low: f64, high: f64) -> Scale {
    Scale { title: "gap".to_owned(), unit: "mm".to_owned(), low, high, beyond: [false; 2] }
}

#[test]
fn ticks_are_round_numbers_within_the_ends() {
    let texts = |s: &Scale| s.ticks().into_iter().map(|(_, text)| text).collect::<Vec<_>>();
    assert_eq!(texts(&scale(0.0, 1.0)), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
    assert_eq!(texts(&scale(1.0, 1.137)), ["1.00", "1.02", "1.04", "1.06", "1.08", "1.10", "1.12"]);
    assert_eq!(texts(&scale(-60.0, 130.0)), ["−50", "0", "50", "100"]);
    let beyond = Scale { beyond: [true, true], ..scale(0.0, 5.0) };
    assert_eq!(texts(&beyond), ["≤ 0", "1", "2", "3", "4", "≥ 5"]);
}

#[test]
fn rounding_moves_the_ends_outward() {
    for (low, high) in [(0.013, 0.87), (1.0, 1.137), (-3.2, 911.0), (2.0, 2.0), (0.0, 0.0), (1e-9, 2e-9)] {
        let s = scale(low, high).rounded();
        assert!(s.low <= low && s.high >= high && s.low < s.high, "{s:?}");
        assert!(s.high - s.low <= 1.45 * (high - low) || high == low, "{s:?}");
        let ticks = s.ticks();
        assert!((3..=12).contains(&ticks.len()), "{ticks:?}");
        assert!(ticks.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }
}

/// At each height the bar has the color of the number there.
#[test]
fn the_bar_agrees_with_the_map() {
    let legend = Legend::Scale(scale(0.0, 1.0));
    let mut picture = Picture::new(400, 320, [255; 3]);
    legend.draw(&mut picture);
    let x = 400 - legend.width(320) + text_size(320) as u32 + 3;
    let (top, bottom) = (64, 272);
    for (y, t) in [(top, 1.0), ((top + bottom) / 2, 0.5), (bottom, 0.0)] {
        let (color, expected) = (picture.at(x, y), viridis(t));
        for c in 0..3 {
            assert!((f64::from(color[c]) / 255.0 - expected[c]).abs() < 0.01, "{color:?} {expected:?}");
        }
    }
    // Nothing is drawn at the right edge of the picture or left of the strip of the legend.
    let strip = 400 - legend.width(320);
    for y in 0..320 {
        assert!((0..strip).chain([399]).all(|x| picture.at(x, y) == [255; 3]), "row {y}");
    }
}

#[test]
fn names_stand_beside_their_colors() {
    let legend = Legend::Names(vec![("cloth".to_owned(), [200, 0, 0]), ("ball".to_owned(), [0, 0, 200])]);
    let mut picture = Picture::new(300, 200, [255; 3]);
    legend.draw(&mut picture);
    let count = |color| picture.pixels.iter().filter(|p| **p == color).count();
    assert_eq!(count([200, 0, 0]), count([0, 0, 200]));
    assert!(count([200, 0, 0]) >= 64);
}
