//! Lists of pairs.

use bowknot_geometry::{PairKind, Topology};
use rayon::prelude::*;
use std::ops::Range;

/// Pairs that one task matches.
const CHUNK: usize = 4096;

/// A partner of an element in a [`CandidateList`](crate::CandidateList): 8 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Candidate {
    /// The element of side *b*, by index.
    pub element: u32,
    /// Certified lower bound of the distance at the positions of the search [m], at least 0.
    pub bound: f32,
}

/// A pair of primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pair {
    /// The primitives' indices: vertices, edges or triangles of the topology by the pair's kind (for
    /// [`PairKind::VertexHalfSpace`] the vertex and the half-space). In edge-edge and vertex-vertex pairs the
    /// smaller index comes first.
    pub elements: [u32; 2],
    /// Vertices in [`PairKind`] order; unused places repeat the first vertex.
    pub vertices: [u32; 4],
}

impl Pair {
    /// The pair of two `elements`; for [`PairKind::VertexHalfSpace`] the second is the half-space.
    ///
    /// # Panics
    /// If the topology does not have them.
    #[inline(always)]
    pub fn of_elements(topology: &Topology, kind: PairKind, elements: [u32; 2]) -> Self {
        let [a, b] = elements;
        let vertices = match kind {
            PairKind::VertexVertex => [a, b, a, a],
            PairKind::VertexEdge => {
                let [b0, b1] = topology.edges[b as usize];
                [a, b0, b1, a]
            }
            PairKind::VertexTriangle => {
                let [b0, b1, b2] = topology.triangles[b as usize];
                [a, b0, b1, b2]
            }
            PairKind::EdgeEdge => {
                let [a0, a1] = topology.edges[a as usize];
                let [b0, b1] = topology.edges[b as usize];
                [a0, a1, b0, b1]
            }
            PairKind::VertexHalfSpace => [a; 4],
        };
        Self { elements, vertices }
    }
}

/// Looks up pairs in a sorted list, see [`PairList::lookup`].
#[derive(Clone, Debug)]
pub struct PairLookup<'a> {
    /// The pairs up to the end of the kind.
    pairs: &'a [Pair],
    next: usize,
}

impl PairLookup<'_> {
    /// The index of the pair of `elements` in its list, if the list has it. Elements must be asked for in
    /// ascending order.
    #[inline]
    pub fn find(&mut self, elements: [u32; 2]) -> Option<u32> {
        while self.pairs.get(self.next).is_some_and(|pair| pair.elements < elements) {
            self.next += 1;
        }
        let found = self.pairs.get(self.next).is_some_and(|pair| pair.elements == elements);
        found.then_some(self.next as u32)
    }
}

/// Pairs grouped by kind in the order of [`PairKind::ALL`], sorted by `elements` within a kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PairList {
    pairs: Vec<Pair>,
    /// Start of each kind in `pairs`, and the end.
    starts: [usize; 6],
}

impl PairList {
    /// A list from the pairs of each kind in the order of [`PairKind::ALL`]; they are sorted.
    pub fn from_kinds(kinds: [Vec<Pair>; 5]) -> Self {
        let mut list = Self::default();
        for (k, mut pairs) in kinds.into_iter().enumerate() {
            pairs.sort_unstable();
            list.pairs.append(&mut pairs);
            list.starts[k + 1] = list.pairs.len();
        }
        list
    }

    /// Resizes the list to the given number of pairs of each kind and returns it: the caller writes all
    /// pairs, in order and sorted within a kind.
    pub fn resize_kinds(&mut self, counts: [usize; 5]) -> &mut [Pair] {
        const BLANK: Pair = Pair { elements: [0; 2], vertices: [0; 4] };
        self.starts = [0; 6];
        for k in 0..5 {
            self.starts[k + 1] = self.starts[k] + counts[k];
        }
        self.pairs.resize(self.starts[5], BLANK);
        &mut self.pairs
    }

    /// Removes all pairs and keeps the allocation.
    pub fn clear(&mut self) {
        self.pairs.clear();
        self.starts = [0; 6];
    }

    /// For each pair, the index of the same pair in another list, or `u32::MAX` if that list does not have
    /// it. They replace the content of `matches`.
    ///
    /// Both lists are sorted, so it takes one pass over both. It serves to carry data of pairs, such as
    /// multipliers, from an old list to a new one.
    pub fn match_with(&self, old: &PairList, matches: &mut Vec<u32>) {
        matches.resize(self.len(), u32::MAX);
        for kind in PairKind::ALL {
            let range = self.range(kind);
            let pairs = self.pairs[range.clone()].par_chunks(CHUNK);
            pairs.zip(matches[range].par_chunks_mut(CHUNK)).for_each(|(pairs, matches)| {
                let mut old = old.lookup(kind, pairs[0].elements);
                for (pair, matched) in pairs.iter().zip(matches) {
                    *matched = old.find(pair.elements).unwrap_or(u32::MAX);
                }
            });
        }
    }

    /// Looks up pairs of a kind in ascending order, from `first` on.
    pub fn lookup(&self, kind: PairKind, first: [u32; 2]) -> PairLookup<'_> {
        let range = self.range(kind);
        let pairs = &self.pairs[..range.end];
        let before = pairs[range.start..].partition_point(|pair| pair.elements < first);
        PairLookup { pairs, next: range.start + before }
    }

    /// All pairs.
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// All pairs with their kinds, in the order of [`Self::pairs`].
    pub fn iter(&self) -> impl Iterator<Item = (PairKind, &Pair)> {
        PairKind::ALL
            .into_iter()
            .flat_map(|kind| self.pairs[self.range(kind)].iter().map(move |pair| (kind, pair)))
    }

    /// Where the pairs of a kind stand in [`Self::pairs`].
    pub fn range(&self, kind: PairKind) -> Range<usize> {
        self.starts[kind as usize]..self.starts[kind as usize + 1]
    }

    /// Kind of the pair at `index` of [`Self::pairs`].
    #[inline]
    pub fn kind(&self, index: usize) -> PairKind {
        let k = self.starts[1..5].iter().filter(|&&start| start <= index).count();
        PairKind::ALL[k]
    }

    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.pairs.len()
    }

    /// Whether there is no pair.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }
}
