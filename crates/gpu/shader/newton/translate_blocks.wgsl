// Parts: free.
//
// Adds a translation per block to the step of its free nodes.

struct Params {
    nodes: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> blocks: array<u32>;
@group(0) @binding(2) var<storage, read> translations: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> free: array<u32>;
@group(0) @binding(4) var<storage, read_write> step: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < params.nodes; i += 64u * MOST_WORKGROUPS) {
        if is_free(i) {
            step[i] = vec4<f32>(step[i].xyz + translations[blocks[i]].xyz, 0.0);
        }
    }
}
