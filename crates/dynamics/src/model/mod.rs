//! The model: everything that is fixed during a run. Bodies, masses, elements, the pattern of the matrix.

mod assembly;
mod check;
mod masses;
pub(crate) mod measures;
mod stiffness;

use crate::body::{Body, BodyShape};
use crate::elements::set::{AnyElementSet, ElementKind};
use crate::error::ModelError;
use crate::linear::assembly::ElementModel;
use crate::linear::block::BlockPattern;
use crate::linear::ordering::order_nodes;
use crate::linear::scalar::ScalarForm;
use crate::nodes::NO_NODE;
use assembly::{Assembly, Elements};
use bowknot_errors::Errors;
use bowknot_geometry::{Point, Vector};
use check::check;
use masses::masses;
use std::ops::Range;

/// Largest number of nodes in a leaf of the numbering; leaves are the aggregates of the coarse correction. As
/// nodes are halved until they fit, a leaf has 32 to 64 nodes.
const MAX_LEAF_NODES: usize = 64;

/// Largest number of aggregates. In larger models aggregates are larger, so that the coarse factor, whose
/// cost grows with their number to the power 1.5, remains a small part of a step.
const MAX_AGGREGATES: usize = 4096;

/// Everything that is fixed during a run.
///
/// Internally the deformable vertices are *nodes*, numbered along the mesh. All slices of the public
/// interface are in the order of the scene's vertices.
pub struct DynamicsModel {
    rest_positions: Vec<Point>,
    bodies: Vec<Body>,
    vertex_body: Vec<u32>,
    masses: Vec<f64>,
    obstacle: Vec<bool>,
    /// Vertex of each node.
    pub(crate) node_vertex: Vec<u32>,
    /// Node of each vertex; [`NO_NODE`] for obstacles.
    pub(crate) vertex_node: Vec<u32>,
    pub(crate) node_masses: Vec<f64>,
    /// Mass of the component that each node is in [kg].
    pub(crate) component_masses: Vec<f64>,
    /// Stiffness of each node at rest in its softest and its stiffest direction [N/m].
    pub(crate) node_stiffness: Vec<[f64; 2]>,
    /// Whether each node belongs to strands only.
    pub(crate) strands: Vec<bool>,
    pub(crate) element_sets: Vec<Box<dyn AnyElementSet>>,
    pub(crate) pattern: BlockPattern,
    /// Bending [N/m].
    pub(crate) bending: ScalarForm,
    /// Bending times each body's damping time [N s/m], with the same pattern; None if no body has any.
    pub(crate) bending_damping: Option<ScalarForm>,
    /// Edges of cloth and strands with their rest lengths [m].
    pub(crate) edges: Vec<([u32; 2], f64)>,
    /// Ranges of nodes that are compact patches.
    pub(crate) leaves: Vec<Range<u32>>,
    /// Ranges of nodes that elements join, directly or through other nodes.
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
    /// Several deformable bodies may share a vertex (they are sewn together there); a deformable body and an
    /// obstacle may not.
    ///
    /// # Errors
    /// Every error that was found, see [`ModelError`].
    pub fn new(rest_positions: Vec<Point>, bodies: Vec<Body>) -> Result<Self, Errors<ModelError>> {
        check(&rest_positions, &bodies)?;
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
            return Err(ModelError::NoMass { vertex }.into());
        }
        let masses = masses(&rest_positions, &bodies);

        let deformable: Vec<u32> = (0..count as u32).filter(|&v| !obstacle[v as usize]).collect();
        let mut compact = vec![NO_NODE; count];
        deformable.iter().enumerate().for_each(|(k, &v)| compact[v as usize] = k as u32);
        let positions: Vec<Vector> = deformable.iter().map(|&v| rest_positions[v as usize].coords).collect();
        let leaf = MAX_LEAF_NODES.max(positions.len().div_ceil(MAX_AGGREGATES));
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
        let Elements { mut element_sets, edges, bending, bending_damping } = assembly.finish();
        let pattern = BlockPattern::from_cliques(rest.len(), |visit| {
            element_sets.iter().for_each(|set| set.for_each_clique(visit));
        });
        element_sets.iter_mut().for_each(|set| set.bind(rest.len(), &pattern));
        let node_masses: Vec<f64> = node_vertex.iter().map(|&v| masses[v as usize]).collect();
        let component_masses = ordering.components.iter().flat_map(|component| {
            let mass = node_masses[component.start as usize..component.end as usize].iter().sum();
            std::iter::repeat_n(mass, component.len())
        });
        let is_strand = |kind| matches!(kind, ElementKind::StrandStretching | ElementKind::StrandBending);
        let node_stiffness = stiffness::softest(&rest, &element_sets, &pattern, &bending);
        let mut strands = joined(&element_sets, rest.len(), is_strand);
        let others = joined(&element_sets, rest.len(), |kind| !is_strand(kind));
        strands.iter_mut().zip(&others).for_each(|(strand, other)| *strand &= !other);
        Ok(Self {
            node_stiffness,
            strands,
            bodies,
            vertex_body,
            obstacle,
            component_masses: component_masses.collect(),
            node_masses,
            masses,
            rest_positions,
            node_vertex,
            vertex_node,
            element_sets,
            pattern,
            bending,
            bending_damping,
            edges,
            leaves: ordering.leaves,
            components: ordering.components,
        })
    }

    /// Number of vertices, obstacles included.
    pub fn vertex_count(&self) -> usize {
        self.rest_positions.len()
    }

    /// Rest positions [m].
    pub fn rest_positions(&self) -> &[Point] {
        &self.rest_positions
    }

    /// The bodies.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Mass of each vertex [kg]: a third of the mass of its triangles, a quarter of the mass of its tets
    /// (1/32 of that of quadratic ones at a corner, 7/48 in the middle of an edge), half of the mass of its
    /// strand edges, the mass of a grain; 0 for vertices of obstacles.
    pub fn masses(&self) -> &[f64] {
        &self.masses
    }

    /// Whether each vertex belongs to an obstacle.
    pub fn obstacle(&self) -> &[bool] {
        &self.obstacle
    }

    /// The elements, for a backend that assembles matrices with these patches.
    pub(crate) fn describe(&self, patches: Vec<Range<u32>>) -> ElementModel {
        let split = self.bending.split(&self.pattern);
        let (scalar_starts, scalar_columns, _) = split.off_rows();
        let rest = self.node_vertex.iter().map(|&v| self.rest_positions[v as usize].coords);
        let mut model = ElementModel {
            rest: rest.collect(),
            starts: self.pattern.starts.clone(),
            columns: self.pattern.columns.clone(),
            scalar_starts: scalar_starts.to_vec(),
            scalar_columns: scalar_columns.to_vec(),
            patches,
            components: self.components.clone(),
            ..ElementModel::default()
        };
        self.element_sets.iter().for_each(|set| set.describe(&mut model));
        model
    }

    /// The component that a node is in; for [`NO_NODE`] the number of components.
    pub(crate) fn component(&self, node: u32) -> usize {
        self.components.partition_point(|c| c.end <= node)
    }

    /// The component that each vertex is in: vertices that elements connect have the same number, those of
    /// obstacles `u32::MAX`.
    pub fn components_of_vertices(&self) -> Vec<u32> {
        let mut components = vec![u32::MAX; self.vertex_count()];
        for (component, nodes) in (0..).zip(&self.components) {
            for node in nodes.clone() {
                components[self.node_vertex[node as usize] as usize] = component;
            }
        }
        components
    }

    /// Whether some body is made of strands.
    pub(crate) fn has_strands(&self) -> bool {
        self.bodies.iter().any(|body| matches!(body.shape, BodyShape::Strands { .. }))
    }

    /// Mass of all deformable bodies [kg].
    pub fn total_mass(&self) -> f64 {
        self.masses.iter().sum()
    }

    /// Gravity on a vertex [m/s^2]: that of its body (of the last one, if several share it) or, if that has
    /// none, that of the `scene`.
    pub fn gravity(&self, vertex: usize, scene: Vector) -> Vector {
        let body = self.vertex_body.get(vertex).and_then(|&b| self.bodies.get(b as usize));
        body.and_then(|b| b.gravity).unwrap_or(scene)
    }

    /// Name of the body that a vertex belongs to; of the last one, if several share it.
    pub fn body_name(&self, vertex: usize) -> &str {
        self.vertex_body.get(vertex).and_then(|&b| self.bodies.get(b as usize)).map_or("", |b| &b.name)
    }
}

/// For each of `nodes` nodes, whether it belongs to an element of one of the `kinds`.
fn joined(
    element_sets: &[Box<dyn AnyElementSet>],
    nodes: usize,
    kinds: impl Fn(ElementKind) -> bool,
) -> Vec<bool> {
    let mut joined = vec![false; nodes];
    for set in element_sets.iter().filter(|set| kinds(set.kind())) {
        set.for_each_clique(&mut |clique| clique.iter().for_each(|&n| joined[n as usize] = true));
    }
    joined
}

#[cfg(test)]
mod tests;
