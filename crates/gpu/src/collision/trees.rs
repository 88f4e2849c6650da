//! The trees of the search on the device, and which of them are searched for which kind of pair.

use super::buffers::{Buffers, words};
use crate::engine::Engine;
use crate::error::GpuError;
use crate::grid::GridPoint;
use crate::kernels;
use crate::layout::{Kind, NodeBox, Slot};
use crate::recording::{BufferId, Recording};
use crate::tree::Tree;
use bowknot_geometry::Topology;

/// Trees by the primitives that they hold, and the queries into them.
#[derive(Debug)]
pub struct Trees {
    pub surface: DeviceTree,
    pub edges: DeviceTree,
    pub triangles: DeviceTree,
    pub particles: DeviceTree,
    pub strands: DeviceTree,
}

/// A tree with its buffers. One without elements has buffers too, which no stage reads.
#[derive(Debug)]
pub struct DeviceTree {
    pub tree: Tree,
    pub slots: BufferId,
    pub boxes: BufferId,
}

impl Trees {
    pub fn new(
        engine: &mut impl Engine,
        topology: &Topology,
        positions: &[GridPoint],
    ) -> Result<Self, GpuError> {
        let [surface, edges, triangles, particles, strands] =
            ordered(topology, positions).map(|tree| DeviceTree::new(engine, tree));
        Ok(Self {
            surface: surface?,
            edges: edges?,
            triangles: triangles?,
            particles: particles?,
            strands: strands?,
        })
    }

    /// Orders the elements anew, by other positions. The buffers stay, for their sizes depend on the numbers
    /// of elements alone.
    pub fn reorder(&mut self, positions: &[GridPoint], recording: &mut Recording) {
        let Self { surface, edges, triangles, particles, strands } = self;
        for kept in [surface, edges, triangles, particles, strands] {
            kept.tree = kept.tree.reordered(positions);
            kept.upload(recording);
        }
    }

    pub fn all(&self) -> [&DeviceTree; 5] {
        [&self.surface, &self.edges, &self.triangles, &self.particles, &self.strands]
    }

    /// Those that are searched in.
    pub fn targets(&self) -> impl Iterator<Item = &DeviceTree> {
        let mut targets: Vec<&DeviceTree> = Vec::new();
        for (_, _, target) in self.searches() {
            if targets.iter().all(|known| known.slots != target.slots) {
                targets.push(target);
            }
        }
        targets.into_iter()
    }

    /// Kinds of pairs with the tree of the queries and the one that they search in. What the scene does not
    /// have takes no part.
    pub fn searches(&self) -> impl Iterator<Item = (Kind, &DeviceTree, &DeviceTree)> {
        [
            (Kind::VertexVertex, &self.particles, &self.particles),
            (Kind::VertexEdge, &self.particles, &self.strands),
            (Kind::VertexTriangle, &self.surface, &self.triangles),
            (Kind::EdgeEdge, &self.edges, &self.edges),
        ]
        .into_iter()
        .filter(|(_, queries, targets)| !queries.tree.is_empty() && !targets.tree.is_empty())
    }

    /// Rows of the search: query elements of all kinds.
    pub fn rows(&self, planes: usize) -> usize {
        let slots = |tree: &DeviceTree| tree.tree.slots.len();
        let searched: usize = self.searches().map(|(_, queries, _)| slots(queries)).sum();
        let near_planes = if planes > 0 { slots(&self.surface) } else { 0 };
        searched + near_planes
    }
}

/// The trees of a topology, in the order of [`Trees::all`].
fn ordered(topology: &Topology, positions: &[GridPoint]) -> [Tree; 5] {
    let points = |list: &[u32]| -> Vec<(u32, [u32; 1])> { list.iter().map(|&v| (v, [v])).collect() };
    let edge = |e: u32| (e, topology.edges[e as usize]);
    let edges: Vec<(u32, [u32; 2])> = (0..topology.edges.len() as u32).map(edge).collect();
    let triangles: Vec<(u32, [u32; 3])> = (0..).zip(topology.triangles.iter().copied()).collect();
    let strands: Vec<(u32, [u32; 2])> = topology.strand_edges.iter().map(|&e| edge(e)).collect();
    [
        Tree::new(&points(&topology.surface_vertices), positions),
        Tree::new(&edges, positions),
        Tree::new(&triangles, positions),
        Tree::new(&points(&topology.particles), positions),
        Tree::new(&strands, positions),
    ]
}

impl DeviceTree {
    pub fn new(engine: &mut impl Engine, tree: Tree) -> Result<Self, GpuError> {
        let slots = engine.buffer("elements", words::<Slot>(tree.slots.len()))?;
        let boxes = engine.buffer("boxes", words::<NodeBox>(tree.box_count))?;
        Ok(Self { tree, slots, boxes })
    }

    pub fn upload(&self, recording: &mut Recording) {
        if !self.tree.is_empty() {
            recording.write(self.slots, &self.tree.slots);
            recording.write(self.boxes, &self.tree.blank_boxes());
        }
    }

    /// Fits the boxes, level by level.
    pub fn record_fit(&self, b: &Buffers, recording: &mut Recording) {
        let slots = self.tree.slots.len();
        recording.dispatch(
            &kernels::ELEMENT_BOXES,
            &[self.slots, b.balls, b.vertices, self.boxes, b.control],
            kernels::element_boxes::Params { slots: slots as u32, count: self.tree.vertex_count as u32 },
            slots,
        );
        for levels in self.tree.levels.windows(2) {
            let [below, level] = [levels[0], levels[1]];
            recording.dispatch(
                &kernels::REFIT_BOXES,
                &[self.boxes, b.control],
                kernels::refit_boxes::Params {
                    first: level.first as u32,
                    nodes: level.nodes as u32,
                    first_child: below.first as u32,
                    children: below.nodes as u32,
                },
                level.nodes,
            );
        }
    }
}
