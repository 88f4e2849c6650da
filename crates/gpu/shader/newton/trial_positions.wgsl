// Parts: sum, largest, newton, free.
//
// A trial of the line search: the iterate plus a multiple of the step p, rounded to the grid; nodes that are
// not free are at their ends. By workgroup: p . b, the largest component of p [m], the largest squared
// distances of free nodes from the iterate and from the iterate at the start of the target, and the largest
// coordinate before it is clamped [quanta].

struct Params {
    nodes: u32,
    workgroups: u32,
    // 1: nodes that are not free move.
    imposed: u32,
    // The length over the quantum; at 0 the step does not count.
    scale: f32,
}

// Largest coordinate: differences of two, and of two differences, fit into 32 bits.
const REACH: i32 = 536870911;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> iterate: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> imposed: array<vec4<i32>>;
@group(0) @binding(3) var<storage, read> free: array<u32>;
@group(0) @binding(4) var<storage, read> step: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> right_side: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> target_start: array<vec4<i32>>;
@group(0) @binding(7) var<storage, read_write> trial: array<vec4<i32>>;
@group(0) @binding(8) var<storage, read_write> sums: array<f32>;

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let t = local.x;
    var product = 0.0;
    var largest = vec4<f32>(0.0);
    for (var i = THREADS * group.x + t; i < params.nodes; i += THREADS * params.workgroups) {
        let x = iterate[i].xyz;
        let p = step[i].xyz;
        product += dot(p, right_side[i].xyz);
        var y = x;
        if is_free(i) {
            if params.scale != 0.0 {
                let way = params.scale * p;
                largest.w = max(largest.w, largest_component(vec3<f32>(x) + way));
                let limit = vec3<f32>(2.0 * f32(REACH));
                y = clamp(x + vec3<i32>(round(clamp(way, -limit, limit))), vec3<i32>(-REACH), vec3<i32>(REACH));
            }
            largest.x = max(largest.x, largest_component(p));
            let moved = vec3<f32>(y - x);
            largest.y = max(largest.y, dot(moved, moved));
            let all = vec3<f32>(y - target_start[i].xyz);
            largest.z = max(largest.z, dot(all, all));
        } else if params.imposed == 1u {
            y = x + imposed[i].xyz;
        }
        trial[i] = vec4<i32>(y, 0);
    }
    let sum = sum_of_threads(t, product);
    if t == 0u {
        sums[8u * group.x] = sum;
    }
    for (var k = 0u; k < 4u; k += 1u) {
        let found = largest_of_threads(t, largest[k]);
        if t == 0u {
            sums[8u * group.x + 1u + k] = found;
        }
    }
}
