// Parts: types, weights, pair.
//
// Which candidates may be within contact range at the present positions: those whose sides no slab holds
// farther apart than both margins. The width of a slab is certified, below the distance, whatever its
// direction (separate.wgsl), so every pair that is within range is among them, and some that are not.

struct Params {
    capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> edges: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read> triangles: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(4) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(5) var<storage, read> separations: array<Separation>;
// 1 for a candidate that may be within range.
@group(0) @binding(6) var<storage, read_write> starts: array<u32>;
@group(0) @binding(7) var<storage, read_write> control: Control;

// More than the rounding of a sum of margins, which are rounded up themselves.
const LARGER: f32 = 1.000001;

fn is_near(c: u32) -> bool {
    let pair = pair_of(candidates[c]);
    // A half-space has no margin: that of the vertex counts twice.
    var other = pair.vertices[0];
    if pair.kind != VERTEX_HALF_SPACE {
        other = pair.vertices[pair.side_a];
    }
    let range = vertices[pair.vertices[0]].margin + vertices[other].margin;
    return separations[c].width <= LARGER * range;
}

@compute @workgroup_size(128)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.candidates), params.capacity);
    for (var c = id.x; c < count; c += 128u * MOST_WORKGROUPS) {
        starts[c] = u32(is_near(c));
    }
}
