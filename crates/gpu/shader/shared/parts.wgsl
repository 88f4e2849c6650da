// Partial sums of energies: see potential/layout.rs. Every workgroup sums over its threads in a fixed order
// and writes one part: the energy at the reference, its change to the trial, and of the sizes of what the
// change is made of the sum and the sum of their squares.

struct EnergyParams {
    // Elements or nodes.
    count: u32,
    // The first part that is written.
    first: u32,
    workgroups: u32,
    rate: f32,
    quantum: f32,
}

@group(0) @binding(0) var<uniform> params: EnergyParams;

const THREADS: u32 = 64u;

var<workgroup> shared_parts: array<vec4<f32>, 64>;

// The part of one element or node.
fn part(energy: vec3<f32>) -> vec4<f32> {
    return vec4<f32>(energy, energy.z * energy.z);
}

fn put_part(group: u32, thread: u32, value: vec4<f32>) {
    shared_parts[thread] = value;
    for (var reach = THREADS / 2u; reach > 0u; reach /= 2u) {
        workgroupBarrier();
        if thread < reach {
            shared_parts[thread] += shared_parts[thread + reach];
        }
    }
    if thread == 0u {
        parts[params.first + group] = shared_parts[0];
    }
}
