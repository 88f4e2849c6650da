//! Which bodies custom elements join, and which of them move.

use bowknot_dynamics::{CustomElement, ElementGroup};
use bowknot_scene::world::World;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The vertices of the elements of each group.
pub(crate) fn vertices_of_elements(groups: &[ElementGroup]) -> BTreeMap<String, Vec<Vec<u32>>> {
    let vertices = |group: &ElementGroup| group.elements.iter().map(|e| e.vertices().to_vec()).collect();
    groups.iter().map(|group| (group.name.clone(), vertices(group))).collect()
}

/// The bodies that elements with these vertices act on, ascending.
pub(crate) fn bodies_of<'a>(world: &World, vertices: impl Iterator<Item = &'a u32>) -> Vec<usize> {
    let body_of = |&vertex: &u32| match world.collision.vertex_body().get(vertex as usize) {
        Some(&body) => Some(body as usize),
        None => world.bodies.iter().position(|body| body.interior.contains(&vertex)),
    };
    let mut bodies: Vec<usize> = vertices.filter_map(body_of).collect();
    bodies.sort_unstable();
    bodies.dedup();
    bodies
}

/// Pairs of bodies that elements join.
pub(crate) fn joined_bodies(world: &World, groups: &[ElementGroup]) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for element in groups.iter().flat_map(|group| &group.elements) {
        let bodies = bodies_of(world, element.vertices().iter());
        pairs.extend(bodies.windows(2).map(|pair| [pair[0] as u32, pair[1] as u32]));
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// The vertices that elements join with others.
pub(crate) fn joined_vertices(groups: &[ElementGroup]) -> Vec<u32> {
    let elements = groups.iter().flat_map(|group| &group.elements);
    let joined = elements.map(|element| element.vertices()).filter(|vertices| vertices.len() > 1);
    joined.flatten().copied().collect()
}

/// The elements that move while the bodies of obstacles rest; these have the vertices that are `fixed`.
/// Bodies that elements join sleep together, so that all vertices of an element rest or none does.
pub(crate) fn moving_elements(fixed: &[bool], groups: &[ElementGroup]) -> Vec<ElementGroup> {
    let moves = |element: &&Arc<dyn CustomElement>| element.vertices().iter().all(|&v| !fixed[v as usize]);
    let moving = |group: &ElementGroup| {
        ElementGroup::new(&*group.name, group.elements.iter().filter(moves).cloned().collect())
    };
    groups.iter().map(moving).collect()
}
