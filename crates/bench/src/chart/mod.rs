//! Charts as SVG: points and lines over linear or logarithmic axes.

mod axis;
mod data;
mod front;
mod labels;
mod svg;

pub use data::{Axis, Chart, Mark, Series, Style};
pub use front::pareto_front;
pub use svg::svg;
