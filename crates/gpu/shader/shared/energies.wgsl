// What the kernels of elements' energies share.

@group(0) @binding(2) var<storage, read> reference: array<vec4<i32>>;
@group(0) @binding(3) var<storage, read> trial: array<vec4<i32>>;
// At the start of the time step, for damping.
@group(0) @binding(4) var<storage, read> start: array<vec4<i32>>;
@group(0) @binding(5) var<storage, read_write> parts: array<vec4<f32>>;

fn way(a: u32, b: u32) -> vec3<f32> {
    return vec3<f32>(reference[b].xyz - reference[a].xyz) * params.quantum;
}

// How much the way from node a to node b has changed since the start of the time step.
fn moved(a: u32, b: u32) -> vec3<f32> {
    return vec3<f32>((reference[b].xyz - reference[a].xyz) - (start[b].xyz - start[a].xyz)) * params.quantum;
}

// How much it changes from the reference to the trial.
fn change(a: u32, b: u32) -> vec3<f32> {
    return vec3<f32>((trial[b].xyz - trial[a].xyz) - (reference[b].xyz - reference[a].xyz)) * params.quantum;
}
