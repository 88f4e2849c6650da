// Positions on a grid that is coarser by a power of two, with the same center.

struct Params {
    nodes: u32,
    // The power, from 1 to 20.
    shift: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> positions: array<vec4<i32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let half = vec3<i32>(i32(1u << (params.shift - 1u)));
    for (var i = id.x; i < params.nodes; i += 64u * MOST_WORKGROUPS) {
        positions[i] = vec4<i32>((positions[i].xyz + half) >> vec3<u32>(params.shift), 0);
    }
}
