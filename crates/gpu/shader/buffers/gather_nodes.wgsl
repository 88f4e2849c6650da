// Copies entries of some nodes, one after the other.

struct Params {
    nodes: u32,
    // Words of an entry.
    width: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> nodes: array<u32>;
@group(0) @binding(2) var<storage, read> source: array<u32>;
@group(0) @binding(3) var<storage, read_write> copy: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var k = id.x; k < params.nodes; k += 64u * MOST_WORKGROUPS) {
        for (var word = 0u; word < params.width; word += 1u) {
            copy[params.width * k + word] = source[params.width * nodes[k] + word];
        }
    }
}
