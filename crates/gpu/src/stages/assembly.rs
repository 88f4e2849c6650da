//! The stages that assemble matrices.

use super::stage::Access::{Read, Write};
use super::stage::Stage;
use crate::cpu;

pub(super) const ELEMENTS: &str = include_str!("../../shader/shared/elements.wgsl");
const BLOCKS: &str = include_str!("../../shader/shared/blocks.wgsl");
pub(super) const TRIANGLE: &str = include_str!("../../shader/shared/triangle.wgsl");
pub(super) const NORMAL: &str = include_str!("../../shader/shared/normal.wgsl");
pub(super) const STRAIN: &str = include_str!("../../shader/shared/strain.wgsl");
pub(super) const STRANDS: &str = include_str!("../../shader/shared/strand.wgsl");
const SOLID: &str = include_str!("../../shader/shared/solid.wgsl");
const EIGEN: &str = include_str!("../../shader/shared/eigen.wgsl");
const GROUPS: &str = include_str!("../../shader/shared/groups.wgsl");
const LINEAR: &str = include_str!("../../shader/shared/linear.wgsl");

pub(crate) static MEMBRANE: Stage = Stage {
    name: "membrane",
    parts: &[ELEMENTS, BLOCKS, TRIANGLE, include_str!("../../shader/membrane.wgsl"), EIGEN],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
    twin: cpu::membrane::bound,
};

pub(crate) static BEND: Stage = Stage {
    name: "bend",
    parts: &[ELEMENTS, BLOCKS, NORMAL, include_str!("../../shader/bend.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
    twin: cpu::bend::bound,
};

pub(crate) static TETRAHEDRON: Stage = Stage {
    name: "tetrahedron",
    parts: &[ELEMENTS, BLOCKS, STRAIN, SOLID, include_str!("../../shader/tetrahedron.wgsl"), EIGEN],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
    twin: cpu::tetrahedron::bound,
};

pub(crate) static DAMPED_TETRAHEDRON: Stage = Stage {
    name: "damped_tetrahedron",
    parts: &[ELEMENTS, BLOCKS, STRAIN, SOLID, include_str!("../../shader/damped_tetrahedron.wgsl"), EIGEN],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
    twin: cpu::damped_tetrahedron::bound,
};

pub(crate) static STRAND: Stage = Stage {
    name: "strand",
    parts: &[ELEMENTS, BLOCKS, STRANDS, include_str!("../../shader/strand.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write, Write],
    twin: cpu::strand::bound,
};

pub(crate) static ASSEMBLE: Stage = Stage {
    name: "assemble",
    parts: &[include_str!("../../shader/assemble.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Read, Write],
    twin: cpu::assemble::bound,
};

pub(crate) static DIAGONAL: Stage = Stage {
    name: "diagonal",
    parts: &[include_str!("../../shader/diagonal.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Write],
    twin: cpu::diagonal::bound,
};

pub(crate) static INVERT: Stage = Stage {
    name: "invert",
    parts: &[LINEAR, include_str!("../../shader/invert.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
    twin: cpu::invert::bound,
};

pub(crate) static FRAME: Stage = Stage {
    name: "frame",
    parts: &[LINEAR, GROUPS, include_str!("../../shader/frame.wgsl"), EIGEN],
    workgroup: 64,
    bindings: &[Read, Write, Write, Write],
    twin: cpu::frame::bound,
};

pub(crate) static COUPLE: Stage = Stage {
    name: "couple",
    parts: &[LINEAR, GROUPS, include_str!("../../shader/couple.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Read, Read, Read, Write],
    twin: cpu::couple::bound,
};

pub(crate) static COARSEN: Stage = Stage {
    name: "coarsen",
    parts: &[GROUPS, include_str!("../../shader/coarsen.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
    twin: cpu::coarsen::bound,
};

pub(crate) static PRESS: Stage = Stage {
    name: "press",
    parts: &[LINEAR, GROUPS, include_str!("../../shader/press.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Read, Write],
    twin: cpu::press::bound,
};

pub(crate) static DOMAIN: Stage = Stage {
    name: "domain",
    parts: &[LINEAR, GROUPS, include_str!("../../shader/domain.wgsl")],
    workgroup: 192,
    bindings: &[Read, Read, Read, Read, Read, Write],
    twin: cpu::domain::bound,
};
