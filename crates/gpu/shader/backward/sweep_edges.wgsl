// Parts: types.
//
// A sweep over the edges of the clusters of a round, which share no vertex that moves. A workgroup takes a
// cluster at a time, with the displacements of its vertices in its own memory, and waits between the colors
// of its edges: edges of one color share no vertex that moves. The ball |x_a - x_b + u_a - u_b| <= L is
// convex, so nothing is linearized: each edge is projected onto its own ball, with the multiplier that it had
// taken back first (Boyle and Dykstra 1986).
//
// Where a cluster has up to four edges per thread, as clusters of cloth do, each thread keeps its edges and
// their colors, so that the memory of the device is read before the first sweep and written after the last
// one. A thread has at most one edge of a color: no color has more edges than the cluster has vertices that
// move, and these are no more than threads. Each edge has a variable of its own, since an array that is
// indexed by a variable lies in the memory of the device.
//
// First all threads look whether any edge would change. Where none is too long or pulls, as in most clusters
// of most bodies, or where sweeps have come to their end in single precision, a sweep changes nothing and is
// left out.

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

const THREADS: u32 = 256u;
// Edges that a thread keeps.
const KEPT: u32 = 4u;

// An edge with what its projection reads.
struct Edge {
    // x_a - x_b.
    between: vec3<f32>,
    limit: f32,
    multiplier: vec3<f32>,
    // EdgeLimit.places.
    places: u32,
}

// The color of no edge.
const NO_COLOR: u32 = 0xffffffffu;

var<workgroup> moved: array<vec4<f32>, 256>;

// Of the edge that is projected, displacements of ends that have no place in the cluster.
var<private> outside: array<vec4<f32>, 2>;

// Whether an edge of the cluster would change, as threads find and as all read it.
var<workgroup> changes: atomic<u32>;
var<workgroup> is_changing: u32;

fn read_edge(e: u32) -> Edge {
    let edge = limits[e];
    let between = vec3<f32>(positions[edge.a].xyz - positions[edge.b].xyz);
    return Edge(between, edge.limit, edge.multiplier, edge.places);
}

// Displacements of ends outside of the cluster, which do not move in the round.
fn read_outside(e: u32, places: u32) {
    if (places & 0xffffu) == FIXED {
        outside[0] = displacements[limits[e].a];
    }
    if (places >> 16u) == FIXED {
        outside[1] = displacements[limits[e].b];
    }
}

// Displacement of the end at a place, the end `k` of the edge.
fn displacement(place: u32, k: u32) -> vec4<f32> {
    if place != FIXED {
        return moved[place];
    }
    return outside[k];
}

// The multiplier of an edge once it is projected, by the displacements of its ends.
fn projected(edge: Edge, a: vec4<f32>, b: vec4<f32>) -> vec3<f32> {
    let total = a.w + b.w;
    let along = edge.between + a.xyz - b.xyz;
    let released = along + total * edge.multiplier;
    let length = sqrt(dot(released, released));
    if length > edge.limit {
        return released * ((length - edge.limit) / (length * total));
    }
    return vec3<f32>(0.0);
}

// Whether an edge would change if it were projected, or moves something if its multiplier is applied.
fn would_change(e: u32, edge: Edge) -> bool {
    read_outside(e, edge.places);
    let a = displacement(edge.places & 0xffffu, 0u);
    let b = displacement(edge.places >> 16u, 1u);
    if a.w + b.w <= 0.0 {
        return false;
    }
    if params.only_apply != 0u {
        return any(edge.multiplier != vec3<f32>(0.0));
    }
    return any(projected(edge, a, b) != edge.multiplier);
}

// Projects an edge; returns its multiplier.
fn relax(e: u32, edge: Edge) -> vec3<f32> {
    read_outside(e, edge.places);
    let a_place = edge.places & 0xffffu;
    let b_place = edge.places >> 16u;
    let a = displacement(a_place, 0u);
    let b = displacement(b_place, 1u);
    if a.w + b.w <= 0.0 {
        return edge.multiplier;
    }
    var multiplier = edge.multiplier;
    var change = multiplier;
    if params.only_apply == 0u {
        multiplier = projected(edge, a, b);
        change = multiplier - edge.multiplier;
    }
    if a_place != FIXED {
        moved[a_place] = vec4<f32>(a.xyz - a.w * change, a.w);
    }
    if b_place != FIXED {
        moved[b_place] = vec4<f32>(b.xyz + b.w * change, b.w);
    }
    return multiplier;
}

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    for (var k = params.first + group.x; k < params.end; k += MOST_WORKGROUPS) {
        let cluster = clusters[k];
        let v = cluster.first_vertex + local.x;
        if local.x < cluster.vertices {
            moved[local.x] = displacements[cluster_vertices[v]];
        }
        if local.x == 0u {
            atomicStore(&changes, 0u);
        }
        // The edges of the thread, and their colors.
        let own = vec4<u32>(cluster.first_edge + local.x) + vec4<u32>(0u, 1u, 2u, 3u) * THREADS;
        var colors = vec4<u32>(NO_COLOR);
        var last = cluster.first_edge;
        for (var color = 0u; color < cluster.colors; color += 1u) {
            let end = color_ends[cluster.first_color + color];
            colors = select(colors, vec4<u32>(color), (own >= vec4<u32>(last)) & (own < vec4<u32>(end)));
            last = end;
        }
        let keeps = last - cluster.first_edge <= KEPT * THREADS;
        var first: Edge;
        var second: Edge;
        var third: Edge;
        var fourth: Edge;
        if keeps && own.x < last {
            first = read_edge(own.x);
        }
        if keeps && own.y < last {
            second = read_edge(own.y);
        }
        if keeps && own.z < last {
            third = read_edge(own.z);
        }
        if keeps && own.w < last {
            fourth = read_edge(own.w);
        }
        workgroupBarrier();
        var any_changes = false;
        if keeps {
            any_changes = own.x < last && would_change(own.x, first);
            any_changes = any_changes || (own.y < last && would_change(own.y, second));
            any_changes = any_changes || (own.z < last && would_change(own.z, third));
            any_changes = any_changes || (own.w < last && would_change(own.w, fourth));
        } else {
            for (var e = own.x; e < last && !any_changes; e += THREADS) {
                any_changes = would_change(e, read_edge(e));
            }
        }
        if any_changes {
            atomicStore(&changes, 1u);
        }
        workgroupBarrier();
        if local.x == 0u {
            is_changing = atomicLoad(&changes);
        }
        if workgroupUniformLoad(&is_changing) == 0u {
            continue;
        }
        for (var sweep = 0u; sweep < params.sweeps; sweep += 1u) {
            var start = cluster.first_edge;
            for (var color = 0u; color < cluster.colors; color += 1u) {
                if keeps {
                    let is_of = colors == vec4<u32>(color);
                    if any(is_of) {
                        var e = own.x;
                        var edge = first;
                        if is_of.y {
                            e = own.y;
                            edge = second;
                        }
                        if is_of.z {
                            e = own.z;
                            edge = third;
                        }
                        if is_of.w {
                            e = own.w;
                            edge = fourth;
                        }
                        let multiplier = relax(e, edge);
                        first.multiplier = select(first.multiplier, multiplier, is_of.x);
                        second.multiplier = select(second.multiplier, multiplier, is_of.y);
                        third.multiplier = select(third.multiplier, multiplier, is_of.z);
                        fourth.multiplier = select(fourth.multiplier, multiplier, is_of.w);
                    }
                } else {
                    let end = color_ends[cluster.first_color + color];
                    for (var e = start + local.x; e < end; e += THREADS) {
                        let multiplier = relax(e, read_edge(e));
                        if params.only_apply == 0u {
                            limits[e].multiplier = multiplier;
                        }
                    }
                    start = end;
                }
                workgroupBarrier();
            }
        }
        if keeps && params.only_apply == 0u {
            if own.x < last {
                limits[own.x].multiplier = first.multiplier;
            }
            if own.y < last {
                limits[own.y].multiplier = second.multiplier;
            }
            if own.z < last {
                limits[own.z].multiplier = third.multiplier;
            }
            if own.w < last {
                limits[own.w].multiplier = fourth.multiplier;
            }
        }
        if local.x < cluster.vertices {
            displacements[cluster_vertices[v]] = moved[local.x];
        }
        workgroupBarrier();
    }
}
