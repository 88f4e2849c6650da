// Parts: types, weights, pair.
//
// The candidates of the rows and their vertices, in the order of the candidates. A search renumbers the
// candidates, so rows keep their pairs as well.

struct Params {
    capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> edges: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read> triangles: array<vec4<u32>>;
// Where the row of each candidate is, if it has one: then that of the next comes after it.
@group(0) @binding(3) var<storage, read> starts: array<u32>;
@group(0) @binding(4) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(5) var<storage, read_write> rows: array<Row>;
@group(0) @binding(6) var<storage, read_write> pairs: array<Candidate>;
@group(0) @binding(7) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.candidates), params.capacity);
    for (var c = id.x; c < count; c += 256u * MOST_WORKGROUPS) {
        let place = starts[c];
        if starts[c + 1u] > place {
            let v = pair_of(candidates[c]).vertices;
            rows[place].vertices = vec4<u32>(v[0], v[1], v[2], v[3]);
            rows[place].candidate = c;
            pairs[place] = candidates[c];
        }
    }
}
