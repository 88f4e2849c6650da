//! What a chart shows.

use super::axis::Scale;

/// A chart.
#[derive(Clone, Debug, Default)]
pub struct Chart {
    /// What it shows; also the text for readers who do not see it.
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub series: Vec<Series>,
    /// Whether the points that no other point beats on both axes, smaller being better, are joined by a line.
    pub front: bool,
}

/// An axis.
#[derive(Clone, Debug, Default)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    pub scale: Scale,
    /// Labels at 0, 1, 2, .. in place of numbers; empty: numbers.
    pub names: Vec<String>,
}

/// Points that belong together.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    pub points: Vec<Mark>,
    pub style: Style,
}

/// A point of a chart. Points that are not finite, or not positive on a logarithmic axis, are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mark {
    pub x: f64,
    pub y: f64,
    /// The label beside it; empty: none.
    pub label: String,
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// Marks alone.
    #[default]
    Marks,
    /// Marks joined by lines.
    Line,
    /// Bars from the axis up, as wide as the distance between neighbors allows.
    Bars,
}

impl Axis {
    pub fn linear(label: &str) -> Self {
        Self { label: label.to_owned(), scale: Scale::Linear, names: Vec::new() }
    }

    /// Names at 0, 1, 2, ..
    pub fn classes(label: &str, names: Vec<String>) -> Self {
        Self { label: label.to_owned(), scale: Scale::Linear, names }
    }

    pub fn log(label: &str) -> Self {
        Self { label: label.to_owned(), scale: Scale::Log, names: Vec::new() }
    }
}

impl Series {
    /// Points without labels.
    pub fn new(name: &str, style: Style, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let points = points.into_iter().map(|(x, y)| Mark { x, y, label: String::new() }).collect();
        Self { name: name.to_owned(), points, style }
    }
}
