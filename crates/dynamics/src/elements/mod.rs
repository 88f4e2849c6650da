//! Families of elements: what each kind of deformable body adds to energy, forces and stiffness.
//!
//! A family is a list of elements of one kind ([`Element`]), each over N nodes: triangles, tetrahedra,
//! edges and turnings of strands. [`ElementFamily`] scatters any of them into the block matrix.
//!
//! Scattering is by owner of the row: nodes are numbered along the mesh and cut into chunks, and a
//! chunk visits every element that touches one of its nodes, adding to its own rows only. Elements
//! on the border of two chunks are computed twice (about a tenth at 512 nodes a chunk), and in
//! exchange there are no locks, no atomics, no buffers, and sums always run in element order: the
//! same bits for any number of threads.

pub(crate) mod bending;
pub(crate) mod shell;
mod solid_law;
pub(crate) mod strand;
mod svd;
#[cfg(test)]
mod test_support;
pub(crate) mod tetrahedron;
pub(crate) mod triangle;
pub(crate) mod woven;

use crate::linear::block::BlockPattern;
use crate::params::HessianFilter;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::ops::Range;

/// Nodes of a chunk, the unit of parallel work and of reductions.
pub(crate) const CHUNK: usize = 512;

/// Energy [J], its gradient [N] and its Hessian [N/m] over an element's nodes.
pub(crate) struct Linearisation<const N: usize> {
    pub energy: f64,
    pub gradient: [Vector; N],
    /// Block (a, b) for a <= b; the others are transposes and are not filled in.
    pub hessian: [[Matrix3<f64>; N]; N],
}

/// An element over N nodes.
pub(crate) trait Element<const N: usize>: Send + Sync {
    /// Its nodes.
    fn nodes(&self) -> [u32; N];

    /// Elastic energy [J] at `x` [m], plus the dissipation potential since `start` if it is given.
    fn energy(&self, x: &[Vector; N], start: Option<Start<'_, N>>) -> f64;

    /// [`Self::energy`] with gradient and filtered Hessian.
    fn linearise(&self, x: &[Vector; N], start: Option<Start<'_, N>>, filter: Filter) -> Linearisation<N>;
}

/// Where an element's nodes were at the start of the step, for damping.
#[derive(Clone, Copy)]
pub(crate) struct Start<'a, const N: usize> {
    pub x: &'a [Vector; N],
    /// 1 / dt [1/s].
    pub rate: f64,
}

/// What becomes of a negative curvature; `Exact` keeps it, for tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Filter {
    Clamp,
    Absolute,
    #[cfg(test)]
    Exact,
}

impl Filter {
    /// That of a target, which may be the `first` of its time step.
    pub fn new(filter: HessianFilter, first: bool) -> Self {
        match filter {
            HessianFilter::Clamp => Filter::Clamp,
            HessianFilter::Absolute => Filter::Absolute,
            HessianFilter::Mixed => {
                if first {
                    Filter::Absolute
                } else {
                    Filter::Clamp
                }
            }
        }
    }

    #[inline]
    pub fn apply(self, curvature: f64) -> f64 {
        match self {
            Filter::Clamp => curvature.max(0.0),
            Filter::Absolute => curvature.abs(),
            #[cfg(test)]
            Filter::Exact => curvature,
        }
    }
}

/// The moving state that elements read: one entry a node.
#[derive(Clone, Copy)]
pub(crate) struct Motion<'a> {
    pub x: &'a [Vector],
    pub start: &'a [Vector],
    /// 1 / dt [1/s], or 0 to leave dissipation out.
    pub rate: f64,
}

/// The rows of one chunk that elements add to.
pub(crate) struct Rows<'a> {
    pub nodes: Range<usize>,
    pub gradient: &'a mut [Vector],
    pub diagonal: &'a mut [Matrix3<f64>],
    /// The off-diagonal blocks of these rows and where they start in the pattern.
    pub blocks: &'a mut [Matrix3<f64>],
    pub first_block: usize,
}

/// Elements of one kind, behind a common face.
pub(crate) trait ElementFamily: Send + Sync {
    /// What its energy belongs to.
    fn kind(&self) -> Kind;

    /// Nodes of every element, for the pattern of the matrix.
    fn for_each_clique(&self, visit: &mut dyn FnMut(&[u32]));

    /// Cuts the work into chunks and looks up the block of every pair of nodes.
    fn bind(&mut self, node_count: usize, pattern: &BlockPattern);

    /// Energy [J] of the elements that the chunk owns.
    fn energy(&self, chunk: usize, motion: Motion<'_>) -> f64;

    /// Calls `visit` with the first node of each element and its elastic energy [J] at `x`.
    fn for_each_energy(&self, x: &[Vector], visit: &mut dyn FnMut(u32, f64));

    /// Adds gradient and Hessian of the elements that touch the chunk to its rows; the energy [J] of
    /// those that it owns.
    fn linearise(&self, chunk: usize, motion: Motion<'_>, filter: Filter, rows: &mut Rows<'_>) -> f64;

    /// Number of elements.
    #[cfg(test)]
    fn len(&self) -> usize;
}

/// What an energy belongs to, for reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Membrane,
    Bending,
    Solid,
    StrandStretching,
    StrandBending,
}

/// Some unit vector orthogonal to the unit vector `u`.
fn any_normal(u: &Vector) -> Vector {
    let axis = if u.x.abs() < 0.6 { Vector::x() } else { Vector::y() };
    u.cross(&axis).normalize()
}

/// Elements of type `E` with their scatter maps.
pub(crate) struct Family<E, const N: usize> {
    kind: Kind,
    elements: Vec<E>,
    /// Where the block of nodes (a, b) stands in the pattern, for a != b.
    slots: Vec<[[u32; N]; N]>,
    /// Elements that touch each chunk, ascending: `touching[starts[c]..starts[c + 1]]`.
    touching: Vec<u32>,
    starts: Vec<usize>,
}

impl<E: Element<N>, const N: usize> Family<E, N> {
    /// The elements, sorted by their nodes: those of a chunk then stand together.
    pub fn new(kind: Kind, mut elements: Vec<E>) -> Self {
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

    /// The chunk that counts the element's energy.
    fn owner(nodes: &[u32; N]) -> usize {
        nodes[0] as usize / CHUNK
    }
}

impl<E: Element<N>, const N: usize> ElementFamily for Family<E, N> {
    fn kind(&self) -> Kind {
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

        let mut chunks = vec![Vec::new(); node_count.div_ceil(CHUNK)];
        for (index, element) in self.elements.iter().enumerate() {
            let nodes = element.nodes();
            for (k, &node) in nodes.iter().enumerate() {
                let chunk = node as usize / CHUNK;
                if nodes[..k].iter().all(|&other| other as usize / CHUNK != chunk) {
                    chunks[chunk].push(index as u32);
                }
            }
        }
        self.starts = std::iter::once(0)
            .chain(chunks.iter().scan(0, |end, chunk| {
                *end += chunk.len();
                Some(*end)
            }))
            .collect();
        self.touching = chunks.concat();
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

    fn for_each_energy(&self, x: &[Vector], visit: &mut dyn FnMut(u32, f64)) {
        let energy = |element: &E| element.energy(&element.nodes().map(|n| x[n as usize]), None);
        let energies: Vec<f64> = self.elements.par_iter().with_min_len(CHUNK).map(energy).collect();
        self.elements.iter().zip(energies).for_each(|(element, energy)| visit(element.nodes()[0], energy));
    }

    fn linearise(&self, chunk: usize, motion: Motion<'_>, filter: Filter, rows: &mut Rows<'_>) -> f64 {
        let mut energy = 0.0;
        for &index in self.chunk(chunk) {
            let element = &self.elements[index as usize];
            let nodes = element.nodes();
            let x = nodes.map(|n| motion.x[n as usize]);
            let x0 = nodes.map(|n| motion.start[n as usize]);
            let start = Start { x: &x0, rate: motion.rate };
            let part = element.linearise(&x, (motion.rate > 0.0).then_some(start), filter);
            if Self::owner(&nodes) == chunk {
                energy += part.energy;
            }
            let slots = &self.slots[index as usize];
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
                        rows.blocks[slots[a][b] as usize - rows.first_block] +=
                            part.hessian[b][a].transpose();
                    }
                }
            }
        }
        energy
    }

    #[cfg(test)]
    fn len(&self) -> usize {
        self.elements.len()
    }
}
