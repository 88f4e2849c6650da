// Parts: types, fixed.
//
// Adds the curvature of edges with a multiplier, |f| / |e|, to the proximal weights of their vertices.

struct Params {
    edges: u32,
    // Part of the curvature that counts.
    strength: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> limits: array<EdgeLimit>;
@group(0) @binding(3) var<storage, read_write> proximal: array<atomic<u32>>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var e = id.x; e < params.edges; e += 256u * MOST_WORKGROUPS) {
        let edge = limits[e];
        let pull = sqrt(dot(edge.multiplier, edge.multiplier));
        if pull > 0.0 {
            let along = vec3<f32>(positions[edge.a].xyz - positions[edge.b].xyz);
            let length = max(sqrt(dot(along, along)), 1.0);
            let units = weight_units(params.strength * pull / length);
            atomicAdd(&proximal[edge.a], units);
            atomicAdd(&proximal[edge.b], units);
        }
    }
}
