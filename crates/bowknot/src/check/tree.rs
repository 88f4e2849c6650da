//! The judge's broad phase: a balanced binary tree over boxes, walked against another tree.
//!
//! A box is given at `K` instants: one for a state; two, start and end, for a path. Between the two,
//! all vertices move linearly on one clock, so a vertex stays within the linear interpolation of its
//! boxes, and two boxes that are apart along one axis, on the same side, at both instants are apart
//! along it all the way. Common motion hence costs nothing, however fast. Boxes are minima and maxima
//! of coordinates, so there is nothing to round.

use rayon::prelude::*;

/// Flag of primitives that belong to an obstacle; two flagged primitives form no pair.
pub(super) const OBSTACLE: u8 = 1;
/// Flag of primitives that do not move; two flagged primitives form no pair.
pub(super) const STILL: u8 = 2;

/// Primitives a leaf holds at most.
const LEAF_SIZE: usize = 4;
/// Pairs of nodes that a walk is cut into, so that threads have enough to share out. Fixed, so that
/// nothing depends on the number of threads.
const TASKS: usize = 2048;
/// Slices longer than this are split by two threads.
const PARALLEL_SPLIT: usize = 8192;

/// An axis-aligned box at `K` instants.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingBox<const K: usize> {
    pub min: [[f64; 3]; K],
    pub max: [[f64; 3]; K],
}

impl<const K: usize> MovingBox<K> {
    const EMPTY: Self = Self { min: [[f64::INFINITY; 3]; K], max: [[f64::NEG_INFINITY; 3]; K] };

    /// The box of some points, each given at every instant.
    pub fn of_points<'a>(points: impl Iterator<Item = [&'a bowknot_geometry::Point; K]>) -> Self {
        let mut hull = Self::EMPTY;
        for point in points {
            for k in 0..K {
                for c in 0..3 {
                    hull.min[k][c] = hull.min[k][c].min(point[k][c]);
                    hull.max[k][c] = hull.max[k][c].max(point[k][c]);
                }
            }
        }
        hull
    }

    fn join(&mut self, other: &Self) {
        for k in 0..K {
            for c in 0..3 {
                self.min[k][c] = self.min[k][c].min(other.min[k][c]);
                self.max[k][c] = self.max[k][c].max(other.max[k][c]);
            }
        }
    }

    /// Whether the boxes may share a point at some time. Touching boxes do.
    #[inline]
    pub fn meets(&self, other: &Self) -> bool {
        for c in 0..3 {
            let mut below = true;
            let mut above = true;
            for k in 0..K {
                below &= self.max[k][c] < other.min[k][c];
                above &= other.max[k][c] < self.min[k][c];
            }
            if below | above {
                return false;
            }
        }
        true
    }

    /// Squared distance of the boxes at the first instant, to rounding.
    #[inline]
    pub fn distance_squared(&self, other: &Self) -> f64 {
        let mut sum = 0.0;
        for c in 0..3 {
            let gap = (other.min[0][c] - self.max[0][c]).max(self.min[0][c] - other.max[0][c]).max(0.0);
            sum += gap * gap;
        }
        sum
    }
}

/// A tree over the boxes of primitives.
#[derive(Debug)]
pub(super) struct Tree<const K: usize> {
    /// Nodes in heap order: the children of node i are 2i + 1 and 2i + 2.
    nodes: Vec<MovingBox<K>>,
    /// Flags that all primitives below a node have.
    node_flags: Vec<u8>,
    /// Number of levels above the leaves.
    depth: u32,
    /// Primitives in leaf order.
    pub primitives: Vec<u32>,
    /// Their boxes.
    pub boxes: Vec<MovingBox<K>>,
    /// Their flags.
    pub flags: Vec<u8>,
}

struct Item {
    center: [f64; 3],
    primitive: u32,
}

impl<const K: usize> Tree<K> {
    /// A tree over the primitives `0..boxes.len()`; `flags` has one entry each.
    pub fn new(boxes: &[MovingBox<K>], flags: &[u8]) -> Self {
        let count = boxes.len();
        let mut depth = 0;
        while count > LEAF_SIZE << depth {
            depth += 1;
        }
        let mut items: Vec<Item> = boxes
            .iter()
            .enumerate()
            .map(|(primitive, b)| Item {
                center: std::array::from_fn(|c| (0..K).map(|k| 0.5 * b.min[k][c] + 0.5 * b.max[k][c]).sum()),
                primitive: primitive as u32,
            })
            .collect();
        split(&mut items, 0, count, 0, 0, depth);

        let primitives: Vec<u32> = items.iter().map(|item| item.primitive).collect();
        let boxes: Vec<_> = primitives.par_iter().map(|&p| boxes[p as usize]).collect();
        let flags: Vec<u8> = primitives.iter().map(|&p| flags[p as usize]).collect();

        let leaves = 1usize << depth;
        let mut nodes = vec![MovingBox::EMPTY; 2 * leaves - 1];
        let mut node_flags = vec![u8::MAX; 2 * leaves - 1];
        for leaf in 0..leaves {
            for slot in leaf_start(count, leaf, depth)..leaf_start(count, leaf + 1, depth) {
                nodes[leaves - 1 + leaf].join(&boxes[slot]);
                node_flags[leaves - 1 + leaf] &= flags[slot];
            }
        }
        for node in (0..leaves - 1).rev() {
            let (left, right) = (nodes[2 * node + 1], nodes[2 * node + 2]);
            nodes[node].join(&left);
            nodes[node].join(&right);
            node_flags[node] = node_flags[2 * node + 1] & node_flags[2 * node + 2];
        }
        Self { nodes, node_flags, depth, primitives, boxes, flags }
    }

    fn is_leaf(&self, node: u32) -> bool {
        node as usize >= (1 << self.depth) - 1
    }

    fn slots(&self, node: u32) -> std::ops::Range<usize> {
        let leaf = node as usize - ((1 << self.depth) - 1);
        leaf_start(self.boxes.len(), leaf, self.depth)..leaf_start(self.boxes.len(), leaf + 1, self.depth)
    }
}

/// First slot of a leaf: the slots are shared out evenly.
fn leaf_start(count: usize, leaf: usize, depth: u32) -> usize {
    ((count as u128 * leaf as u128) >> depth) as usize
}

/// Sorts `items`, which start at slot `start` of `count`, into the leaves below the node at `index`
/// of `level`, halving along the axis along which their centers spread most.
fn split(items: &mut [Item], start: usize, count: usize, level: u32, index: usize, depth: u32) {
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
            a.center[axis].total_cmp(&b.center[axis]).then(a.primitive.cmp(&b.primitive))
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

/// A walk over pairs of nodes, cut into tasks that run in parallel.
///
/// `keep(box_a, box_b)` says whether two boxes may hold a pair of interest; `visit(slot_a, slot_b,
/// found)` is called with the slots of each pair of primitives whose boxes are kept, each pair once
/// when both trees are the same. Nearer children are walked first. What the tasks found is joined in
/// the order of the tasks.
pub(super) fn walk<const K: usize, R: Send>(
    a: &Tree<K>,
    b: &Tree<K>,
    keep: impl Fn(&MovingBox<K>, &MovingBox<K>) -> bool + Sync,
    visit: impl Fn(usize, usize, &mut Vec<R>) + Sync,
) -> Vec<R> {
    if a.boxes.is_empty() || b.boxes.is_empty() {
        return Vec::new();
    }
    let same = std::ptr::eq(a, b);
    let alive = |&(i, j): &(u32, u32)| {
        a.node_flags[i as usize] & b.node_flags[j as usize] == 0
            && keep(&a.nodes[i as usize], &b.nodes[j as usize])
    };

    // Breadth first until there are enough tasks.
    let mut tasks = vec![(0u32, 0u32)];
    tasks.retain(alive);
    let mut children = Vec::new();
    while !tasks.is_empty()
        && tasks.len() < TASKS
        && !tasks.iter().all(|&(i, j)| a.is_leaf(i) && b.is_leaf(j))
    {
        let mut next = Vec::new();
        for task in tasks {
            descend(a, b, same, task, &mut children);
            next.extend(children.drain(..).filter(|pair| alive(pair)));
        }
        tasks = next;
    }

    let found: Vec<Vec<R>> = tasks
        .into_par_iter()
        .map(|task| {
            let mut found = Vec::new();
            let mut stack = vec![task];
            let mut children = Vec::with_capacity(4);
            while let Some(pair) = stack.pop() {
                // Asked again because `keep` may have become stricter since.
                if !alive(&pair) {
                    continue;
                }
                let (i, j) = pair;
                if a.is_leaf(i) && b.is_leaf(j) {
                    for s in a.slots(i) {
                        let first = if same && i == j { s + 1 } else { b.slots(j).start };
                        for t in first..b.slots(j).end {
                            if a.flags[s] & b.flags[t] == 0 && keep(&a.boxes[s], &b.boxes[t]) {
                                visit(s, t, &mut found);
                            }
                        }
                    }
                    continue;
                }
                descend(a, b, same, pair, &mut children);
                children.sort_by(|x, y| {
                    let far = |p: &(u32, u32)| a.nodes[p.0 as usize].distance_squared(&b.nodes[p.1 as usize]);
                    far(y).total_cmp(&far(x))
                });
                stack.append(&mut children);
            }
            found
        })
        .collect();
    found.into_iter().flatten().collect()
}

/// The pairs of nodes below a pair of nodes.
fn descend<const K: usize>(
    a: &Tree<K>,
    b: &Tree<K>,
    same: bool,
    (i, j): (u32, u32),
    children: &mut Vec<(u32, u32)>,
) {
    let (i1, i2, j1, j2) = (2 * i + 1, 2 * i + 2, 2 * j + 1, 2 * j + 2);
    match (a.is_leaf(i), b.is_leaf(j)) {
        (true, true) => children.push((i, j)),
        (true, false) => children.extend([(i, j1), (i, j2)]),
        (false, true) => children.extend([(i1, j), (i2, j)]),
        // Each unordered pair of two different nodes comes up once.
        (false, false) if same && i == j => children.extend([(i1, i1), (i1, i2), (i2, i2)]),
        (false, false) => children.extend([(i1, j1), (i1, j2), (i2, j1), (i2, j2)]),
    }
}
