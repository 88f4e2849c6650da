//! The key to a picture's colours: a bar with ticks, or a name beside each colour.

use crate::Picture;
use crate::colormap::viridis;
use crate::palette::INK;
use crate::text::Pen;

/// What colours stand for.
#[derive(Clone, Debug, PartialEq)]
pub enum Legend {
    /// Numbers from low to high.
    Scale(Scale),
    /// Names of colours.
    Names(Vec<(String, [u8; 3])>),
}

/// Numbers that colours stand for.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// What is shown, without its unit.
    pub title: String,
    /// Its unit; empty if it has none.
    pub unit: String,
    /// What the lowest colour stands for, and all below.
    pub low: f64,
    /// What the highest colour stands for, and all above.
    pub high: f64,
    /// Whether values below `low` or above `high` occur: the ticks at the ends then say so.
    pub beyond: [bool; 2],
}

impl Scale {
    /// Where a value lies between the ends, in [0, 1].
    pub fn share(&self, value: f64) -> f64 {
        let span = self.high - self.low;
        if span > 0.0 { ((value - self.low) / span).clamp(0.0, 1.0) } else { 0.5 }
    }

    /// The same scale with its ends moved outward to round numbers; a scale without length gets some.
    pub fn rounded(&self) -> Self {
        let (mut low, mut high) = (self.low, self.high);
        if high - low <= 1e-9 * high.abs().max(low.abs()) {
            let half = if low == 0.0 { 0.5 } else { 0.05 * low.abs() };
            (low, high) = (low - half, high + half);
        }
        let step = step(high - low) / 2.0;
        Self {
            low: (low / step + 1e-6).floor() * step,
            high: (high / step - 1e-6).ceil() * step,
            ..self.clone()
        }
    }

    /// Ticks: where each lies, in [0, 1], and its number.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let span = self.high - self.low;
        if !(span.is_finite() && span > 0.0) {
            return vec![(0.5, number(self.low, 3))];
        }
        let step = step(span);
        let digits = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
        let (first, last) =
            ((self.low / step - 1e-6).ceil() as i64, (self.high / step + 1e-6).floor() as i64);
        (first..=last)
            .map(|k| {
                let value = k as f64 * step;
                let share = self.share(value);
                let sign = match (share, self.beyond) {
                    (s, [true, _]) if s < 1e-6 => "≤ ",
                    (s, [_, true]) if s > 1.0 - 1e-6 => "≥ ",
                    _ => "",
                };
                (share, format!("{sign}{}", number(value, digits)))
            })
            .collect()
    }

    fn heading(&self) -> String {
        if self.unit.is_empty() { self.title.clone() } else { format!("{} [{}]", self.title, self.unit) }
    }
}

/// 1, 2 or 5 times a power of ten, for four to nine steps over a span.
fn step(span: f64) -> f64 {
    let rough = span / 5.0;
    let power = 10.0_f64.powf(rough.log10().floor());
    match rough / power {
        m if m < 1.5 => power,
        m if m < 3.5 => 2.0 * power,
        m if m < 7.5 => 5.0 * power,
        _ => 10.0 * power,
    }
}

fn number(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let text = if text.trim_start_matches(['-', '0', '.']).is_empty() { text.replace('-', "") } else { text };
    text.replace('-', "−")
}

impl Legend {
    /// Width that the legend takes at the right of a picture of this height [pixels].
    pub fn width(&self, height: u32) -> u32 {
        let pen = Pen::new(text_size(height));
        let inner = match self {
            Self::Scale(scale) => {
                let ticks = scale.ticks().iter().map(|(_, text)| pen.width(text)).fold(0.0, f32::max);
                (bar_width(height) + tick_length(height) * 2.0 + ticks).max(pen.width(&scale.heading()))
            }
            Self::Names(names) => {
                let widest = names.iter().map(|(name, _)| pen.width(name)).fold(0.0, f32::max);
                text_size(height) * 1.2 + widest
            }
        };
        (inner + 2.0 * text_size(height)).ceil() as u32
    }

    /// Draws the legend at the right of a picture.
    pub fn draw(&self, picture: &mut Picture) {
        let height = picture.height;
        let size = text_size(height);
        let pen = Pen::new(size);
        let left = picture.width as f32 - self.width(height) as f32 + size;
        match self {
            Self::Scale(scale) => {
                let (top, bottom) = ((height as f32 * 0.2).round(), (height as f32 * 0.85).round());
                let (x, width) = (left.round() as i64, bar_width(height).round() as i64);
                pen.write(picture, left, top - 1.6 * size, INK, &scale.heading());
                for y in top as i64..=bottom as i64 {
                    let t = 1.0 - (y as f64 - f64::from(top)) / f64::from(bottom - top);
                    let color = viridis(t).map(|c| (c * 255.0).round() as u8);
                    picture.fill([x, y], [width, 1], color);
                }
                for (t, text) in scale.ticks() {
                    let y = bottom + (top - bottom) * t as f32;
                    let length = tick_length(height).round() as i64;
                    let thick = (height as i64 / 500).max(1);
                    picture.fill([x + width, y.round() as i64 - thick / 2], [length, thick], INK);
                    let start = left + width as f32 + 2.0 * tick_length(height);
                    pen.write(picture, start, y, INK, &text);
                }
            }
            Self::Names(names) => {
                let pitch = (1.7 * size).min(0.8 * height as f32 / names.len().max(1) as f32);
                let first = (height as f32 - pitch * (names.len() as f32 - 1.0)) / 2.0;
                for (k, (name, color)) in names.iter().enumerate() {
                    let y = first + pitch * k as f32;
                    let side = (0.8 * size).round() as i64;
                    picture.fill([left.round() as i64, y.round() as i64 - side / 2], [side, side], *color);
                    pen.write(picture, left + 1.2 * size, y, INK, name);
                }
            }
        }
    }
}

fn text_size(height: u32) -> f32 {
    (height as f32 / 32.0).max(12.0)
}

fn bar_width(height: u32) -> f32 {
    (height as f32 / 36.0).max(8.0)
}

fn tick_length(height: u32) -> f32 {
    (height as f32 / 120.0).max(4.0)
}

#[cfg(test)]
mod tests {
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
        for (low, high) in [(0.013, 0.87), (1.0, 1.137), (-3.2, 911.0), (2.0, 2.0), (0.0, 0.0), (1e-9, 2e-9)]
        {
            let s = scale(low, high).rounded();
            assert!(s.low <= low && s.high >= high && s.low < s.high, "{s:?}");
            assert!(s.high - s.low <= 1.45 * (high - low) || high == low, "{s:?}");
            let ticks = s.ticks();
            assert!((3..=12).contains(&ticks.len()), "{ticks:?}");
            assert!(ticks.windows(2).all(|pair| pair[0].0 < pair[1].0));
        }
    }

    /// The bar shows at each height the colour that the number there has.
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
        // Nothing reaches the picture's edge nor leaves the legend's own strip.
        let strip = 400 - legend.width(320);
        for y in 0..320 {
            assert!((0..strip).chain([399]).all(|x| picture.at(x, y) == [255; 3]), "row {y}");
        }
    }

    #[test]
    fn names_stand_beside_their_colours() {
        let legend = Legend::Names(vec![("cloth".to_owned(), [200, 0, 0]), ("ball".to_owned(), [0, 0, 200])]);
        let mut picture = Picture::new(300, 200, [255; 3]);
        legend.draw(&mut picture);
        let count = |color| picture.pixels.iter().filter(|p| **p == color).count();
        assert_eq!(count([200, 0, 0]), count([0, 0, 200]));
        assert!(count([200, 0, 0]) >= 64);
    }
}
