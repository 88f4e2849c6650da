// Parts: types.
//
// All multipliers times the factor of the coarse correction, and the displacements with them.

struct Params {
    capacity: u32,
    limits: u32,
    vertices: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> factor: array<f32>;
@group(0) @binding(2) var<storage, read_write> rows: array<Row>;
@group(0) @binding(3) var<storage, read_write> limits: array<EdgeLimit>;
@group(0) @binding(4) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(5) var<storage, read> targets: array<vec4<i32>>;
@group(0) @binding(6) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(7) var<storage, read_write> displacements: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let s = factor[0];
    let stride = 256u * MOST_WORKGROUPS;
    for (var r = id.x; r < min(atomicLoad(&control.rows), params.capacity); r += stride) {
        rows[r].multiplier *= s;
        rows[r].friction *= s;
    }
    for (var e = id.x; e < params.limits; e += stride) {
        limits[e].multiplier *= s;
    }
    for (var v = id.x; v < params.vertices; v += stride) {
        let displacement = displacements[v];
        if displacement.w > 0.0 {
            let wanted = vec3<f32>(targets[v].xyz - positions[v].xyz);
            let free = wanted * (displacement.w * vertices[v].mass);
            displacements[v] = vec4<f32>(free + s * (displacement.xyz - free), displacement.w);
        }
    }
}
