//! A packed implicit 16-ary tree of boxes over elements of `V` vertices.
//!
//! Elements are stored in a spatial order. Each 16 of them make a leaf, each 16 leaves a node, and so on: the
//! children of node i of a level are 16 i .. 16 i + 15 of the level below, without pointers. A node holds the
//! boxes of its 16 children side by side, so that one box is tested against all of them in a few vector
//! instructions. When elements move, the order stays and the boxes are refitted. A stale order costs time but
//! no correctness; it is rebuilt when the leaves have grown.
//!
//! **Rounding.** With u = 2^-24, local coordinates x and radii r are off by u|x| and u r (see
//! [`crate::frame`]). Let m be the largest |x| of an element. A computed box bound x - r is off by at most u
//! m + u r + u (m + r), and moving it outward by 8 u (m + r) rounds once more: the computed box certainly
//! contains the exact one. 1e-30 m more covers underflow.

use crate::frame::{LocalVertex, UNIT_ROUNDOFF};
use crate::min_max::{larger, smaller};
use crate::order::{Center, kd_order};
use rayon::prelude::*;

/// Children of a node, elements of a leaf.
pub const LANES: usize = 16;

/// Leaves that one task refits.
const REFIT_CHUNK: usize = 64;

/// Growth of the boxes of the leaves at which the tree is rebuilt.
const STALE_GROWTH: f64 = 1.4;

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
            bounds[0][k] = self.low[k].iter().fold(f32::INFINITY, |m, &x| smaller(m, x));
            bounds[1][k] = self.high[k].iter().fold(f32::NEG_INFINITY, |m, &x| larger(m, x));
        }
        bounds
    }
}

/// What the distance test needs of an element. Each element is stored in one place, not side by side as the
/// boxes are, because the test reads single elements of many leaves.
#[derive(Clone, Copy, Debug)]
pub struct ElementRow<const V: usize> {
    /// Local coordinates of the vertices [m].
    pub positions: [[f32; 3]; V],
    /// Radius [m].
    pub radius: f32,
    /// Bound of the rounding error of the test [m], see [`crate::pair_test`].
    pub slack: f32,
}

/// The sixteen elements of a leaf, without their boxes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Leaf<const V: usize> {
    /// Indices of the elements; `u32::MAX` in lanes without one.
    pub elements: [u32; LANES],
    /// Their vertices; `u32::MAX` in lanes without an element.
    pub vertices: [[u32; LANES]; V],
    /// Input of the distance test for each element.
    pub rows: [ElementRow<V>; LANES],
    /// Largest index of an element.
    pub last_element: u32,
    /// Sum of the side lengths of the box of all vertices, without radii [m].
    extent: f32,
}

impl<const V: usize> Leaf<V> {
    const EMPTY: Self = Self {
        elements: [u32::MAX; LANES],
        vertices: [[u32::MAX; LANES]; V],
        rows: [ElementRow { positions: [[0.0; 3]; V], radius: 0.0, slack: 0.0 }; LANES],
        last_element: 0,
        extent: 0.0,
    };
}

/// The tree. Level 0 holds the boxes of the elements, the last level only the root. There are at least two
/// levels unless the tree is empty.
#[derive(Debug, Default)]
pub struct Tree<const V: usize> {
    /// Nodes of each level.
    pub levels: Vec<Vec<Node>>,
    /// Leaves, in spatial order.
    pub leaves: Vec<Leaf<V>>,
    /// Boxes at the start and the end of a motion; level 0 then holds their hull. Empty if the last refit was
    /// without motion.
    pub sweep: Vec<[Node; 2]>,
    /// For each level and node, the children of which some vertex has changed, one bit each; see
    /// [`Self::mark_changed`].
    pub changed: Vec<Vec<u16>>,
    len: usize,
    /// Sum of the extents of the leaves when the tree was built.
    built_extent: f64,
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

    /// Builds the tree of `elements` (index and vertices of each) in spatial order. [`Self::refit`] must
    /// follow: it sets the boxes.
    pub fn build(&mut self, elements: &[(u32, [u32; V])], local: &[LocalVertex]) {
        let mut centers: Vec<Center> = elements
            .iter()
            .zip(0..)
            .map(|((_, vertices), index)| {
                let mut position = [0.0; 3];
                for k in 0..3 {
                    position[k] = vertices.iter().map(|&v| local[v as usize][k]).sum();
                }
                Center { position, index }
            })
            .collect();
        kd_order(&mut centers, LANES);

        self.len = elements.len();
        self.leaves.clear();
        self.leaves.extend(centers.chunks(LANES).map(|group| {
            let mut leaf = Leaf::EMPTY;
            for (lane, center) in group.iter().enumerate() {
                let (element, vertices) = &elements[center.index as usize];
                leaf.elements[lane] = *element;
                leaf.last_element = leaf.last_element.max(*element);
                for j in 0..V {
                    leaf.vertices[j][lane] = vertices[j];
                }
            }
            leaf
        }));
        // Lanes that lose their element must not keep its box.
        self.sweep.clear();
        self.levels.clear();
        let mut count = self.leaves.len();
        while count > 0 {
            self.levels.push(vec![Node::EMPTY; count]);
            if count == 1 && self.levels.len() > 1 {
                break;
            }
            count = count.div_ceil(LANES);
        }
        self.changed = self.levels.iter().map(|level| vec![0; level.len()]).collect();
        self.built_extent = f64::NAN;
    }

    /// Index and vertices of each element, in the tree's order.
    pub fn elements(&self) -> Vec<(u32, [u32; V])> {
        let lanes = self.leaves.iter().flat_map(|leaf| {
            (0..LANES).map(move |lane| (leaf.elements[lane], std::array::from_fn(|j| leaf.vertices[j][lane])))
        });
        lanes.take(self.len).collect()
    }

    /// Refits all boxes to the local positions or, with `end`, to the motion from `local` to `end`.
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
                            // The start comes last, because the leaf keeps the state of the start.
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
        if self.built_extent.is_nan() {
            self.built_extent = self.extent();
        }
    }

    /// Notes which elements have a vertex that has `changed`.
    pub fn mark_changed(&mut self, changed: &[bool]) {
        let Some((leaf_marks, inner_marks)) = self.changed.split_first_mut() else { return };
        leaf_marks.par_chunks_mut(REFIT_CHUNK).zip(self.leaves.par_chunks(REFIT_CHUNK)).for_each(
            |(marks, leaves)| {
                for (mark, leaf) in marks.iter_mut().zip(leaves) {
                    *mark = changed_lanes(leaf, changed);
                }
            },
        );
        let mut below: &[u16] = leaf_marks;
        for marks in inner_marks {
            for (mark, children) in marks.iter_mut().zip(below.chunks(LANES)) {
                let bits = children.iter().enumerate();
                *mark = bits.fold(0, |mark, (lane, &child)| mark | u16::from(child != 0) << lane);
            }
            below = marks;
        }
    }

    /// Refits the boxes of the elements that are marked as changed.
    pub fn refit_changed(&mut self, local: &[LocalVertex]) {
        if self.is_empty() {
            return;
        }
        self.sweep.clear();
        let (elements, inner) = self.levels.split_at_mut(1);
        elements[0]
            .par_chunks_mut(REFIT_CHUNK)
            .zip(self.leaves.par_chunks_mut(REFIT_CHUNK))
            .zip(self.changed[0].par_chunks(REFIT_CHUNK))
            .for_each(|((nodes, leaves), marks)| {
                for ((node, leaf), mark) in nodes.iter_mut().zip(leaves).zip(marks) {
                    if *mark != 0 {
                        refit_leaf(local, node, leaf);
                    }
                }
            });
        let mut below = &elements[0];
        for (level, marks) in inner.iter_mut().zip(&self.changed[1..]) {
            for ((node, mark), children) in level.iter_mut().zip(marks).zip(below.chunks(LANES)) {
                for (lane, child) in children.iter().enumerate().filter(|(lane, _)| mark >> lane & 1 != 0) {
                    node.set_lane(lane, child.bounds());
                }
            }
            below = level;
        }
    }

    /// Builds the tree again and refits it if its leaves have grown so much that this is worth its cost; returns
    /// whether it has.
    pub fn rebuild_stale(&mut self, local: &[LocalVertex], end: Option<&[LocalVertex]>) -> bool {
        let is_stale = self.extent() > STALE_GROWTH * self.built_extent;
        if is_stale {
            self.build(&self.elements(), local);
            self.refit(local, end);
        }
        is_stale
    }

    fn extent(&self) -> f64 {
        self.leaves.iter().map(|leaf| f64::from(leaf.extent)).sum()
    }
}

/// The elements of a leaf with a vertex that has `changed`, one bit each.
#[inline(always)]
fn changed_lanes<const V: usize>(leaf: &Leaf<V>, changed: &[bool]) -> u16 {
    (0..LANES).filter(|&lane| leaf.elements[lane] != u32::MAX).fold(0, |mark, lane| {
        let any = leaf.vertices.iter().any(|vertices| changed[vertices[lane] as usize]);
        mark | u16::from(any) << lane
    })
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
                low[k] = smaller(low[k], vertex[k]);
                high[k] = larger(high[k], vertex[k]);
            }
            leaf.rows[lane].positions[j].copy_from_slice(&vertex[..3]);
            check += vertex[3];
        }
        if check.is_nan() {
            // Comparisons would drop some not-a-numbers and pass others on to the boxes above.
            node.set_lane(lane, [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]]);
            continue;
        }
        let radius = high[3];
        let mut largest = 0.0;
        for k in 0..3 {
            all[0][k] = smaller(all[0][k], low[k]);
            all[1][k] = larger(all[1][k], high[k]);
            largest = larger(largest, larger(low[k].abs(), high[k].abs()));
        }
        let margin = 8.0 * UNIT_ROUNDOFF * (largest + radius) + 1e-30;
        for k in 0..3 {
            node.low[k][lane] = (low[k] - radius) - margin;
            node.high[k][lane] = (high[k] + radius) + margin;
        }
        leaf.rows[lane].radius = radius;
        leaf.rows[lane].slack = 80.0 * UNIT_ROUNDOFF * largest + 1e-18;
    }
    leaf.extent = larger(0.0, (0..3).map(|k| all[1][k] - all[0][k]).sum());
}

fn hull(a: &Node, b: &Node) -> Node {
    let mut node = *a;
    for k in 0..3 {
        for lane in 0..LANES {
            node.low[k][lane] = smaller(a.low[k][lane], b.low[k][lane]);
            node.high[k][lane] = larger(a.high[k][lane], b.high[k][lane]);
        }
    }
    node
}
