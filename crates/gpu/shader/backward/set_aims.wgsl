// Parts: types.
//
// Where each vertex goes in this step: the position and its displacement, on the grid. Without displacements
// that are bounded numbers it stays where it is.

struct Params {
    vertices: u32,
    // Largest factor on the proximal weight of a vertex.
    growth: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> targets: array<vec4<i32>>;
@group(0) @binding(3) var<storage, read> displacements: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> aims: array<vec4<i32>>;
// Last displacement, and the factor on the proximal weight. A displacement that reverses oscillates about the
// position: the weight is too small there.
@group(0) @binding(5) var<storage, read_write> swings: array<vec4<f32>>;

// Coordinates of the grid stay below this.
const BORDER: i32 = 536870911;
// Change of the factor each time that a displacement reverses, and each time that it does not.
const GROWTH: f32 = 2.0;
const DECAY: f32 = 0.8;
// A displacement of more than this is no result.
const FARTHEST: f32 = 1073741824.0;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var v = id.x; v < params.vertices; v += 256u * MOST_WORKGROUPS) {
        let displacement = displacements[v];
        let position = positions[v].xyz;
        var aim = position;
        if displacement.w == 0.0 {
            aim = targets[v].xyz;
        } else {
            // By bits, because a comparison with what is no number may be optimized away.
            let size = bitcast<vec3<u32>>(displacement.xyz) & vec3<u32>(0x7fffffffu);
            if all(size <= vec3<u32>(bitcast<u32>(FARTHEST))) {
                let near = clamp(position, vec3<i32>(-BORDER), vec3<i32>(BORDER));
                let moved = vec3<i32>(round(displacement.xyz));
                aim = clamp(near + moved, vec3<i32>(-BORDER), vec3<i32>(BORDER));
            }
        }
        aims[v] = vec4<i32>(aim, 0);
        let last = swings[v];
        let turn = dot(displacement.xyz, last.xyz);
        var factor = last.w;
        if turn < 0.0 {
            factor = min(factor * GROWTH, params.growth);
        } else if turn > 0.0 {
            factor = max(factor * DECAY, 1.0);
        }
        // 0 in the first step of a call (begin_call.wgsl).
        swings[v] = vec4<f32>(displacement.xyz, max(factor, 1.0));
    }
}
