//! The stages that compute the potential of the bodies and its gradient.

use super::assembly::{ELEMENTS, NORMAL, STRAIN, STRANDS, TRIANGLE};
use super::stage::Access::{Read, Write};
use super::stage::Stage;
use crate::cpu;

const GRADIENTS: &str = include_str!("../../shader/shared/gradients.wgsl");
const ENERGIES: &str = include_str!("../../shader/shared/energies.wgsl");
const PARTS: &str = include_str!("../../shader/shared/parts.wgsl");
const TERMS: &str = include_str!("../../shader/shared/terms.wgsl");
const LOGARITHM: &str = include_str!("../../shader/shared/logarithm.wgsl");

pub(crate) static MEMBRANE_GRADIENT: Stage = Stage {
    name: "membrane_gradient",
    parts: &[ELEMENTS, GRADIENTS, TRIANGLE, include_str!("../../shader/membrane_gradient.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
    twin: cpu::membrane_gradient::bound,
};

pub(crate) static BEND_GRADIENT: Stage = Stage {
    name: "bend_gradient",
    parts: &[ELEMENTS, GRADIENTS, NORMAL, include_str!("../../shader/bend_gradient.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
    twin: cpu::bend_gradient::bound,
};

pub(crate) static TETRAHEDRON_GRADIENT: Stage = Stage {
    name: "tetrahedron_gradient",
    parts: &[ELEMENTS, GRADIENTS, STRAIN, include_str!("../../shader/tetrahedron_gradient.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
    twin: cpu::tetrahedron_gradient::bound,
};

pub(crate) static STRAND_GRADIENT: Stage = Stage {
    name: "strand_gradient",
    parts: &[ELEMENTS, GRADIENTS, STRANDS, include_str!("../../shader/strand_gradient.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
    twin: cpu::strand_gradient::bound,
};

pub(crate) static GATHER_GRADIENT: Stage = Stage {
    name: "gather_gradient",
    parts: &[TERMS, include_str!("../../shader/gather_gradient.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Read, Read, Read, Write],
    twin: cpu::gather_gradient::bound,
};

pub(crate) static MEMBRANE_ENERGY: Stage = Stage {
    name: "membrane_energy",
    parts: &[ELEMENTS, PARTS, ENERGIES, TRIANGLE, include_str!("../../shader/membrane_energy.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Write],
    twin: cpu::membrane_energy::bound,
};

pub(crate) static BEND_ENERGY: Stage = Stage {
    name: "bend_energy",
    parts: &[ELEMENTS, PARTS, ENERGIES, NORMAL, include_str!("../../shader/bend_energy.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Write],
    twin: cpu::bend_energy::bound,
};

pub(crate) static TETRAHEDRON_ENERGY: Stage = Stage {
    name: "tetrahedron_energy",
    parts: &[
        ELEMENTS,
        PARTS,
        ENERGIES,
        STRAIN,
        LOGARITHM,
        include_str!("../../shader/tetrahedron_energy.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Write],
    twin: cpu::tetrahedron_energy::bound,
};

pub(crate) static STRAND_ENERGY: Stage = Stage {
    name: "strand_energy",
    parts: &[ELEMENTS, PARTS, ENERGIES, STRANDS, include_str!("../../shader/strand_energy.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Write],
    twin: cpu::strand_energy::bound,
};

pub(crate) static NODE_ENERGY: Stage = Stage {
    name: "node_energy",
    parts: &[PARTS, TERMS, include_str!("../../shader/node_energy.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Read, Read, Write],
    twin: cpu::node_energy::bound,
};

pub(crate) static SUM_ENERGY: Stage = Stage {
    name: "sum_energy",
    parts: &[PARTS, include_str!("../../shader/sum_energy.wgsl")],
    workgroup: 64,
    bindings: &[Read, Write],
    twin: cpu::sum_energy::bound,
};
