// The candidates of the rows, in the order of the candidates. Places that no row takes have none. A search renumbers
// the candidates, so rows keep their pairs as well.

struct Params {
    // Candidates and rows for which there is room.
    capacity: u32,
    row_capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
// Where the row of each candidate is, if it has one: then that of the next comes after it.
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(2) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(3) var<storage, read_write> rows: array<Row>;
@group(0) @binding(4) var<storage, read_write> pairs: array<Candidate>;
@group(0) @binding(5) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = atomicLoad(&control.rows);
    for (var c = id.x; c < max(params.capacity, params.row_capacity); c += 256u * MOST_WORKGROUPS) {
        if c < params.capacity && starts[c + 1u] > starts[c] {
            let place = starts[c];
            rows[place].candidate = c;
            pairs[place] = candidates[c];
        }
        if c >= count && c < params.row_capacity {
            rows[c].candidate = NONE;
        }
    }
}
