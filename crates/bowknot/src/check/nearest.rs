//! The smallest distance of a state, by branch and bound.

use super::primitives::{Scene, closest_points, gather};
use super::{Judge, Nearest, PairClass};
use bowknot_geometry::Point;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Boxes this much nearer than the best distance so far, relatively, are still looked into: covers the
/// rounding of both distances, so that pairs equally near are all seen, by any thread.
const SLACK: f64 = 1.0 - 1e-9;

/// A distance, and whose it is; ordered by distance, then by class and elements.
type Measured = (f64, PairClass, [u32; 2]);

impl Judge {
    /// The closest pair; of equally close ones the first by class and elements.
    pub(super) fn nearest(&self, x: &[Point], scene: &Scene<'_, 1>) -> Option<Nearest> {
        // Bits of non-negative floats are ordered as the floats are.
        let best = AtomicU64::new(f64::INFINITY.to_bits());
        let read_best = || f64::from_bits(best.load(Ordering::Relaxed));
        let best_now = &read_best;
        let best_ref = &best;
        let pairs = scene.all_pairs(
            |a, b| a.distance_squared(b).sqrt() * SLACK <= best_now(),
            |class, elements, sides, found: &mut Vec<Measured>| {
                let distance = closest_points(class, &gather(x, sides)).1;
                let old = best_ref.fetch_min(distance.to_bits(), Ordering::Relaxed);
                if distance <= f64::from_bits(old) {
                    found.push((distance, class, elements));
                }
            },
        );
        let heights = self.vertices.par_iter().filter(|&&v| self.meets_half_spaces(v)).flat_map_iter(|&v| {
            let height = move |h| self.half_space_places([v, h as u32], &x[v as usize]).1;
            (0..self.half_spaces.len()).map(move |h| (height(h), PairClass::VertexHalfSpace, [v, h as u32]))
        });
        let smaller = |a: Measured, b: Measured| match a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))) {
            std::cmp::Ordering::Greater => b,
            _ => a,
        };
        let (_, class, elements) = heights.chain(pairs.into_par_iter()).reduce_with(smaller)?;

        let sides = self.sides(class, elements);
        let (places, distance) = match class {
            PairClass::VertexHalfSpace => self.half_space_places(elements, &x[elements[0] as usize]),
            _ => closest_points(class, &gather(x, sides)),
        };
        let vertices = sides.map(<[u32]>::to_vec);
        Some(Nearest { class, elements, vertices, bodies: self.side_bodies(sides), places, distance })
    }
}
