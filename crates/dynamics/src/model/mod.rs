//! The model: everything that is fixed during a run. Bodies, masses, elements, the pattern of the matrix.

mod assembly;
mod check;
mod joined;
mod masses;
pub(crate) mod measures;
mod stiffness;

use crate::body::{Body, BodyShape};
use crate::custom::element::{CustomElement, ElementGroup};
use crate::custom::groups::{check_groups, check_replacement};
use crate::custom::set::CustomSet;
use crate::elements::set::AnyElementSet;
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
use joined::strand_nodes;
use masses::masses;
use std::ops::Range;
use std::sync::Arc;

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
    groups: Vec<ElementGroup>,
    /// The elements of the groups; None if there are none.
    pub(crate) custom: Option<CustomSet>,
    /// Whether custom elements hold each component: their energy is not that of rigid motions.
    pub(crate) held_components: Vec<bool>,
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
        Self::of(rest_positions, bodies, Vec::new())
    }

    /// The same bodies with these custom elements, in place of any that there were. It is built anew.
    ///
    /// Vertices that elements join are then of one component: its linear system is solved as one, and rotation
    /// that implicit Euler loses is given back to it as a whole. Contacts take their stiffness from masses and
    /// from the other elements alone.
    ///
    /// # Errors
    /// Every error that was found: two groups of one name, elements without vertices or with more than
    /// [`MAX_ELEMENT_VERTICES`](crate::MAX_ELEMENT_VERTICES), vertices that do not exist, are named twice or
    /// belong to an obstacle.
    pub fn with_elements(self, groups: Vec<ElementGroup>) -> Result<Self, Errors<ModelError>> {
        let obstacle = |vertex: u32| {
            let is_obstacle = self.obstacle.get(vertex as usize).copied().unwrap_or(false);
            is_obstacle.then(|| self.body_name(vertex as usize))
        };
        Errors::check(check_groups(&groups, self.vertex_count(), obstacle))?;
        Self::of(self.rest_positions, self.bodies, groups)
    }

    /// A model of what has been checked.
    fn of(
        rest_positions: Vec<Point>,
        bodies: Vec<Body>,
        groups: Vec<ElementGroup>,
    ) -> Result<Self, Errors<ModelError>> {
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
            for pair in groups.iter().flat_map(|group| &group.elements).flat_map(|e| e.vertices().windows(2))
            {
                link(compact[pair[0] as usize], compact[pair[1] as usize]);
            }
        });
        let node_vertex: Vec<u32> = ordering.order.iter().map(|&k| deformable[k as usize]).collect();
        let mut vertex_node = vec![NO_NODE; count];
        node_vertex.iter().enumerate().for_each(|(node, &v)| vertex_node[v as usize] = node as u32);

        let rest: Vec<Vector> = node_vertex.iter().map(|&v| rest_positions[v as usize].coords).collect();
        let mut assembly = Assembly::new(&rest);
        bodies.iter().for_each(|body| assembly.add(&body.shape, &vertex_node));
        let Elements { mut element_sets, edges, bending, bending_damping } = assembly.finish();
        let mut custom = Some(CustomSet::new(&groups, &vertex_node)).filter(|_| !groups.is_empty());
        let pattern = BlockPattern::from_cliques(rest.len(), |visit| {
            element_sets.iter().for_each(|set| set.for_each_clique(visit));
            custom.iter().for_each(|set| set.for_each_clique(visit));
        });
        element_sets.iter_mut().for_each(|set| set.bind(rest.len(), &pattern));
        custom.iter_mut().for_each(|set| set.bind(rest.len(), &pattern));
        let node_masses: Vec<f64> = node_vertex.iter().map(|&v| masses[v as usize]).collect();
        let component_masses = ordering.components.iter().flat_map(|component| {
            let mass = node_masses[component.start as usize..component.end as usize].iter().sum();
            std::iter::repeat_n(mass, component.len())
        });
        let node_stiffness = stiffness::softest(&rest, &element_sets, &pattern, &bending);
        let strands = strand_nodes(&element_sets, custom.as_ref(), rest.len());
        let held_components = held_components(custom.as_ref(), &ordering.components);
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
            groups,
            custom,
            held_components,
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
    /// strand edges (of those of rods, a hundredth or more goes to the frame point), the mass of a grain; 0 for vertices of obstacles.
    pub fn masses(&self) -> &[f64] {
        &self.masses
    }

    /// Whether each vertex belongs to an obstacle.
    pub fn obstacle(&self) -> &[bool] {
        &self.obstacle
    }

    /// The custom elements.
    pub fn element_groups(&self) -> &[ElementGroup] {
        &self.groups
    }

    /// Puts elements with the same vertices in the place of those of a group.
    pub(crate) fn replace_elements(
        &mut self,
        group: &str,
        elements: Vec<Arc<dyn CustomElement>>,
    ) -> Result<(), ModelError> {
        let index = check_replacement(&self.groups, group, &elements)?;
        self.custom.iter_mut().for_each(|set| set.replace(index, &elements));
        self.groups[index].elements = elements;
        self.held_components = held_components(self.custom.as_ref(), &self.components);
        Ok(())
    }

    /// All elements, custom ones last.
    pub(crate) fn sets(&self) -> impl Iterator<Item = &dyn AnyElementSet> {
        let custom = self.custom.iter().map(|set| set as &dyn AnyElementSet);
        self.element_sets.iter().map(|set| &**set).chain(custom)
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
        self.bodies
            .iter()
            .any(|body| matches!(body.shape, BodyShape::Strands { .. } | BodyShape::Rods { .. }))
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

/// Which of the components custom elements hold.
fn held_components(custom: Option<&CustomSet>, components: &[Range<u32>]) -> Vec<bool> {
    let mut held = vec![false; components.len()];
    let component = |node: u32| components.partition_point(|c| c.end <= node);
    custom.into_iter().for_each(|set| set.for_each_held(&mut |nodes| held[component(nodes[0])] = true));
    held
}

#[cfg(test)]
mod tests;
