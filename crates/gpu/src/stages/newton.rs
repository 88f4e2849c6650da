//! The stages of Newton's method.

use super::stage::Access::{Read, Write};
use super::stage::Stage;
use crate::cpu;
use crate::cpu::sum::THREADS;

const LINEAR: &str = include_str!("../../shader/shared/linear.wgsl");
const SUM: &str = include_str!("../../shader/shared/sum.wgsl");
const LARGEST: &str = include_str!("../../shader/shared/largest.wgsl");
const NEWTON: &str = include_str!("../../shader/shared/newton.wgsl");
const FREE: &str = include_str!("../../shader/shared/free.wgsl");
const SEGMENTS: &str = include_str!("../../shader/shared/segments.wgsl");

pub(crate) static NEGATE: Stage = Stage {
    name: "negate",
    parts: &[LINEAR, SUM, LARGEST, NEWTON, FREE, include_str!("../../shader/negate.wgsl")],
    workgroup: THREADS,
    bindings: &[Read, Read, Read, Read, Read, Write, Write],
    twin: cpu::negate::bound,
};

pub(crate) static SETTLE: Stage = Stage {
    name: "settle",
    parts: &[LINEAR, SUM, LARGEST, NEWTON, include_str!("../../shader/settle.wgsl")],
    workgroup: THREADS,
    bindings: &[Read, Write, Write, Write],
    twin: cpu::settle::bound,
};

pub(crate) static RESIDUE: Stage = Stage {
    name: "residue",
    parts: &[NEWTON, include_str!("../../shader/residue.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
    twin: cpu::residue::bound,
};

pub(crate) static IMPOSE: Stage = Stage {
    name: "impose",
    parts: &[include_str!("../../shader/impose.wgsl")],
    workgroup: 64,
    bindings: &[Read, Write],
    twin: cpu::impose::bound,
};

pub(crate) static GUESS: Stage = Stage {
    name: "guess",
    parts: &[FREE, include_str!("../../shader/guess.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Write, Write],
    twin: cpu::guess::bound,
};

pub(crate) static CORRELATE: Stage = Stage {
    name: "correlate",
    parts: &[SUM, include_str!("../../shader/correlate.wgsl")],
    workgroup: THREADS,
    bindings: &[Read, Read, Read, Read, Read, Write],
    twin: cpu::correlate::bound,
};

pub(crate) static COMBINE: Stage = Stage {
    name: "combine",
    parts: &[SUM, NEWTON, include_str!("../../shader/combine.wgsl")],
    workgroup: THREADS,
    bindings: &[Read, Read, Read, Read, Read, Read, Write, Write],
    twin: cpu::combine::bound,
};

pub(crate) static ACCUMULATE: Stage = Stage {
    name: "accumulate",
    parts: &[LINEAR, NEWTON, include_str!("../../shader/accumulate.wgsl")],
    workgroup: 64,
    bindings: &[Read, Write, Write, Write, Write],
    twin: cpu::accumulate::bound,
};

pub(crate) static MOMENTA: Stage = Stage {
    name: "momenta",
    parts: &[SEGMENTS, include_str!("../../shader/momenta.wgsl")],
    workgroup: cpu::newton::WINDOW,
    bindings: &[Read, Read, Read, Read, Read, Write],
    twin: cpu::momenta::bound,
};

pub(crate) static PRODUCTS: Stage = Stage {
    name: "products",
    parts: &[SEGMENTS, include_str!("../../shader/products.wgsl")],
    workgroup: cpu::newton::WINDOW,
    bindings: &[Read, Read, Read, Write],
    twin: cpu::products::bound,
};

pub(crate) static TRANSLATE: Stage = Stage {
    name: "translate",
    parts: &[FREE, include_str!("../../shader/translate.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
    twin: cpu::translate::bound,
};

pub(crate) static ATTEMPT: Stage = Stage {
    name: "attempt",
    parts: &[SUM, LARGEST, NEWTON, FREE, include_str!("../../shader/attempt.wgsl")],
    workgroup: THREADS,
    bindings: &[Read, Read, Read, Read, Read, Read, Write, Write],
    twin: cpu::attempt::bound,
};

pub(crate) static SUMMARIZE: Stage = Stage {
    name: "summarize",
    parts: &[SUM, LARGEST, include_str!("../../shader/summarize.wgsl")],
    workgroup: THREADS,
    bindings: &[Read, Write],
    twin: cpu::summarize::bound,
};

pub(crate) static COPY: Stage = Stage {
    name: "copy",
    parts: &[include_str!("../../shader/copy.wgsl")],
    workgroup: 64,
    bindings: &[Read, Write],
    twin: cpu::copy::bound,
};

pub(crate) static GATHER: Stage = Stage {
    name: "gather",
    parts: &[include_str!("../../shader/gather.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Write],
    twin: cpu::gather::bound,
};

pub(crate) static REGRID: Stage = Stage {
    name: "regrid",
    parts: &[include_str!("../../shader/regrid.wgsl")],
    workgroup: 64,
    bindings: &[Write],
    twin: cpu::regrid::bound,
};

pub(crate) static SUBTRACT_KNOWN: Stage = Stage {
    name: "subtract_known",
    parts: &[include_str!("../../shader/subtract_known.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Write],
    twin: cpu::subtract_known::bound,
};
