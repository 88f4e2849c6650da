//! Hanging strands, for tests and examples.

use bowknot_geometry::Point;

/// `count` strands of `nodes` vertices that hang down over `length` [m], with roots on a square grid of
/// `spacing` [m]: positions and edges. The root of strand s is vertex s * nodes.
pub fn strands(count: usize, nodes: usize, length: f64, spacing: f64) -> (Vec<Point>, Vec<[u32; 2]>) {
    let side = (count as f64).sqrt().ceil() as usize;
    let (mut positions, mut edges) = (Vec::new(), Vec::new());
    for s in 0..count {
        for k in 0..nodes {
            let down = length * k as f64 / (nodes - 1) as f64;
            positions.push(Point::new(spacing * (s % side) as f64, spacing * (s / side) as f64, -down));
            if k > 0 {
                let v = (s * nodes + k) as u32;
                edges.push([v - 1, v]);
            }
        }
    }
    (positions, edges)
}
