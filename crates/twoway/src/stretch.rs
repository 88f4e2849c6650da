//! How far edges are stretched at the end of a call, whether they have a limit or not.

use crate::scene::CollisionScene;
use bowknot_geometry::Point;

/// Largest ratios of the length of a deformable body's edge at `end` to its lengths in two `references`; 1 where
/// no edge has a length.
pub fn max_stretch(scene: &CollisionScene, references: [&[Point]; 2], end: &[Point]) -> [f64; 2] {
    let model = scene.model();
    let mut largest = [None; 2];
    for &[a, b] in &model.topology().edges {
        if model.is_obstacle(a) && model.is_obstacle(b) {
            continue;
        }
        let length = |x: &[Point]| (x[a as usize] - x[b as usize]).norm();
        let now = length(end);
        for (largest, reference) in largest.iter_mut().zip(references) {
            let before = length(reference);
            if before > 0.0 {
                *largest = Some((now / before).max(largest.unwrap_or(0.0)));
            }
        }
    }
    largest.map(|ratio| ratio.unwrap_or(1.0))
}
