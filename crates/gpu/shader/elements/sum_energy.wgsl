// Parts: parts.
//
// Sums the partial sums of energies: 64 of them to one, in a fixed order.

@group(0) @binding(1) var<storage, read> addends: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> parts: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let at = THREADS * group.x + local.x;
    var value = vec4<f32>(0.0);
    if at < params.count {
        value = addends[at];
    }
    put_part(group.x, local.x, value);
}
