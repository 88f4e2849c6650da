//! What a backend that computes Newton iterations gets: the elements of a model, and springs.

use super::springs::LinearSpring;
use bowknot_geometry::Vector;
use std::fmt::Debug;
use std::ops::Range;

/// What is fixed during a run: the elements of all bodies over nodes, and which pairs of nodes they join.
#[derive(Clone, Debug, Default)]
pub struct ElementModel {
    /// Positions of the nodes at rest [m].
    pub rest: Vec<Vector>,
    /// Row i joins node i with the nodes `columns[starts[i]..starts[i + 1]]`, ascending.
    pub starts: Vec<u32>,
    /// See [`Self::starts`].
    pub columns: Vec<u32>,
    /// Row i joins node i with the nodes `scalar_columns[scalar_starts[i]..scalar_starts[i + 1]]`, ascending,
    /// which flat bending alone joins with it.
    pub scalar_starts: Vec<u32>,
    /// See [`Self::scalar_starts`].
    pub scalar_columns: Vec<u32>,
    /// Ranges of nodes that are compact patches of one body each; empty if block-Jacobi was asked for.
    pub patches: Vec<Range<u32>>,
    /// Ranges of nodes that elements join, directly or through other nodes; each node is in one.
    pub components: Vec<Range<u32>>,
    /// Triangles of cloth.
    pub membranes: Vec<MembraneElement>,
    /// Bending of cloth that is curved at rest.
    pub bends: Vec<BendElement>,
    /// Tetrahedra of solids.
    pub tetrahedra: Vec<TetrahedronElement>,
    /// Edges and turns of strands.
    pub strands: Vec<StrandElement>,
}

/// A triangle of constant strain E = U - I with F = R U; its energy per area is c11/2 E11^2 + c12 E11 E22 + c22/2
/// E22^2 + 2 shear E12^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MembraneElement {
    /// The nodes.
    pub nodes: [u32; 3],
    /// Gradients of the shape functions of nodes 1 and 2 in the rest plane [1/m].
    pub gradients: [[f64; 2]; 2],
    /// Rest area [m^2].
    pub area: f64,
    /// c11, c12, c22 and shear [N/m].
    pub stiffness: [f64; 4],
    /// Damping time [s]: the same energy of the increment of Green's strain, times this and 1 / dt.
    pub damping: f64,
}

/// Bending around a triangle: energy 1/2 sum_ef g_ef r_e . r_f with r_e = sum_p k_ep x_p - a_e f1 - b_e f2 - c_e n.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BendElement {
    /// The nodes, the corners of the triangle first; `u32::MAX` for places without a node.
    pub nodes: [u32; 6],
    /// The weights k by edge [1].
    pub jumps: [[f64; 6]; 3],
    /// The matrix g [N/m].
    pub gram: [[f64; 3]; 3],
    /// Gradients of the shape functions of nodes 1 and 2 in the rest plane [1/m].
    pub gradients: [[f64; 2]; 2],
    /// The components (a, b, c) of each edge [m].
    pub rest: [[f64; 3]; 3],
    /// Below about this share of the rest area the normal becomes shorter.
    pub crushed: f64,
}

/// Which energy density a solid has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolidKind {
    /// St. Venant-Kirchhoff.
    Stvk,
    /// Stable neo-Hookean.
    StableNeoHookean,
}

/// A tetrahedron of constant strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TetrahedronElement {
    /// The nodes.
    pub nodes: [u32; 4],
    /// Gradients of the shape functions of nodes 1, 2 and 3 at rest [1/m].
    pub gradients: [[f64; 3]; 3],
    /// Rest volume [m^3].
    pub volume: f64,
    /// The law.
    pub kind: SolidKind,
    /// The constants lambda and mu of the law [Pa].
    pub constants: [f64; 2],
    /// Damping time times mu [Pa s].
    pub viscosity: f64,
}

/// An edge of a strand, or a turn between two edges: energy k/2 (|w| - w0)^2 with w = c (x2 - x1) - a (x1 - x0).
///
/// | element | w | k | w0 | damping, times the damping time and 1 / dt |
/// |---|---|---|---|---|
/// | edge | x2 - x1 over the rest length, a = 0 | EA times the rest length | 1 | k/2 ((w^2 - ws^2)/2)^2 |
/// | turn | jump of the tangent | EI / M | that at rest | k/2 (w - ws)^2 |
///
/// with ws at the start of the time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrandElement {
    /// The nodes 0, 1 and 2; the first is `u32::MAX` for an edge.
    pub nodes: [u32; 3],
    /// a and c: the inverse rest lengths [1/m].
    pub inverse_lengths: [f64; 2],
    /// k [N m].
    pub stiffness: f64,
    /// w0 [1].
    pub rest: f64,
    /// Damping time [s].
    pub damping: f64,
}

/// Springs of a matrix.
#[derive(Clone, Copy, Debug, Default)]
pub struct AssemblySprings<'a> {
    /// The springs.
    pub springs: &'a [LinearSpring],
    /// Springs of each node with its weights: `entries[starts[i]..starts[i + 1]]`. Both are empty if there are none.
    pub starts: &'a [u32],
    /// See [`Self::starts`].
    pub entries: &'a [(u32, f64)],
}
