//! What is fixed about what is judged: elements, bodies, who is exempt.

use crate::error::CheckError;
use crate::exceptions::uncovered_pairs;
use crate::report::PairClass;
use bowknot_geometry::{BodyFilter, CollisionModel, HalfSpace, Point, check_elements};

/// Coordinates from here on are refused: exact predicates multiply three differences of them [m].
const LARGEST_COORDINATE: f64 = 1e60;

/// Loose meshes to be judged. Every slice but those said to be optional may be empty as well.
#[derive(Clone, Copy, Debug, Default)]
pub struct Parts<'a> {
    /// Number of vertices.
    pub vertex_count: usize,
    /// Vertices of each triangle.
    pub triangles: &'a [[u32; 3]],
    /// Vertices of each strand edge; edges of triangles are known already.
    pub strands: &'a [[u32; 2]],
    /// Vertices that are judged as points; those in edges or triangles are known already.
    pub particles: &'a [u32],
    /// Whether each vertex is of an obstacle; empty: none is. A primitive is of an obstacle if all its
    /// vertices are.
    pub obstacle: &'a [bool],
    /// Body of each vertex, for reports and filters; empty: all are of body 0.
    pub body: &'a [u32],
    /// Which bodies meet, and which meet themselves, one entry per body; bodies without one meet all. What is an
    /// obstacle is said by `obstacle` alone.
    pub filters: &'a [BodyFilter],
    /// Half-spaces, which every vertex not of an obstacle must be above.
    pub half_spaces: &'a [HalfSpace],
}

/// Judges states and straight paths of fixed elements; see the [crate](crate) for what is judged.
#[derive(Clone, Debug, Default)]
pub struct Judge {
    pub(super) vertex_count: usize,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) edges: Vec<[u32; 2]>,
    pub(super) strands: Vec<u32>,
    pub(super) particles: Vec<u32>,
    /// Vertices that are judged at all, ascending.
    pub(super) vertices: Vec<u32>,
    pub(super) half_spaces: Vec<HalfSpace>,
    /// Touching pairs that no edge-triangle pair stands for.
    pub(super) uncovered: Vec<(PairClass, [u32; 2])>,
    /// One entry per vertex.
    pub(super) obstacle: Vec<bool>,
    /// One entry per vertex.
    body: Vec<u32>,
    /// See [`Parts::filters`].
    filters: Vec<BodyFilter>,
}

impl Judge {
    /// A judge of loose meshes.
    ///
    /// # Errors
    /// The first index out of range, repeated vertex or array of the wrong length.
    pub fn new(parts: &Parts<'_>) -> Result<Self, CheckError> {
        let vertex_count = parts.vertex_count;
        for (what, given) in [("obstacle", parts.obstacle.len()), ("body", parts.body.len())] {
            if given != 0 && given != vertex_count {
                return Err(CheckError::WrongLength { what, given, vertex_count });
            }
        }
        let mut faults = check_elements("triangle", parts.triangles, vertex_count)
            .chain(check_elements("strand edge", parts.strands, vertex_count))
            .chain(check_elements("particle", parts.particles.as_chunks::<1>().0, vertex_count));
        if let Some(fault) = faults.next() {
            return Err(fault.into());
        }

        let ascending = |[i, j]: [u32; 2]| [i.min(j), i.max(j)];
        // The flag sorts a triangle's copy of an edge before a strand's, which is then dropped.
        let mut flagged: Vec<([u32; 2], bool)> = parts
            .triangles
            .iter()
            .flat_map(|&[i, j, k]| [[i, j], [j, k], [k, i]])
            .map(|edge| (ascending(edge), false))
            .chain(parts.strands.iter().map(|&edge| (ascending(edge), true)))
            .collect();
        flagged.sort_unstable();
        flagged.dedup_by_key(|entry| entry.0);
        let edges: Vec<[u32; 2]> = flagged.iter().map(|entry| entry.0).collect();
        let strands = (0..edges.len() as u32).filter(|&e| flagged[e as usize].1).collect();

        let mut used = vec![false; vertex_count];
        edges.iter().flatten().for_each(|&v| used[v as usize] = true);
        let mut particles: Vec<u32> =
            parts.particles.iter().copied().filter(|&v| !used[v as usize]).collect();
        particles.sort_unstable();
        particles.dedup();
        particles.iter().for_each(|&v| used[v as usize] = true);

        let uncovered = uncovered_pairs(vertex_count, parts.triangles, &edges);
        let or_default = |given: bool| if given { 0 } else { vertex_count };
        Ok(Self {
            vertex_count,
            triangles: parts.triangles.to_vec(),
            edges,
            strands,
            particles,
            vertices: (0..vertex_count as u32).filter(|&v| used[v as usize]).collect(),
            half_spaces: parts.half_spaces.to_vec(),
            uncovered,
            obstacle: [parts.obstacle, &vec![false; or_default(!parts.obstacle.is_empty())]].concat(),
            body: [parts.body, &vec![0; or_default(!parts.body.is_empty())]].concat(),
            filters: parts.filters.to_vec(),
        })
    }

    /// A judge of a scene, with the filters of its bodies.
    pub fn from_model(model: &CollisionModel) -> Self {
        let topology = model.topology();
        let strands: Vec<[u32; 2]> =
            topology.strand_edges.iter().map(|&e| topology.edges[e as usize]).collect();
        let obstacle: Vec<bool> = (0..topology.vertex_count as u32).map(|v| model.is_obstacle(v)).collect();
        let parts = Parts {
            vertex_count: topology.vertex_count,
            triangles: &topology.triangles,
            strands: &strands,
            particles: &topology.particles,
            obstacle: &obstacle,
            body: model.vertex_body(),
            half_spaces: model.half_spaces(),
            filters: model.bodies(),
        };
        // A model has passed these checks already, so the default is never taken.
        Self::new(&parts).unwrap_or_default()
    }

    /// All edges, of triangles and strands: smaller vertex first, ascending, each once.
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// Number of vertices that a state must have.
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// Whether positions can be judged.
    pub(super) fn check_positions(&self, what: &'static str, x: &[Point]) -> Result<(), CheckError> {
        if x.len() != self.vertex_count {
            return Err(CheckError::WrongLength { what, given: x.len(), vertex_count: self.vertex_count });
        }
        let bad = |v: &&u32| !x[**v as usize].iter().all(|c| c.abs() < LARGEST_COORDINATE);
        match self.vertices.iter().find(bad) {
            Some(&v) => Err(CheckError::BadCoordinate {
                vertex: v as usize,
                position: x[v as usize].coords.into(),
                limit: LARGEST_COORDINATE,
            }),
            None => Ok(()),
        }
    }

    /// Vertices of either side of a pair; none for a half-space.
    ///
    /// # Panics
    /// If the elements are not of this judge.
    pub fn sides(&self, class: PairClass, [a, b]: [u32; 2]) -> [&[u32]; 2] {
        let vertex = |v: u32| {
            // `vertices` is sorted and holds every vertex that can be in a pair.
            let at = self.vertices.partition_point(|&w| w < v);
            &self.vertices[at..at + 1]
        };
        let edge = |e: u32| &self.edges[e as usize][..];
        match class {
            PairClass::EdgeTriangle => [edge(a), &self.triangles[b as usize]],
            PairClass::EdgeEdge => [edge(a), edge(b)],
            PairClass::VertexTriangle => [vertex(a), &self.triangles[b as usize]],
            PairClass::VertexEdge => [vertex(a), edge(b)],
            PairClass::VertexVertex => [vertex(a), vertex(b)],
            PairClass::VertexHalfSpace => [vertex(a), &[]],
        }
    }

    /// Bodies of either side of a pair.
    pub(super) fn side_bodies(&self, sides: [&[u32]; 2]) -> [Option<u32>; 2] {
        sides.map(|side| side.first().map(|&v| self.body[v as usize]))
    }

    /// Whether two primitives are judged against each other: they share no vertex, and their bodies
    /// meet. (Obstacles are told apart by the trees' flags.)
    #[inline]
    pub(super) fn may_meet(&self, a: &[u32], b: &[u32]) -> bool {
        if a.iter().any(|v| b.contains(v)) {
            return false;
        }
        let (body_a, body_b) = (self.body[a[0] as usize], self.body[b[0] as usize]);
        match (self.filters.get(body_a as usize), self.filters.get(body_b as usize)) {
            (Some(filter), _) if body_a == body_b => filter.self_collision,
            (Some(f), Some(g)) => f.groups & g.mask != 0 && g.groups & f.mask != 0,
            _ => true,
        }
    }

    /// Whether a vertex must be above the half-spaces.
    pub(super) fn meets_half_spaces(&self, v: u32) -> bool {
        !self.obstacle[v as usize]
    }
}
