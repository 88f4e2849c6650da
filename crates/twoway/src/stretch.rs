//! How far edges are stretched at the end of a call, whether they have a limit or not.

use crate::scene::CollisionScene;
use bowknot_geometry::Point;
use rayon::prelude::*;

/// Edges that one task looks at.
const CHUNK: usize = 4096;

/// Ratios to both references; none where no edge has a length.
type Ratios = [Option<f64>; 2];

/// Largest ratios of the length of a deformable body's edge at `end` to its lengths in two `references`; 1
/// where no edge has a length.
pub fn max_stretch(scene: &CollisionScene, references: [&[Point]; 2], end: &[Point]) -> [f64; 2] {
    let model = scene.model();
    let ratios = |&[a, b]: &[u32; 2]| -> Ratios {
        if model.is_obstacle(a) && model.is_obstacle(b) {
            return [None; 2];
        }
        let length = |x: &[Point]| (x[a as usize] - x[b as usize]).norm();
        let now = length(end);
        references.map(|reference| {
            let before = length(reference);
            (before > 0.0).then(|| (now / before).max(0.0))
        })
    };
    let larger = |a: Option<f64>, b: Option<f64>| a.map_or(b, |a| Some(a.max(b.unwrap_or(0.0))));
    let both = |a: Ratios, b: Ratios| [larger(a[0], b[0]), larger(a[1], b[1])];
    let edges = &model.topology().edges;
    let largest = match edges.len() {
        // A parallel loop would pay for the way to its threads.
        ..=CHUNK => edges.iter().map(ratios).fold([None; 2], both),
        _ => edges.par_iter().with_min_len(CHUNK).map(ratios).reduce(|| [None; 2], both),
    };
    largest.map(|ratio| ratio.unwrap_or(1.0))
}
