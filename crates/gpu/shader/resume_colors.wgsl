// Rows keep their colors from step to step: marks the colors in use at each vertex that moves, and lists the rows that
// have none.

struct Params {
    capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> rows: array<Row>;
@group(0) @binding(2) var<storage, read> displacements: array<vec4<f32>>;
// Colors in use, 128 bits per vertex.
@group(0) @binding(3) var<storage, read_write> in_use: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> waiting: array<u32>;
@group(0) @binding(5) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.rows), params.capacity);
    for (var r = id.x; r < count; r += 256u * MOST_WORKGROUPS) {
        let color = rows[r].color;
        if color == NONE {
            waiting[atomicAdd(&control.waiting, 1u)] = r;
        } else if color < COLORS {
            for (var k = 0u; k < 4u; k += 1u) {
                let v = rows[r].vertices[k];
                if displacements[v].w > 0.0 {
                    atomicOr(&in_use[4u * v + color / 32u], 1u << (color % 32u));
                }
            }
        }
    }
}
