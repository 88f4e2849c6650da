//! Axes: the map from values to pixels, and the ticks.

/// How values are spread along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    #[default]
    Linear,
    Log,
}

/// An axis in use: values from `low` to `high` over pixels from `start` to `end`.
#[derive(Clone, Copy, Debug)]
pub struct Mapping {
    scale: Scale,
    low: f64,
    high: f64,
    start: f64,
    end: f64,
}

impl Mapping {
    /// An axis that shows all of `values` that it can show, with a margin. A linear axis of non-negative
    /// values begins at 0.
    pub fn new(scale: Scale, values: impl Iterator<Item = f64>, [start, end]: [f64; 2]) -> Self {
        let inside = |v: &f64| v.is_finite() && (scale == Scale::Linear || *v > 0.0);
        let (low, high) = values
            .map(|v| if inside(&v) { transform(scale, v) } else { f64::NAN })
            .filter(|v| v.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        let margin = match high - low {
            0.0 => 0.5,
            range => 0.06 * range,
        };
        let bottom = if scale == Scale::Linear && low >= 0.0 { 0.0 } else { low - margin };
        Self { scale, low: bottom, high: high + margin, start, end }
    }

    /// The pixel of a value; none if the axis cannot show it.
    pub fn place(&self, value: f64) -> Option<f64> {
        if !value.is_finite() || (self.scale == Scale::Log && value <= 0.0) {
            return None;
        }
        let share = (transform(self.scale, value) - self.low) / (self.high - self.low);
        Some(self.start + share * (self.end - self.start))
    }

    /// Values with a tick, and their labels.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let values = match self.scale {
            Scale::Linear => linear_ticks(self.low, self.high),
            Scale::Log => log_ticks(self.low, self.high),
        };
        values.into_iter().map(|v| (v, label(v))).collect()
    }
}

fn transform(scale: Scale, value: f64) -> f64 {
    match scale {
        Scale::Linear => value,
        Scale::Log => value.log10(),
    }
}

/// Multiples of 1, 2 or 5 times a power of ten, four to eight of them.
fn linear_ticks(low: f64, high: f64) -> Vec<f64> {
    let rough = (high - low) / 5.0;
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|s| *s >= rough).unwrap_or(power);
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    (first..=last).map(|k| k as f64 * step).collect()
}

/// Powers of ten. If they are few, also 2 and 5 times them; if they are many, every second one or fewer.
fn log_ticks(low: f64, high: f64) -> Vec<f64> {
    let (first, last) = (low.floor() as i32, high.ceil() as i32);
    let inside = |v: f64| (low..=high).contains(&v.log10());
    let powers: Vec<f64> = (first..=last).map(|p| 10f64.powi(p)).filter(|v| inside(*v)).collect();
    match powers.len() {
        0..=2 => {
            let multiples: &[f64] =
                if high - low < 0.8 { &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0] } else { &[1.0, 2.0, 5.0] };
            let finer = |p: i32| multiples.iter().map(move |m| m * 10f64.powi(p));
            (first..=last).flat_map(finer).filter(|v| inside(*v)).collect()
        }
        3..=8 => powers,
        n => powers.into_iter().step_by(n.div_ceil(8)).collect(),
    }
}

fn label(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        return "0".to_owned();
    }
    if (1e-3..1e5).contains(&size) {
        // Two significant digits, without zeros at the end.
        let digits = (1 - size.log10().floor() as i32).max(0) as usize;
        let text = format!("{value:.digits$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    } else {
        format!("{value:.0e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        let labels = |scale, values: [f64; 2]| -> Vec<String> {
            Mapping::new(scale, values.into_iter(), [0.0, 1.0]).ticks().into_iter().map(|t| t.1).collect()
        };
        assert_eq!(labels(Scale::Linear, [0.0, 10.0]), ["0", "5", "10"]);
        assert_eq!(labels(Scale::Linear, [-1.0, 1.2]), ["-1", "-0.5", "0", "0.5", "1"]);
        assert_eq!(labels(Scale::Log, [0.002, 3.0]), ["0.01", "0.1", "1"]);
        assert_eq!(labels(Scale::Log, [2.1, 40.0]), ["2", "5", "10", "20"]);
        assert_eq!(labels(Scale::Log, [0.02, 0.05]), ["0.02", "0.03", "0.04", "0.05"]);
        assert_eq!(labels(Scale::Log, [1e-6, 1e-4]), ["1e-6", "1e-5", "1e-4"]);
    }

    #[test]
    fn places_are_in_proportion() {
        let axis = Mapping::new(Scale::Log, [1.0, 100.0].into_iter(), [0.0, 112.0]);
        assert!((axis.place(10.0).unwrap_or(f64::NAN) - 56.0).abs() < 1e-9);
        assert_eq!((axis.place(0.0), axis.place(f64::NAN)), (None, None));
        let nothing = Mapping::new(Scale::Log, std::iter::empty(), [0.0, 100.0]);
        assert!(nothing.place(1.0).is_some());
    }
}
