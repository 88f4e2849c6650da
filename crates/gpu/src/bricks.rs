//! Contact rows by bricks of space, so that many workgroups sweep them at a time.
//!
//! Four lattices of cubes of side S are shifted against each other by S / 4 along each axis. A row belongs to
//! the first lattice of which one cube, its brick, holds all of its vertices that move, as they are at the
//! start of the step. Bricks of one lattice share no point, so rows of different bricks share no vertex that
//! moves, and all bricks of a lattice are swept at the same time.
//!
//! A row whose vertices lie within S / 4 along each axis has a brick: the faces of all lattices across an
//! axis are S / 4 apart, so at most one of them cuts the row, and three axes rule out at most three of the
//! four lattices. Rows that have no brick come last, by one workgroup.
//!
//! A bucket holds the rows of all bricks of a lattice with the same hash.

use crate::layout::Vertex;
use std::ops::Range;

/// Lattices: as many as there are axes, and one more.
pub(crate) const LATTICES: usize = 4;

/// Side of a brick, at least, in mean edge lengths of the vertices that move: rows extend over one or two of
/// them.
const SIDE: f32 = 8.0;

/// Most buckets of a lattice: as many workgroups fill a large device.
const MOST_BUCKETS: usize = 512;

/// Scenes with fewer buckets than this are swept by one workgroup: lattices cost dispatches.
const FEWEST_BUCKETS: usize = 8;

/// How contact rows are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Bricks {
    /// Binary logarithm of the side in quanta.
    pub shift: u32,
    /// Buckets of a lattice, a power of two; 0 if all rows are in one bucket.
    pub buckets: u32,
}

impl Bricks {
    /// Those of a scene, with about so many vertices that move by bucket.
    pub fn new(vertices: &[Vertex], vertices_per_bucket: usize) -> Self {
        let moving = || vertices.iter().filter(|vertex| vertex.flags & Vertex::PRESCRIBED == 0);
        let count = moving().count();
        let mean = moving().map(|vertex| f64::from(vertex.edge)).sum::<f64>() / count.max(1) as f64;
        let side = (f64::from(SIDE) * mean).max(1.0);
        let buckets = count / vertices_per_bucket.max(1);
        Self {
            // At least 4, for a quarter of it is a number of quanta; coordinates are below 2^30, and sums
            // with three quarters of it must be below 2^31.
            shift: (side.log2().ceil() as u32).clamp(2, 28),
            buckets: if buckets < FEWEST_BUCKETS {
                0
            } else {
                buckets.next_power_of_two().min(MOST_BUCKETS) as u32
            },
        }
    }

    /// Buckets of all lattices, and that of the rows without a brick.
    pub fn count(&self) -> usize {
        LATTICES * self.buckets as usize + 1
    }

    /// The buckets that are swept at the same time, one range after the other.
    pub fn rounds(&self) -> impl Iterator<Item = Range<u32>> {
        let buckets = self.buckets;
        let end = LATTICES as u32 * buckets;
        let lattices = (0..LATTICES as u32).map(move |lattice| lattice * buckets..(lattice + 1) * buckets);
        lattices.filter(|round| !round.is_empty()).chain(std::iter::once(end..end + 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moving(edges: &[f32]) -> Vec<Vertex> {
        edges.iter().map(|&edge| Vertex { edge, ..Vertex::default() }).collect()
    }

    #[test]
    fn bricks_are_eight_mean_edges_wide_and_buckets_grow_with_the_scene() {
        let bricks = Bricks::new(&moving(&[100.0; 4096]), 128);
        assert_eq!(bricks, Bricks { shift: 10, buckets: 32 });
        assert_eq!(bricks.rounds().collect::<Vec<_>>(), [0..32, 32..64, 64..96, 96..128, 128..129]);
        assert_eq!(bricks.count(), 129);
        let small = Bricks::new(&moving(&[100.0; 1000]), 128);
        assert_eq!((small.buckets, small.count()), (0, 1));
        assert!(small.rounds().eq(std::iter::once(0..1)));
        // Vertices that do not move count for nothing.
        let mut obstacle = moving(&[1e6; 4096]);
        obstacle.iter_mut().for_each(|vertex| vertex.flags = Vertex::PRESCRIBED);
        obstacle.extend(moving(&[100.0; 4096]));
        assert_eq!(Bricks::new(&obstacle, 128), bricks);
    }

    #[test]
    fn bricks_of_extreme_scenes_fit_into_integers() {
        assert_eq!(Bricks::new(&moving(&[1e9; 4096]), 1).shift, 28);
        assert_eq!(Bricks::new(&moving(&[0.0; 4096]), 1), Bricks { shift: 2, buckets: 512 });
        assert_eq!(Bricks::new(&[], 128).buckets, 0);
    }
}
