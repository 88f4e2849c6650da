// What the kernels of Hessians share. An element writes the blocks that couple two of its nodes; those of one
// node follow, since translations store no energy.

struct ElementParams {
    elements: u32,
    first_block: u32,
    absolute: u32,
    rate: f32,
    quantum: f32,
}

@group(0) @binding(0) var<uniform> params: ElementParams;
@group(0) @binding(2) var<storage, read> positions: array<vec4<i32>>;
// At the start of the time step, for damping.
@group(0) @binding(3) var<storage, read> start: array<vec4<i32>>;
@group(0) @binding(4) var<storage, read_write> blocks: array<f32>;

fn way(a: u32, b: u32) -> vec3<f32> {
    return vec3<f32>(positions[b].xyz - positions[a].xyz) * params.quantum;
}

// How much the way from node a to node b has changed since the start of the time step.
fn moved(a: u32, b: u32) -> vec3<f32> {
    return vec3<f32>((positions[b].xyz - positions[a].xyz) - (start[b].xyz - start[a].xyz)) * params.quantum;
}

fn filtered(curvature: f32) -> f32 {
    return select(max(curvature, 0.0), abs(curvature), params.absolute == 1u);
}

// Writes a block, given by its columns.
fn put(block: u32, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) {
    let at = 9u * (params.first_block + block);
    for (var k = 0u; k < 3u; k += 1u) {
        blocks[at + k] = a[k];
        blocks[at + 3u + k] = b[k];
        blocks[at + 6u + k] = c[k];
    }
}
