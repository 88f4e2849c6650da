//! Elements against trees: which pairs are listed.

use crate::CollisionModel;
use crate::frame::UNIT;
use crate::kinds::{Batch, Kind, bits, classify};
use crate::narrow::separate_one;
use crate::tree::{LANES, Leaf, Node, Tree};
use bowknot_geometry::Point;

/// Leaves of querying elements that one task handles.
pub const TASK_LEAVES: usize = 8;

/// Everything a traversal reads beside the trees.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    pub model: &'a CollisionModel,
    pub positions: &'a [Point],
    pub radii: &'a [f64],
    /// Whether some pairs of bodies that meet in the trees may not collide.
    pub filtered: bool,
}

/// Leaves of a tree, to be searched for in others.
pub struct Query<'a, const A: usize, const B: usize> {
    pub tree: &'a Tree<A>,
    pub leaves: &'a [u32],
    pub targets: &'a [&'a Tree<B>],
}

/// The listed partners of one element.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    pub element: u32,
    /// Where its partners begin in [`Found::partners`].
    pub start: u32,
    pub count: u32,
}

/// What one task found; its buffers are kept between searches.
#[derive(Debug, Default)]
pub struct Found {
    pub runs: Vec<Run>,
    /// Partners of the elements of `runs`, ascending within each.
    pub partners: Vec<u32>,
    pub candidates: u64,
    pub undecided: u64,
    lists: [Vec<u32>; LANES],
    queue: Vec<Candidate>,
}

/// A pair whose boxes meet.
#[derive(Clone, Copy, Debug, Default)]
struct Candidate {
    /// Lane of the element in its leaf.
    lane: u32,
    /// Leaf and lane of the other element in its tree.
    other_leaf: u32,
    other_lane: u32,
}

/// Leaves of `tree` whose boxes meet `bounds`, ascending.
pub fn leaves_meeting<const V: usize>(tree: &Tree<V>, bounds: &[[f32; 3]; 2], out: &mut Vec<u32>) {
    out.clear();
    let Some(top) = tree.levels.len().checked_sub(1) else { return };
    let mut stack = vec![(top, 0)];
    while let Some((level, index)) = stack.pop() {
        let mut mask = overlap(&tree.levels[level][index], bounds);
        while mask != 0 {
            let child = index * LANES + mask.trailing_zeros() as usize;
            mask &= mask - 1;
            if level == 1 { out.push(child as u32) } else { stack.push((level - 1, child)) }
        }
    }
    out.sort_unstable();
}

/// Lists the partners of the elements in `query.leaves`.
///
/// Compiled for several instruction sets; the operations and hence the results are the same.
#[multiversion::multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2+bmi1+bmi2+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+lzcnt+popcnt",
))]
pub fn search_leaves<K: Kind<A, B>, const A: usize, const B: usize, const SWEPT: bool>(
    scene: &Scene<'_>,
    query: &Query<'_, A, B>,
    found: &mut Found,
) {
    found.runs.clear();
    found.partners.clear();
    found.candidates = 0;
    found.undecided = 0;
    for &index in query.leaves {
        search_leaf::<K, A, B, SWEPT>(scene, query, index as usize, found);
    }
}

#[inline(always)]
fn search_leaf<K: Kind<A, B>, const A: usize, const B: usize, const SWEPT: bool>(
    scene: &Scene<'_>,
    query: &Query<'_, A, B>,
    index: usize,
    found: &mut Found,
) {
    let bounds = query.tree.leaf_bounds(index);
    let first_element = query.tree.leaves[index].elements.iter().fold(u32::MAX, |first, &e| first.min(e));
    for target in query.targets {
        let Some(top) = target.levels.len().checked_sub(1) else { continue };
        let mut stack = [(0_u32, 0_u32); LANES * 8];
        stack[0] = (top as u32, 0);
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let (level, node) = stack[depth];
            let mut mask = overlap(&target.levels[level as usize][node as usize], &bounds);
            while mask != 0 {
                let child = node * LANES as u32 + mask.trailing_zeros();
                mask &= mask - 1;
                if level == 1 {
                    // Nothing there comes after any of these elements.
                    if K::SYMMETRIC && target.leaves[child as usize].last_element <= first_element {
                        continue;
                    }
                    meet::<K, A, B, SWEPT>(scene, query.tree, index, target, child as usize, found);
                } else {
                    stack[depth] = (level - 1, child);
                    depth += 1;
                }
            }
        }
        if !SWEPT {
            decide::<K, A, B>(scene, &query.tree.leaves[index], target, found);
        }
    }

    let leaf = &query.tree.leaves[index];
    for lane in 0..LANES {
        let list = &mut found.lists[lane];
        if list.is_empty() {
            continue;
        }
        list.sort_unstable();
        found.runs.push(Run {
            element: leaf.elements[lane],
            start: found.partners.len() as u32,
            count: list.len() as u32,
        });
        found.partners.extend_from_slice(list);
        list.clear();
    }
}

/// The elements of one leaf against those of another.
#[inline(always)]
fn meet<K: Kind<A, B>, const A: usize, const B: usize, const SWEPT: bool>(
    scene: &Scene<'_>,
    query: &Tree<A>,
    index: usize,
    target: &Tree<B>,
    other: usize,
    found: &mut Found,
) {
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
        let mut mask = overlap(other_boxes, &boxes.lane(lane));
        if mask == 0 {
            continue;
        }
        mask &= partners::<A, B>(K::SYMMETRIC, element, &vertices, other_leaf);
        if scene.filtered {
            mask = filter(scene.model, vertices[0], &other_leaf.vertices[0], mask);
        }
        if mask == 0 {
            continue;
        }
        if SWEPT {
            let own = moving_box(query, index, lane);
            mask &= match target.sweep.get(other) {
                Some([first, last]) => sweeps_meet(first, last, &own),
                None => sweeps_meet(other_boxes, other_boxes, &own),
            };
            found.candidates += u64::from(mask.count_ones());
            push(&mut found.lists[lane], mask, other_leaf);
            continue;
        }
        while mask != 0 {
            let other_lane = mask.trailing_zeros();
            mask &= mask - 1;
            found.queue.push(Candidate { lane: lane as u32, other_leaf: other as u32, other_lane });
        }
    }
}

/// Decides the queued pairs and empties the queue.
#[inline(always)]
fn decide<K: Kind<A, B>, const A: usize, const B: usize>(
    scene: &Scene<'_>,
    leaf: &Leaf<A>,
    target: &Tree<B>,
    found: &mut Found,
) {
    found.candidates += found.queue.len() as u64;
    let mut batch = Batch {
        a: [[[0.0; LANES]; 3]; A],
        b: [[[0.0; LANES]; 3]; B],
        reject: [0.0; LANES],
        accept: [0.0; LANES],
    };
    for candidates in found.queue.chunks(LANES) {
        for (slot, candidate) in candidates.iter().enumerate() {
            let lane = candidate.lane as usize % LANES;
            let other = &target.leaves[candidate.other_leaf as usize];
            let other_lane = candidate.other_lane as usize % LANES;
            for k in 0..3 {
                for i in 0..A {
                    batch.a[i][k][slot] = leaf.positions[i][k][lane];
                }
                for j in 0..B {
                    batch.b[j][k][slot] = other.positions[j][k][other_lane];
                }
            }
            batch.reject[slot] = leaf.reject[lane] + other.reject[other_lane];
            batch.accept[slot] = leaf.accept[lane] + other.accept[other_lane];
        }
        let verdicts = classify::<K, A, B>(&batch);
        // Slots beyond the candidates hold something old.
        let present = (1_u32 << candidates.len()) - 1;
        let mut near = present & verdicts.accepted;
        let mut undecided = present & !(verdicts.accepted | verdicts.rejected);
        while undecided != 0 {
            let slot = undecided.trailing_zeros() as usize;
            undecided &= undecided - 1;
            found.undecided += 1;
            let candidate = candidates[slot];
            let other = &target.leaves[candidate.other_leaf as usize];
            let a = std::array::from_fn(|i| leaf.vertices[i][candidate.lane as usize % LANES]);
            let b = std::array::from_fn(|j| other.vertices[j][candidate.other_lane as usize % LANES]);
            near |= u32::from(is_near::<K, A, B>(scene, a, b)) << slot;
        }
        while near != 0 {
            let candidate = candidates[near.trailing_zeros() as usize % LANES];
            near &= near - 1;
            let other = &target.leaves[candidate.other_leaf as usize];
            found.lists[candidate.lane as usize % LANES]
                .push(other.elements[candidate.other_lane as usize % LANES]);
        }
    }
    found.queue.clear();
}

#[inline(always)]
fn push<const B: usize>(list: &mut Vec<u32>, mut mask: u32, leaf: &Leaf<B>) {
    while mask != 0 {
        list.push(leaf.elements[mask.trailing_zeros() as usize % LANES]);
        mask &= mask - 1;
    }
}

/// The boxes of a node that meet a box, one bit each.
#[inline(always)]
fn overlap(node: &Node, [low, high]: &[[f32; 3]; 2]) -> u32 {
    let mut flags = [0_u8; LANES];
    for lane in 0..LANES {
        let x = (node.low[0][lane] <= high[0]) & (low[0] <= node.high[0][lane]);
        let y = (node.low[1][lane] <= high[1]) & (low[1] <= node.high[1][lane]);
        let z = (node.low[2][lane] <= high[2]) & (low[2] <= node.high[2][lane]);
        flags[lane] = u8::from(x & y & z);
    }
    bits(&flags)
}

/// Elements of a leaf that share no vertex with another element, and, where each pair would be met
/// twice, have the larger index.
#[inline(always)]
fn partners<const A: usize, const B: usize>(
    symmetric: bool,
    element: u32,
    vertices: &[u32; A],
    leaf: &Leaf<B>,
) -> u32 {
    let mut flags = [0_u8; LANES];
    for lane in 0..LANES {
        let mut apart = !symmetric | (leaf.elements[lane] > element);
        for i in 0..A {
            for j in 0..B {
                apart &= vertices[i] != leaf.vertices[j][lane];
            }
        }
        flags[lane] = u8::from(apart);
    }
    bits(&flags)
}

/// Drops the pairs whose bodies do not collide.
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
fn is_near<K: Kind<A, B>, const A: usize, const B: usize>(
    scene: &Scene<'_>,
    a: [u32; A],
    b: [u32; B],
) -> bool {
    let mut vertices = [a[0]; 4];
    a.iter().chain(&b).zip(&mut vertices).for_each(|(&v, vertex)| *vertex = v);
    let largest = |side: &[u32]| side.iter().map(|&v| scene.radii[v as usize]).fold(0.0, f64::max);
    // Rounded up: a pair exactly at the radii must not be lost.
    separate_one(K::KIND, vertices, scene.positions).width <= (largest(&a) + largest(&b)).next_up()
}

/// The boxes of an element at the start and at the end of the sweep.
#[inline(always)]
fn moving_box<const V: usize>(tree: &Tree<V>, leaf: usize, lane: usize) -> [[[f32; 3]; 2]; 2] {
    match tree.sweep.get(leaf) {
        Some([first, last]) => [first.lane(lane), last.lane(lane)],
        None => [tree.levels[0][leaf].lane(lane); 2],
    }
}

/// The elements of a leaf whose moving boxes meet another moving box at one and the same time.
///
/// A vertex goes from x to x + u in a straight line, so a bound of its element (the least of linear
/// functions of time is concave) never falls below the straight line between the bound at the start
/// and that at the end: the box whose corners move linearly from the first to the last contains the
/// element all the time, inflated by its radius. Two such boxes are apart along an axis while a gap,
/// linear in time, is positive. A gap positive at both ends is so always. One that changes sign
/// does it at g0 / (g0 - g1); both ends are right to u = 2^-24 of themselves, as the corners are
/// exact data, and the denominator adds numbers of one sign, so the time is right to 4 u and is
/// moved outward by 16 u. The pair is dropped where the six intervals of no gap and [0, 1] have no
/// time in common.
#[inline(always)]
fn sweeps_meet(first: &Node, last: &Node, [own_first, own_last]: &[[[f32; 3]; 2]; 2]) -> u32 {
    const EARLIER: f32 = 1.0 - 16.0 * UNIT;
    const LATER: f32 = 1.0 + 16.0 * UNIT;
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
        flags[lane] = u8::from(!apart & (enter <= leave));
    }
    bits(&flags)
}
