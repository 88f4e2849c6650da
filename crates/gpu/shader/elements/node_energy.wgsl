// Parts: parts, terms.
//
// The quadratic terms of the potential: see potential/mod.rs. With d from the start to the reference and u
// from there to the trial, the energy of a node is d.((R + K) d / 2 + c) and its change u.((R + K)(d + u/2) +
// c). K multiplies differences of d and u, which are formed in integers.

@group(0) @binding(1) var<storage, read> ranges: array<vec4<u32>>;
@group(0) @binding(2) var<storage, read> pairs: array<Pair>;
@group(0) @binding(3) var<storage, read> terms: array<Terms>;
@group(0) @binding(4) var<storage, read> reference: array<vec4<i32>>;
@group(0) @binding(5) var<storage, read> trial: array<vec4<i32>>;
@group(0) @binding(6) var<storage, read> start: array<vec4<i32>>;
@group(0) @binding(7) var<storage, read_write> parts: array<vec4<f32>>;

// |R| times the sizes of a vector's components.
fn row_sum_size(i: u32, x: vec3<f32>) -> vec3<f32> {
    let r = terms[i].row_sum;
    let y = abs(x);
    return vec3<f32>(
        abs(r[0]) * y.x + abs(r[1]) * y.y + abs(r[2]) * y.z,
        abs(r[1]) * y.x + abs(r[3]) * y.y + abs(r[4]) * y.z,
        abs(r[2]) * y.x + abs(r[4]) * y.y + abs(r[5]) * y.z,
    );
}

fn energy(i: u32) -> vec4<f32> {
    let range = ranges[i];
    let own = reference[i].xyz - start[i].xyz;
    let own_step = trial[i].xyz - reference[i].xyz;
    let d = vec3<f32>(own) * params.quantum;
    let u = vec3<f32>(own_step) * params.quantum;
    var before = vec3<f32>(0.0);
    var between = vec3<f32>(0.0);
    var size = vec3<f32>(0.0);
    for (var k = range.z; k < range.w; k += 1u) {
        let pair = pairs[k];
        let at = reference[pair.node].xyz;
        let x = vec3<f32>(at - start[pair.node].xyz - own) * (params.quantum * pair.value);
        let y = vec3<f32>(trial[pair.node].xyz - at - own_step) * (params.quantum * pair.value);
        before += x;
        between += x + 0.5 * y;
        size += abs(x) + abs(y);
    }
    let c = linear_term(i);
    let middle = d + 0.5 * u;
    return part(vec3<f32>(
        dot(d, 0.5 * (row_sum_times(i, d) + before) + c),
        dot(u, row_sum_times(i, middle) + between + c),
        dot(abs(u), row_sum_size(i, abs(d) + abs(u)) + size + abs(c)),
    ));
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    var sum = vec4<f32>(0.0);
    for (var i = THREADS * group.x + local.x; i < params.count; i += THREADS * params.workgroups) {
        sum += energy(i);
    }
    put_part(group.x, local.x, sum);
}
