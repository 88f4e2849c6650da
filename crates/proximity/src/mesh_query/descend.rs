//! A walk down a tree of triangles, nearest boxes first.

use crate::tree::{LANES, Node, Tree};
use bowknot_geometry::Point;

/// A mesh at some positions, with its tree.
#[derive(Clone, Copy)]
pub struct Placed<'a> {
    pub tree: &'a Tree<3>,
    /// Of all vertices [m].
    pub positions: &'a [Point],
    /// Of the local frame.
    pub origin: Point,
}

impl Placed<'_> {
    /// The corners of a triangle.
    pub fn corners(&self, vertices: [u32; 3]) -> [&Point; 3] {
        vertices.map(|v| &self.positions[v as usize])
    }
}

/// What is searched for in a tree.
pub trait Probe {
    /// For each box of a node a lower bound of what the triangles in it can reach; infinite where they are of
    /// no interest, and for lanes without a box.
    fn bounds(&self, node: &Node) -> [f64; LANES];
    /// Triangles with a bound above this are of no interest any more.
    fn limit(&self) -> f64;
    /// Looks at a triangle.
    fn visit(&mut self, triangle: u32, vertices: [u32; 3]);
}

/// Shows the probe all triangles that it has not excluded.
pub fn descend(tree: &Tree<3>, probe: &mut impl Probe) {
    if let Some(top) = tree.levels.len().checked_sub(1) {
        descend_from(tree, top, 0, probe);
    }
}

/// There are at most 8 levels.
fn descend_from(tree: &Tree<3>, level: usize, node: usize, probe: &mut impl Probe) {
    let bounds = probe.bounds(&tree.levels[level][node]);
    let mut order = [(0.0, 0); LANES];
    let mut count = 0;
    let limit = probe.limit();
    for (lane, &bound) in bounds.iter().enumerate() {
        if bound <= limit && bound < f64::INFINITY {
            let mut place = count;
            while place > 0 && order[place - 1].0 > bound {
                order[place] = order[place - 1];
                place -= 1;
            }
            order[place] = (bound, lane);
            count += 1;
        }
    }
    for &(bound, lane) in &order[..count] {
        if bound > probe.limit() {
            break;
        }
        if level > 0 {
            descend_from(tree, level - 1, node * LANES + lane, probe);
        } else {
            let leaf = &tree.leaves[node];
            probe.visit(leaf.elements[lane], [0, 1, 2].map(|j: usize| leaf.vertices[j][lane]));
        }
    }
}
