//! The smallest distance of a state, by branch and bound.

use crate::judge::Judge;
use crate::primitives::{Scene, closest_points, gather};
use crate::report::{Nearest, PairClass};
use crate::tree::{LeafBoxes, MovingBox};
use crate::walk::Keep;
use bowknot_geometry::Point;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Boxes this much nearer than the best distance so far, relatively, are still looked into: covers the
/// rounding of both distances, so that pairs equally near are all seen, by any thread.
const SLACK: f64 = 1.0 - 1e-9;

/// A distance, and whose it is; ordered by distance, then by class and elements.
type Measured = (f64, PairClass, [u32; 2]);

/// Boxes that may hold a pair as near as the nearest so far, whose distance is given by its bits: those
/// of non-negative floats are ordered as the floats are.
struct AsNear(AtomicU64);

impl Keep<1> for AsNear {
    const NARROWS: bool = true;

    #[inline]
    fn keep(&self, a: &MovingBox<1>, b: &MovingBox<1>) -> bool {
        a.distance_squared(b).sqrt() * SLACK <= f64::from_bits(self.0.load(Ordering::Relaxed))
    }

    fn kept(&self, _: &MovingBox<1>, _: &LeafBoxes<1>) -> u32 {
        u32::MAX
    }
}

impl Judge {
    /// The closest pair; of equally close ones the first by class and elements.
    pub(super) fn nearest(&self, x: &[Point], scene: &Scene<1>) -> Option<Nearest> {
        let best = AsNear(AtomicU64::new(f64::INFINITY.to_bits()));
        let best_now = &best.0;
        let pairs = scene.all_pairs(self, &best, |class, elements, sides, found: &mut Vec<Measured>| {
            let distance = closest_points(class, &gather(x, sides)).1;
            let old = best_now.fetch_min(distance.to_bits(), Ordering::Relaxed);
            if distance <= f64::from_bits(old) {
                found.push((distance, class, elements));
            }
        });
        let pairs = pairs.into_par_iter().flatten_iter();
        let heights = self.vertices.par_iter().filter(|&&v| self.meets_half_spaces(v)).flat_map_iter(|&v| {
            let height = move |h| self.half_space_places([v, h as u32], &x[v as usize]).1;
            let planes = (0..self.half_spaces.len()).filter(|&h| !self.half_spaces[h].is_empty());
            planes.map(move |h| (height(h), PairClass::VertexHalfSpace, [v, h as u32]))
        });
        let smaller = |a: Measured, b: Measured| match a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))) {
            std::cmp::Ordering::Greater => b,
            _ => a,
        };
        let (_, class, elements) = heights.chain(pairs).reduce_with(smaller)?;

        let sides = self.sides(class, elements);
        let (places, distance) = self.measured(class, elements, x);
        let vertices = sides.map(<[u32]>::to_vec);
        Some(Nearest { class, elements, vertices, bodies: self.side_bodies(sides), places, distance })
    }
}
