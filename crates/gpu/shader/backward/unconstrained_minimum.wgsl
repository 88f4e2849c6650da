// Parts: types, fixed.
//
// The displacement of each vertex without any multiplier: the minimum of m |u - u0|^2 + mu |u|^2, with u0 the
// way to the target and mu the proximal weight, which is reset. Prescribed vertices have no inverse weight.
// They go all the way, but where one has got no nearer for some steps, rows and edges take it to stay where
// it is: something holds it back, and nothing could follow it. The forward step goes on to move it toward its
// target.

struct Params {
    vertices: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> targets: array<vec4<i32>>;
@group(0) @binding(3) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(4) var<storage, read_write> proximal: array<u32>;
// Displacement and inverse weight.
@group(0) @binding(5) var<storage, read_write> displacements: array<vec4<f32>>;
// Last displacement, and the factor on the proximal weight.
@group(0) @binding(6) var<storage, read> swings: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> late: array<Late>;

// Largest proximal weight, in the mass of the vertex.
const MOST_PROXIMAL: f32 = 100.0;
// Steps without progress after which a prescribed vertex is taken to stay: fewer than the 24 steps of a call
// that another Newton iteration follows.
const MOST_IDLE_STEPS: u32 = 6u;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var v = id.x; v < params.vertices; v += 256u * MOST_WORKGROUPS) {
        let vertex = vertices[v];
        let wanted = vec3<f32>(targets[v].xyz - positions[v].xyz);
        if (vertex.flags & PRESCRIBED) != 0u {
            displacements[v] = vec4<f32>(select(wanted, vec3<f32>(0.0), late[v].idle_steps >= MOST_IDLE_STEPS), 0.0);
        } else {
            let damping = min(f32(proximal[v]) / WEIGHT_UNITS * swings[v].w, MOST_PROXIMAL * vertex.mass);
            let weight = 1.0 / (vertex.mass + damping);
            displacements[v] = vec4<f32>(wanted * (weight * vertex.mass), weight);
        }
        proximal[v] = 0u;
    }
}
