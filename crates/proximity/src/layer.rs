//! The trees of a part of the scene whose primitives are rebuilt and refitted together.

use crate::frame::LocalVertex;
use crate::tree::Tree;
use bowknot_geometry::CollisionModel;

/// The trees of some bodies. Trees that no pair kind needs stay empty.
#[derive(Debug, Default)]
pub struct Layer {
    /// Surface vertices, particles included; empty in a scene without triangles.
    pub vertices: Tree<1>,
    /// Edges of triangles and strands.
    pub edges: Tree<2>,
    /// Triangles.
    pub triangles: Tree<3>,
    /// Particles.
    pub particles: Tree<1>,
    /// Strand edges; empty in a scene without particles.
    pub strands: Tree<2>,
}

impl Layer {
    /// Builds the trees of the primitives whose vertices satisfy `belongs`, in spatial order; returns how
    /// many trees that were. [`Self::refit`] must follow.
    pub fn build(
        &mut self,
        model: &CollisionModel,
        local: &[LocalVertex],
        belongs: impl Fn(u32) -> bool,
    ) -> u32 {
        let topology = model.topology();
        let points = |list: &[u32]| -> Vec<(u32, [u32; 1])> {
            list.iter().filter(|&&v| belongs(v)).map(|&v| (v, [v])).collect()
        };
        let edge = |e: u32| (e, topology.edges[e as usize]);
        let mut built = 0;
        if !topology.triangles.is_empty() {
            built += build(&mut self.vertices, &points(&topology.surface_vertices), local);
            let triangles: Vec<_> =
                (0..).zip(topology.triangles.iter().copied()).filter(|(_, t)| belongs(t[0])).collect();
            built += build(&mut self.triangles, &triangles, local);
        }
        let edges: Vec<_> =
            (0..topology.edges.len() as u32).map(edge).filter(|(_, e)| belongs(e[0])).collect();
        built += build(&mut self.edges, &edges, local);
        if !topology.particles.is_empty() {
            built += build(&mut self.particles, &points(&topology.particles), local);
            let strands: Vec<_> =
                topology.strand_edges.iter().map(|&e| edge(e)).filter(|(_, e)| belongs(e[0])).collect();
            built += build(&mut self.strands, &strands, local);
        }
        built
    }

    /// Refits all boxes; returns how many trees that were.
    pub fn refit(&mut self, local: &[LocalVertex], end: Option<&[LocalVertex]>) -> u32 {
        self.vertices.refit(local, end);
        self.edges.refit(local, end);
        self.triangles.refit(local, end);
        self.particles.refit(local, end);
        self.strands.refit(local, end);
        self.trees()
    }

    /// Notes which elements have a vertex that has `changed`.
    pub fn mark_changed(&mut self, changed: &[bool]) {
        self.vertices.mark_changed(changed);
        self.edges.mark_changed(changed);
        self.triangles.mark_changed(changed);
        self.particles.mark_changed(changed);
        self.strands.mark_changed(changed);
    }

    /// Refits the boxes of the elements that are marked as changed.
    pub fn refit_changed(&mut self, local: &[LocalVertex]) {
        self.vertices.refit_changed(local);
        self.edges.refit_changed(local);
        self.triangles.refit_changed(local);
        self.particles.refit_changed(local);
        self.strands.refit_changed(local);
    }

    /// Rebuilds trees whose order is stale, and refits their boxes; returns how many trees that were.
    pub fn rebuild_stale(&mut self, local: &[LocalVertex], end: Option<&[LocalVertex]>) -> u32 {
        u32::from(self.vertices.rebuild_stale(local, end))
            + u32::from(self.edges.rebuild_stale(local, end))
            + u32::from(self.triangles.rebuild_stale(local, end))
            + u32::from(self.particles.rebuild_stale(local, end))
            + u32::from(self.strands.rebuild_stale(local, end))
    }

    /// Number of trees that are not empty.
    fn trees(&self) -> u32 {
        let present = [
            !self.vertices.is_empty(),
            !self.edges.is_empty(),
            !self.triangles.is_empty(),
            !self.particles.is_empty(),
            !self.strands.is_empty(),
        ];
        present.into_iter().map(u32::from).sum()
    }
}

fn build<const V: usize>(tree: &mut Tree<V>, elements: &[(u32, [u32; V])], local: &[LocalVertex]) -> u32 {
    tree.build(elements, local);
    u32::from(!elements.is_empty())
}
