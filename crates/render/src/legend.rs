//! The legend of a picture: a bar with ticks, or a name beside each color.

use crate::Picture;
use crate::colormap::viridis;
use crate::palette::INK;
use crate::text::Pen;

/// The meaning of colors.
#[derive(Clone, Debug, PartialEq)]
pub enum Legend {
    /// Colors show numbers.
    Scale(Scale),
    /// Colors show named things.
    Names(Vec<(String, [u8; 3])>),
}

/// A scale of numbers that are shown by colors.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// Name of the quantity.
    pub title: String,
    /// Its unit; empty for a pure number.
    pub unit: String,
    /// The number that the first color shows; smaller numbers have the same color.
    pub low: f64,
    /// The number that the last color shows; larger numbers have the same color.
    pub high: f64,
    /// Whether numbers below `low`, and above `high`, occur. The ticks at the ends then show ≤ and ≥.
    pub beyond: [bool; 2],
}

impl Scale {
    /// Position of a value on the scale, from 0 at `low` to 1 at `high`.
    pub fn share(&self, value: f64) -> f64 {
        let span = self.high - self.low;
        if span > 0.0 { ((value - self.low) / span).clamp(0.0, 1.0) } else { 0.5 }
    }

    /// This scale with its ends moved outward to round numbers. A scale of length 0 is lengthened first.
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

    /// The ticks: their positions in [0, 1] and their labels.
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

/// A step of 1, 2 or 5 times a power of ten that divides the span into four to nine parts.
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
    /// Width of the legend at the right of a picture of this height [pixels].
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
mod tests;
