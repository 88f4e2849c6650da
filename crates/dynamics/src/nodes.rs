//! Nodes, the deformable vertices: how loops over them are divided, and the number that stands for none.

/// Nodes per chunk, the unit of parallel work and of reductions.
pub(crate) const CHUNK: usize = 512;

/// Nodes or vertices that one thread takes at least, in loops that do little for each.
pub(crate) const MIN_NODES: usize = 4096;

/// "No node": the vertex is part of an obstacle and has no degrees of freedom.
pub(crate) const NO_NODE: u32 = u32::MAX;
