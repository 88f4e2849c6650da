// A sweep over the edges of the clusters of a round, which share no vertex that moves. A workgroup takes a cluster at a
// time, with the displacements of its vertices in its own memory, and waits between the colors of its edges: edges of
// one color share no vertex that moves. The ball |x_a - x_b + u_a - u_b| <= L is convex, so nothing is linearized: each
// edge is projected onto its own ball, with the multiplier that it had taken back first (Boyle and Dykstra 1986).

struct Params {
    // Clusters of the round.
    first: u32,
    end: u32,
    // 1: multipliers are only applied, they do not change.
    only_apply: u32,
    // Sweeps over each cluster.
    sweeps: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> clusters: array<EdgeCluster>;
@group(0) @binding(3) var<storage, read> cluster_vertices: array<u32>;
// Where each color ends among the edges.
@group(0) @binding(4) var<storage, read> color_ends: array<u32>;
@group(0) @binding(5) var<storage, read_write> limits: array<EdgeLimit>;
@group(0) @binding(6) var<storage, read_write> displacements: array<vec4<f32>>;

var<workgroup> moved: array<vec4<f32>, 256>;

fn displacement(place: u32, v: u32) -> vec4<f32> {
    if place == FIXED {
        return displacements[v];
    }
    return moved[place];
}

fn relax(e: u32) {
    let edge = limits[e];
    let old = edge.multiplier;
    var change = old;
    let a_place = edge.places & 0xffffu;
    let b_place = edge.places >> 16u;
    let a = displacement(a_place, edge.a);
    let b = displacement(b_place, edge.b);
    let total = a.w + b.w;
    if total <= 0.0 {
        return;
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
    if a_place != FIXED {
        moved[a_place] = vec4<f32>(a.xyz - a.w * change, a.w);
    }
    if b_place != FIXED {
        moved[b_place] = vec4<f32>(b.xyz + b.w * change, b.w);
    }
}

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    for (var k = params.first + group.x; k < params.end; k += MOST_WORKGROUPS) {
        let cluster = clusters[k];
        let v = cluster.first_vertex + local.x;
        if local.x < cluster.vertices {
            moved[local.x] = displacements[cluster_vertices[v]];
        }
        workgroupBarrier();
        for (var sweep = 0u; sweep < params.sweeps; sweep += 1u) {
            var first = cluster.first_edge;
            for (var color = 0u; color < cluster.colors; color += 1u) {
                let end = color_ends[cluster.first_color + color];
                for (var e = first + local.x; e < end; e += 256u) {
                    relax(e);
                }
                first = end;
                workgroupBarrier();
            }
        }
        if local.x < cluster.vertices {
            displacements[cluster_vertices[v]] = moved[local.x];
        }
        workgroupBarrier();
    }
}
