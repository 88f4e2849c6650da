//! The drawing of a chart.

use super::axis::{Mapping, Scale};
use super::data::{Chart, Series, Style};
use super::front::pareto_front;
use super::labels::Placer;
use std::fmt::Write;

const WIDTH: f64 = 860.0;
const HEIGHT: f64 = 470.0;
/// Left, top, right, bottom of the area within the axes [px].
const AREA: [f64; 4] = [72.0, 34.0, 660.0, 416.0];
/// Colors that color-blind readers can tell apart (Okabe and Ito 2008), light ones last.
const COLORS: [&str; 8] =
    ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#e69f00", "#56b4e9", "#8c564b"];
/// Number of shapes of marks. The shape changes when the colors start again.
const SHAPES: usize = 4;

/// The chart as an SVG file.
pub fn svg(chart: &Chart) -> String {
    let marks = || chart.series.iter().flat_map(|series| &series.points);
    let [left, top, right, bottom] = AREA;
    let x = Mapping::new(chart.x.scale, marks().map(|m| m.x), [left, right]);
    // Bars start at zero.
    let foot = chart.series.iter().any(|s| s.style == Style::Bars && chart.y.scale == Scale::Linear);
    let y = Mapping::new(chart.y.scale, marks().map(|m| m.y).chain(foot.then_some(0.0)), [bottom, top]);
    let place = |px: f64, py: f64| Some((x.place(px)?, y.place(py)?));
    let mut out = String::new();
    let mut add = |line: String| {
        out.push_str(&line);
        out.push('\n');
    };
    add(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" \
         height=\"{HEIGHT}\" font-family=\"sans-serif\" font-size=\"12\">"
    ));
    add(format!("<title>{}</title>", escape(&chart.title)));
    add(format!("<rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#ffffff\"/>"));
    add(format!(
        "<text x=\"{left}\" y=\"20\" font-size=\"14\" font-weight=\"bold\">{}</text>",
        escape(&chart.title)
    ));
    axes(chart, &x, &y, &mut add);
    if chart.front {
        front(chart, place, &mut add);
    }
    let bars = chart.series.iter().filter(|s| s.style == Style::Bars).count() as f64;
    for (index, series) in chart.series.iter().enumerate() {
        draw(series, index, place, [bottom, bars], &mut add);
    }
    label(chart, place, &mut add);
    legend(chart, &mut add);
    add("</svg>".to_owned());
    out
}

fn axes(chart: &Chart, x: &Mapping, y: &Mapping, add: &mut impl FnMut(String)) {
    let [left, top, right, bottom] = AREA;
    let names = chart.x.names.iter().enumerate().map(|(k, name)| (k as f64, escape(name)));
    let ticks = if chart.x.names.is_empty() { x.ticks() } else { names.collect() };
    for (value, text) in ticks {
        let Some(at) = x.place(value) else { continue };
        add(format!("<path d=\"M{at:.1} {top}V{bottom}\" stroke=\"#e4e4e4\"/>"));
        add(format!("<text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{text}</text>", bottom + 17.0));
    }
    for (value, text) in y.ticks() {
        let Some(at) = y.place(value) else { continue };
        add(format!("<path d=\"M{left} {at:.1}H{right}\" stroke=\"#e4e4e4\"/>"));
        add(format!("<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{text}</text>", left - 6.0, at + 4.0));
    }
    add(format!("<path d=\"M{left} {top}V{bottom}H{right}\" fill=\"none\" stroke=\"#444444\"/>"));
    let middle = 0.5 * (left + right);
    let label = escape(&chart.x.label);
    add(format!("<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">{label}</text>", bottom + 38.0));
    let middle = 0.5 * (top + bottom);
    let label = escape(&chart.y.label);
    add(format!(
        "<text transform=\"translate(18 {middle}) rotate(-90)\" text-anchor=\"middle\">{label}</text>"
    ));
}

fn front(chart: &Chart, place: impl Fn(f64, f64) -> Option<(f64, f64)>, add: &mut impl FnMut(String)) {
    let points: Vec<(f64, f64)> =
        chart.series.iter().flat_map(|s| &s.points).filter_map(|m| place(m.x, m.y)).collect();
    // On the screen y points down: the front is computed with -y.
    let values: Vec<(f64, f64)> = points.iter().map(|&(x, y)| (x, -y)).collect();
    let front = pareto_front(&values);
    let mut path = String::new();
    for (k, &index) in front.iter().enumerate() {
        let (x, y) = points[index];
        let _ = match k {
            0 => write!(path, "M{x:.1} {y:.1}"),
            // Up to x the smallest error is that of the point before.
            _ => write!(path, "H{x:.1}V{y:.1}"),
        };
    }
    if !path.is_empty() {
        add(format!("<path d=\"{path}\" fill=\"none\" stroke=\"#999999\" stroke-dasharray=\"5 3\"/>"));
    }
}

fn draw(
    series: &Series,
    index: usize,
    place: impl Fn(f64, f64) -> Option<(f64, f64)>,
    [bottom, bars]: [f64; 2],
    add: &mut impl FnMut(String),
) {
    let color = COLORS[index % COLORS.len()];
    let points: Vec<(f64, f64)> = series.points.iter().filter_map(|m| place(m.x, m.y)).collect();
    match series.style {
        Style::Bars => {
            let gaps = points.windows(2).map(|w| (w[1].0 - w[0].0).abs());
            let width = (0.8 / bars * gaps.fold(f64::INFINITY, f64::min)).clamp(2.0, 40.0);
            for (x, y) in points {
                add(format!(
                    "<rect x=\"{:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{:.1}\" fill=\"{color}\" \
                     fill-opacity=\"0.75\"/>",
                    x - width / 2.0,
                    (bottom - y).max(0.0)
                ));
            }
            return;
        }
        Style::Line => {
            let path: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1} {y:.1}")).collect();
            if path.len() > 1 {
                let path = path.join("L");
                add(format!("<path d=\"M{path}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"1.5\"/>"));
            }
        }
        Style::Marks => {}
    }
    for (x, y) in points {
        add(mark(index, x, y));
    }
}

/// A mark in the color and shape of a series.
fn mark(index: usize, x: f64, y: f64) -> String {
    let color = COLORS[index % COLORS.len()];
    match index / COLORS.len() % SHAPES {
        0 => format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.6\" fill=\"{color}\"/>"),
        1 => format!(
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"7\" height=\"7\" fill=\"{color}\"/>",
            x - 3.5,
            y - 3.5
        ),
        2 => format!("<path d=\"M{x:.1} {:.1}l4.5 8h-9z\" fill=\"{color}\"/>", y - 5.0),
        _ => format!("<path d=\"M{x:.1} {:.1}l5 5l-5 5l-5 -5z\" fill=\"{color}\"/>", y - 5.0),
    }
}

fn label(chart: &Chart, place: impl Fn(f64, f64) -> Option<(f64, f64)>, add: &mut impl FnMut(String)) {
    let marks = || chart.series.iter().enumerate().flat_map(|(k, s)| s.points.iter().map(move |m| (k, m)));
    let points: Vec<(f64, f64)> = marks().filter_map(|(_, m)| place(m.x, m.y)).collect();
    let [left, top, right, bottom] = AREA;
    let mut placer = Placer::new([left, top, right, bottom], &points);
    for (index, mark) in marks().filter(|(_, m)| !m.label.is_empty()) {
        let Some(point) = place(mark.x, mark.y) else { continue };
        if let Some(anchor) = placer.place(point, &mark.label) {
            add(format!(
                "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"10\" fill=\"{}\">{}</text>",
                anchor.x,
                anchor.y,
                COLORS[index % COLORS.len()],
                escape(&mark.label)
            ));
        }
    }
}

fn legend(chart: &Chart, add: &mut impl FnMut(String)) {
    let [_, top, right, _] = AREA;
    let mut y = top + 6.0;
    let named = chart.series.iter().enumerate().filter(|(_, s)| !s.name.is_empty());
    for (index, series) in named {
        add(mark(index, right + 16.0, y));
        add(format!("<text x=\"{}\" y=\"{:.1}\">{}</text>", right + 28.0, y + 4.0, escape(&series.name)));
        y += 18.0;
    }
    if chart.front {
        let from = right + 8.0;
        add(format!("<path d=\"M{from} {y:.1}h16\" stroke=\"#999999\" stroke-dasharray=\"5 3\"/>"));
        add(format!("<text x=\"{}\" y=\"{:.1}\">best for its time</text>", right + 28.0, y + 4.0));
    }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests;
