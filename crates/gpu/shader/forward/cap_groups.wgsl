// Parts: types.
//
// Gives all vertices of a group the smallest of their shares, and starts with step sizes that no pair limits.

struct Params {
    vertices: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(2) var<storage, read> group_caps: array<u32>;
@group(0) @binding(3) var<storage, read_write> paths: array<vec4<f32>>;
// Bits of the step size of each vertex.
@group(0) @binding(4) var<storage, read_write> alphas: array<u32>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var v = id.x; v < params.vertices; v += 256u * MOST_WORKGROUPS) {
        let group = vertices[v].group;
        var path = paths[v];
        if group != NONE {
            let cap = bitcast<f32>(group_caps[group]);
            if cap < path.w {
                path = vec4<f32>(path.xyz * (cap / path.w), cap);
                paths[v] = path;
            }
        }
        alphas[v] = bitcast<u32>(path.w);
    }
}
