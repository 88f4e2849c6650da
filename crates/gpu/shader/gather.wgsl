// Third part of the list of candidates: copies the partners of each row to their places.

struct Params {
    rows: u32,
    stride: u32,
    most: u32,
    capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> partners: array<u32>;
@group(0) @binding(2) var<storage, read> starts: array<u32>;
@group(0) @binding(3) var<storage, read> blocks: array<u32>;
@group(0) @binding(4) var<storage, read_write> candidates: array<Candidate>;
@group(0) @binding(5) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if atomicLoad(&control.changed) == 0u {
        return;
    }
    for (var row = id.x; row < params.rows; row += 256u * MOST_WORKGROUPS) {
        let words = row * params.stride;
        let count = min(partners[words], params.most);
        let first = blocks[row / 256u] + starts[row];
        for (var k = 0u; k < count && first + k < params.capacity; k += 1u) {
            candidates[first + k] = Candidate(partners[words + 1u], partners[words + 2u + k]);
        }
    }
}
