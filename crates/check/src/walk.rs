//! Walks over the pairs of two trees, or of a tree and itself.

use crate::tree::{LeafBoxes, MovingBox, Tree};
use rayon::prelude::*;

/// Pairs of nodes that a walk is cut into, so that threads have enough to share out. Fixed, so that
/// nothing depends on the number of threads.
const TASKS: usize = 2048;

/// What pairs of boxes a walk goes into.
pub(super) trait Keep<const K: usize>: Sync {
    /// Whether [`Self::keep`] may say no to what it said yes to before, and is best told of near pairs
    /// first.
    const NARROWS: bool;

    /// Whether two boxes may hold a pair of interest.
    fn keep(&self, a: &MovingBox<K>, b: &MovingBox<K>) -> bool;

    /// Which boxes of a leaf [`Self::keep`] keeps with another box, a bit each; if [`Self::NARROWS`], it is
    /// asked again for each of them.
    fn kept(&self, a: &MovingBox<K>, leaf: &LeafBoxes<K>) -> u32;
}

/// Boxes that may share a point at some time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting;

impl<const K: usize> Keep<K> for Meeting {
    const NARROWS: bool = false;

    #[inline]
    fn keep(&self, a: &MovingBox<K>, b: &MovingBox<K>) -> bool {
        a.meets(b)
    }

    #[inline]
    fn kept(&self, a: &MovingBox<K>, leaf: &LeafBoxes<K>) -> u32 {
        leaf.meeting(a)
    }
}

/// Walks over pairs of nodes, cut into tasks that run in parallel.
///
/// `visit(slot_a, slot_b, result)` is called with the places of each pair of primitives whose boxes are
/// kept, each pair once when both trees are the same. Every task has a result of its own; they are
/// returned in the order of the tasks.
pub(super) fn walk<const K: usize, R: Default + Send>(
    a: &Tree<K>,
    b: &Tree<K>,
    filter: &impl Keep<K>,
    visit: impl Fn(usize, usize, &mut R) + Sync,
) -> Vec<R> {
    if a.boxes.is_empty() || b.boxes.is_empty() {
        return Vec::new();
    }
    let walk = Walk { a, b, same: std::ptr::eq(a, b), filter };
    let found = walk.tasks().into_par_iter().map_init(Vec::new, |stack, task| {
        let mut result = R::default();
        walk.run(task, stack, |s, t| visit(s, t, &mut result));
        result
    });
    found.collect()
}

/// A pair of nodes, one of either tree.
type NodePair = (u32, u32);

struct Walk<'t, const K: usize, F> {
    a: &'t Tree<K>,
    b: &'t Tree<K>,
    same: bool,
    filter: &'t F,
}

impl<const K: usize, F: Keep<K>> Walk<'_, K, F> {
    #[inline]
    fn alive(&self, (i, j): NodePair) -> bool {
        self.a.node_flags[i as usize] & self.b.node_flags[j as usize] == 0
            && self.filter.keep(&self.a.nodes[i as usize], &self.b.nodes[j as usize])
    }

    /// Breadth first until there are enough tasks.
    fn tasks(&self) -> Vec<NodePair> {
        let both_leaves = |&(i, j): &NodePair| self.a.is_leaf(i) && self.b.is_leaf(j);
        let mut tasks = vec![(0, 0)];
        tasks.retain(|&pair| self.alive(pair));
        while !tasks.is_empty() && tasks.len() < TASKS && !tasks.iter().all(both_leaves) {
            let mut next = Vec::with_capacity(4 * tasks.len());
            for task in tasks {
                let (children, count) = self.children(task);
                next.extend(children[..count].iter().filter(|&&pair| self.alive(pair)));
            }
            tasks = next;
        }
        tasks
    }

    /// All below a pair of nodes that is alive; `stack` is empty before and after.
    fn run(&self, task: NodePair, stack: &mut Vec<NodePair>, mut visit: impl FnMut(usize, usize)) {
        stack.push(task);
        while let Some(pair) = stack.pop() {
            if F::NARROWS && !self.alive(pair) {
                continue;
            }
            let (i, j) = pair;
            if self.a.is_leaf(i) && self.b.is_leaf(j) {
                self.leaves(i, j, &mut visit);
                continue;
            }
            let (mut children, count) = self.children(pair);
            let children = &mut children[..count];
            if F::NARROWS {
                let far =
                    |&(i, j): &NodePair| self.a.nodes[i as usize].distance_squared(&self.b.nodes[j as usize]);
                children.sort_by(|x, y| far(y).total_cmp(&far(x)));
                stack.extend_from_slice(children);
            } else {
                stack.extend(children.iter().filter(|&&pair| self.alive(pair)));
            }
        }
    }

    /// The pairs of primitives of two leaves.
    #[inline]
    fn leaves(&self, i: u32, j: u32, visit: &mut impl FnMut(usize, usize)) {
        let (a, b) = (self.a, self.b);
        let (others, leaf) = (b.slots(j), b.leaf_boxes(j));
        let all = (1 << others.len()) - 1;
        for s in a.slots(i) {
            let (place, flags) = (&a.boxes[s], a.flags[s]);
            if flags & b.node_flags[j as usize] != 0 || !self.filter.keep(place, &b.nodes[j as usize]) {
                continue;
            }
            let mut kept = self.filter.kept(place, leaf) & all;
            if self.same && i == j {
                // Those after it.
                kept &= !1 << (s - others.start);
            }
            while kept != 0 {
                let t = others.start + kept.trailing_zeros() as usize;
                kept &= kept - 1;
                if flags & b.flags[t] == 0 && (!F::NARROWS || self.filter.keep(place, &b.boxes[t])) {
                    visit(s, t);
                }
            }
        }
    }

    /// The pairs of nodes below a pair of nodes: the first so many.
    #[inline]
    fn children(&self, (i, j): NodePair) -> ([NodePair; 4], usize) {
        let (i1, i2, j1, j2) = (2 * i + 1, 2 * i + 2, 2 * j + 1, 2 * j + 2);
        let none = (0, 0);
        match (self.a.is_leaf(i), self.b.is_leaf(j)) {
            (true, true) => ([(i, j), none, none, none], 1),
            (true, false) => ([(i, j1), (i, j2), none, none], 2),
            (false, true) => ([(i1, j), (i2, j), none, none], 2),
            // Each unordered pair of two different nodes comes up once.
            (false, false) if self.same && i == j => ([(i1, i1), (i1, i2), (i2, i2), none], 3),
            (false, false) => ([(i1, j1), (i1, j2), (i2, j1), (i2, j2)], 4),
        }
    }
}
