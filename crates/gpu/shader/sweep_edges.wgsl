// A sweep over the edges of one color, which share no vertex that moves. The ball |x_a - x_b + u_a - u_b| <= L is convex,
// so nothing is linearized: each edge is projected onto its own ball, with the multiplier that it had taken back first
// (Boyle and Dykstra 1986).

struct Params {
    first: u32,
    end: u32,
    // 1: multipliers are only applied, they do not change.
    only_apply: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read_write> limits: array<EdgeLimit>;
@group(0) @binding(3) var<storage, read_write> displacements: array<vec4<f32>>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var e = params.first + id.x; e < params.end; e += 256u * MOST_WORKGROUPS) {
        let edge = limits[e];
        let old = edge.multiplier;
        var change = old;
        let a = displacements[edge.a];
        let b = displacements[edge.b];
        let total = a.w + b.w;
        if total <= 0.0 {
            continue;
        }
        if params.only_apply == 0u {
            let along = vec3<f32>(positions[edge.a].xyz - positions[edge.b].xyz) + a.xyz - b.xyz;
            let released = along + total * old;
            let length = sqrt(dot(released, released));
            var multiplier = vec3<f32>(0.0);
            if length > edge.limit {
                multiplier = released * ((length - edge.limit) / (length * total));
            }
            change = multiplier - old;
            limits[e].multiplier = multiplier;
        }
        if a.w > 0.0 {
            displacements[edge.a] = vec4<f32>(a.xyz - a.w * change, a.w);
        }
        if b.w > 0.0 {
            displacements[edge.b] = vec4<f32>(b.xyz + b.w * change, b.w);
        }
    }
}
