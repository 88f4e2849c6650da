// Parts: types.
//
// Divides the rows by bricks of space (bricks.rs): the bucket of each row, how many rows each bucket has, and
// the diagonal of each row for the step that solves it.

struct Params {
    capacity: u32,
    // Binary logarithm of the side of a brick.
    shift: u32,
    // Buckets of a lattice, a power of two; 0: all rows are in one bucket.
    buckets: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> displacements: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> rows: array<Row>;
// Number of rows of each bucket.
@group(0) @binding(4) var<storage, read_write> tally: array<atomic<u32>>;
@group(0) @binding(5) var<storage, read_write> control: Control;

const LATTICES: u32 = 4u;

// Of integer coordinates, by three large primes (Teschner et al. 2003).
fn hash(cell: vec3<i32>) -> u32 {
    let c = bitcast<vec3<u32>>(cell);
    return (c.x * 73856093u) ^ (c.y * 19349663u) ^ (c.z * 83492791u);
}

fn bucket_of(row: Row) -> u32 {
    var low = vec3<i32>(0x7fffffff);
    var high = vec3<i32>(-0x7fffffff);
    for (var k = 0u; k < 4u; k += 1u) {
        let v = row.vertices[k];
        if displacements[v].w > 0.0 {
            low = min(low, positions[v].xyz);
            high = max(high, positions[v].xyz);
        }
    }
    // Nothing moves: any bucket will do.
    if low.x > high.x {
        return 0u;
    }
    if params.buckets > 0u {
        for (var lattice = 0u; lattice < LATTICES; lattice += 1u) {
            let offset = vec3<i32>(i32(lattice << (params.shift - 2u)));
            let cell = (low + offset) >> vec3<u32>(params.shift);
            if all(cell == ((high + offset) >> vec3<u32>(params.shift))) {
                return lattice * params.buckets + (hash(cell) & (params.buckets - 1u));
            }
        }
    }
    return LATTICES * params.buckets;
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.rows), params.capacity);
    for (var r = id.x; r < count; r += 256u * MOST_WORKGROUPS) {
        let row = rows[r];
        var diagonal = 0.0;
        for (var k = 0u; k < 4u; k += 1u) {
            diagonal += displacements[row.vertices[k]].w * row.weights[k] * row.weights[k];
        }
        let bucket = bucket_of(row);
        rows[r].inverse_diagonal = select(0.0, 1.0 / diagonal, diagonal > 0.0);
        rows[r].bucket = bucket;
        atomicAdd(&tally[bucket], 1u);
    }
}
