//! The data that host, kernels and twins share, as they lie in buffers. A test compares every struct with
//! what the shaders declare (`stages/tests.rs`).
//!
//! Lengths are in quanta of the [grid](crate::Grid), so that no number has a unit.

use bytemuck::{Pod, Zeroable};

/// No element, no group.
pub const NONE: u32 = u32::MAX;

/// Children of a node of a [tree](crate::tree), elements of a leaf.
pub const BRANCHING: usize = 8;

/// Most levels of a tree: 8^10 elements are more than `u32` counts.
pub const MAX_LEVELS: usize = 11;

/// What does not change during a call, by vertex; behind the vertices, by half-space.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Vertex {
    /// Local edge length.
    pub edge: f32,
    /// Half of the largest contact range of a pair with this vertex.
    pub margin: f32,
    /// Body of the vertex.
    pub body: u32,
    /// [`Vertex::OBSTACLE`], [`Vertex::PRESCRIBED`], [`Vertex::SELF_COLLIDES`], [`Vertex::KNOWN`].
    pub flags: u32,
    /// Collision groups of the body, and those that it collides with.
    pub groups: u32,
    pub mask: u32,
    /// Vertices of a group move by one fraction of their displacements; [`NONE`] for no group.
    pub group: u32,
    /// Desired distance of the body's contacts.
    pub delta: f32,
    /// Desired distance of the body's contacts with half-spaces that have no thickness.
    pub half_space_delta: f32,
    /// Thickness of the body, a minimum separation that is guaranteed; below 0 if it has none.
    pub thickness: f32,
    /// Mass over the mean mass; of a vertex that is not prescribed it is above 0.
    pub mass: f32,
    /// Square root of the coefficient of friction of the body.
    pub root_of_friction: f32,
}

impl Vertex {
    /// The vertex belongs to an obstacle: two obstacles form no pair.
    pub const OBSTACLE: u32 = 1;
    /// The vertex is prescribed: of an obstacle, or pinned.
    pub const PRESCRIBED: u32 = 2;
    /// The body collides with itself.
    pub const SELF_COLLIDES: u32 = 4;
    /// The target of the call knows the contacts of the vertex.
    pub const KNOWN: u32 = 8;
}

/// A trust region: the list of candidates is complete inside of it only.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Ball {
    pub center: [i32; 3],
    pub radius: i32,
}

/// The progress of a prescribed vertex in a call.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Late {
    /// Smallest distance to its target so far.
    pub smallest: f32,
    /// Steps without progress.
    pub idle_steps: u32,
}

/// The place of an element in a tree.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct Slot {
    /// Vertices; the first fills places that the element does not have.
    pub vertices: [u32; 3],
    /// Index of the element among its kind; [`NONE`] for a place without one.
    pub element: u32,
}

/// The box of a node of a tree; empty if a low coordinate is above a high one.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct NodeBox {
    pub low: [i32; 3],
    /// 1 if something in it is no obstacle.
    pub deformable: u32,
    pub high: [i32; 3],
    pub padding: u32,
}

impl NodeBox {
    pub const EMPTY: Self = Self { low: [i32::MAX; 3], deformable: 0, high: [i32::MIN; 3], padding: 0 };
}

/// A pair of elements that may meet.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Pod, Zeroable)]
pub struct Candidate {
    /// The kind ([`Kind`]) in the upper three bits, the element of side *a* in the others.
    pub kind_and_a: u32,
    /// The element of side *b*.
    pub b: u32,
}

/// Kinds of pairs, by the primitives of both sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Kind {
    /// Two particles.
    VertexVertex = 0,
    /// A particle and an edge of a strand.
    VertexEdge = 1,
    /// A vertex of a surface, or a particle, and a triangle.
    VertexTriangle = 2,
    /// Two edges.
    EdgeEdge = 3,
    /// A vertex and a half-space.
    VertexHalfSpace = 4,
}

impl Candidate {
    /// Bits of the element of side *a*.
    pub const ELEMENT_BITS: u32 = 29;

    /// A pair of that kind.
    pub fn new(kind: Kind, a: u32, b: u32) -> Self {
        Self { kind_and_a: (kind as u32) << Self::ELEMENT_BITS | a, b }
    }

    /// The element of side *a*.
    pub fn a(&self) -> u32 {
        self.kind_and_a & ((1 << Self::ELEMENT_BITS) - 1)
    }

    /// The number of the kind.
    pub fn kind(&self) -> u32 {
        self.kind_and_a >> Self::ELEMENT_BITS
    }

    /// This pair with sides of one kind in the order of their numbers: a search may find it either way.
    pub(crate) fn ordered(self) -> Self {
        let (kind, a) = (self.kind(), self.a());
        let is_symmetric = kind == Kind::VertexVertex as u32 || kind == Kind::EdgeEdge as u32;
        if is_symmetric && self.b < a {
            Self { kind_and_a: kind << Self::ELEMENT_BITS | self.b, b: a }
        } else {
            self
        }
    }
}

/// Contact geometry of a candidate.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Separation {
    /// Unit direction from side *b* to side *a*.
    pub normal: [f32; 3],
    /// Certified lower bound of the width of the slab between both sides; 0 or less if nothing is certified.
    pub width: f32,
    /// Weights in the closest points: of the last two vertices of a pair with a triangle, of the last
    /// vertices of both sides otherwise. The weights of a side sum to 1.
    pub weights: [f32; 2],
    /// Computed distance of the closest points.
    pub distance: f32,
    /// No step makes the gap smaller than this; see [`PairState`].
    pub min_separation: f32,
    /// Distance that a row of the pair asks for; 0 if it gets none.
    pub wanted: f32,
    /// Sine of the angle between two edges; 0 for other pairs.
    pub sine: f32,
    pub padding_0: u32,
    pub padding_1: u32,
}

/// What a candidate keeps from step to step.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct PairState {
    /// Multiplier of friction.
    pub friction: [f32; 3],
    /// Multiplier of the contact row.
    pub multiplier: f32,
    /// Distance that the contact row asks for; below 0 for a candidate that is new.
    pub desired: f32,
    /// Minimum separation.
    pub min_separation: f32,
    /// Distance within which the pair can have a row.
    pub range: f32,
    /// 1: the pair was out of range in the last step.
    pub is_far: u32,
}

#[cfg(test)]
impl PairState {
    /// A candidate that is new.
    pub const NEW: Self = Self {
        friction: [0.0; 3],
        multiplier: 0.0,
        desired: -1.0,
        min_separation: 0.0,
        range: 0.0,
        is_far: 0,
    };
}

/// What a pair carries at the start of a call, in a list that is sorted by pair.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct CarriedState {
    /// Multiplier of friction on side *a*.
    pub friction: [f32; 3],
    /// Multiplier of the contact row.
    pub multiplier: f32,
    /// The pair, [ordered](Candidate::ordered).
    pub candidate: Candidate,
    pub padding_0: u32,
    pub padding_1: u32,
}

/// A contact row, linearized at the positions: value + normal . sum of weights u >= 0.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Row {
    /// Unused places repeat the first vertex, with the weight 0.
    pub vertices: [u32; 4],
    /// With the sign of the change of the gap: + on side *a*, - on side *b*.
    pub weights: [f32; 4],
    pub normal: [f32; 3],
    /// Gap less the desired distance.
    pub value: f32,
    /// 1 / sum of inverse weights times squared weights; 0 if nothing moves.
    pub inverse_diagonal: f32,
    pub multiplier: f32,
    /// The candidate of the row.
    pub candidate: u32,
    /// Its color in its bucket; [`COLORS`](crate::kernels::color_rows::COLORS) if there is none for it.
    pub color: u32,
    /// How far the contact has slipped since the start of the time step, across the normal.
    pub slip: [f32; 3],
    /// Coefficient of friction.
    pub coefficient: f32,
    /// Multiplier of friction, across the normal.
    pub friction: [f32; 3],
    /// Its bucket ([`crate::bricks`]).
    pub bucket: u32,
}

/// Rows that one workgroup sweeps ([`crate::bricks`]).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Bucket {
    /// Where they begin and end in the order of the rows.
    pub first: u32,
    pub end: u32,
    /// How many colors they have.
    pub colors: u32,
    /// Most rows without a color of one vertex.
    pub most: u32,
}

/// Successive edges that a workgroup sweeps in its own memory.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct EdgeCluster {
    /// Its vertices that move, in a list of those of all clusters.
    pub first_vertex: u32,
    pub vertices: u32,
    pub first_edge: u32,
    /// Its colors, in a list of those of all clusters.
    pub first_color: u32,
    pub colors: u32,
}

/// The largest length of an edge, in the order of the clusters and of their colors.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct EdgeLimit {
    pub a: u32,
    pub b: u32,
    /// In the present call [quanta].
    pub limit: f32,
    /// Places of a (lower half) and b in the list of vertices of the cluster; [`EdgeLimit::FIXED`] for a
    /// vertex that does not move.
    pub places: u32,
    /// Multiplier: the force that pulls a toward b, times -1 on a.
    pub multiplier: [f32; 3],
    /// By the scene [quanta].
    pub longest: f32,
}

impl EdgeLimit {
    /// The place of a vertex that does not move.
    pub const FIXED: u32 = 0xffff;
}

/// The candidates of a row before the present search.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct OldRow {
    pub first: u32,
    pub count: u32,
}

/// A half-space, the solid below a plane.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Plane {
    /// Unit normal, out of the solid.
    pub normal: [f32; 3],
    /// How far the computed height of a vertex may be off, relative to its distance from `point`.
    pub rounding: f32,
    /// A point of the plane.
    pub point: [i32; 3],
    pub padding: u32,
}

/// Friction between two sides that have a coefficient of their own: bodies, and behind them half-spaces.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct PairFriction {
    /// The lower number.
    pub a: u32,
    pub b: u32,
    /// Coefficient of friction.
    pub coefficient: f32,
}

/// Successive vertices of one body.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Block {
    pub first: u32,
    /// At most [`Block::MOST`].
    pub count: u32,
    pub body: u32,
}

impl Block {
    /// Most vertices of a block: the threads of a workgroup.
    pub const MOST: usize = 256;
}

/// Sums over the vertices of a block that move.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct BlockSum {
    /// Of the residuals, times the masses.
    pub residual: [f32; 3],
    pub mass: f32,
    /// Of the lengths of the residuals, times the masses.
    pub lengths: f32,
    pub padding: [u32; 3],
}

/// What the device reports and decides by itself.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Control {
    /// 1 if a trust region is new: the candidates must be searched for.
    pub changed: u32,
    /// 1 if a buffer was too small: nothing moves then.
    pub overflow: u32,
    /// Pairs that nothing certifies, and whose vertices wanted to move.
    pub frozen: u32,
    /// Bits of the largest remaining distance of a vertex that is not prescribed, of a prescribed one that no
    /// pair holds back, of any prescribed one, and of the longest move of any vertex and of one that is not
    /// prescribed. They are `f32` of at least 0, so their bits are ordered as they are.
    pub free_remaining: u32,
    pub unhindered_lag: u32,
    pub lag: u32,
    pub largest_move: u32,
    pub free_move: u32,
    /// Bits of the largest remaining distance of a vertex that no pair holds back, of the largest net
    /// residual of a body, of the largest mean residual, and of the largest ratio of an edge's length to its
    /// limit.
    pub unhindered: u32,
    pub net_residual: u32,
    pub mean_residual: u32,
    pub stretch_to_limit: u32,
    /// Contact rows that press; the last of the words that are reset.
    pub pressing: u32,
    /// Number of candidates: what their list should hold. It stays from step to step, for the list does.
    pub candidates: u32,
    /// Number of contact rows.
    pub rows: u32,
    /// 1 if the steps that a submission still has are not made: the call may end, or a buffer was too small,
    /// or the next step makes another number of sweeps; [`Control::HALTED_BY_SEARCH`],
    /// [`Control::HALTED_BY_ROWS`].
    pub halted: u32,
    /// Steps made by a submission.
    pub steps: u32,
    /// Bits of the mean residual after the last step of the call that met all other conditions of the rule
    /// ([`crate::Stop`]).
    pub last_mean_residual: u32,
    /// Steps that the call has made beyond the rule.
    pub finishing_steps: u32,
}

impl Control {
    #[cfg(test)]
    /// Words that a step begins with as zeros: all before the number of candidates.
    pub const RESET_WORDS: usize = 13;

    /// A buffer was too small for the search at the start of a call.
    pub const HALTED_BY_SEARCH: u32 = 2;

    /// There was no room for the contact rows of a step. Nothing of the step is done but its list of rows.
    pub const HALTED_BY_ROWS: u32 = 3;

    /// At the start of a call, without candidates: nothing is inherited from the call before.
    pub fn of_new_call() -> Self {
        Self { last_mean_residual: f32::MAX.to_bits(), ..Self::default() }
    }

    /// Bits of the largest remaining distance of any vertex.
    pub fn remaining(&self) -> u32 {
        self.free_remaining.max(self.lag)
    }
}
