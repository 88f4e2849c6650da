//! The stages: each is a kernel in `shader/NAME.wgsl` and its twin in `cpu/NAME.rs`, with the same bindings in the same
//! order.
//!
//! Binding 0 holds the parameters of a dispatch. Threads go on with strides, so that any number of workgroups up to
//! [`recording::MAX_WORKGROUPS`](crate::recording::MAX_WORKGROUPS) does all of the work; only those that scan
//! depend on the size of a workgroup.

mod assembly;
mod linear;
mod newton;
mod potential;
mod stage;

use crate::cpu;

pub(crate) use assembly::{
    ASSEMBLE, BEND, COARSEN, COUPLE, DAMPED_TETRAHEDRON, DIAGONAL, DOMAIN, FRAME, INVERT, MEMBRANE, PRESS,
    STRAND, TETRAHEDRON,
};
pub(crate) use linear::{CLIMB, DESCEND, MULTIPLY, REDIRECT, STRAND_PRODUCT};
pub(crate) use newton::{
    ACCUMULATE, ATTEMPT, COMBINE, COPY, CORRELATE, GATHER, GUESS, IMPOSE, MOMENTA, NEGATE, PRODUCTS, REGRID,
    RESIDUE, SETTLE, SUBTRACT_KNOWN, SUMMARIZE, TRANSLATE,
};
pub(crate) use potential::{
    BEND_ENERGY, BEND_GRADIENT, GATHER_GRADIENT, MEMBRANE_ENERGY, MEMBRANE_GRADIENT, NODE_ENERGY,
    STRAND_ENERGY, STRAND_GRADIENT, SUM_ENERGY, TETRAHEDRON_ENERGY, TETRAHEDRON_GRADIENT,
};
pub(crate) use stage::{Access, Stage};

const TYPES: &str = include_str!("../shader/shared/types.wgsl");
const CLOSEST: &str = include_str!("../shader/shared/closest.wgsl");
const ENTRIES: &str = include_str!("../shader/shared/entries.wgsl");
const SCAN: &str = include_str!("../shader/shared/scan.wgsl");
const MOST: &str = include_str!("../shader/shared/most.wgsl");
const WEIGHTS: &str = include_str!("../shader/shared/weights.wgsl");
const PAIR: &str =
    concat!(include_str!("../shader/shared/weights.wgsl"), include_str!("../shader/shared/pair.wgsl"));
const CONTACT: &str = include_str!("../shader/shared/contact.wgsl");
const FIXED: &str = include_str!("../shader/shared/fixed.wgsl");

use Access::{Read, Write};

pub(crate) static RESTART: Stage = Stage {
    name: "restart",
    parts: &[TYPES, include_str!("../shader/restart.wgsl")],
    workgroup: 256,
    bindings: &[Write, Write, Write],
    twin: cpu::restart::bound,
};

pub(crate) static DECIDE: Stage = Stage {
    name: "decide",
    parts: &[TYPES, include_str!("../shader/decide.wgsl")],
    workgroup: 256,
    bindings: &[Write, Write, Write],
    twin: cpu::decide::bound,
};

pub(crate) static CURVE_EDGES: Stage = Stage {
    name: "curve_edges",
    parts: &[TYPES, FIXED, include_str!("../shader/curve_edges.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Write],
    twin: cpu::curve_edges::bound,
};

pub(crate) static RELEASE: Stage = Stage {
    name: "release",
    parts: &[TYPES, FIXED, include_str!("../shader/release.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Read, Write, Write, Read, Read],
    twin: cpu::release::bound,
};

pub(crate) static RELIEVE: Stage = Stage {
    name: "relieve",
    parts: &[TYPES, include_str!("../shader/relieve.wgsl")],
    workgroup: 128,
    bindings: &[Read, Read, Read, Read, Write, Write],
    twin: cpu::relieve::bound,
};

pub(crate) static SWEEP_EDGES: Stage = Stage {
    name: "sweep_edges",
    parts: &[TYPES, include_str!("../shader/sweep_edges.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Write, Write],
    twin: cpu::sweep_edges::bound,
};

pub(crate) static SLACK: Stage = Stage {
    name: "slack",
    parts: &[TYPES, include_str!("../shader/slack.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Read, Read, Write, Write],
    twin: cpu::slack::bound,
};

pub(crate) static FACTOR: Stage = Stage {
    name: "factor",
    parts: &[TYPES, include_str!("../shader/factor.wgsl")],
    workgroup: 256,
    bindings: &[Read, Write],
    twin: cpu::factor::bound,
};

pub(crate) static RESCALE: Stage = Stage {
    name: "rescale",
    parts: &[TYPES, include_str!("../shader/rescale.wgsl")],
    workgroup: 256,
    bindings: &[Read, Write, Write, Read, Read, Read, Write, Write],
    twin: cpu::rescale::bound,
};

pub(crate) static AIM: Stage = Stage {
    name: "aim",
    parts: &[TYPES, include_str!("../shader/aim.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Read, Write, Write],
    twin: cpu::aim::bound,
};

pub(crate) static BEGIN: Stage = Stage {
    name: "begin",
    parts: &[TYPES, include_str!("../shader/begin.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Write, Write, Write, Write, Write, Read],
    twin: cpu::begin::bound,
};

pub(crate) static RECALL: Stage = Stage {
    name: "recall",
    parts: &[TYPES, include_str!("../shader/recall.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Write, Write],
    twin: cpu::recall::bound,
};

pub(crate) static PICK: Stage = Stage {
    name: "pick",
    parts: &[TYPES, PAIR, include_str!("../shader/pick.wgsl")],
    workgroup: 128,
    bindings: &[Read, Read, Read, Read, Read, Write, Write, Write],
    twin: cpu::pick::bound,
};

pub(crate) static ENLIST: Stage = Stage {
    name: "enlist",
    parts: &[TYPES, PAIR, CONTACT, include_str!("../shader/enlist.wgsl")],
    workgroup: 128,
    bindings: &[Read, Read, Read, Read, Read, Read, Write, Write],
    twin: cpu::enlist::bound,
};

pub(crate) static MERGE: Stage = Stage {
    name: "merge",
    parts: &[TYPES, PAIR, CONTACT, include_str!("../shader/merge.wgsl")],
    workgroup: 128,
    bindings: &[Read, Read, Read, Read, Read, Write, Write, Write],
    twin: cpu::merge::bound,
};

pub(crate) static FACING: Stage = Stage {
    name: "facing",
    parts: &[TYPES, PAIR, include_str!("../shader/facing.wgsl")],
    workgroup: 128,
    bindings: &[Read, Read, Read, Read, Read, Read, Write, Write],
    twin: cpu::facing::bound,
};

pub(crate) static NEAR: Stage = Stage {
    name: "near",
    parts: &[TYPES, PAIR, include_str!("../shader/near.wgsl")],
    workgroup: 128,
    bindings: &[Read, Read, Read, Read, Read, Write, Write],
    twin: cpu::near::bound,
};

pub(crate) static LIST_NEAR: Stage = Stage {
    name: "list_near",
    parts: &[TYPES, include_str!("../shader/list_near.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Write, Write],
    twin: cpu::list_near::bound,
};

pub(crate) static LIST: Stage = Stage {
    name: "list",
    parts: &[TYPES, PAIR, include_str!("../shader/list.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Write, Write, Write],
    twin: cpu::list::bound,
};

pub(crate) static BUILD: Stage = Stage {
    name: "build",
    parts: &[TYPES, WEIGHTS, FIXED, include_str!("../shader/build.wgsl")],
    workgroup: 128,
    bindings: &[Read, Read, Read, Read, Write, Write, Write],
    twin: cpu::build::bound,
};

pub(crate) static SLIP: Stage = Stage {
    name: "slip",
    parts: &[TYPES, include_str!("../shader/slip.wgsl")],
    workgroup: 128,
    bindings: &[Read, Read, Read, Read, Read, Read, Write, Write],
    twin: cpu::slip::bound,
};

pub(crate) static DIVIDE: Stage = Stage {
    name: "divide",
    parts: &[TYPES, include_str!("../shader/divide.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Write, Write, Write],
    twin: cpu::divide::bound,
};

pub(crate) static START_BUCKETS: Stage = Stage {
    name: "start_buckets",
    parts: &[TYPES, SCAN, include_str!("../shader/start_buckets.wgsl")],
    workgroup: 256,
    bindings: &[Read, Write],
    twin: cpu::start_buckets::bound,
};

pub(crate) static SORT: Stage = Stage {
    name: "sort",
    parts: &[TYPES, include_str!("../shader/sort.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Write, Write, Write],
    twin: cpu::sort::bound,
};

pub(crate) static COLOR: Stage = Stage {
    name: "color",
    parts: &[TYPES, include_str!("../shader/color.wgsl")],
    workgroup: 256,
    bindings: &[Read, Write, Write, Write, Write, Write, Write, Write],
    twin: cpu::color::bound,
};

pub(crate) static SWEEP_ROWS: Stage = Stage {
    name: "sweep_rows",
    parts: &[TYPES, include_str!("../shader/sweep_rows.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Read, Write, Write, Write],
    twin: cpu::sweep_rows::bound,
};

pub(crate) static STORE: Stage = Stage {
    name: "store",
    parts: &[TYPES, include_str!("../shader/store.wgsl")],
    workgroup: 256,
    bindings: &[Read, Write, Write],
    twin: cpu::store::bound,
};

pub(crate) static PLAN: Stage = Stage {
    name: "plan",
    parts: &[TYPES, include_str!("../shader/plan.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Read, Write, Write],
    twin: cpu::plan::bound,
};

pub(crate) static JOIN: Stage = Stage {
    name: "join",
    parts: &[TYPES, include_str!("../shader/join.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Write, Write],
    twin: cpu::join::bound,
};

pub(crate) static COVER: Stage = Stage {
    name: "cover",
    parts: &[TYPES, include_str!("../shader/cover.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Read, Write, Write],
    twin: cpu::cover::bound,
};

pub(crate) static BOXES: Stage = Stage {
    name: "boxes",
    parts: &[TYPES, include_str!("../shader/boxes.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Read, Write, Write],
    twin: cpu::boxes::bound,
};

pub(crate) static REFIT: Stage = Stage {
    name: "refit",
    parts: &[TYPES, include_str!("../shader/refit.wgsl")],
    workgroup: 256,
    bindings: &[Write, Write],
    twin: cpu::refit::bound,
};

pub(crate) static TRAVERSE: Stage = Stage {
    name: "traverse",
    parts: &[TYPES, include_str!("../shader/traverse.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Read, Write, Write, Write],
    twin: cpu::traverse::bound,
};

pub(crate) static NEAR_PLANES: Stage = Stage {
    name: "near_planes",
    parts: &[TYPES, include_str!("../shader/near_planes.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Write, Write, Write],
    twin: cpu::near_planes::bound,
};

pub(crate) static COUNT: Stage = Stage {
    name: "count",
    parts: &[TYPES, SCAN, ENTRIES, include_str!("../shader/count.wgsl")],
    workgroup: cpu::count::BLOCK,
    bindings: &[Write, Write, Write],
    twin: cpu::count::bound,
};

pub(crate) static TOTAL: Stage = Stage {
    name: "total",
    parts: &[TYPES, SCAN, ENTRIES, include_str!("../shader/total.wgsl")],
    workgroup: 256,
    bindings: &[Write, Write],
    twin: cpu::total::bound,
};

pub(crate) static PLACE: Stage = Stage {
    name: "place",
    parts: &[TYPES, SCAN, ENTRIES, include_str!("../shader/place.wgsl")],
    workgroup: 256,
    bindings: &[Read, Write, Write],
    twin: cpu::place::bound,
};

pub(crate) static SEPARATE: Stage = Stage {
    name: "separate",
    parts: &[TYPES, CLOSEST, PAIR, include_str!("../shader/separate.wgsl")],
    workgroup: 128,
    bindings: &[Read, Read, Read, Read, Read, Write, Write],
    twin: cpu::separate::bound,
};

pub(crate) static KEEP: Stage = Stage {
    name: "keep",
    parts: &[TYPES, include_str!("../shader/keep.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Read, Write, Write, Write, Write],
    twin: cpu::keep::bound,
};

pub(crate) static INHERIT: Stage = Stage {
    name: "inherit",
    parts: &[TYPES, include_str!("../shader/inherit.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Read, Write, Write],
    twin: cpu::inherit::bound,
};

pub(crate) static RESUME: Stage = Stage {
    name: "resume",
    parts: &[TYPES, include_str!("../shader/resume.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Write, Write],
    twin: cpu::resume::bound,
};

pub(crate) static SPACE: Stage = Stage {
    name: "space",
    parts: &[TYPES, CLOSEST, PAIR, include_str!("../shader/space.wgsl")],
    workgroup: 128,
    bindings: &[Read, Read, Read, Read, Read, Write, Write, Write],
    twin: cpu::space::bound,
};

pub(crate) static LIMIT: Stage = Stage {
    name: "limit",
    parts: &[TYPES, PAIR, include_str!("../shader/limit.wgsl")],
    workgroup: 128,
    bindings: &[Read, Read, Read, Read, Read, Read, Write, Write],
    twin: cpu::limit::bound,
};

pub(crate) static LIMIT_GROUPS: Stage = Stage {
    name: "limit_groups",
    parts: &[TYPES, include_str!("../shader/limit_groups.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Write],
    twin: cpu::limit_groups::bound,
};

pub(crate) static ADVANCE: Stage = Stage {
    name: "advance",
    parts: &[TYPES, MOST, include_str!("../shader/advance.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Read, Write, Write, Write],
    twin: cpu::advance::bound,
};

pub(crate) static RESIDUALS: Stage = Stage {
    name: "residuals",
    parts: &[TYPES, include_str!("../shader/residuals.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Read, Write],
    twin: cpu::residuals::bound,
};

pub(crate) static BALANCE: Stage = Stage {
    name: "balance",
    parts: &[TYPES, include_str!("../shader/balance.wgsl")],
    workgroup: 64,
    bindings: &[Read, Read, Write],
    twin: cpu::balance::bound,
};

pub(crate) static STRETCH: Stage = Stage {
    name: "stretch",
    parts: &[TYPES, MOST, include_str!("../shader/stretch.wgsl")],
    workgroup: 256,
    bindings: &[Read, Read, Write],
    twin: cpu::stretch::bound,
};

/// All of them.
#[cfg(test)]
pub(crate) static ALL: &[&Stage] = &[
    &BEGIN,
    &RESTART,
    &DECIDE,
    &RECALL,
    &FACING,
    &PICK,
    &ENLIST,
    &MERGE,
    &NEAR,
    &LIST_NEAR,
    &LIST,
    &BUILD,
    &SLIP,
    &DIVIDE,
    &START_BUCKETS,
    &SORT,
    &COLOR,
    &SWEEP_ROWS,
    &STORE,
    &CURVE_EDGES,
    &RELEASE,
    &RELIEVE,
    &SWEEP_EDGES,
    &SLACK,
    &FACTOR,
    &RESCALE,
    &AIM,
    &PLAN,
    &JOIN,
    &COVER,
    &BOXES,
    &REFIT,
    &TRAVERSE,
    &NEAR_PLANES,
    &COUNT,
    &TOTAL,
    &PLACE,
    &KEEP,
    &INHERIT,
    &RESUME,
    &SEPARATE,
    &SPACE,
    &LIMIT,
    &LIMIT_GROUPS,
    &ADVANCE,
    &RESIDUALS,
    &BALANCE,
    &STRETCH,
    &STRAND_PRODUCT,
    &MULTIPLY,
    &DESCEND,
    &CLIMB,
    &REDIRECT,
    &MEMBRANE,
    &BEND,
    &TETRAHEDRON,
    &DAMPED_TETRAHEDRON,
    &STRAND,
    &ASSEMBLE,
    &DIAGONAL,
    &INVERT,
    &FRAME,
    &COUPLE,
    &COARSEN,
    &PRESS,
    &DOMAIN,
    &ACCUMULATE,
    &ATTEMPT,
    &COMBINE,
    &COPY,
    &CORRELATE,
    &GATHER,
    &GUESS,
    &IMPOSE,
    &MOMENTA,
    &NEGATE,
    &PRODUCTS,
    &REGRID,
    &SUBTRACT_KNOWN,
    &RESIDUE,
    &SETTLE,
    &SUMMARIZE,
    &TRANSLATE,
    &MEMBRANE_GRADIENT,
    &BEND_GRADIENT,
    &TETRAHEDRON_GRADIENT,
    &STRAND_GRADIENT,
    &GATHER_GRADIENT,
    &MEMBRANE_ENERGY,
    &BEND_ENERGY,
    &TETRAHEDRON_ENERGY,
    &STRAND_ENERGY,
    &NODE_ENERGY,
    &SUM_ENERGY,
];

#[cfg(test)]
mod tests;
