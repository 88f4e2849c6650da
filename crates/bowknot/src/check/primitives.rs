//! The sets of primitives that are walked against each other, each with its tree.

use super::tree::{self, MovingBox, OBSTACLE, STILL, Tree};
use super::{Judge, PairClass};
use bowknot_geometry::{PairKind, Point, distance};
use rayon::prelude::*;
use std::borrow::Cow;

/// Primitives of one kind with `N` vertices, and a tree over their boxes at `K` instants.
pub(super) struct Primitives<'j, const N: usize, const K: usize> {
    vertices: Cow<'j, [[u32; N]]>,
    /// Element number of each primitive; `None`: its own index.
    ids: Option<&'j [u32]>,
    pub tree: Tree<K>,
}

impl<'j, const N: usize, const K: usize> Primitives<'j, N, K> {
    fn new(
        judge: &'j Judge,
        vertices: Cow<'j, [[u32; N]]>,
        ids: Option<&'j [u32]>,
        instants: [&[Point]; K],
        skip_unmoved: bool,
    ) -> Self {
        let (boxes, flags): (Vec<_>, Vec<_>) = vertices
            .par_iter()
            .map(|vertices| {
                let points = vertices.iter().map(|&v| instants.map(|x| &x[v as usize]));
                let obstacle = vertices.iter().all(|&v| judge.obstacle[v as usize]);
                let unmoved = |&v: &u32| instants.iter().all(|x| x[v as usize] == instants[0][v as usize]);
                let still = skip_unmoved && vertices.iter().all(unmoved);
                let flags = if obstacle { OBSTACLE } else { 0 } | if still { STILL } else { 0 };
                (MovingBox::of_points(points), flags)
            })
            .unzip();
        let tree = Tree::new(&boxes, &flags);
        Self { vertices, ids, tree }
    }

    fn at_slot(&self, slot: usize) -> (u32, &[u32]) {
        let primitive = self.tree.primitives[slot];
        let id = self.ids.map_or(primitive, |ids| ids[primitive as usize]);
        (id, &self.vertices[primitive as usize])
    }
}

/// All primitives of a judge at `K` instants.
pub(super) struct Scene<'j, const K: usize> {
    judge: &'j Judge,
    pub vertices: Primitives<'j, 1, K>,
    pub edges: Primitives<'j, 2, K>,
    pub triangles: Primitives<'j, 3, K>,
    pub particles: Primitives<'j, 1, K>,
    pub strands: Primitives<'j, 2, K>,
}

impl<'j, const K: usize> Scene<'j, K> {
    /// Trees over all primitives; those that do not move are flagged if `skip_unmoved`.
    pub fn new(judge: &'j Judge, instants: [&[Point]; K], skip_unmoved: bool) -> Self {
        let points = |list: &'j [u32]| -> Primitives<'j, 1, K> {
            let vertices = list.iter().map(|&v| [v]).collect();
            Primitives::new(judge, Cow::Owned(vertices), Some(list), instants, skip_unmoved)
        };
        let strands = judge.strands.iter().map(|&e| judge.edges[e as usize]).collect();
        Self {
            judge,
            vertices: points(&judge.vertices),
            edges: Primitives::new(judge, Cow::Borrowed(&judge.edges), None, instants, skip_unmoved),
            triangles: Primitives::new(judge, Cow::Borrowed(&judge.triangles), None, instants, skip_unmoved),
            particles: points(&judge.particles),
            strands: Primitives::new(
                judge,
                Cow::Owned(strands),
                Some(&judge.strands),
                instants,
                skip_unmoved,
            ),
        }
    }

    /// Walks every class of pairs that can be measured, see [`Self::pairs`]: all but edge-triangle.
    pub fn all_pairs<R: Send>(
        &self,
        keep: impl Fn(&MovingBox<K>, &MovingBox<K>) -> bool + Sync + Copy,
        visit: impl Fn(PairClass, [u32; 2], [&[u32]; 2], &mut Vec<R>) + Sync + Copy,
    ) -> Vec<R> {
        let mut found = Vec::new();
        found.extend(self.pairs(PairClass::EdgeEdge, &self.edges, &self.edges, keep, visit));
        found.extend(self.pairs(PairClass::VertexTriangle, &self.vertices, &self.triangles, keep, visit));
        found.extend(self.pairs(PairClass::VertexEdge, &self.particles, &self.strands, keep, visit));
        found.extend(self.pairs(PairClass::VertexVertex, &self.particles, &self.particles, keep, visit));
        found
    }

    /// Calls `visit(class, elements, vertices of either side, found)` for every pair of one class that
    /// is judged and whose boxes `keep` keeps; in pairs of one kind the smaller element comes first.
    pub fn pairs<const A: usize, const B: usize, R: Send>(
        &self,
        class: PairClass,
        a: &Primitives<'j, A, K>,
        b: &Primitives<'j, B, K>,
        keep: impl Fn(&MovingBox<K>, &MovingBox<K>) -> bool + Sync,
        visit: impl Fn(PairClass, [u32; 2], [&[u32]; 2], &mut Vec<R>) + Sync,
    ) -> Vec<R> {
        let alike = std::ptr::eq(&a.tree, &b.tree);
        tree::walk(&a.tree, &b.tree, keep, |slot_a, slot_b, found| {
            let (mut first, mut second) = (a.at_slot(slot_a), b.at_slot(slot_b));
            if self.judge.may_meet(first.1, second.1) {
                if alike && second.0 < first.0 {
                    std::mem::swap(&mut first, &mut second);
                }
                visit(class, [first.0, second.0], [first.1, second.1], found);
            }
        })
    }
}

/// How [`bowknot_geometry`] calls a class of pairs that can be measured; edge-triangle pairs cannot.
pub(super) fn pair_kind(class: PairClass) -> PairKind {
    match class {
        PairClass::EdgeEdge | PairClass::EdgeTriangle => PairKind::EdgeEdge,
        PairClass::VertexTriangle => PairKind::VertexTriangle,
        PairClass::VertexEdge => PairKind::VertexEdge,
        PairClass::VertexVertex => PairKind::VertexVertex,
        PairClass::VertexHalfSpace => PairKind::VertexHalfSpace,
    }
}

/// The points of both sides in [`PairKind`] order; unused places repeat the first.
pub(super) fn gather(x: &[Point], sides: [&[u32]; 2]) -> [Point; 4] {
    let mut points = [x[sides[0][0] as usize]; 4];
    for (point, &v) in points.iter_mut().zip(sides[0].iter().chain(sides[1])) {
        *point = x[v as usize];
    }
    points
}

/// Closest points of either side, and their distance.
pub(super) fn closest_points(class: PairClass, points: &[Point; 4]) -> ([Point; 2], f64) {
    let kind = pair_kind(class);
    let closest = distance::closest(kind, points);
    let mut on_b = bowknot_geometry::Vector::zeros();
    for i in kind.side_a()..kind.vertex_count() {
        on_b += points[i].coords * closest.weights[i];
    }
    let on_b = Point::from(on_b);
    ([on_b + closest.offset, on_b], closest.distance)
}
