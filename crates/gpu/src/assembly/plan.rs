//! What the host prepares once for a model: elements, and which of their blocks each block of the matrix
//! sums.

use super::layout::{Bend, Entry, Membrane, Strand, Tetrahedron};
use crate::layout::NONE;
use crate::linear::{Columns, PackedMatrix, SLICE};
use bowknot_dynamics::{ElementModel, SolidKind};
use std::collections::BTreeMap;

/// The plan of a model.
#[derive(Debug, Default)]
pub struct Plan {
    pub nodes: usize,
    pub membranes: Vec<Membrane>,
    pub bends: Vec<Bend>,
    pub tetrahedra: Vec<Tetrahedron>,
    pub strands: Vec<Strand>,
    /// Of each node that only strands act on the node, where its entries in this vector begin and end; then
    /// the entries: three times a strand plus the place of the node in it.
    pub strand_rows: Vec<u32>,
    /// Nodes that only strands act on.
    pub strand_nodes: usize,
    /// Blocks that the elements write.
    pub blocks: usize,
    /// In the order in which they lie in the matrix. Flat bending is left out.
    pub entries: Vec<Entry>,
    /// Which of the pairs of [`ElementModel::columns`] each entry is.
    pub pairs: Vec<u32>,
    pub sources: Vec<u32>,
    /// The matrix with its columns and without numbers.
    pub structure: PackedMatrix,
    /// The words of the scalar entries, in the order of [`ElementModel::scalar_columns`].
    pub scalar_words: Vec<u32>,
}

impl Plan {
    /// Whether some tetrahedron is damped.
    pub fn has_damped_tetrahedra(&self) -> bool {
        self.tetrahedra.iter().any(|tet| tet.viscous_mu > 0.0)
    }

    pub fn new(model: &ElementModel) -> Self {
        let nodes = model.rest.len();
        let blocks = Columns { starts: &model.starts, columns: &model.columns };
        let scalars = Columns { starts: &model.scalar_starts, columns: &model.scalar_columns };
        let mut structure = PackedMatrix::new(nodes, blocks, scalars);
        let mut plan = Self {
            nodes,
            membranes: model.membranes.iter().map(membrane).collect(),
            bends: model.bends.iter().map(bend).collect(),
            tetrahedra: model.tetrahedra.iter().map(tetrahedron).collect(),
            strands: model.strands.iter().map(strand).collect(),
            ..Self::default()
        };
        // The blocks of an element couple its nodes a and b for a < b, in this order.
        let mut sums: Vec<Vec<u32>> = vec![Vec::new(); model.columns.len()];
        let mut next = 0;
        let mut add = |element: &[u32]| {
            for (k, &a) in element.iter().enumerate() {
                for &b in &element[k + 1..] {
                    if a != NONE && b != NONE {
                        sums[pair(model, a, b)].push(2 * next);
                        sums[pair(model, b, a)].push(2 * next + 1);
                    }
                    next += 1;
                }
            }
        };
        plan.membranes.iter().for_each(|element| add(&element.nodes));
        plan.bends.iter().for_each(|element| add(&element.nodes));
        plan.tetrahedra.iter().for_each(|element| add(&element.nodes));
        model.strands.iter().for_each(|element| add(&element.nodes));
        plan.blocks = next as usize;

        let mut places = vec![0; model.columns.len()];
        for i in 0..nodes {
            let slice = structure.slices[i / SLICE];
            let at = |k: u32| structure.block_at(slice, i, k);
            for (k, pair) in (model.starts[i]..model.starts[i + 1]).enumerate() {
                places[pair as usize] = at(1 + k as u32);
            }
            let first = structure.block_at(slice, i, slice[1]);
            let scalars = model.scalar_starts[i + 1] - model.scalar_starts[i];
            plan.scalar_words.extend((0..scalars).map(|k| first + (2 * k + 1) * SLICE as u32));
        }
        plan.pairs = (0..places.len() as u32).collect();
        plan.pairs.sort_unstable_by_key(|pair| places[*pair as usize]);
        for &pair in &plan.pairs {
            let sum = &sums[pair as usize];
            plan.entries.push(Entry {
                at: places[pair as usize],
                first: plan.sources.len() as u32,
                count: sum.len() as u32,
                bending: 0.0,
            });
            plan.sources.extend(sum);
        }
        plan.add_strand_rows(model, &mut structure);
        plan.structure = structure;
        plan
    }

    /// Lists the strands of each node that only strands act on: the matrix leaves its row to them. Rows of
    /// other nodes, such as those where a strand is sewn to cloth, have all of their blocks.
    fn add_strand_rows(&mut self, model: &ElementModel, structure: &mut PackedMatrix) {
        let mut others = vec![false; model.rest.len()];
        let mut mark = |nodes: &[u32]| {
            nodes.iter().filter(|node| **node != NONE).for_each(|node| others[*node as usize] = true);
        };
        self.membranes.iter().for_each(|element| mark(&element.nodes));
        self.bends.iter().for_each(|element| mark(&element.nodes));
        self.tetrahedra.iter().for_each(|element| mark(&element.nodes));
        mark(&model.scalar_columns);
        let mut rows: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (e, strand) in (0..).zip(&model.strands) {
            for (place, &node) in (0..).zip(&strand.nodes) {
                if node != NONE && !others[node as usize] {
                    rows.entry(node).or_default().push(3 * e + place);
                }
            }
        }
        self.strand_nodes = rows.len();
        let mut end = 3 * rows.len() as u32;
        for (&node, row) in &rows {
            structure.slices[node as usize / SLICE][3] |= 1 << (node as usize % SLICE);
            self.strand_rows.extend([node, end, end + row.len() as u32]);
            end += row.len() as u32;
        }
        self.strand_rows.extend(rows.values().flatten());
    }

    /// The entries with flat bending, and the words of the matrix with its scalar entries, which `bending`
    /// and `scalars` give pair by pair.
    pub fn with_bending(&self, bending: &[f64], scalars: &[f64]) -> (Vec<Entry>, Vec<u32>) {
        let with =
            |(entry, pair): (&Entry, &u32)| Entry { bending: bending[*pair as usize] as f32, ..*entry };
        let entries = self.entries.iter().zip(&self.pairs).map(with).collect();
        let mut words = self.structure.words.clone();
        for (&at, value) in self.scalar_words.iter().zip(scalars) {
            words[at as usize] = (*value as f32).to_bits();
        }
        (entries, words)
    }
}

/// The index of the block (a, b) in [`ElementModel::columns`], which has it.
fn pair(model: &ElementModel, a: u32, b: u32) -> usize {
    let row = model.starts[a as usize] as usize..model.starts[a as usize + 1] as usize;
    row.start + model.columns[row].partition_point(|column| *column < b)
}

fn singles<const N: usize, const M: usize>(numbers: &[[f64; N]]) -> [f32; M] {
    let mut singles = [0.0; M];
    singles.iter_mut().zip(numbers.as_flattened()).for_each(|(single, number)| *single = *number as f32);
    singles
}

fn membrane(element: &bowknot_dynamics::MembraneElement) -> Membrane {
    Membrane {
        nodes: element.nodes,
        area: element.area as f32,
        gradients: singles(&element.gradients),
        stiffness: singles(&[element.stiffness]),
        damping: element.damping as f32,
        padding: [0; 3],
    }
}

fn bend(element: &bowknot_dynamics::BendElement) -> Bend {
    Bend {
        nodes: element.nodes,
        jumps: singles(&element.jumps),
        gram: singles(&element.gram),
        gradients: singles(&element.gradients),
        rest: singles(&element.rest),
        crushed: element.crushed as f32,
        padding: 0,
    }
}

fn tetrahedron(element: &bowknot_dynamics::TetrahedronElement) -> Tetrahedron {
    let [lambda, mu] = element.constants;
    // The Lame parameters of small strain: see solid_law.rs of the crate bowknot-dynamics.
    let lame = match element.kind {
        SolidKind::Stvk => [lambda, mu],
        SolidKind::StableNeoHookean => [lambda - 0.625 * mu, 0.75 * mu],
    };
    let is_damped = element.viscosity > 0.0 && lame[1] > 0.0;
    let time = if is_damped { element.viscosity / lame[1] } else { 0.0 };
    Tetrahedron {
        nodes: element.nodes,
        gradients: singles(&element.gradients),
        volume: element.volume as f32,
        lambda: lambda as f32,
        mu: mu as f32,
        law: u32::from(element.kind == SolidKind::StableNeoHookean),
        viscous_lambda: (time * lame[0]) as f32,
        viscous_mu: (time * lame[1]) as f32,
        padding: 0,
    }
}

fn strand(element: &bowknot_dynamics::StrandElement) -> Strand {
    let [a, b, c] = element.nodes;
    Strand {
        nodes: [if a == NONE { b } else { a }, b, c],
        rest: element.rest as f32,
        inverse_lengths: singles(&[element.inverse_lengths]),
        stiffness: element.stiffness as f32,
        damping: element.damping as f32,
    }
}
