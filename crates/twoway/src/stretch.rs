//! How far edges are stretched at the end of a call, whether they have a limit or not.

use crate::scene::CollisionScene;
use bowknot_geometry::Point;

/// Largest ratio of the length of a deformable body's edge at `end` to its length at `start`; 1 if there is no
/// edge with a length at `start`.
pub(crate) fn max_stretch(scene: &CollisionScene, start: &[Point], end: &[Point]) -> f64 {
    let model = scene.model();
    let length = |[a, b]: [u32; 2], x: &[Point]| (x[a as usize] - x[b as usize]).norm();
    let edges = model.topology().edges.iter().filter(|edge| edge.iter().any(|v| !model.is_obstacle(*v)));
    let ratio = |edge: &[u32; 2]| {
        let before = length(*edge, start);
        (before > 0.0).then(|| length(*edge, end) / before)
    };
    edges.filter_map(ratio).reduce(f64::max).unwrap_or(1.0)
}
