// Parts: types.
//
// Sums for the coarse correction, by block, in a fixed order: over rows and edges of the product of
// multiplier and slack, and over vertices of |u - u'|^2 / w, with the displacement u, that without any
// multiplier u', and the inverse weight w. The sums are those of `CoarseCorrection` on the CPU
// (crates/twoway/src/coarse.rs). One workgroup per block; its threads go on with strides.

struct Params {
    blocks: u32,
    capacity: u32,
    limits: u32,
    vertices: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> rows: array<Row>;
@group(0) @binding(2) var<storage, read> limits: array<EdgeLimit>;
@group(0) @binding(3) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(4) var<storage, read> targets: array<vec4<i32>>;
@group(0) @binding(5) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(6) var<storage, read> displacements: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> control: Control;
@group(0) @binding(8) var<storage, read_write> sums: array<vec2<f32>>;

// Share of the largest friction from which on a contact slides.
const SLIDES: f32 = 0.999999;

var<workgroup> shared_sums: array<vec2<f32>, 256>;

// A sticking contact is the equation slip = 0; a sliding one is solved by any slip opposite to its multiplier
// and does not count.
fn of_row(r: u32) -> f32 {
    let row = rows[r];
    if row.multiplier <= 0.0 {
        return 0.0;
    }
    var relative = vec3<f32>(0.0);
    for (var k = 0u; k < 4u; k += 1u) {
        relative += row.weights[k] * displacements[row.vertices[k]].xyz;
    }
    var slack = row.multiplier * (row.value + dot(row.normal, relative));
    let friction = sqrt(dot(row.friction, row.friction));
    if friction > 0.0 && friction < SLIDES * row.coefficient * row.multiplier {
        slack += dot(row.friction, row.slip + relative);
    }
    return slack;
}

fn of_limit(e: u32) -> f32 {
    let edge = limits[e];
    let along = vec3<f32>(positions[edge.a].xyz - positions[edge.b].xyz) + displacements[edge.a].xyz
        - displacements[edge.b].xyz;
    let f = edge.multiplier;
    return edge.limit * sqrt(dot(f, f)) - dot(f, along);
}

fn of_vertex(v: u32) -> f32 {
    let displacement = displacements[v];
    if displacement.w == 0.0 {
        return 0.0;
    }
    let wanted = vec3<f32>(targets[v].xyz - positions[v].xyz);
    let moved = displacement.xyz - wanted * (displacement.w * vertices[v].mass);
    return dot(moved, moved) / displacement.w;
}

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let row_count = min(atomicLoad(&control.rows), params.capacity);
    let stride = 256u * params.blocks;
    let first = 256u * group.x + local.x;
    var sum = vec2<f32>(0.0);
    for (var r = first; r < row_count; r += stride) {
        sum.x += of_row(r);
    }
    for (var e = first; e < params.limits; e += stride) {
        sum.x += of_limit(e);
    }
    for (var v = first; v < params.vertices; v += stride) {
        sum.y += of_vertex(v);
    }
    shared_sums[local.x] = sum;
    for (var reach = 128u; reach > 0u; reach /= 2u) {
        workgroupBarrier();
        if local.x < reach {
            shared_sums[local.x] += shared_sums[local.x + reach];
        }
    }
    if local.x == 0u {
        sums[group.x] = shared_sums[0];
    }
}
