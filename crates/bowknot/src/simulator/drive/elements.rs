//! Elements of a caller's own: added, replaced, removed.

use super::error::DriveError;
use super::renumber::Numbers;
use crate::simulator::Simulator;
use crate::simulator::custom_elements::{bodies_of, moving_elements};
use crate::simulator::error::SimulationError;
use crate::simulator::sleep::SleepingBodies;
use bowknot_dynamics::{CustomElement, ElementGroup, ElementMatrix, Errors, ModelError};
use bowknot_geometry::{Point, Vector};
use bowknot_scene::world::World;
use std::sync::Arc;

impl Simulator {
    /// Adds custom elements under a name, from the next time step on. Their vertices are those of the
    /// [world](crate::world), see [`Self::vertex`]: of deformable bodies, pinned ones included.
    ///
    /// This sets the simulation up anew, which takes as long as [`Simulator::new`] without its meshes, and
    /// wakes all bodies. Bodies that elements join sleep and wake together. Contacts take their stiffness
    /// from masses and the material, not from custom elements.
    ///
    /// Checkpoints hold the vertices of elements, but no code: [`Self::restore`] needs a simulator that has
    /// elements of the same names with the same vertices, and refuses others. Whether they compute the same,
    /// nothing can check. Changes of bodies ([`Self::add_body`] and others) keep elements and renumber their
    /// vertices; a body that they need cannot be removed.
    ///
    /// # Errors
    /// A name that is taken, [`DriveError::Elements`] with what is wrong with each element, a backend of the
    /// dynamics: only the CPU computes custom elements. The simulator is then as it was.
    pub fn add_elements(
        &mut self,
        name: &str,
        elements: Vec<Arc<dyn CustomElement>>,
    ) -> Result<(), SimulationError> {
        let mut groups = self.dynamics.model().element_groups().to_vec();
        // By name: results do not depend on the order in which a program adds them.
        match groups.binary_search_by(|group| group.name.as_str().cmp(name)) {
            Ok(_) => {
                let (what, name) = ("group of custom elements", name.to_owned());
                return Err(DriveError::Taken { what, name }.into());
            }
            Err(place) => groups.insert(place, ElementGroup::new(name, elements)),
        }
        self.change_elements(groups)
    }

    /// Puts other elements in the place of those of a name, from the next time step on: springs with other
    /// rest lengths, a magnet that has moved. They must have the same vertices in the same order. Bodies wake
    /// whose elements are not the same objects as before. An element that stays and reads a value that a
    /// program changes wakes nothing.
    ///
    /// # Errors
    /// No elements of that name, another number, other vertices. All elements then stay.
    pub fn set_elements(
        &mut self,
        name: &str,
        elements: Vec<Arc<dyn CustomElement>>,
    ) -> Result<(), DriveError> {
        let groups = self.dynamics.model().element_groups();
        let before = groups.iter().find(|group| group.name == name);
        let before = before.map_or_else(Vec::new, |group| group.elements.clone());
        self.dynamics.replace_elements(name, elements.clone()).map_err(refused)?;
        let changed = elements.iter().zip(&before).filter(|(now, then)| !Arc::ptr_eq(now, then));
        let bodies = bodies_of(&self.world, changed.flat_map(|(element, _)| element.vertices()));
        self.push(&bodies);
        if let Some(awake) = self.sleeping.as_mut().and_then(SleepingBodies::dynamics) {
            let moving = ElementGroup::new(name, elements);
            for ElementGroup { name, elements } in moving_elements(awake.model().obstacle(), &[moving]) {
                awake.replace_elements(&name, elements).map_err(refused)?;
            }
        }
        Ok(())
    }

    /// Removes the elements of a name. See [`Self::add_elements`] for what this costs.
    ///
    /// # Errors
    /// No elements of that name.
    pub fn remove_elements(&mut self, name: &str) -> Result<(), SimulationError> {
        let mut groups = self.dynamics.model().element_groups().to_vec();
        let Some(index) = groups.iter().position(|group| group.name == name) else {
            let known = groups.into_iter().map(|group| group.name).collect();
            return Err(refused(ModelError::UnknownGroup { group: name.to_owned(), known }).into());
        };
        groups.remove(index);
        self.change_elements(groups)
    }

    /// The number in the [world](crate::world) of a vertex of a deformable body, which is counted as in its
    /// mesh, from 0. It changes when bodies or obstacles are added or removed.
    ///
    /// # Errors
    /// No such body; a vertex that its mesh does not have, or that no element of the mesh names.
    pub fn vertex(&self, body: &str, vertex: u32) -> Result<u32, DriveError> {
        let order = self.world.bodies[self.deformable(body)?].mesh_order();
        let found = order.get(vertex as usize).copied().flatten();
        found.ok_or_else(|| DriveError::Vertex { body: body.to_owned(), vertex, count: order.len() })
    }

    /// Goes on with other groups of elements, or stays as it is.
    fn change_elements(&mut self, groups: Vec<ElementGroup>) -> Result<(), SimulationError> {
        let (world, scene) = (Arc::clone(&self.undriven), self.driven.scene.clone());
        let mut next = Self::at_start(world, self.home.clone(), scene, groups)?;
        next.measured = self.measured;
        let mut state = self.checkpoint();
        state.driven.elements.clone_from(&next.driven.elements);
        // All bodies are awake.
        state.sleep = Default::default();
        next.restore(&state)?;
        self.give_way_to(next)
    }
}

/// Elements that are refused.
pub(crate) fn refused(errors: impl Into<Errors<ModelError>>) -> DriveError {
    DriveError::Elements { source: errors.into() }
}

/// Groups of elements of one world as those of another one.
pub(super) fn renumbered_elements(
    old: &World,
    new: &World,
    groups: &[ElementGroup],
) -> Result<Vec<ElementGroup>, DriveError> {
    if groups.is_empty() {
        return Ok(Vec::new());
    }
    let numbers = Numbers::new(old, new);
    let renumbered = |group: &ElementGroup| {
        let of_element = |element: &Arc<dyn CustomElement>| {
            let number = |&vertex: &u32| {
                numbers.vertex(vertex).ok_or_else(|| DriveError::Needed {
                    group: group.name.clone(),
                    body: old.body_name(vertex as usize).to_owned(),
                })
            };
            let vertices = element.vertices().iter().map(number).collect::<Result<Vec<u32>, DriveError>>()?;
            if vertices == element.vertices() {
                return Ok(Arc::clone(element));
            }
            Ok(Arc::new(Renumbered { element: Arc::clone(element), vertices }) as Arc<dyn CustomElement>)
        };
        let elements = group.elements.iter().map(of_element).collect::<Result<_, DriveError>>()?;
        Ok(ElementGroup::new(&*group.name, elements))
    };
    groups.iter().map(renumbered).collect()
}

/// An element with other numbers of its vertices.
#[derive(Debug)]
struct Renumbered {
    element: Arc<dyn CustomElement>,
    vertices: Vec<u32>,
}

impl CustomElement for Renumbered {
    fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    fn energy(&self, x: &[Point]) -> f64 {
        self.element.energy(x)
    }

    fn gradient(&self, x: &[Point], gradient: &mut [Vector]) {
        self.element.gradient(x, gradient);
    }

    fn hessian(&self, x: &[Point], hessian: &mut ElementMatrix<'_>) {
        self.element.hessian(x, hessian);
    }

    fn is_positive_semidefinite(&self) -> bool {
        self.element.is_positive_semidefinite()
    }

    fn is_invariant(&self) -> bool {
        self.element.is_invariant()
    }
}
