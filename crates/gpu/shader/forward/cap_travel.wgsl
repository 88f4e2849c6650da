// Parts: types.
//
// How far each vertex may travel in this step, whatever its pairs: a share of its way to the target.

struct Params {
    vertices: u32,
    // Longest travel, in local edge lengths.
    longest: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> targets: array<vec4<i32>>;
@group(0) @binding(3) var<storage, read> vertices: array<Vertex>;
// Path, the displacement times the share, and the share.
@group(0) @binding(4) var<storage, read_write> paths: array<vec4<f32>>;
// Bits of the smallest share of each group.
@group(0) @binding(5) var<storage, read_write> group_caps: array<atomic<u32>>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var v = id.x; v < params.vertices; v += 256u * MOST_WORKGROUPS) {
        let vertex = vertices[v];
        let displacement = vec3<f32>(targets[v].xyz - positions[v].xyz);
        let length = sqrt(dot(displacement, displacement));
        let longest = params.longest * vertex.edge;
        var cap = 1.0;
        if length > longest {
            cap = longest / length;
        }
        paths[v] = vec4<f32>(displacement * cap, cap);
        if vertex.group != NONE {
            atomicMin(&group_caps[vertex.group], bitcast<u32>(cap));
        }
    }
}
