//! Areas, volumes and lengths of elements.

use bowknot_geometry::Vector;

/// Area of a triangle [m^2].
pub(crate) fn area(corners: &[Vector; 3]) -> f64 {
    0.5 * (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm()
}

/// Signed volume of a tetrahedron [m^3].
pub(crate) fn volume(corners: &[Vector; 4]) -> f64 {
    let edge = |k: usize| corners[k] - corners[0];
    edge(1).cross(&edge(2)).dot(&edge(3)) / 6.0
}

/// The largest distance between two corners [m].
pub(crate) fn longest_edge(corners: &[Vector]) -> f64 {
    let lengths =
        corners.iter().enumerate().flat_map(|(k, a)| corners[..k].iter().map(move |b| (a - b).norm()));
    lengths.fold(0.0, f64::max)
}
