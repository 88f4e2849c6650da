//! Slow oracles for the whole crate, in one binary.

/// Closest points and widths against integer arithmetic on grids.
mod exact_distance;
/// Exact distances and intersections of simplices with small integer coordinates.
mod integer;
/// Intersection tests against integer arithmetic, exhaustively on the smallest grid.
mod intersections;
/// Symmetry, rigid motion, gradients.
mod invariance;
/// Distances against two other implementations.
mod parry;
/// Near-degenerate pairs.
mod sampling;
/// Certified widths against double-double arithmetic.
mod slab_width;
/// Two triangles: exact distances, certified slabs, another implementation.
mod triangles;
