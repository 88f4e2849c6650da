// What the kernels of elements' gradients share: see potential/layout.rs. An element writes the gradient of
// its energy by each of its nodes. They sum to zero, since translations store no energy.

struct GradientParams {
    elements: u32,
    first: u32,
    rate: f32,
    quantum: f32,
}

@group(0) @binding(0) var<uniform> params: GradientParams;
@group(0) @binding(2) var<storage, read> positions: array<vec4<i32>>;
// At the start of the time step, for damping.
@group(0) @binding(3) var<storage, read> start: array<vec4<i32>>;
@group(0) @binding(4) var<storage, read_write> gradients: array<f32>;

fn way(a: u32, b: u32) -> vec3<f32> {
    return vec3<f32>(positions[b].xyz - positions[a].xyz) * params.quantum;
}

// How much the way from node a to node b has changed since the start of the time step.
fn moved(a: u32, b: u32) -> vec3<f32> {
    return vec3<f32>((positions[b].xyz - positions[a].xyz) - (start[b].xyz - start[a].xyz)) * params.quantum;
}

// Writes the gradient by a node; `entry` counts the nodes of the elements of this kind.
fn put(entry: u32, gradient: vec3<f32>) {
    let at = 3u * (params.first + entry);
    gradients[at] = gradient.x;
    gradients[at + 1u] = gradient.y;
    gradients[at + 2u] = gradient.z;
}
