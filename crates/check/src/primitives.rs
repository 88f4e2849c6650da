//! The sets of primitives that are walked against each other, each with its tree.

use crate::closest::closest;
use crate::judge::Judge;
use crate::report::PairClass;
use crate::tree::{self, Item, MovingBox, OBSTACLE, STILL, Tree};
use crate::walk::{Keep, walk};
use bowknot_geometry::Point;
use rayon::prelude::*;

/// A primitive at its place in the order of a tree.
#[derive(Clone, Copy, Debug)]
struct Slot<const N: usize> {
    vertices: [u32; N],
    element: u32,
    /// [`OBSTACLE`] or nothing.
    flags: u8,
}

/// Primitives of one kind with `N` vertices, and a tree over their boxes at `K` instants.
#[derive(Debug)]
pub(super) struct Primitives<const N: usize, const K: usize> {
    slots: Vec<Slot<N>>,
    tree: Tree<K>,
}

impl<const N: usize, const K: usize> Primitives<N, K> {
    /// Primitives in the order given.
    fn new(judge: &Judge, elements: impl Iterator<Item = (u32, [u32; N])>) -> Self {
        let slots: Vec<_> = elements
            .map(|(element, vertices)| {
                let obstacle = vertices.iter().all(|&v| judge.obstacle[v as usize]);
                Slot { vertices, element, flags: if obstacle { OBSTACLE } else { 0 } }
            })
            .collect();
        let tree = Tree::new(slots.len());
        Self { slots, tree }
    }

    /// Puts the primitives in the order that suits these positions.
    fn arrange(&mut self, instants: [&[Point]; K]) {
        let item = |slot: &Slot<N>| {
            let mut center = [0.0; 3];
            for v in slot.vertices {
                for x in instants {
                    (0..3).for_each(|c| center[c] += x[v as usize][c]);
                }
            }
            Item { center, number: slot.element, content: *slot }
        };
        let mut items: Vec<_> = self.slots.par_iter().map(item).collect();
        tree::arrange(&mut items);
        self.slots.clear();
        self.slots.extend(items.into_iter().map(|item| item.content));
    }

    /// Fits the tree to these positions.
    fn fit(&mut self, instants: [&[Point]; K], skip_unmoved: bool) {
        let slots = &self.slots;
        self.tree.fit(|slot| {
            let Slot { vertices, flags, .. } = &slots[slot];
            let unmoved = |&v: &u32| instants.iter().all(|x| x[v as usize] == instants[0][v as usize]);
            let still = skip_unmoved && vertices.iter().all(unmoved);
            let points = vertices.iter().map(|&v| instants.map(|x| &x[v as usize]));
            (MovingBox::of_points(points), flags | if still { STILL } else { 0 })
        });
    }
}

/// All primitives of a judge, and trees over their boxes at `K` instants.
#[derive(Debug)]
pub(super) struct Scene<const K: usize> {
    pub vertices: Primitives<1, K>,
    pub edges: Primitives<2, K>,
    pub triangles: Primitives<3, K>,
    pub particles: Primitives<1, K>,
    pub strands: Primitives<2, K>,
}

impl<const K: usize> Scene<K> {
    /// The primitives, to be [arranged](Self::arrange) and [fitted](Self::fit).
    pub fn new(judge: &Judge) -> Self {
        let vertices = |list: &[u32]| Primitives::new(judge, list.iter().map(|&v| (v, [v])));
        Self {
            vertices: vertices(&judge.vertices),
            edges: Primitives::new(judge, (0..).zip(judge.edges.iter().copied())),
            triangles: Primitives::new(judge, (0..).zip(judge.triangles.iter().copied())),
            particles: vertices(&judge.particles),
            strands: Primitives::new(judge, judge.strands.iter().map(|&e| (e, judge.edges[e as usize]))),
        }
    }

    /// Orders the primitives by where they are, `vertices` included or not. What walks find does not depend
    /// on it, how long they take does; other positions may follow, as long as they are not all too different.
    pub fn arrange(&mut self, instants: [&[Point]; K], vertices: bool) {
        if vertices {
            self.vertices.arrange(instants);
        }
        self.edges.arrange(instants);
        self.triangles.arrange(instants);
        self.particles.arrange(instants);
        self.strands.arrange(instants);
    }

    /// Fits all boxes to these positions, those of the `vertices` included or not; primitives that do not
    /// move are flagged if `skip_unmoved`.
    pub fn fit(&mut self, instants: [&[Point]; K], vertices: bool, skip_unmoved: bool) {
        if vertices {
            self.vertices.fit(instants, skip_unmoved);
        }
        self.edges.fit(instants, skip_unmoved);
        self.triangles.fit(instants, skip_unmoved);
        self.particles.fit(instants, skip_unmoved);
        self.strands.fit(instants, skip_unmoved);
    }

    /// Walks every class of pairs that can be measured, see [`pairs`]: all but edge-triangle.
    pub fn all_pairs<R: Default + Send>(
        &self,
        judge: &Judge,
        filter: &impl Keep<K>,
        visit: impl Fn(PairClass, [u32; 2], [&[u32]; 2], &mut R) + Sync + Copy,
    ) -> Vec<R> {
        let Self { vertices, edges, triangles, particles, strands } = self;
        let mut results = pairs(judge, PairClass::EdgeEdge, edges, edges, filter, visit);
        results.extend(pairs(judge, PairClass::VertexTriangle, vertices, triangles, filter, visit));
        results.extend(pairs(judge, PairClass::VertexEdge, particles, strands, filter, visit));
        results.extend(pairs(judge, PairClass::VertexVertex, particles, particles, filter, visit));
        results
    }
}

/// Calls `visit(class, elements, vertices of either side, result)` for every pair of one class that is
/// judged and whose boxes `filter` keeps; in pairs of one kind the smaller element comes first. Returns
/// the results of the tasks that this is cut into.
pub(super) fn pairs<const A: usize, const B: usize, const K: usize, R: Default + Send>(
    judge: &Judge,
    class: PairClass,
    a: &Primitives<A, K>,
    b: &Primitives<B, K>,
    filter: &impl Keep<K>,
    visit: impl Fn(PairClass, [u32; 2], [&[u32]; 2], &mut R) + Sync,
) -> Vec<R> {
    let alike = std::ptr::eq(&a.tree, &b.tree);
    walk(&a.tree, &b.tree, filter, |slot_a, slot_b, result| {
        let (a, b) = (&a.slots[slot_a], &b.slots[slot_b]);
        let (mut first, mut second) = ((a.element, &a.vertices[..]), (b.element, &b.vertices[..]));
        if judge.may_meet(first.1, second.1) {
            if alike && second.0 < first.0 {
                std::mem::swap(&mut first, &mut second);
            }
            visit(class, [first.0, second.0], [first.1, second.1], result);
        }
    })
}

/// The points of both sides in [`bowknot_geometry::PairKind`] order; unused places repeat the first.
pub(super) fn gather(x: &[Point], sides: [&[u32]; 2]) -> [Point; 4] {
    let mut points = [x[sides[0][0] as usize]; 4];
    for (point, &v) in points.iter_mut().zip(sides[0].iter().chain(sides[1])) {
        *point = x[v as usize];
    }
    points
}

/// Closest points of either side, and their distance.
pub(super) fn closest_points(class: PairClass, points: &[Point; 4]) -> ([Point; 2], f64) {
    let closest = closest(class.kind(), points);
    (closest.places(), closest.distance())
}
