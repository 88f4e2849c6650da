//! Drawn charts, read as text.

use super::*;
use crate::chart::{Axis, Mark};

fn chart() -> Chart {
    let mark = |x, y, label: &str| Mark { x, y, label: label.to_owned() };
    Chart {
        title: "error & time".to_owned(),
        x: Axis::log("CPU seconds"),
        y: Axis::log("error [mm]"),
        series: vec![
            Series {
                name: "a < b".to_owned(),
                points: vec![mark(1.0, 1.0, "x"), mark(10.0, 0.1, "y"), mark(20.0, 0.0, "not shown")],
                style: Style::Line,
            },
            Series::new("bars", Style::Bars, [(2.0, 0.5), (5.0, 5.0)]),
        ],
        front: true,
    }
}

#[test]
fn charts_show_what_they_can_and_escape_the_rest() {
    let text = svg(&chart());
    assert!(text.starts_with("<svg") && text.ends_with("</svg>\n"));
    assert!(text.contains("error &amp; time") && text.contains("a &lt; b"));
    assert_eq!(text.matches("<circle").count(), 2 + 2, "two marks, one key for each series");
    assert!(!text.contains("not shown") && !text.contains("NaN"));
}

/// The front goes down in steps from the fastest to the most exact point.
#[test]
fn the_front_goes_through_the_best_points() {
    let text = svg(&chart());
    let dashed: Vec<&str> = text.lines().filter(|l| l.contains("stroke-dasharray")).collect();
    assert_eq!(dashed.len(), 2, "the front and its key");
    assert_eq!(dashed[0].matches('H').count(), 2, "{}", dashed[0]);
}
