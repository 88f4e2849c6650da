//! Sets of elements of one kind, and how they add their derivatives to the block matrix.
//!
//! The unit of parallel work is a chunk of rows. Nodes are numbered along the mesh and cut into chunks; a
//! chunk visits every element that touches one of its nodes and adds to its own rows only. Elements on the
//! border of two chunks are computed twice (about a tenth of them at 512 nodes per chunk). In exchange there
//! are no locks, no atomics and no buffers, and sums always run in element order: the result has the same
//! bits for any number of threads.

use super::element::{BATCH, Element, Linearization, Start};
use super::filter::Filter;
use crate::linear::assembly::ElementModel;
use crate::linear::block::BlockPattern;
use crate::nodes::CHUNK;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::ops::Range;

/// The moving state that elements read, one entry per node.
#[derive(Clone, Copy)]
pub(crate) struct Motion<'a> {
    pub x: &'a [Vector],
    pub start: &'a [Vector],
    /// 1 / dt [1/s]; 0 leaves dissipation out.
    pub rate: f64,
}

/// Positions of which some have changed, one entry per node.
#[derive(Clone, Copy)]
pub(crate) struct Displaced<'a> {
    pub from: &'a [Vector],
    pub x: &'a [Vector],
    /// Which nodes differ. At the others both have the same positions.
    pub moved: &'a [bool],
}

/// The rows of one chunk, to which elements add.
pub(crate) struct Rows<'a> {
    pub nodes: Range<usize>,
    pub gradient: &'a mut [Vector],
    pub diagonal: &'a mut [Matrix3<f64>],
    /// The off-diagonal blocks of these rows.
    pub blocks: &'a mut [Matrix3<f64>],
    /// Index of the first of them in the pattern.
    pub first_block: usize,
}

/// The interface of [`ElementSet`]s of any type of element.
pub(crate) trait AnyElementSet: Send + Sync {
    /// The kind of its elements.
    fn kind(&self) -> ElementKind;

    /// Calls `visit` with the nodes of every element, for the pattern of the matrix.
    fn for_each_clique(&self, visit: &mut dyn FnMut(&[u32]));

    /// Assigns the elements to chunks and looks up the block of every pair of nodes.
    fn bind(&mut self, node_count: usize, pattern: &BlockPattern);

    /// Energy [J] of the elements that the chunk owns.
    fn energy(&self, chunk: usize, motion: Motion<'_>) -> f64;

    /// Change of the elastic energy [J] of the elements that the chunk owns.
    fn energy_change(&self, chunk: usize, change: &Displaced<'_>) -> f64;

    /// Calls `visit` with the first node of each element and its elastic energy [J] at `x`.
    fn for_each_energy(&self, x: &[Vector], visit: &mut dyn FnMut(u32, f64));

    /// Adds gradient and Hessian of the elements that touch the chunk to its rows. Returns the energy [J] of
    /// the elements that the chunk owns.
    fn linearize(&self, chunk: usize, motion: Motion<'_>, filter: Filter, rows: &mut Rows<'_>) -> f64;

    /// Adds the gradient of the elements that touch the chunk to that of its `nodes`.
    fn add_gradient(&self, chunk: usize, motion: Motion<'_>, nodes: Range<usize>, gradient: &mut [Vector]);

    /// Adds the elements to a description of the model.
    fn describe(&self, model: &mut ElementModel);

    /// Number of elements.
    #[cfg(test)]
    fn len(&self) -> usize;
}

/// What elements model; energies are reported by it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ElementKind {
    Membrane,
    Bending,
    Solid,
    StrandStretching,
    StrandBending,
    Custom,
}

/// Elements of type `E` with their places in the matrix.
pub(crate) struct ElementSet<E, const N: usize> {
    kind: ElementKind,
    elements: Vec<E>,
    /// Index of the block of nodes (a, b) in the pattern, for a != b.
    slots: Vec<[[u32; N]; N]>,
    /// Elements that touch chunk c, ascending: `touching[starts[c]..starts[c + 1]]`.
    touching: Vec<u32>,
    starts: Vec<usize>,
}

impl<E: Element<N>, const N: usize> ElementSet<E, N> {
    /// The elements, sorted by their nodes: those of a chunk are then close in memory.
    pub fn new(kind: ElementKind, mut elements: Vec<E>) -> Self {
        elements.sort_by_key(|e| {
            let mut nodes = e.nodes();
            nodes.sort_unstable();
            nodes
        });
        Self { kind, elements, slots: Vec::new(), touching: Vec::new(), starts: vec![0] }
    }

    fn chunk(&self, chunk: usize) -> &[u32] {
        &self.touching[self.starts[chunk]..self.starts[chunk + 1]]
    }

    /// The chunk to which the element's energy belongs.
    fn owner(nodes: &[u32; N]) -> usize {
        nodes[0] as usize / CHUNK
    }
}

impl<E: Element<N>, const N: usize> AnyElementSet for ElementSet<E, N> {
    fn kind(&self) -> ElementKind {
        self.kind
    }

    fn for_each_clique(&self, visit: &mut dyn FnMut(&[u32])) {
        self.elements.iter().for_each(|e| visit(&e.nodes()));
    }

    fn bind(&mut self, node_count: usize, pattern: &BlockPattern) {
        let slot = |nodes: &[u32; N], a: usize, b: usize| {
            if a == b { u32::MAX } else { pattern.slot(nodes[a], nodes[b]) }
        };
        let slots = self.elements.iter().map(|e| {
            let nodes = e.nodes();
            std::array::from_fn(|a| std::array::from_fn(|b| slot(&nodes, a, b)))
        });
        self.slots = slots.collect();

        (self.touching, self.starts) = touching_chunks(node_count, self.elements.iter().map(E::nodes));
    }

    fn energy(&self, chunk: usize, motion: Motion<'_>) -> f64 {
        let mut energy = 0.0;
        for &index in self.chunk(chunk) {
            let element = &self.elements[index as usize];
            let nodes = element.nodes();
            if Self::owner(&nodes) == chunk {
                let x = nodes.map(|n| motion.x[n as usize]);
                let x0 = nodes.map(|n| motion.start[n as usize]);
                let start = Start { x: &x0, rate: motion.rate };
                energy += element.energy(&x, (motion.rate > 0.0).then_some(start));
            }
        }
        energy
    }

    fn energy_change(&self, chunk: usize, change: &Displaced<'_>) -> f64 {
        let mut sum = 0.0;
        for &index in self.chunk(chunk) {
            let element = &self.elements[index as usize];
            let nodes = element.nodes();
            if Self::owner(&nodes) == chunk && nodes.iter().any(|&n| change.moved[n as usize]) {
                let energy = |x: &[Vector]| element.energy(&nodes.map(|n| x[n as usize]), None);
                sum += energy(change.x) - energy(change.from);
            }
        }
        sum
    }

    fn for_each_energy(&self, x: &[Vector], visit: &mut dyn FnMut(u32, f64)) {
        let energy = |element: &E| element.energy(&element.nodes().map(|n| x[n as usize]), None);
        let energies: Vec<f64> = self.elements.par_iter().with_min_len(CHUNK).map(energy).collect();
        self.elements.iter().zip(energies).for_each(|(element, energy)| visit(element.nodes()[0], energy));
    }

    fn linearize(&self, chunk: usize, motion: Motion<'_>, filter: Filter, rows: &mut Rows<'_>) -> f64 {
        let mut energy = 0.0;
        for batch in self.chunk(chunk).chunks(BATCH) {
            // The last ones may be fewer; others fill their places.
            let elements: [&E; BATCH] =
                std::array::from_fn(|k| &self.elements[batch[k.min(batch.len() - 1)] as usize]);
            let [x, start] = [motion.x, motion.start]
                .map(|of| elements.map(|element| element.nodes().map(|n| of[n as usize])));
            E::linearize_batch(elements, &x, &start, motion.rate, filter, &mut |k, part| {
                let (Some(&index), nodes) = (batch.get(k), elements[k].nodes()) else { return };
                if Self::owner(&nodes) == chunk {
                    energy += part.energy;
                }
                add(part, &nodes, &self.slots[index as usize], rows);
            });
        }
        energy
    }

    fn add_gradient(&self, chunk: usize, motion: Motion<'_>, rows: Range<usize>, gradient: &mut [Vector]) {
        for &index in self.chunk(chunk) {
            let element = &self.elements[index as usize];
            let nodes = element.nodes();
            let x = nodes.map(|n| motion.x[n as usize]);
            let x0 = nodes.map(|n| motion.start[n as usize]);
            let start = Start { x: &x0, rate: motion.rate };
            let part = element.gradient(&x, (motion.rate > 0.0).then_some(start));
            for (node, force) in nodes.iter().zip(part) {
                if rows.contains(&(*node as usize)) {
                    gradient[*node as usize - rows.start] += force;
                }
            }
        }
    }

    fn describe(&self, model: &mut ElementModel) {
        self.elements.iter().for_each(|element| element.describe(model));
    }

    #[cfg(test)]
    fn len(&self) -> usize {
        self.elements.len()
    }
}

/// From the nodes of each element: the elements that touch chunk c, ascending, at `starts[c]..starts[c + 1]`.
pub(crate) fn touching_chunks(
    node_count: usize,
    elements: impl Iterator<Item = impl AsRef<[u32]>>,
) -> (Vec<u32>, Vec<usize>) {
    let mut chunks = vec![Vec::new(); node_count.div_ceil(CHUNK)];
    for (index, nodes) in elements.enumerate() {
        let nodes = nodes.as_ref();
        for (k, &node) in nodes.iter().enumerate() {
            let chunk = node as usize / CHUNK;
            if nodes[..k].iter().all(|&other| other as usize / CHUNK != chunk) {
                chunks[chunk].push(index as u32);
            }
        }
    }
    let mut starts = vec![0];
    chunks.iter().for_each(|chunk| starts.push(starts[starts.len() - 1] + chunk.len()));
    (chunks.concat(), starts)
}

/// Adds gradient and Hessian of an element to those of its `nodes` that are among the rows.
#[inline]
fn add<const N: usize>(
    part: &Linearization<N>,
    nodes: &[u32; N],
    slots: &[[u32; N]; N],
    rows: &mut Rows<'_>,
) {
    for a in 0..N {
        let node = nodes[a] as usize;
        if !rows.nodes.contains(&node) {
            continue;
        }
        let row = node - rows.nodes.start;
        rows.gradient[row] += part.gradient[a];
        rows.diagonal[row] += part.hessian[a][a];
        for b in 0..N {
            if a < b {
                rows.blocks[slots[a][b] as usize - rows.first_block] += part.hessian[a][b];
            } else if b < a {
                rows.blocks[slots[a][b] as usize - rows.first_block] += part.hessian[b][a].transpose();
            }
        }
    }
}
