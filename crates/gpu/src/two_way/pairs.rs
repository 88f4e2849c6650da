//! Pairs of a device as the CPU names them.

use crate::{Candidate, Carried, ContactRow, Kind};
use bowknot_geometry::{PairKind, Topology};
use bowknot_twoway::proximity::{Pair, PairList};
use bowknot_twoway::{CollisionScene, PairMultipliers};
use rayon::prelude::*;

/// The pairs of a list. None if one of them is no pair of the scene, which a device that works does not list.
pub fn list(scene: &CollisionScene, candidates: &[Candidate]) -> Option<PairList> {
    let (topology, half_spaces) = (scene.model().topology(), scene.model().half_spaces().len());
    let mut kinds: [Vec<Pair>; 5] = Default::default();
    // A sorted list is sorted by kind.
    for alike in candidates.chunk_by(|a, b| a.kind() == b.kind()) {
        let kind = *PairKind::ALL.get(alike[0].kind() as usize)?;
        let counts = element_counts(topology, half_spaces, kind);
        let pair = |candidate: &Candidate| {
            let (elements, _) = elements(kind, candidate);
            let exists = (0..2).all(|side| (elements[side] as usize) < counts[side]);
            exists.then(|| Pair::of_elements(topology, kind, elements))
        };
        let pairs: Option<Vec<Pair>> = match alike.len() {
            // A parallel loop would pay for the way to its threads.
            ..=CHUNK => alike.iter().map(pair).collect(),
            _ => alike.par_iter().with_min_len(CHUNK).map(pair).collect(),
        };
        kinds[kind as usize].extend(pairs?);
    }
    Some(PairList::from_kinds(kinds))
}

/// Pairs that one task looks at.
const CHUNK: usize = 16384;

/// What the contact of a row carries. None if it is no pair.
pub fn multipliers(row: &ContactRow) -> Option<PairMultipliers> {
    let kind = *PairKind::ALL.get(row.candidate.kind() as usize)?;
    let (elements, sign) = elements(kind, &row.candidate);
    Some(PairMultipliers { kind, elements, normal: row.multiplier, friction: row.friction * sign })
}

/// What a pair carries, as the device names it: the inverse of [`multipliers`]. None if no device numbers as
/// many elements.
pub fn carried(pair: &PairMultipliers) -> Option<Carried> {
    let kind = match pair.kind {
        PairKind::VertexVertex => Kind::VertexVertex,
        PairKind::VertexEdge => Kind::VertexEdge,
        PairKind::VertexTriangle => Kind::VertexTriangle,
        PairKind::EdgeEdge => Kind::EdgeEdge,
        PairKind::VertexHalfSpace => Kind::VertexHalfSpace,
    };
    let ([a, b], friction) = (pair.elements, pair.friction);
    let has_number = a >> Candidate::ELEMENT_BITS == 0;
    has_number.then(|| Carried { candidate: Candidate::new(kind, a, b), multiplier: pair.normal, friction })
}

/// The elements in the order of the CPU, and -1 if that changes sides.
fn elements(kind: PairKind, candidate: &Candidate) -> ([u32; 2], f64) {
    let (a, b) = (candidate.a(), candidate.b);
    let is_symmetric = matches!(kind, PairKind::VertexVertex | PairKind::EdgeEdge);
    if is_symmetric && b < a { ([b, a], -1.0) } else { ([a, b], 1.0) }
}

/// How many elements each side of a kind of pair can be.
fn element_counts(topology: &Topology, half_spaces: usize, kind: PairKind) -> [usize; 2] {
    let (vertices, edges) = (topology.vertex_count, topology.edges.len());
    match kind {
        PairKind::VertexVertex => [vertices; 2],
        PairKind::VertexEdge => [vertices, edges],
        PairKind::VertexTriangle => [vertices, topology.triangles.len()],
        PairKind::EdgeEdge => [edges; 2],
        PairKind::VertexHalfSpace => [vertices, half_spaces],
    }
}
