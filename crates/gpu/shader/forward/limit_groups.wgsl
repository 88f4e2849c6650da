// Parts: types.
//
// The step size of each group: the smallest of its vertices.

struct Params {
    vertices: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(2) var<storage, read> alphas: array<u32>;
@group(0) @binding(3) var<storage, read_write> group_alphas: array<atomic<u32>>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var v = id.x; v < params.vertices; v += 256u * MOST_WORKGROUPS) {
        let group = vertices[v].group;
        if group != NONE {
            atomicMin(&group_alphas[group], alphas[v]);
        }
    }
}
