// Parts: types.
//
// The displacements to the last aims, from where the vertices are now; an empty table of contacts.

struct Params {
    vertices: u32,
    // Size of the table.
    table: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> aims: array<vec4<i32>>;
@group(0) @binding(3) var<storage, read_write> displacements: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> table: array<u32>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var v = id.x; v < params.vertices; v += 256u * MOST_WORKGROUPS) {
        displacements[v] = vec4<f32>(vec3<f32>(aims[v].xyz - positions[v].xyz), 0.0);
    }
    for (var place = id.x; place < params.table; place += 256u * MOST_WORKGROUPS) {
        table[place] = NONE;
    }
}
