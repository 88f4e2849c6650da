//! What is fixed during a run: bodies, masses, elements, the pattern of the matrix.

mod assembly;
mod check;

use crate::elements::{ElementFamily, Kind};
use crate::linear::block::BlockPattern;
use crate::linear::coarse::Coarse;
use crate::linear::direct::Direct;
use crate::linear::ordering::order_nodes;
use crate::linear::preconditioner::Preconditioner;
use crate::linear::scalar::ScalarForm;
use crate::{Body, BodyShape, ModelError};
use assembly::{Assembly, Elements};
use bowknot_geometry::{Point, Vector};
pub(crate) use check::volume;
use check::{area, check};
use std::ops::Range;

/// Most nodes of a leaf of the numbering, the aggregates of the coarse correction. Halving makes
/// them 32 to 64 nodes large.
const LEAF: usize = 64;

/// Most aggregates: beyond, they grow, so that the coarse factor, whose cost rises with their number
/// to the power 1.5, stays a small part of a step.
const MAX_AGGREGATES: usize = 4096;

/// "No node": the vertex has no freedom, ever.
pub(crate) const NO_NODE: u32 = u32::MAX;

/// What is fixed during a run.
///
/// Internally the deformable vertices are *nodes*, numbered along the mesh; all slices of the public
/// interface are in the order of the scene's vertices.
pub struct DynamicsModel {
    rest_positions: Vec<Point>,
    bodies: Vec<Body>,
    vertex_body: Vec<u32>,
    masses: Vec<f64>,
    obstacle: Vec<bool>,
    pub(crate) node_vertex: Vec<u32>,
    pub(crate) vertex_node: Vec<u32>,
    pub(crate) node_masses: Vec<f64>,
    /// Mass of the component that each node is in [kg].
    pub(crate) body_masses: Vec<f64>,
    /// Whether each node is part of strands and of nothing else.
    pub(crate) strands: Vec<bool>,
    pub(crate) families: Vec<Box<dyn ElementFamily>>,
    pub(crate) pattern: BlockPattern,
    /// Bending [N/m].
    pub(crate) bending: ScalarForm,
    /// Bending times each body's damping time [N s/m]; same pattern. None if no body has any.
    pub(crate) bending_damping: Option<ScalarForm>,
    /// Edges of cloth and strands with their rest lengths [m].
    pub(crate) edges: Vec<([u32; 2], f64)>,
    /// Ranges of nodes that are compact patches.
    pub(crate) leaves: Vec<Range<u32>>,
    /// Ranges of nodes that elements join.
    pub(crate) components: Vec<Range<u32>>,
}

impl std::fmt::Debug for DynamicsModel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("DynamicsModel")
            .field("vertices", &self.rest_positions.len())
            .field("nodes", &self.node_vertex.len())
            .field("bodies", &self.bodies.iter().map(|b| &b.name).collect::<Vec<_>>())
            .finish_non_exhaustive()
    }
}

impl DynamicsModel {
    /// Builds masses, elements and patterns from the rest positions [m] of all vertices.
    ///
    /// A vertex may be shared by several deformable bodies (they are sewn together there), never by one
    /// and an obstacle.
    ///
    /// # Errors
    /// Everything that is wrong, see [`ModelError`].
    pub fn new(rest_positions: Vec<Point>, bodies: Vec<Body>) -> Result<Self, Vec<ModelError>> {
        let errors = check(&rest_positions, &bodies);
        if !errors.is_empty() {
            return Err(errors);
        }
        let count = rest_positions.len();
        let mut obstacle = vec![false; count];
        let mut vertex_body = vec![u32::MAX; count];
        for (index, body) in bodies.iter().enumerate() {
            body.shape.for_each_element(|vertices| {
                for &v in vertices {
                    obstacle[v as usize] = body.shape.is_obstacle();
                    vertex_body[v as usize] = index as u32;
                }
            });
        }
        if let Some(vertex) = vertex_body.iter().position(|body| *body == u32::MAX) {
            return Err(vec![ModelError::NoMass { vertex }]);
        }
        let masses = masses(&rest_positions, &bodies);

        let deformable: Vec<u32> = (0..count as u32).filter(|&v| !obstacle[v as usize]).collect();
        let mut compact = vec![NO_NODE; count];
        deformable.iter().enumerate().for_each(|(k, &v)| compact[v as usize] = k as u32);
        let positions: Vec<Vector> = deformable.iter().map(|&v| rest_positions[v as usize].coords).collect();
        let leaf = LEAF.max(positions.len().div_ceil(MAX_AGGREGATES));
        let ordering = order_nodes(&positions, leaf, |link| {
            for body in bodies.iter().filter(|body| !body.shape.is_obstacle()) {
                body.shape.for_each_element(|vertices| {
                    for pair in vertices.windows(2) {
                        link(compact[pair[0] as usize], compact[pair[1] as usize]);
                    }
                });
            }
        });
        let node_vertex: Vec<u32> = ordering.order.iter().map(|&k| deformable[k as usize]).collect();
        let mut vertex_node = vec![NO_NODE; count];
        node_vertex.iter().enumerate().for_each(|(node, &v)| vertex_node[v as usize] = node as u32);

        let rest: Vec<Vector> = node_vertex.iter().map(|&v| rest_positions[v as usize].coords).collect();
        let mut assembly = Assembly::new(&rest);
        bodies.iter().for_each(|body| assembly.add(&body.shape, &vertex_node));
        let Elements { mut families, edges, bending, bending_damping } = assembly.finish();
        let pattern = BlockPattern::from_cliques(rest.len(), |visit| {
            families.iter().for_each(|family| family.for_each_clique(visit));
        });
        families.iter_mut().for_each(|family| family.bind(rest.len(), &pattern));
        let node_masses: Vec<f64> = node_vertex.iter().map(|&v| masses[v as usize]).collect();
        let body_masses = ordering.components.iter().flat_map(|component| {
            let mass = node_masses[component.start as usize..component.end as usize].iter().sum();
            std::iter::repeat_n(mass, component.len())
        });
        let is_strand = |kind| matches!(kind, Kind::StrandStretching | Kind::StrandBending);
        let mut strands = joined(&families, rest.len(), is_strand);
        let others = joined(&families, rest.len(), |kind| !is_strand(kind));
        strands.iter_mut().zip(&others).for_each(|(strand, other)| *strand &= !other);
        Ok(Self {
            strands,
            bodies,
            vertex_body,
            obstacle,
            body_masses: body_masses.collect(),
            node_masses,
            masses,
            rest_positions,
            node_vertex,
            vertex_node,
            families,
            pattern,
            bending,
            bending_damping,
            edges,
            leaves: ordering.leaves,
            components: ordering.components,
        })
    }

    /// The two-level preconditioner of this model: strands are solved exactly, other components that elements
    /// join get a coarse correction, single nodes need neither.
    pub(crate) fn two_level(&self) -> Preconditioner {
        let single = |n: usize| self.pattern.row(n).is_empty();
        // A component is all of one kind or, where strands are fixed to other bodies, in the coarse space.
        let mut leaves = Vec::new();
        let mut next = 0;
        for component in &self.components {
            let mut nodes = component.start as usize..component.end as usize;
            let coarse = nodes.any(|n| !self.strands[n] && !single(n));
            while next < self.leaves.len() && self.leaves[next].start < component.end {
                leaves.extend(coarse.then(|| self.leaves[next].clone()));
                next += 1;
            }
        }
        let rest: Vec<Vector> =
            self.node_vertex.iter().map(|&v| self.rest_positions[v as usize].coords).collect();
        let coarse = (!leaves.is_empty()).then(|| {
            Coarse::new(&leaves, &rest, |row, visit| {
                self.pattern.columns[self.pattern.row(row)].iter().for_each(|&column| visit(column));
                self.bending.row(row).0.iter().for_each(|&column| visit(column));
            })
        });
        Preconditioner::new(Direct::new(&self.pattern, &self.strands), coarse)
    }

    /// Number of vertices, obstacles included.
    pub fn vertex_count(&self) -> usize {
        self.rest_positions.len()
    }

    /// Rest positions [m].
    pub fn rest_positions(&self) -> &[Point] {
        &self.rest_positions
    }

    /// The bodies, as given.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Mass of each vertex [kg]: a third of every triangle's, a quarter of every tet's, half of every strand
    /// edge's, all of a grain's; 0 for vertices of obstacles.
    pub fn masses(&self) -> &[f64] {
        &self.masses
    }

    /// Whether each vertex belongs to an obstacle.
    pub fn obstacle(&self) -> &[bool] {
        &self.obstacle
    }

    /// The component that a node is in, or their number for [`NO_NODE`].
    pub(crate) fn component(&self, node: u32) -> usize {
        self.components.partition_point(|c| c.end <= node)
    }

    /// Whether strands are among the bodies.
    pub(crate) fn has_strands(&self) -> bool {
        self.bodies.iter().any(|body| matches!(body.shape, BodyShape::Strands { .. }))
    }

    /// Mass of all deformable bodies [kg].
    pub fn total_mass(&self) -> f64 {
        self.masses.iter().sum()
    }

    /// Gravity on a vertex [m/s^2]: that of its body (where several meet, the last), else the `scene`'s.
    pub fn gravity(&self, vertex: usize, scene: Vector) -> Vector {
        let body = self.vertex_body.get(vertex).and_then(|&b| self.bodies.get(b as usize));
        body.and_then(|b| b.gravity).unwrap_or(scene)
    }

    /// Name of the body that a vertex belongs to; where several meet, the last.
    pub fn body_name(&self, vertex: usize) -> &str {
        self.vertex_body.get(vertex).and_then(|&b| self.bodies.get(b as usize)).map_or("", |b| &b.name)
    }
}

/// Which of `nodes` nodes elements of some kinds join.
fn joined(families: &[Box<dyn ElementFamily>], nodes: usize, kinds: impl Fn(Kind) -> bool) -> Vec<bool> {
    let mut joined = vec![false; nodes];
    for family in families.iter().filter(|family| kinds(family.kind())) {
        family.for_each_clique(&mut |clique| clique.iter().for_each(|&n| joined[n as usize] = true));
    }
    joined
}

/// Lumped masses [kg].
fn masses(positions: &[Point], bodies: &[Body]) -> Vec<f64> {
    let mut masses = vec![0.0; positions.len()];
    let at = |v: u32| positions[v as usize].coords;
    for body in bodies {
        let mut share = |vertices: &[u32], mass: f64| {
            vertices.iter().for_each(|&v| masses[v as usize] += mass / vertices.len() as f64);
        };
        match &body.shape {
            BodyShape::Cloth { triangles, material } => {
                triangles.iter().for_each(|t| share(t, area(&t.map(at)) * material.density));
            }
            BodyShape::Solid { tets, material } => {
                tets.iter().for_each(|t| share(t, volume(&t.map(at)) * material.density));
            }
            BodyShape::Strands { edges, material } => {
                edges.iter().for_each(|e| share(e, (at(e[0]) - at(e[1])).norm() * material.density));
            }
            BodyShape::Particles { vertices, material } => {
                vertices.iter().for_each(|v| share(&[*v], material.mass()));
            }
            BodyShape::Obstacle { .. } => {}
        }
    }
    masses
}

#[cfg(test)]
mod tests;
