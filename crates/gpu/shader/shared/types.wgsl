// The data that all stages share: see layout.rs. Lengths are in quanta of the grid.

const NONE: u32 = 0xffffffffu;

struct Vertex {
    edge: f32,
    margin: f32,
    body: u32,
    flags: u32,
    groups: u32,
    mask: u32,
    group: u32,
    delta: f32,
    half_space_delta: f32,
    thickness: f32,
    mass: f32,
    root_of_friction: f32,
}

const OBSTACLE: u32 = 1u;
const PRESCRIBED: u32 = 2u;
const SELF_COLLIDES: u32 = 4u;
const KNOWN: u32 = 8u;

struct Ball {
    center: vec3<i32>,
    radius: i32,
}

struct Late {
    smallest: f32,
    idle_steps: u32,
}

struct Slot {
    v0: u32,
    v1: u32,
    v2: u32,
    element: u32,
}

struct NodeBox {
    low: vec3<i32>,
    deformable: u32,
    high: vec3<i32>,
    padding: u32,
}

struct Candidate {
    kind_and_a: u32,
    b: u32,
}

const ELEMENT_BITS: u32 = 29u;
const ELEMENT_MASK: u32 = 0x1fffffffu;

const VERTEX_VERTEX: u32 = 0u;
const VERTEX_EDGE: u32 = 1u;
const VERTEX_TRIANGLE: u32 = 2u;
const EDGE_EDGE: u32 = 3u;
const VERTEX_HALF_SPACE: u32 = 4u;

struct Separation {
    normal: vec3<f32>,
    width: f32,
    weights: vec2<f32>,
    distance: f32,
    min_separation: f32,
    wanted: f32,
    sine: f32,
    padding_0: u32,
    padding_1: u32,
}

struct PairState {
    friction: vec3<f32>,
    multiplier: f32,
    desired: f32,
    min_separation: f32,
    range: f32,
    // 1: the pair was out of range in the last step.
    is_far: u32,
}

struct CarriedState {
    friction: vec3<f32>,
    multiplier: f32,
    candidate: Candidate,
    padding_0: u32,
    padding_1: u32,
}

struct Row {
    vertices: vec4<u32>,
    weights: vec4<f32>,
    normal: vec3<f32>,
    value: f32,
    inverse_diagonal: f32,
    multiplier: f32,
    candidate: u32,
    color: u32,
    slip: vec3<f32>,
    coefficient: f32,
    friction: vec3<f32>,
    bucket: u32,
}

// Colors of rows; rows that get none of them are swept at once, and share the masses of their vertices.
const COLORS: u32 = 128u;

struct Bucket {
    first: u32,
    end: u32,
    colors: u32,
    // Most rows without a color of one vertex.
    most: u32,
}

struct EdgeCluster {
    first_vertex: u32,
    vertices: u32,
    first_edge: u32,
    first_color: u32,
    colors: u32,
}

const FIXED: u32 = 0xffffu;

struct EdgeLimit {
    a: u32,
    b: u32,
    limit: f32,
    places: u32,
    multiplier: vec3<f32>,
    longest: f32,
}

struct OldRow {
    first: u32,
    count: u32,
}

struct Plane {
    normal: vec3<f32>,
    rounding: f32,
    point: vec3<i32>,
    padding: u32,
}

struct PairFriction {
    a: u32,
    b: u32,
    coefficient: f32,
}

struct Block {
    first: u32,
    count: u32,
    body: u32,
}

struct BlockSum {
    residual: vec3<f32>,
    mass: f32,
    lengths: f32,
    padding_0: u32,
    padding_1: u32,
    padding_2: u32,
}

struct Control {
    changed: atomic<u32>,
    overflow: atomic<u32>,
    frozen: atomic<u32>,
    free_remaining: atomic<u32>,
    unhindered_lag: atomic<u32>,
    lag: atomic<u32>,
    largest_move: atomic<u32>,
    free_move: atomic<u32>,
    unhindered: atomic<u32>,
    net_residual: atomic<u32>,
    mean_residual: atomic<u32>,
    stretch_to_limit: atomic<u32>,
    pressing: atomic<u32>,
    candidates: atomic<u32>,
    rows: atomic<u32>,
    halted: atomic<u32>,
    steps: atomic<u32>,
    last_mean_residual: atomic<u32>,
    finishing_steps: atomic<u32>,
}

// Whether two elements, given by one vertex of each, may form a pair.
fn may_collide(a: Vertex, b: Vertex) -> bool {
    if (a.flags & b.flags & OBSTACLE) != 0u {
        return false;
    }
    if a.body == b.body {
        return (a.flags & SELF_COLLIDES) != 0u;
    }
    return (a.groups & b.mask) != 0u && (b.groups & a.mask) != 0u;
}
