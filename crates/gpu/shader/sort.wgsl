// Sorts the rows by color. Their order within a color does not matter, for they share no vertex that moves; rows without a
// color of their own, of which there are few, keep the order that they have.

struct Params {
    capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> rows: array<Row>;
// Where each color starts at first, where it ends at last.
@group(0) @binding(2) var<storage, read_write> ends: array<atomic<u32>>;
@group(0) @binding(3) var<storage, read_write> order: array<u32>;
@group(0) @binding(4) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.rows), params.capacity);
    for (var r = id.x; r < count; r += 256u * MOST_WORKGROUPS) {
        let color = rows[r].color;
        if color < COLORS {
            order[atomicAdd(&ends[color], 1u)] = r;
        } else {
            var after = 0u;
            for (var other = r + 1u; other < count; other += 1u) {
                after += u32(rows[other].color == COLORS);
            }
            order[count - 1u - after] = r;
            atomicAdd(&ends[COLORS], 1u);
        }
    }
}
