// How many rows each color has, and the diagonal of each row, for the step that solves it.

struct Params {
    capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> displacements: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> rows: array<Row>;
// Number of rows of each color, then of those without one.
@group(0) @binding(3) var<storage, read_write> tally: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.rows), params.capacity);
    for (var r = id.x; r < count; r += 256u * MOST_WORKGROUPS) {
        var diagonal = 0.0;
        for (var k = 0u; k < 4u; k += 1u) {
            let weight = rows[r].weights[k];
            diagonal += displacements[rows[r].vertices[k]].w * weight * weight;
        }
        rows[r].inverse_diagonal = select(0.0, 1.0 / diagonal, diagonal > 0.0);
        atomicAdd(&tally[rows[r].color], 1u);
    }
}
