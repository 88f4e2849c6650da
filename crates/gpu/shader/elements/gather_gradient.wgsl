// Parts: terms.
//
// The gradient (R + K) d + c + sum of e' of the potential by each node: see potential/mod.rs. K multiplies
// differences of d, which are formed in integers: a body that moves as a whole does not feel it.

@group(0) @binding(0) var<uniform> params: NodeParams;
// Of each node: its first entry in `sources` and their end, its first entry in `pairs` and their end.
@group(0) @binding(1) var<storage, read> ranges: array<vec4<u32>>;
// Places in `gradients`.
@group(0) @binding(2) var<storage, read> sources: array<u32>;
@group(0) @binding(3) var<storage, read> gradients: array<f32>;
@group(0) @binding(4) var<storage, read> pairs: array<Pair>;
@group(0) @binding(5) var<storage, read> terms: array<Terms>;
@group(0) @binding(6) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(7) var<storage, read> start: array<vec4<i32>>;
@group(0) @binding(8) var<storage, read_write> gradient: array<vec4<f32>>;

struct NodeParams {
    nodes: u32,
    quantum: f32,
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < params.nodes; i += 64u * MOST_WORKGROUPS) {
        let range = ranges[i];
        let own = positions[i].xyz - start[i].xyz;
        var sum = row_sum_times(i, vec3<f32>(own) * params.quantum) + linear_term(i);
        for (var k = range.z; k < range.w; k += 1u) {
            let pair = pairs[k];
            let other = positions[pair.node].xyz - start[pair.node].xyz;
            sum += vec3<f32>(other - own) * (params.quantum * pair.value);
        }
        for (var k = range.x; k < range.y; k += 1u) {
            let at = 3u * sources[k];
            sum += vec3<f32>(gradients[at], gradients[at + 1u], gradients[at + 2u]);
        }
        gradient[i] = vec4<f32>(sum, 0.0);
    }
}
