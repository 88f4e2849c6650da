//! A point in the local frame of a tree, between two numbers of `f32`.

use crate::frame::MAX_COORDINATE;
use bowknot_geometry::Point;
use bowknot_geometry::bounds::{round_down_f32, round_up_f32};

/// A box of `f32` that certainly contains the point; `None` for one that is not finite or beyond 1e15 m.
pub fn local_box(point: &Point, origin: &Point) -> Option<[[f32; 3]; 2]> {
    let local = [0, 1, 2].map(|k: usize| point[k] - origin[k]);
    // The difference is off by half a unit of `f64`; one unit of `f32` more covers that.
    let box_of = || [local.map(|x| round_down_f32(x).next_down()), local.map(|x| round_up_f32(x).next_up())];
    local.iter().all(|x| x.abs() < MAX_COORDINATE).then(box_of)
}
