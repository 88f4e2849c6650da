//! Implicit trees of boxes with eight children per node: the host orders the elements in space, the device
//! fits the boxes.
//!
//! Children of node i of a level are 8 i .. 8 i + 7 of the level below, without pointers. Each level is
//! padded to a multiple of 8 with empty boxes, the top level has one group. When elements move, the order
//! stays; an order that is old costs time but no pair.

use crate::grid::GridPoint;
use crate::layout::{BRANCHING, MAX_LEVELS, NONE, NodeBox, Slot};

/// The order of the elements of a tree, and the places of its levels.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    /// Elements in spatial order, padded to a multiple of 8.
    pub slots: Vec<Slot>,
    /// Vertices of an element.
    pub vertex_count: usize,
    /// First node and number of nodes of each level, without padding; level 0 holds the elements.
    pub levels: Vec<Level>,
    /// Number of boxes of all levels, padding included.
    pub box_count: usize,
}

/// A level of a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level {
    pub first: usize,
    pub nodes: usize,
}

impl Tree {
    /// The tree of `elements`, each with its index and its vertices at `positions`.
    pub fn new<const V: usize>(elements: &[(u32, [u32; V])], positions: &[GridPoint]) -> Self {
        let center = |vertices: &[u32; V]| -> [i64; 3] {
            [0, 1, 2].map(|k| vertices.iter().map(|&v| i64::from(positions[v as usize][k])).sum())
        };
        let mut order: Vec<(usize, [i64; 3])> =
            elements.iter().enumerate().map(|(place, (_, vertices))| (place, center(vertices))).collect();
        bisect(&mut order);
        let mut slots: Vec<Slot> = order
            .iter()
            .map(|&(place, _)| {
                let (element, vertices) = elements[place];
                Slot { vertices: [0, 1, 2].map(|k| *vertices.get(k).unwrap_or(&vertices[0])), element }
            })
            .collect();
        let mut tree = Self { vertex_count: V, ..Self::default() };
        let mut nodes = slots.len();
        slots.resize(padded(nodes), Slot { vertices: [0; 3], element: NONE });
        tree.slots = slots;
        while nodes > 0 {
            tree.levels.push(Level { first: tree.box_count, nodes });
            tree.box_count += padded(nodes);
            if nodes <= BRANCHING {
                break;
            }
            nodes = nodes.div_ceil(BRANCHING);
        }
        debug_assert!(tree.levels.len() <= MAX_LEVELS);
        tree
    }

    /// The tree of the same elements, with their vertices at other positions.
    pub fn reordered(&self, positions: &[GridPoint]) -> Self {
        match self.vertex_count {
            1 => Self::new(&self.elements::<1>(), positions),
            2 => Self::new(&self.elements::<2>(), positions),
            _ => Self::new(&self.elements::<3>(), positions),
        }
    }

    /// The elements by index, each with its vertices.
    fn elements<const V: usize>(&self) -> Vec<(u32, [u32; V])> {
        let slots = self.slots.iter().filter(|slot| slot.element != NONE);
        let mut elements: Vec<(u32, [u32; V])> =
            slots.map(|slot| (slot.element, std::array::from_fn(|k| slot.vertices[k]))).collect();
        elements.sort_unstable();
        elements
    }

    /// Whether there is no element.
    pub fn is_empty(&self) -> bool {
        self.levels.is_empty()
    }

    /// The boxes before the first fit: all of them empty.
    pub fn blank_boxes(&self) -> Vec<NodeBox> {
        vec![NodeBox::EMPTY; self.box_count]
    }
}

fn padded(nodes: usize) -> usize {
    nodes.next_multiple_of(BRANCHING)
}

/// Orders elements so that groups of 8, 64, 512, .. are compact: halves along the longest side, at a multiple
/// of the largest power of 8 below their number.
fn bisect(order: &mut [(usize, [i64; 3])]) {
    let count = order.len();
    if count <= BRANCHING {
        return;
    }
    let mut unit = BRANCHING;
    while unit * BRANCHING < count {
        unit *= BRANCHING;
    }
    let middle = count.div_ceil(unit) / 2 * unit;
    let (mut low, mut high) = ([i64::MAX; 3], [i64::MIN; 3]);
    for (_, center) in order.iter() {
        for k in 0..3 {
            low[k] = low[k].min(center[k]);
            high[k] = high[k].max(center[k]);
        }
    }
    let axis = (0..3).max_by_key(|&k| high[k] - low[k]).unwrap_or(0);
    // Ties are broken by place, so that the order depends on the input alone.
    order.select_nth_unstable_by_key(middle, |(place, center)| (center[axis], *place));
    let (left, right) = order.split_at_mut(middle);
    bisect(left);
    bisect(right);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_hold_eight_times_fewer_nodes_and_groups_are_compact() {
        let count = 8 * 8 * 3 + 5;
        let positions: Vec<GridPoint> = (0..count).map(|i| [(i * 7919) % count, 0, 0]).collect();
        let elements: Vec<(u32, [u32; 1])> = (0..count as u32).map(|v| (v, [v])).collect();
        let tree = Tree::new(&elements, &positions);
        let nodes: Vec<usize> = tree.levels.iter().map(|level| level.nodes).collect();
        assert_eq!(nodes, [197, 25, 4]);
        assert_eq!(tree.levels[1].first, 200);
        assert_eq!((tree.slots.len(), tree.box_count), (200, 200 + 32 + 8));
        let mut seen: Vec<u32> = tree.slots.iter().map(|slot| slot.element).filter(|e| *e != NONE).collect();
        for group in tree.slots[..192].chunks(8) {
            let x = || group.iter().map(|slot| positions[slot.element as usize][0]);
            assert_eq!(x().max().unwrap_or(0) - x().min().unwrap_or(0), 7);
        }
        seen.sort_unstable();
        assert!(seen.into_iter().eq(0..count as u32));
        assert!(Tree::new::<2>(&[], &positions).is_empty());
    }
}
