//! The stages of linear solves.

use super::assembly::STRANDS;
use super::stage::Access::{Read, Write};
use super::stage::Stage;
use crate::cpu;
use crate::cpu::sum::THREADS;

const LINEAR: &str = include_str!("../../shader/shared/linear.wgsl");
const SUM: &str = include_str!("../../shader/shared/sum.wgsl");
const TWO_SUMS: &str = include_str!("../../shader/shared/two_sums.wgsl");
const RIGID: &str = include_str!("../../shader/shared/rigid.wgsl");

pub(crate) static STRAND_PRODUCT: Stage = Stage {
    name: "strand_product",
    parts: &[LINEAR, STRANDS, include_str!("../../shader/strand_product.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Write, Write],
    twin: cpu::strand_product::bound,
};

pub(crate) static MULTIPLY: Stage = Stage {
    name: "multiply",
    parts: &[LINEAR, SUM, include_str!("../../shader/multiply.wgsl")],
    workgroup: THREADS,
    bindings: &[Read, Read, Read, Read, Read, Write, Write, Write],
    twin: cpu::multiply::bound,
};

pub(crate) static DESCEND: Stage = Stage {
    name: "descend",
    parts: &[LINEAR, SUM, TWO_SUMS, RIGID, include_str!("../../shader/descend.wgsl")],
    workgroup: THREADS,
    bindings: &[Read, Read, Read, Write, Write, Write, Write, Write],
    twin: cpu::descend::bound,
};

pub(crate) static CLIMB: Stage = Stage {
    name: "climb",
    parts: &[LINEAR, SUM, RIGID, include_str!("../../shader/climb.wgsl")],
    workgroup: THREADS,
    bindings: &[Read, Read, Write, Write, Write, Write],
    twin: cpu::climb::bound,
};

pub(crate) static REDIRECT: Stage = Stage {
    name: "redirect",
    parts: &[LINEAR, SUM, TWO_SUMS, include_str!("../../shader/redirect.wgsl")],
    workgroup: THREADS,
    bindings: &[Read, Read, Read, Read, Write, Read, Write],
    twin: cpu::redirect::bound,
};
