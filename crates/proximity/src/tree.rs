//! A packed implicit 16-ary tree of boxes over elements of `V` vertices.
//!
//! Elements stand in a spatial order; each 16 of them make a leaf, each 16 leaves a node, and so on:
//! the children of node i of a level are 16 i .. 16 i + 15 of the level below, without pointers. A
//! node holds the boxes of its 16 children side by side, so that one box meets all in a few vector
//! instructions. When things move the order stays and the boxes are refitted; a stale order costs
//! some time and no correctness, and is redone when the leaves have grown.
//!
//! **Rounding.** With u = 2^-24, local coordinates x and radii r are off by u|x| and u r (see
//! [`crate::frame`]). Let m be the largest |x| of an element. A box bound x - r as computed is off by
//! at most u m + u r + u (m + r), and moving it outward by 8 u (m + r) rounds once more: the
//! inflated box is contained for certain, with f32 rounding to spare for underflow by 1e-30 m.

use crate::frame::{LocalVertex, UNIT};
use crate::order::{Centre, kd_order};
use rayon::prelude::*;

/// Children of a node, elements of a leaf.
pub const LANES: usize = 16;

/// Leaves that one task refits.
const REFIT_CHUNK: usize = 64;

/// Growth of the leaves' boxes at which the order is redone.
const STALE: f64 = 1.4;

/// Sixteen boxes [m], local coordinates. Lanes without a box are empty: +inf .. -inf.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Node {
    pub low: [[f32; LANES]; 3],
    pub high: [[f32; LANES]; 3],
}

impl Node {
    const EMPTY: Self = Self { low: [[f32::INFINITY; LANES]; 3], high: [[f32::NEG_INFINITY; LANES]; 3] };

    /// The box of one lane: low and high corner.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> [[f32; 3]; 2] {
        [0, 1].map(|side| {
            let corner = if side == 0 { &self.low } else { &self.high };
            [corner[0][lane], corner[1][lane], corner[2][lane]]
        })
    }

    #[inline(always)]
    fn set_lane(&mut self, lane: usize, [low, high]: [[f32; 3]; 2]) {
        for k in 0..3 {
            self.low[k][lane] = low[k];
            self.high[k][lane] = high[k];
        }
    }

    /// The box around all lanes.
    #[inline(always)]
    pub fn bounds(&self) -> [[f32; 3]; 2] {
        let mut bounds = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
        for k in 0..3 {
            bounds[0][k] = self.low[k].iter().fold(f32::INFINITY, |m, &x| least(m, x));
            bounds[1][k] = self.high[k].iter().fold(f32::NEG_INFINITY, |m, &x| greatest(m, x));
        }
        bounds
    }
}

/// What the distance test needs of an element. In one place each, not side by side as the boxes are:
/// the test picks single elements of many leaves.
#[derive(Clone, Copy, Debug)]
pub struct Row<const V: usize> {
    /// Local coordinates of the vertices [m].
    pub positions: [[f32; 3]; V],
    /// Radius plus the slack that certifies a rejection [m], see [`crate::kinds`].
    pub reject: f32,
    /// Radius less the slack that certifies a pair's nearness [m].
    pub accept: f32,
}

/// What is known of the sixteen elements of a leaf, beside their boxes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Leaf<const V: usize> {
    /// Indices of the elements; `u32::MAX` in lanes without one.
    pub elements: [u32; LANES],
    /// Their vertices; `u32::MAX` in lanes without an element.
    pub vertices: [[u32; LANES]; V],
    pub rows: [Row<V>; LANES],
    /// Largest index of an element.
    pub last_element: u32,
    /// Sum of the sides of the box of all vertices, radii left out [m].
    extent: f32,
}

impl<const V: usize> Leaf<V> {
    const EMPTY: Self = Self {
        elements: [u32::MAX; LANES],
        vertices: [[u32::MAX; LANES]; V],
        rows: [Row { positions: [[0.0; 3]; V], reject: 0.0, accept: 0.0 }; LANES],
        last_element: 0,
        extent: 0.0,
    };
}

/// The tree. Level 0 holds the elements' boxes, the last level is the root alone; there are at
/// least two levels unless the tree is empty.
#[derive(Debug, Default)]
pub struct Tree<const V: usize> {
    pub levels: Vec<Vec<Node>>,
    pub leaves: Vec<Leaf<V>>,
    /// Boxes at the start and the end of a sweep; level 0 then holds their hull. Empty when the last
    /// refit was not swept.
    pub sweep: Vec<[Node; 2]>,
    len: usize,
    /// Sum of the leaves' extents when the order was made.
    fresh_extent: f64,
}

impl<const V: usize> Tree<V> {
    /// Whether there is no element.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The box of leaf `index` as a whole.
    #[inline(always)]
    pub fn leaf_bounds(&self, index: usize) -> [[f32; 3]; 2] {
        self.levels[1][index / LANES].lane(index % LANES)
    }

    /// The box of everything.
    pub fn bounds(&self) -> [[f32; 3]; 2] {
        self.levels.last().map_or(Node::EMPTY, |root| root[0]).bounds()
    }

    /// Puts `elements` in spatial order. The boxes are those of a following [`Self::refit`].
    ///
    /// `elements` yields index and vertices of each.
    pub fn build(&mut self, elements: &[(u32, [u32; V])], local: &[LocalVertex]) {
        let mut centres: Vec<Centre> = elements
            .iter()
            .zip(0..)
            .map(|((_, vertices), index)| {
                let mut position = [0.0; 3];
                for k in 0..3 {
                    position[k] = vertices.iter().map(|&v| local[v as usize][k]).sum();
                }
                Centre { position, index }
            })
            .collect();
        kd_order(&mut centres, LANES);

        self.len = elements.len();
        self.leaves.clear();
        self.leaves.extend(centres.chunks(LANES).map(|group| {
            let mut leaf = Leaf::EMPTY;
            for (lane, centre) in group.iter().enumerate() {
                let (element, vertices) = &elements[centre.index as usize];
                leaf.elements[lane] = *element;
                leaf.last_element = leaf.last_element.max(*element);
                for j in 0..V {
                    leaf.vertices[j][lane] = vertices[j];
                }
            }
            leaf
        }));
        self.levels.clear();
        let mut count = self.leaves.len();
        while count > 0 {
            self.levels.push(vec![Node::EMPTY; count]);
            if count == 1 && self.levels.len() > 1 {
                break;
            }
            count = count.div_ceil(LANES);
        }
        self.fresh_extent = f64::NAN;
    }

    /// Index and vertices of each element, in the tree's order.
    pub fn elements(&self) -> Vec<(u32, [u32; V])> {
        let lanes = self.leaves.iter().flat_map(|leaf| {
            (0..LANES).map(move |lane| (leaf.elements[lane], std::array::from_fn(|j| leaf.vertices[j][lane])))
        });
        lanes.take(self.len).collect()
    }

    /// Fits all boxes to the local positions; with `end`, to the motion from `local` to `end`.
    pub fn refit(&mut self, local: &[LocalVertex], end: Option<&[LocalVertex]>) {
        if self.is_empty() {
            return;
        }
        let (elements, inner) = self.levels.split_at_mut(1);
        match end {
            None => {
                self.sweep.clear();
                elements[0]
                    .par_chunks_mut(REFIT_CHUNK)
                    .zip(self.leaves.par_chunks_mut(REFIT_CHUNK))
                    .for_each(|(nodes, leaves)| {
                        for (node, leaf) in nodes.iter_mut().zip(leaves) {
                            refit_leaf(local, node, leaf);
                        }
                    });
            }
            Some(end) => {
                self.sweep.resize(self.leaves.len(), [Node::EMPTY; 2]);
                elements[0]
                    .par_chunks_mut(REFIT_CHUNK)
                    .zip(self.leaves.par_chunks_mut(REFIT_CHUNK))
                    .zip(self.sweep.par_chunks_mut(REFIT_CHUNK))
                    .for_each(|((nodes, leaves), sweeps)| {
                        for ((node, leaf), [first, last]) in nodes.iter_mut().zip(leaves).zip(sweeps) {
                            refit_leaf(end, last, leaf);
                            // Last, for what the leaf holds belongs to the start.
                            refit_leaf(local, first, leaf);
                            *node = hull(first, last);
                        }
                    });
            }
        }
        let mut below = &elements[0];
        for level in inner {
            level.par_chunks_mut(REFIT_CHUNK).zip(below.par_chunks(REFIT_CHUNK * LANES)).for_each(
                |(nodes, children)| {
                    for (node, children) in nodes.iter_mut().zip(children.chunks(LANES)) {
                        for (lane, child) in children.iter().enumerate() {
                            node.set_lane(lane, child.bounds());
                        }
                    }
                },
            );
            below = level;
        }
        if self.fresh_extent.is_nan() {
            self.fresh_extent = self.extent();
        }
    }

    /// Whether the leaves have grown so much that a new order pays.
    pub fn is_stale(&self) -> bool {
        self.extent() > STALE * self.fresh_extent
    }

    fn extent(&self) -> f64 {
        self.leaves.iter().map(|leaf| f64::from(leaf.extent)).sum()
    }
}

/// Boxes, positions and radii of a leaf's elements.
#[inline(always)]
fn refit_leaf<const V: usize>(local: &[LocalVertex], node: &mut Node, leaf: &mut Leaf<V>) {
    let mut all = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    for lane in 0..LANES {
        if leaf.elements[lane] == u32::MAX {
            break;
        }
        let mut low = [f32::INFINITY; 4];
        let mut high = [f32::NEG_INFINITY; 4];
        let mut check = 0.0;
        for j in 0..V {
            let vertex = local[leaf.vertices[j][lane] as usize];
            for k in 0..4 {
                low[k] = least(low[k], vertex[k]);
                high[k] = greatest(high[k], vertex[k]);
            }
            leaf.rows[lane].positions[j].copy_from_slice(&vertex[..3]);
            check += vertex[3];
        }
        if check.is_nan() {
            // Not-a-number would hide in some comparisons and spoil the boxes above.
            node.set_lane(lane, [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]]);
            continue;
        }
        let radius = high[3];
        let mut largest = 0.0;
        for k in 0..3 {
            all[0][k] = least(all[0][k], low[k]);
            all[1][k] = greatest(all[1][k], high[k]);
            largest = greatest(largest, greatest(low[k].abs(), high[k].abs()));
        }
        let margin = 8.0 * UNIT * (largest + radius) + 1e-30;
        for k in 0..3 {
            node.low[k][lane] = (low[k] - radius) - margin;
            node.high[k][lane] = (high[k] + radius) + margin;
        }
        leaf.rows[lane].reject = radius * (1.0 + 16.0 * UNIT) + (80.0 * UNIT * largest + 1e-18);
        leaf.rows[lane].accept = radius * (1.0 - 16.0 * UNIT) - (128.0 * UNIT * largest + 1e-18);
    }
    leaf.extent = greatest(0.0, (0..3).map(|k| all[1][k] - all[0][k]).sum());
}

fn hull(a: &Node, b: &Node) -> Node {
    let mut node = *a;
    for k in 0..3 {
        for lane in 0..LANES {
            node.low[k][lane] = least(a.low[k][lane], b.low[k][lane]);
            node.high[k][lane] = greatest(a.high[k][lane], b.high[k][lane]);
        }
    }
    node
}

/// The smaller of two numbers as one instruction; `b` where one is not a number.
#[inline(always)]
pub fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The larger of two numbers as one instruction; `b` where one is not a number.
#[inline(always)]
pub fn greatest(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
