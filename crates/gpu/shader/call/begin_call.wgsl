// Parts: types.
//
// The start of a call: aims are the targets, no edge pulls, nothing has swung back or waited. An edge that is
// too long already may have nearly its length, and one that the target keeps within its limit may be a little
// longer. One thread per vertex and edge.

struct Params {
    vertices: u32,
    limits: u32,
    // 1: slip counts from the present positions.
    slips_from_here: u32,
    // Factor on the limits of edges that the target knows.
    guarded_stretch: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> targets: array<vec4<i32>>;
@group(0) @binding(3) var<storage, read_write> limits: array<EdgeLimit>;
@group(0) @binding(4) var<storage, read_write> aims: array<vec4<i32>>;
@group(0) @binding(5) var<storage, read_write> slip_start: array<vec4<i32>>;
@group(0) @binding(6) var<storage, read_write> swings: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> late: array<Late>;
@group(0) @binding(8) var<storage, read> vertices: array<Vertex>;

// Smallest ratio of an edge's limit to its length at the start: an edge that starts too long is shortened a
// little in each call.
const START_SHARE: f32 = 0.97;

const LARGEST: f32 = 3.40282347e38;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let stride = 256u * MOST_WORKGROUPS;
    for (var v = id.x; v < params.vertices; v += stride) {
        aims[v] = targets[v];
        if params.slips_from_here != 0u {
            slip_start[v] = positions[v];
        }
        // What pairs carry at the start damps nothing: it would hold what has moved on since.
        swings[v] = vec4<f32>(0.0);
        late[v] = Late(LARGEST, 0u);
    }
    for (var e = id.x; e < params.limits; e += stride) {
        let edge = limits[e];
        let along = vec3<f32>(positions[edge.a].xyz - positions[edge.b].xyz);
        let is_known = ((vertices[edge.a].flags | vertices[edge.b].flags) & KNOWN) != 0u;
        let factor = select(1.0, params.guarded_stretch, is_known);
        limits[e].limit = factor * max(edge.longest, START_SHARE * sqrt(dot(along, along)));
        limits[e].multiplier = vec3<f32>(0.0);
    }
}
