// Parts: types.
//
// How far the vertices of each block are from where the forces on them balance: sums over the block, in a
// fixed order. The residual of a vertex is y0 + m^-1 J^T lambda - x = u mu / m + (aim - x), with the
// displacement u of the backward step, its proximal weight mu, and x after the step. A block holds vertices
// of one body. One workgroup per block.

struct Params {
    blocks: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> blocks: array<Block>;
@group(0) @binding(2) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(3) var<storage, read> aims: array<vec4<i32>>;
@group(0) @binding(4) var<storage, read> displacements: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(6) var<storage, read_write> sums: array<BlockSum>;

var<workgroup> shared_sums: array<BlockSum, 256>;

fn of_vertex(v: u32) -> BlockSum {
    let displacement = displacements[v];
    if displacement.w == 0.0 {
        return BlockSum(vec3<f32>(0.0), 0.0, 0.0, 0u, 0u, 0u);
    }
    let mass = vertices[v].mass;
    let share = max(1.0 / (displacement.w * mass) - 1.0, 0.0);
    let residual = displacement.xyz * share + vec3<f32>(aims[v].xyz - positions[v].xyz);
    return BlockSum(residual * mass, mass, mass * sqrt(dot(residual, residual)), 0u, 0u, 0u);
}

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let block = blocks[group.x];
    var sum = BlockSum(vec3<f32>(0.0), 0.0, 0.0, 0u, 0u, 0u);
    if local.x < block.count {
        sum = of_vertex(block.first + local.x);
    }
    shared_sums[local.x] = sum;
    for (var reach = 128u; reach > 0u; reach /= 2u) {
        workgroupBarrier();
        if local.x < reach {
            let other = shared_sums[local.x + reach];
            shared_sums[local.x].residual += other.residual;
            shared_sums[local.x].mass += other.mass;
            shared_sums[local.x].lengths += other.lengths;
        }
    }
    if local.x == 0u {
        sums[group.x] = shared_sums[0];
    }
}
