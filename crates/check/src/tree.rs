//! The judge's broad phase: a balanced binary tree over boxes, walked against another tree.
//!
//! A box is given at `K` instants: one for a state; two, start and end, for a path. Between the two,
//! all vertices move linearly in one path time, so a vertex stays within the linear interpolation of its
//! boxes, and two boxes that are apart along one axis, on the same side, at both instants are apart
//! along it all the way. Common motion hence costs nothing, however fast.
//!
//! **A tree is an order of primitives, and boxes fitted to it.** Boxes are computed from the positions
//! at hand whenever these change, so the pairs that a walk comes to are right with any order; a good one
//! ([`arrange`]) only makes the walk short. An order may hence be kept while things move.
//!
//! **Rounding.** Boxes are minima and maxima of coordinates rounded to `f32`: half the memory to move,
//! four lanes to a register. Rounding to nearest and clamping are monotone, so of two coordinates whose
//! images differ, the order is that of the images: boxes that are apart as stored are apart.

use bowknot_geometry::Point;
use rayon::prelude::*;
use wide::{f32x4, f32x8};

/// Flag of primitives that belong to an obstacle; two flagged primitives form no pair.
pub(super) const OBSTACLE: u8 = 1;
/// Flag of primitives that do not move; two flagged primitives form no pair.
pub(super) const STILL: u8 = 2;

/// Primitives a leaf holds at most.
const LEAF_SIZE: usize = 8;
/// Slices longer than this are split by two threads.
const PARALLEL_SPLIT: usize = 8192;
/// Boxes that one thread fits at least.
const PARALLEL_FIT: usize = 1024;
/// Coordinates are clamped to this, so that no difference of two overflows [m].
const LARGEST: f64 = 1e37;
/// Relative bound of the rounding of a coordinate to `f32`, doubled, and an absolute one for those that
/// underflow.
const COORDINATE_ROUNDING: [f64; 2] = [f32::EPSILON as f64, 1e-44];

/// An axis-aligned box at `K` instants; the fourth lane is zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingBox<const K: usize> {
    min: [[f32; 4]; K],
    max: [[f32; 4]; K],
}

impl<const K: usize> MovingBox<K> {
    const EMPTY: Self = {
        let (low, high) = (-(LARGEST as f32), LARGEST as f32);
        Self { min: [[high, high, high, 0.0]; K], max: [[low, low, low, 0.0]; K] }
    };

    /// The box of some points, each given at every instant.
    pub fn of_points<'a>(points: impl Iterator<Item = [&'a Point; K]>) -> Self {
        let mut hull = Self::EMPTY;
        for point in points {
            for k in 0..K {
                for c in 0..3 {
                    let coordinate = point[k][c].clamp(-LARGEST, LARGEST) as f32;
                    hull.min[k][c] = smaller(hull.min[k][c], coordinate);
                    hull.max[k][c] = larger(hull.max[k][c], coordinate);
                }
            }
        }
        hull
    }

    fn join(&mut self, other: &Self) {
        for k in 0..K {
            for c in 0..4 {
                self.min[k][c] = smaller(self.min[k][c], other.min[k][c]);
                self.max[k][c] = larger(self.max[k][c], other.max[k][c]);
            }
        }
    }

    /// Whether the boxes may share a point at some time. Touching boxes do.
    #[inline(always)]
    pub fn meets(&self, other: &Self) -> bool {
        // By coordinates, at some instant: whether self reaches up to other, and other up to self. Not: apart
        // on that side all the way.
        let (mut up, mut down) = (f32x4::ZERO, f32x4::ZERO);
        for k in 0..K {
            up |= f32x4::from(self.max[k]).simd_ge(f32x4::from(other.min[k]));
            down |= f32x4::from(other.max[k]).simd_ge(f32x4::from(self.min[k]));
        }
        (up & down).all()
    }

    /// A lower bound of the squared distance, at the first instant, of what the boxes hold.
    #[inline]
    pub fn distance_squared(&self, other: &Self) -> f64 {
        let mut sum = 0.0;
        for c in 0..3 {
            let gap = |low: f32, high: f32| {
                let (low, high) = (f64::from(low), f64::from(high));
                let [relative, absolute] = COORDINATE_ROUNDING;
                high - low - relative * (high.abs() + low.abs()) - absolute
            };
            let apart = gap(self.max[0][c], other.min[0][c]).max(gap(other.max[0][c], self.min[0][c]));
            sum += apart.max(0.0).powi(2);
        }
        sum
    }
}

/// The boxes of a leaf, coordinate by coordinate: a box is compared with all of them at once, in the lanes of
/// a register.
#[derive(Clone, Copy, Debug)]
pub(super) struct LeafBoxes<const K: usize> {
    min: [[[f32; LEAF_SIZE]; 3]; K],
    max: [[[f32; LEAF_SIZE]; 3]; K],
}

impl<const K: usize> LeafBoxes<K> {
    /// Nothing meets an empty place.
    const EMPTY: Self = {
        let (low, high) = (-(LARGEST as f32), LARGEST as f32);
        Self { min: [[[high; LEAF_SIZE]; 3]; K], max: [[[low; LEAF_SIZE]; 3]; K] }
    };

    fn set(&mut self, place: usize, one: &MovingBox<K>) {
        for k in 0..K {
            for c in 0..3 {
                self.min[k][c][place] = one.min[k][c];
                self.max[k][c][place] = one.max[k][c];
            }
        }
    }

    /// Which of the boxes [meet](MovingBox::meets) another one, a bit each.
    #[inline(always)]
    pub fn meeting(&self, other: &MovingBox<K>) -> u32 {
        let mut meets = f32x8::splat(f32::from_bits(u32::MAX));
        for c in 0..3 {
            let (mut up, mut down) = (f32x8::ZERO, f32x8::ZERO);
            for k in 0..K {
                up |= f32x8::from(self.max[k][c]).simd_ge(f32x8::splat(other.min[k][c]));
                down |= f32x8::splat(other.max[k][c]).simd_ge(f32x8::from(self.min[k][c]));
            }
            meets &= up & down;
        }
        meets.to_bitmask()
    }
}

/// Minimum and maximum of numbers: one instruction each, where `f32::min` cares for NaN as well.
#[inline]
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// A tree over the boxes of primitives.
#[derive(Debug)]
pub(super) struct Tree<const K: usize> {
    /// Nodes in heap order: the children of node i are 2i + 1 and 2i + 2.
    pub nodes: Vec<MovingBox<K>>,
    /// Flags that all primitives below a node have.
    pub node_flags: Vec<u8>,
    /// Number of levels above the leaves.
    depth: u32,
    /// Boxes of the primitives, in their order, and again by leaf.
    pub boxes: Vec<MovingBox<K>>,
    leaves: Vec<LeafBoxes<K>>,
    /// Their flags.
    pub flags: Vec<u8>,
}

impl<const K: usize> Tree<K> {
    /// A tree over so many primitives, all of them empty.
    pub fn new(count: usize) -> Self {
        let depth = depth(count);
        let nodes = (2usize << depth) - 1;
        Self {
            nodes: vec![MovingBox::EMPTY; nodes],
            node_flags: vec![0; nodes],
            depth,
            boxes: vec![MovingBox::EMPTY; count],
            leaves: vec![LeafBoxes::EMPTY; 1 << depth],
            flags: vec![0; count],
        }
    }

    /// Fits the boxes: `primitive(slot)` says box and flags of the primitive at each place of the order.
    pub fn fit(&mut self, primitive: impl Fn(usize) -> (MovingBox<K>, u8) + Sync) {
        let Self { nodes, node_flags, depth, boxes, leaves, flags } = self;
        let slots = boxes.par_iter_mut().zip(flags.par_iter_mut()).with_min_len(PARALLEL_FIT);
        slots.enumerate().for_each(|(slot, (place, flag))| (*place, *flag) = primitive(slot));

        let first_leaf = (1usize << *depth) - 1;
        let leaf_nodes = nodes[first_leaf..].par_iter_mut().zip(&mut node_flags[first_leaf..]).zip(leaves);
        leaf_nodes.with_min_len(PARALLEL_FIT).enumerate().for_each(|(leaf, ((node, flag), own))| {
            (*node, *flag) = (MovingBox::EMPTY, u8::MAX);
            for (place, slot) in leaf_slots(boxes.len(), leaf, *depth).enumerate() {
                node.join(&boxes[slot]);
                own.set(place, &boxes[slot]);
                *flag &= flags[slot];
            }
        });
        for level in (0..*depth).rev() {
            let first = (1usize << level) - 1;
            let (upper, lower) = nodes.split_at_mut(2 * first + 1);
            let (upper_flags, lower_flags) = node_flags.split_at_mut(2 * first + 1);
            let parents = upper[first..].par_iter_mut().zip(&mut upper_flags[first..]);
            parents.with_min_len(PARALLEL_FIT).enumerate().for_each(|(i, (node, flag))| {
                *node = lower[2 * i];
                node.join(&lower[2 * i + 1]);
                *flag = lower_flags[2 * i] & lower_flags[2 * i + 1];
            });
        }
    }

    pub fn is_leaf(&self, node: u32) -> bool {
        node as usize >= (1 << self.depth) - 1
    }

    pub fn slots(&self, node: u32) -> std::ops::Range<usize> {
        leaf_slots(self.boxes.len(), self.leaf(node), self.depth)
    }

    /// The boxes of a leaf, in the order of its [slots](Self::slots).
    pub fn leaf_boxes(&self, node: u32) -> &LeafBoxes<K> {
        &self.leaves[self.leaf(node)]
    }

    /// Number of a node that is a leaf.
    fn leaf(&self, node: u32) -> usize {
        node as usize - ((1 << self.depth) - 1)
    }
}

/// Levels above the leaves of a tree over so many primitives.
fn depth(count: usize) -> u32 {
    let mut depth = 0;
    while count > LEAF_SIZE << depth {
        depth += 1;
    }
    depth
}

/// First slot of a leaf: the slots are shared out evenly.
fn leaf_start(count: usize, leaf: usize, depth: u32) -> usize {
    // Both are below 2^32.
    ((count as u64 * leaf as u64) >> depth) as usize
}

fn leaf_slots(count: usize, leaf: usize, depth: u32) -> std::ops::Range<usize> {
    leaf_start(count, leaf, depth)..leaf_start(count, leaf + 1, depth)
}

/// What is put in order: where it is, and a number of its own that decides between equals.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item<T> {
    pub center: [f64; 3],
    pub number: u32,
    pub content: T,
}

/// Sorts items so that a [`Tree`] over them, in this order, has small boxes.
pub(super) fn arrange<T: Send>(items: &mut [Item<T>]) {
    let count = items.len();
    split(items, 0, count, 0, 0, depth(count));
}

/// Sorts `items`, which start at slot `start` of `count`, into the leaves below the node at `index`
/// of `level`, halving along the axis along which their centers spread most.
fn split<T: Send>(items: &mut [Item<T>], start: usize, count: usize, level: u32, index: usize, depth: u32) {
    if level == depth {
        return;
    }
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for item in items.iter() {
        for c in 0..3 {
            low[c] = low[c].min(item.center[c]);
            high[c] = high[c].max(item.center[c]);
        }
    }
    let axis = (0..3).fold(0, |best, c| if high[c] - low[c] > high[best] - low[best] { c } else { best });
    let middle = leaf_start(count, 2 * index + 1, level + 1) - start;
    if middle < items.len() {
        items.select_nth_unstable_by(middle, |a, b| {
            a.center[axis].total_cmp(&b.center[axis]).then(a.number.cmp(&b.number))
        });
    }
    let (left, right) = items.split_at_mut(middle);
    let (level, left_index, right_start) = (level + 1, 2 * index, start + middle);
    if left.len() > PARALLEL_SPLIT {
        rayon::join(
            || split(left, start, count, level, left_index, depth),
            || split(right, right_start, count, level, left_index + 1, depth),
        );
    } else {
        split(left, start, count, level, left_index, depth);
        split(right, right_start, count, level, left_index + 1, depth);
    }
}
