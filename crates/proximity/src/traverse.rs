//! Tests of elements against trees: which pairs are listed.

use crate::bits::{append_places, append_sorted, bits, flag};
use crate::frame::UNIT_ROUNDOFF;
use crate::narrow::separate_one;
use crate::pair_test::{Batch, PairTest, classify};
use crate::pairs::{Candidate, Pair};
use crate::tree::{LANES, Leaf, Node, Tree};
use bowknot_geometry::{CollisionModel, Point};

/// Leaves of querying elements that one task handles.
pub const TASK_LEAVES: usize = 8;

/// Everything that a traversal reads beside the trees.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    pub model: &'a CollisionModel,
    pub positions: &'a [Point],
    pub radii: &'a [f64],
    /// Whether some pairs of bodies that are searched together may not collide.
    pub filtered: bool,
    /// Whether only pairs are searched of which an element has changed.
    pub changed_only: bool,
}

/// Leaves of a tree whose elements are searched for in other trees.
#[derive(Clone, Copy)]
pub struct Query<'a, const A: usize, const B: usize> {
    /// The tree of the leaves.
    pub tree: &'a Tree<A>,
    /// Indices of the leaves.
    pub leaves: &'a [u32],
    /// The trees that are searched.
    pub targets: &'a [&'a Tree<B>],
}

/// The listed partners of one element.
#[derive(Clone, Copy, Debug)]
pub struct PartnerRange {
    pub element: u32,
    /// Where its partners begin in [`TaskResult::partners`].
    pub start: usize,
    /// At most the number of elements.
    pub count: u32,
}

/// The result of one task. Its buffers are kept between searches.
#[derive(Debug, Default)]
pub struct TaskResult {
    pub runs: Vec<PartnerRange>,
    /// Partners of the elements of `runs`, ascending within each. Bounds of swept searches are 0.
    pub partners: Vec<Candidate>,
    pub candidates: u64,
    pub undecided: u64,
}

impl TaskResult {
    /// Removes the results and keeps the buffers.
    pub fn clear(&mut self) {
        self.runs.clear();
        self.partners.clear();
        (self.candidates, self.undecided) = (0, 0);
    }
}

/// What a thread needs for the current leaf.
#[derive(Debug, Default)]
pub struct Scratch {
    /// Leaves of a target tree whose boxes overlap that of the current leaf.
    near_leaves: Vec<u32>,
    /// Pairs whose boxes overlap, as [`code`]s. The valid ones come first; their number is kept outside.
    queue: Vec<u32>,
    /// Partners of each lane, and the lower bounds of their distances; only the first `lengths[lane]` are
    /// valid.
    lists: [Vec<u32>; LANES],
    bounds: [Vec<f32>; LANES],
    lengths: [usize; LANES],
}

/// Number of queued pairs at which they are tested.
const QUEUE: usize = 2048;
/// Room in the queue beyond that, for all pairs of two leaves.
const QUEUE_ROOM: usize = LANES * LANES + LANES;

/// A pair of an element of the current leaf (its lane) and an element of another leaf.
#[inline(always)]
const fn code(other_leaf: u32, lane: u32, other_lane: u32) -> u32 {
    // Leaves are numbered below 2^24, because elements are numbered below 2^28 (as many as memory holds).
    other_leaf << 8 | lane << 4 | other_lane
}

/// Leaf, lane and other lane of a [`code`].
#[inline(always)]
const fn decode(code: u32) -> (usize, usize, usize) {
    ((code >> 8) as usize, (code >> 4) as usize % LANES, code as usize % LANES)
}

/// Leaves of `tree` whose boxes overlap `bounds`, ascending.
pub fn overlapping_leaves<const V: usize>(tree: &Tree<V>, bounds: &[[f32; 3]; 2], out: &mut Vec<u32>) {
    gather_leaves(tree, bounds, false, out, |_| true);
    out.sort_unstable();
}

/// Adds the partners of the elements in `query.leaves` to `found`.
///
/// Compiled for several instruction sets; the operations and hence the results are the same.
#[multiversion::multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2+bmi1+bmi2+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+lzcnt+popcnt",
))]
pub fn search_leaves<K: PairTest<A, B>, const A: usize, const B: usize, const SWEPT: bool>(
    scene: &Scene<'_>,
    query: &Query<'_, A, B>,
    scratch: &mut Scratch,
    found: &mut TaskResult,
) {
    for &index in query.leaves {
        search_leaf::<K, A, B, SWEPT>(scene, query, index as usize, scratch, found);
    }
}

#[inline(always)]
fn search_leaf<K: PairTest<A, B>, const A: usize, const B: usize, const SWEPT: bool>(
    scene: &Scene<'_>,
    query: &Query<'_, A, B>,
    index: usize,
    scratch: &mut Scratch,
    found: &mut TaskResult,
) {
    let leaf = &query.tree.leaves[index];
    // A leaf without a change is searched for in changed leaves only.
    let unchanged = scene.changed_only && query.tree.changed[0][index] == 0;
    for target in query.targets {
        let mut near_leaves = std::mem::take(&mut scratch.near_leaves);
        let first_element = leaf.elements.iter().fold(u32::MAX, |first, &e| first.min(e));
        gather_leaves(target, &query.tree.leaf_bounds(index), unchanged, &mut near_leaves, |leaf| {
            // If each pair would be found twice, the larger index is the partner.
            !K::SYMMETRIC || leaf.last_element > first_element
        });
        scratch.queue.resize(QUEUE + QUEUE_ROOM, 0);
        let mut queued = 0;
        for (done, &other) in near_leaves.iter().enumerate() {
            queued = queue_candidates::<K, A, B, SWEPT>(
                scene,
                query.tree,
                index,
                target,
                other as usize,
                &mut scratch.queue,
                queued,
            );
            if queued >= QUEUE || done + 1 == near_leaves.len() {
                test_queue::<K, A, B, SWEPT>(scene, leaf, target, queued, scratch, found);
                queued = 0;
            }
        }
        scratch.near_leaves = near_leaves;
    }

    for lane in 0..LANES {
        let count = std::mem::take(&mut scratch.lengths[lane]);
        if count > 0 {
            let start = found.partners.len();
            found.runs.push(PartnerRange { element: leaf.elements[lane], start, count: count as u32 });
            append_sorted(&scratch.lists[lane][..count], &scratch.bounds[lane][..count], &mut found.partners);
        }
    }
}

/// Leaves whose boxes overlap `bounds` and that are `wanted`; with `changed_only` those that have changed.
#[inline(always)]
fn gather_leaves<const V: usize>(
    tree: &Tree<V>,
    bounds: &[[f32; 3]; 2],
    changed_only: bool,
    leaves: &mut Vec<u32>,
    wanted: impl Fn(&Leaf<V>) -> bool,
) {
    leaves.clear();
    let Some(top) = tree.levels.len().checked_sub(1) else { return };
    // Each level leaves at most 15 siblings behind, and there are at most 7 levels.
    let mut stack = [(0_u32, 0_u32); LANES * 8];
    stack[0] = (top as u32, 0);
    let mut depth = 1;
    while depth > 0 {
        depth -= 1;
        let (level, node) = stack[depth];
        let mut mask = overlap(&tree.levels[level as usize][node as usize], bounds);
        if changed_only {
            mask &= u32::from(tree.changed[level as usize][node as usize]);
        }
        while mask != 0 {
            let child = node * LANES as u32 + mask.trailing_zeros();
            mask &= mask - 1;
            if level > 1 {
                stack[depth] = (level - 1, child);
                depth += 1;
            } else if wanted(&tree.leaves[child as usize]) {
                leaves.push(child);
            }
        }
    }
}

/// Queues the pairs of elements of two leaves whose boxes overlap; returns the new end of the queue.
#[inline(always)]
fn queue_candidates<K: PairTest<A, B>, const A: usize, const B: usize, const SWEPT: bool>(
    scene: &Scene<'_>,
    query: &Tree<A>,
    index: usize,
    target: &Tree<B>,
    other: usize,
    queue: &mut [u32],
    mut queued: usize,
) -> usize {
    let leaf = &query.leaves[index];
    let boxes = &query.levels[0][index];
    let other_leaf = &target.leaves[other];
    let other_boxes = &target.levels[0][other];
    let mut lanes = overlap(boxes, &target.leaf_bounds(other));
    while lanes != 0 {
        let lane = lanes.trailing_zeros() as usize;
        lanes &= lanes - 1;
        let element = leaf.elements[lane];
        if K::SYMMETRIC && other_leaf.last_element <= element {
            continue;
        }
        let vertices: [u32; A] = std::array::from_fn(|i| leaf.vertices[i][lane]);
        let mut mask = candidates::<K, A, B>(other_boxes, other_leaf, &boxes.lane(lane), element, &vertices);
        if scene.changed_only && query.changed[0][index] >> lane & 1 == 0 {
            mask &= u32::from(target.changed[0][other]);
        }
        if scene.filtered && mask != 0 {
            mask = filter(scene.model, vertices[0], &other_leaf.vertices[0], mask);
        }
        if SWEPT && mask != 0 {
            let own = moving_box(query, index, lane);
            mask &= match target.sweep.get(other) {
                Some([first, last]) => moving_boxes_overlap(first, last, &own),
                None => moving_boxes_overlap(other_boxes, other_boxes, &own),
            };
        }
        queued = append_places(queue, queued, mask, code(other as u32, lane as u32, 0));
    }
    queued
}

/// Tests the first `queued` pairs of the queue, and lists the partners that are near.
#[inline(always)]
fn test_queue<K: PairTest<A, B>, const A: usize, const B: usize, const SWEPT: bool>(
    scene: &Scene<'_>,
    leaf: &Leaf<A>,
    target: &Tree<B>,
    queued: usize,
    scratch: &mut Scratch,
    found: &mut TaskResult,
) {
    found.candidates += queued as u64;
    // The last batch is filled with a valid pair.
    let filler = scratch.queue[0];
    scratch.queue[queued..queued.next_multiple_of(LANES)].fill(filler);
    let mut batch = Batch {
        a: [[[0.0; LANES]; 3]; A],
        b: [[[0.0; LANES]; 3]; B],
        radius: [0.0; LANES],
        slack: [0.0; LANES],
    };
    let mut remaining = queued;
    for codes in scratch.queue.as_chunks::<LANES>().0.iter().take(queued.div_ceil(LANES)) {
        let present = ((1_u64 << remaining.min(LANES)) - 1) as u32;
        remaining = remaining.saturating_sub(LANES);
        let mut near = present;
        let mut bounds = [0.0; LANES];
        if !SWEPT {
            for slot in 0..LANES {
                let (other_leaf, lane, other_lane) = decode(codes[slot]);
                let (own, other) = (&leaf.rows[lane], &target.leaves[other_leaf].rows[other_lane]);
                for k in 0..3 {
                    for i in 0..A {
                        batch.a[i][k][slot] = own.positions[i][k];
                    }
                    for j in 0..B {
                        batch.b[j][k][slot] = other.positions[j][k];
                    }
                }
                batch.radius[slot] = own.radius + other.radius;
                batch.slack[slot] = own.slack + other.slack;
            }
            let verdicts = classify::<K, A, B>(&batch);
            near &= verdicts.accepted;
            bounds = verdicts.bounds;
            let mut undecided = present & !(verdicts.accepted | verdicts.rejected);
            while undecided != 0 {
                let slot = undecided.trailing_zeros() as usize % LANES;
                undecided &= undecided - 1;
                found.undecided += 1;
                let (other_leaf, lane, other_lane) = decode(codes[slot]);
                let other = &target.leaves[other_leaf];
                let a = std::array::from_fn(|i| leaf.vertices[i][lane]);
                let b = std::array::from_fn(|j| other.vertices[j][other_lane]);
                near |= u32::from(is_near::<K, A, B>(scene, a, b)) << slot;
            }
        }
        // Every pair is written; a pair that is not near is overwritten by the next.
        for slot in 0..LANES {
            let (other_leaf, lane, other_lane) = decode(codes[slot]);
            let (list, length) = (&mut scratch.lists[lane], &mut scratch.lengths[lane]);
            let list_bounds = &mut scratch.bounds[lane];
            if list.len() <= *length {
                list.resize(2 * *length + LANES, 0);
                list_bounds.resize(2 * *length + LANES, 0.0);
            }
            list[*length] = target.leaves[other_leaf].elements[other_lane];
            list_bounds[*length] = bounds[slot];
            *length += (near >> slot & 1) as usize;
        }
    }
}

/// The boxes of a node that overlap a box, one bit each.
#[inline(always)]
fn overlap(node: &Node, bounds: &[[f32; 3]; 2]) -> u32 {
    let mut flags = [0_u8; LANES];
    for lane in 0..LANES {
        flags[lane] = flag(lane_overlaps(node, lane, bounds));
    }
    bits(&flags)
}

#[inline(always)]
fn lane_overlaps(node: &Node, lane: usize, [low, high]: &[[f32; 3]; 2]) -> bool {
    let x = (node.low[0][lane] <= high[0]) & (low[0] <= node.high[0][lane]);
    let y = (node.low[1][lane] <= high[1]) & (low[1] <= node.high[1][lane]);
    let z = (node.low[2][lane] <= high[2]) & (low[2] <= node.high[2][lane]);
    x & y & z
}

/// Elements of a leaf whose boxes overlap that of another element, that share no vertex with it, and that
/// have the larger index if each pair would be found twice.
#[inline(always)]
fn candidates<K: PairTest<A, B>, const A: usize, const B: usize>(
    node: &Node,
    leaf: &Leaf<B>,
    bounds: &[[f32; 3]; 2],
    element: u32,
    vertices: &[u32; A],
) -> u32 {
    let mut flags = [0_u8; LANES];
    for lane in 0..LANES {
        let mut candidate = lane_overlaps(node, lane, bounds);
        candidate &= !K::SYMMETRIC | (leaf.elements[lane] > element);
        for i in 0..A {
            for j in 0..B {
                candidate &= vertices[i] != leaf.vertices[j][lane];
            }
        }
        flags[lane] = flag(candidate);
    }
    bits(&flags)
}

/// Drops the pairs whose bodies may not collide.
#[inline(never)]
fn filter(model: &CollisionModel, vertex: u32, others: &[u32; LANES], mask: u32) -> u32 {
    let body = |v: u32| model.vertex_body()[v as usize];
    let own = body(vertex);
    (0..LANES)
        .filter(|&lane| mask >> lane & 1 != 0 && model.may_collide(own, body(others[lane])))
        .fold(0, |kept, lane| kept | 1 << lane)
}

/// Whether the certified width of a pair is within its radii.
#[inline(never)]
fn is_near<K: PairTest<A, B>, const A: usize, const B: usize>(
    scene: &Scene<'_>,
    a: [u32; A],
    b: [u32; B],
) -> bool {
    let mut vertices = [a[0]; 4];
    a.iter().chain(&b).zip(&mut vertices).for_each(|(&v, vertex)| *vertex = v);
    let largest = |side: &[u32]| side.iter().map(|&v| scene.radii[v as usize]).fold(0.0, f64::max);
    // Rounded up: a pair at exactly the sum of its radii must be listed.
    let pair = Pair { elements: [0; 2], vertices };
    separate_one(scene.model, K::KIND, &pair, scene.positions).width <= (largest(&a) + largest(&b)).next_up()
}

/// The boxes of an element at the start and at the end of the motion.
#[inline(always)]
fn moving_box<const V: usize>(tree: &Tree<V>, leaf: usize, lane: usize) -> [[[f32; 3]; 2]; 2] {
    match tree.sweep.get(leaf) {
        Some([first, last]) => [first.lane(lane), last.lane(lane)],
        None => [tree.levels[0][leaf].lane(lane); 2],
    }
}

/// The elements of a leaf whose moving boxes overlap another moving box at some time, one bit each.
///
/// A vertex moves from x to x + u in a straight line. The lower bound of an element is the minimum of linear
/// functions of time, hence concave: it never falls below the straight line between the bounds at the start
/// and at the end. So the box whose corners move linearly from the first to the last box contains the
/// element, inflated by its radius, at any time. Two such boxes are apart along an axis while a gap, linear
/// in time, is positive. A gap that is positive at both ends is always positive. A gap that changes sign does
/// so at g0 / (g0 - g1). Both ends have a relative error of u = 2^-24, as the corners are exact data, and the
/// denominator adds numbers of one sign, so the time has a relative error of 4 u; it is moved outward by 16
/// u. The pair is dropped if the six intervals without a gap and [0, 1] have no time in common.
#[inline(always)]
fn moving_boxes_overlap(first: &Node, last: &Node, [own_first, own_last]: &[[[f32; 3]; 2]; 2]) -> u32 {
    const EARLIER: f32 = 1.0 - 16.0 * UNIT_ROUNDOFF;
    const LATER: f32 = 1.0 + 16.0 * UNIT_ROUNDOFF;
    let mut flags = [0_u8; LANES];
    for lane in 0..LANES {
        let mut enter = 0.0;
        let mut leave = 1.0;
        let mut apart = false;
        for k in 0..3 {
            let gaps = [
                [first.low[k][lane] - own_first[1][k], last.low[k][lane] - own_last[1][k]],
                [own_first[0][k] - first.high[k][lane], own_last[0][k] - last.high[k][lane]],
            ];
            for [g0, g1] in gaps {
                apart |= (g0 > 0.0) & (g1 > 0.0);
                let time = g0 / (g0 - g1);
                let opens = (g0 <= 0.0) & (g1 > 0.0);
                let closes = (g0 > 0.0) & (g1 <= 0.0);
                let until = if opens { time * LATER } else { 1.0 };
                let from = if closes { time * EARLIER } else { 0.0 };
                leave = if until < leave { until } else { leave };
                enter = if from > enter { from } else { enter };
            }
        }
        flags[lane] = flag(!apart & (enter <= leave));
    }
    bits(&flags)
}
