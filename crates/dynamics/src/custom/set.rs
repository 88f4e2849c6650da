//! Custom elements with their places in the matrix. They are assembled as those of [`crate::elements::set`],
//! chunk by chunk.

use super::element::{CustomElement, ElementGroup, MAX_ELEMENT_VERTICES, Quantity, derivatives};
use super::filter::filter_matrix;
use crate::elements::filter::Filter;
use crate::elements::set::{AnyElementSet, Displaced, ElementKind, Motion, Rows, touching_chunks};
use crate::linear::assembly::ElementModel;
use crate::linear::block::BlockPattern;
use crate::nodes::CHUNK;
use bowknot_geometry::{Point, Vector};
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The custom elements of a model.
#[derive(Debug)]
pub(crate) struct CustomSet {
    /// Sorted by their nodes: those of a chunk are then close in memory.
    elements: Vec<Placed>,
    /// Elements that touch chunk c, ascending: `touching[starts[c]..starts[c + 1]]`.
    touching: Vec<u32>,
    starts: Vec<usize>,
    fault: Fault,
}

/// An element, and where its parts go.
#[derive(Debug)]
struct Placed {
    element: Arc<dyn CustomElement>,
    /// Its group, and its index there.
    place: [usize; 2],
    nodes: Box<[u32]>,
    /// Index of the block of nodes (a, b) in the pattern, row by row, for a != b.
    slots: Box<[u32]>,
}

/// Positions of an element's nodes.
type Positions = [Point; MAX_ELEMENT_VERTICES];

impl CustomSet {
    /// Elements whose vertices have been checked; `vertex_node` has the node of each vertex of the scene.
    pub fn new(groups: &[ElementGroup], vertex_node: &[u32]) -> Self {
        let mut elements = Vec::new();
        for (group, ElementGroup { elements: of_group, .. }) in groups.iter().enumerate() {
            for (index, element) in of_group.iter().enumerate() {
                let nodes = element.vertices().iter().map(|&v| vertex_node[v as usize]).collect();
                let (element, place) = (Arc::clone(element), [group, index]);
                elements.push(Placed { element, place, nodes, slots: Box::default() });
            }
        }
        elements.sort_by_key(|placed| {
            let mut nodes = placed.nodes.clone();
            nodes.sort_unstable();
            nodes
        });
        Self { elements, touching: Vec::new(), starts: vec![0], fault: Fault::default() }
    }

    /// Puts elements with the same vertices in the place of those of a group.
    pub fn replace(&mut self, group: usize, elements: &[Arc<dyn CustomElement>]) {
        for placed in self.elements.iter_mut().filter(|placed| placed.place[0] == group) {
            placed.element = Arc::clone(&elements[placed.place[1]]);
        }
    }

    /// Calls `visit` with the nodes of every element whose energy is not that of rigid motions.
    pub fn for_each_held(&self, visit: &mut dyn FnMut(&[u32])) {
        self.elements
            .iter()
            .filter(|placed| !placed.element.is_invariant())
            .for_each(|placed| visit(&placed.nodes));
    }

    /// The first element that has computed something that is not finite since the last call, as its group and
    /// its index there, and what that is.
    pub fn take_fault(&self) -> Option<([usize; 2], Quantity)> {
        let (element, quantity) = self.fault.take()?;
        Some((self.elements.get(element)?.place, quantity))
    }

    fn chunk(&self, chunk: usize) -> &[u32] {
        &self.touching[self.starts[chunk]..self.starts[chunk + 1]]
    }

    /// Energy [J] of an element in a line search or a report: infinite where it is not defined.
    fn energy_at(&self, index: u32, x: &[Vector]) -> f64 {
        let placed = &self.elements[index as usize];
        let energy = placed.element.energy(placed.positions(x, &mut Positions::default()));
        if energy.is_nan() || energy == f64::NEG_INFINITY {
            self.fault.note(index as usize, Quantity::Energy);
            return f64::INFINITY;
        }
        energy
    }
}

impl Placed {
    /// The chunk to which the element's energy belongs.
    fn owner(&self) -> usize {
        self.nodes[0] as usize / CHUNK
    }

    fn positions<'a>(&self, x: &[Vector], buffer: &'a mut Positions) -> &'a [Point] {
        for (position, &node) in buffer.iter_mut().zip(&self.nodes) {
            *position = Point::from(x[node as usize]);
        }
        &buffer[..self.nodes.len()]
    }

    /// Adds gradient and Hessian of the element to those of its nodes that are among the rows.
    fn add(&self, gradient: &[Vector], blocks: &[Matrix3<f64>], rows: &mut Rows<'_>) {
        let count = self.nodes.len();
        for (a, &node) in self.nodes.iter().enumerate() {
            let node = node as usize;
            if !rows.nodes.contains(&node) {
                continue;
            }
            let row = node - rows.nodes.start;
            rows.gradient[row] += gradient[a];
            rows.diagonal[row] += blocks[a * count + a];
            for b in (0..count).filter(|&b| b != a) {
                rows.blocks[self.slots[a * count + b] as usize - rows.first_block] += blocks[a * count + b];
            }
        }
    }
}

impl AnyElementSet for CustomSet {
    fn kind(&self) -> ElementKind {
        ElementKind::Custom
    }

    fn for_each_clique(&self, visit: &mut dyn FnMut(&[u32])) {
        self.elements.iter().for_each(|placed| visit(&placed.nodes));
    }

    fn bind(&mut self, node_count: usize, pattern: &BlockPattern) {
        for placed in &mut self.elements {
            let nodes = &placed.nodes;
            let slot = |a: u32, b: u32| if a == b { u32::MAX } else { pattern.slot(a, b) };
            placed.slots = nodes.iter().flat_map(|&a| nodes.iter().map(move |&b| slot(a, b))).collect();
        }
        let nodes = self.elements.iter().map(|placed| &placed.nodes);
        (self.touching, self.starts) = touching_chunks(node_count, nodes);
    }

    fn energy(&self, chunk: usize, motion: Motion<'_>) -> f64 {
        let own = self.chunk(chunk).iter().filter(|index| self.elements[**index as usize].owner() == chunk);
        own.map(|&index| self.energy_at(index, motion.x)).sum()
    }

    fn energy_change(&self, chunk: usize, change: &Displaced<'_>) -> f64 {
        let mut sum = 0.0;
        for &index in self.chunk(chunk) {
            let placed = &self.elements[index as usize];
            if placed.owner() == chunk && placed.nodes.iter().any(|&n| change.moved[n as usize]) {
                sum += self.energy_at(index, change.x) - self.energy_at(index, change.from);
            }
        }
        sum
    }

    fn for_each_energy(&self, x: &[Vector], visit: &mut dyn FnMut(u32, f64)) {
        let indices = (0..self.elements.len() as u32).into_par_iter().with_min_len(CHUNK);
        let energies: Vec<f64> = indices.map(|index| self.energy_at(index, x)).collect();
        self.elements.iter().zip(energies).for_each(|(placed, energy)| visit(placed.nodes[0], energy));
    }

    /// What is not finite is left out and noted, so that the rest of the time step computes with numbers.
    fn linearize(&self, chunk: usize, motion: Motion<'_>, filter: Filter, rows: &mut Rows<'_>) -> f64 {
        let mut sum = 0.0;
        let (mut gradient, mut blocks) = (Vec::new(), Vec::new());
        for &index in self.chunk(chunk) {
            let placed = &self.elements[index as usize];
            let (element, count) = (&*placed.element, placed.nodes.len());
            let mut buffer = Positions::default();
            let x = placed.positions(motion.x, &mut buffer);
            gradient.resize(count, Vector::zeros());
            blocks.resize(count * count, Matrix3::zeros());
            if let Err(quantity) = derivatives(element, x, &mut gradient, &mut blocks) {
                self.fault.note(index as usize, quantity);
                continue;
            }
            if !element.is_positive_semidefinite() && !filter_matrix(count, &mut blocks, filter) {
                self.fault.note(index as usize, Quantity::Hessian);
                continue;
            }
            if placed.owner() == chunk {
                let energy = element.energy(x);
                if !energy.is_finite() {
                    self.fault.note(index as usize, Quantity::Energy);
                }
                sum += energy;
            }
            placed.add(&gradient, &blocks, rows);
        }
        sum
    }

    fn add_gradient(&self, chunk: usize, motion: Motion<'_>, rows: Range<usize>, gradient: &mut [Vector]) {
        for &index in self.chunk(chunk) {
            let placed = &self.elements[index as usize];
            let mut forces = [Vector::zeros(); MAX_ELEMENT_VERTICES];
            let forces = &mut forces[..placed.nodes.len()];
            placed.element.gradient(placed.positions(motion.x, &mut Positions::default()), forces);
            for (node, force) in placed.nodes.iter().zip(forces) {
                if rows.contains(&(*node as usize)) {
                    gradient[*node as usize - rows.start] += *force;
                }
            }
        }
    }

    /// The CPU alone computes them.
    fn describe(&self, _model: &mut ElementModel) {}

    #[cfg(test)]
    fn len(&self) -> usize {
        self.elements.len()
    }
}

/// The first element that computed something that is not finite, whatever thread came first.
#[derive(Debug)]
struct Fault(AtomicUsize);

impl Default for Fault {
    fn default() -> Self {
        Self(AtomicUsize::new(usize::MAX))
    }
}

impl Fault {
    fn note(&self, element: usize, quantity: Quantity) {
        self.0.fetch_min(element * Quantity::ALL.len() + quantity as usize, Ordering::Relaxed);
    }

    fn take(&self) -> Option<(usize, Quantity)> {
        let code = self.0.swap(usize::MAX, Ordering::Relaxed);
        let count = Quantity::ALL.len();
        (code != usize::MAX).then(|| (code / count, Quantity::ALL[code % count]))
    }
}
