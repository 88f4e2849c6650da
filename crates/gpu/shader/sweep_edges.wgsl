// A sweep over the edges of the clusters of a round, which share no vertex that moves. A workgroup takes a cluster at a
// time, with the displacements of its vertices in its own memory, and waits between the colors of its edges: edges of
// one color share no vertex that moves. The ball |x_a - x_b + u_a - u_b| <= L is convex, so nothing is linearized: each
// edge is projected onto its own ball, with the multiplier that it had taken back first (Boyle and Dykstra 1986).
//
// Where a cluster has few colors with few edges each, as clusters of meshes do, a thread keeps its edges of all colors, so
// that the memory of the device is read before the first sweep and written after the last one. First all threads look whether
// any edge would change: where none is too long or pulls, as in most clusters of most bodies, a sweep changes nothing and is
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
// Colors of which a thread keeps its edges.
const KEPT: u32 = 12u;

// An edge with what its projection reads.
struct Edge {
    // x_a - x_b.
    between: vec3<f32>,
    limit: f32,
    multiplier: vec3<f32>,
    // EdgeLimit.places; all bits for no edge.
    places: u32,
}

const NO_EDGE: u32 = 0xffffffffu;

var<workgroup> moved: array<vec4<f32>, 256>;

var<private> kept: array<Edge, 12>;
// Of the edge that is projected, displacements of ends that have no place in the cluster.
var<private> outside: array<vec4<f32>, 2>;

// Whether an edge of the cluster pulls, as threads find and as all read it.
var<workgroup> pulling: atomic<u32>;
var<workgroup> is_pulling: u32;

fn read_edge(e: u32) -> Edge {
    let edge = limits[e];
    let between = vec3<f32>(positions[edge.a].xyz - positions[edge.b].xyz);
    return Edge(between, edge.limit, edge.multiplier, edge.places);
}

// Displacements of ends outside of the cluster, which do not move in the round.
fn read_outside(e: u32) {
    let edge = limits[e];
    if (edge.places & 0xffffu) == FIXED {
        outside[0] = displacements[edge.a];
    }
    if (edge.places >> 16u) == FIXED {
        outside[1] = displacements[edge.b];
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

// Whether an edge pulls, or would if it were projected.
fn pulls(edge: Edge) -> bool {
    let a = displacement(edge.places & 0xffffu, 0u);
    let b = displacement(edge.places >> 16u, 1u);
    if a.w + b.w <= 0.0 {
        return false;
    }
    let pulled = any(edge.multiplier != vec3<f32>(0.0));
    return pulled || (params.only_apply == 0u && any(projected(edge, a, b) != vec3<f32>(0.0)));
}

// Projects an edge; returns its multiplier.
fn relax(edge: Edge) -> vec3<f32> {
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

// The edge of a thread in a color that begins and ends there.
fn edge_of(first: u32, end: u32, thread: u32) -> u32 {
    return select(NO_EDGE, first + thread, first + thread < end);
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
            atomicStore(&pulling, 0u);
        }
        let keeps = cluster.colors <= KEPT;
        if keeps {
            var first = cluster.first_edge;
            for (var color = 0u; color < cluster.colors; color += 1u) {
                let end = color_ends[cluster.first_color + color];
                let e = edge_of(first, end, local.x);
                kept[color].places = NO_EDGE;
                if e != NO_EDGE {
                    kept[color] = read_edge(e);
                }
                first = end;
            }
        }
        workgroupBarrier();
        var first_edge = cluster.first_edge;
        for (var color = 0u; color < cluster.colors; color += 1u) {
            let end = color_ends[cluster.first_color + color];
            var e = edge_of(first_edge, end, local.x);
            while e < end {
                // Edges beyond those that threads keep are few, and read again.
                var edge = kept[min(color, KEPT - 1u)];
                if !keeps || e >= first_edge + THREADS {
                    edge = read_edge(e);
                }
                if (edge.places & 0xffffu) == FIXED || (edge.places >> 16u) == FIXED {
                    read_outside(e);
                }
                if pulls(edge) {
                    atomicStore(&pulling, 1u);
                }
                e += THREADS;
            }
            first_edge = end;
        }
        workgroupBarrier();
        if local.x == 0u {
            is_pulling = atomicLoad(&pulling);
        }
        if workgroupUniformLoad(&is_pulling) == 0u {
            continue;
        }
        for (var sweep = 0u; sweep < params.sweeps; sweep += 1u) {
            var first = cluster.first_edge;
            for (var color = 0u; color < cluster.colors; color += 1u) {
                let end = color_ends[cluster.first_color + color];
                var e = edge_of(first, end, local.x);
                if keeps && e != NO_EDGE {
                    let places = kept[color].places;
                    if (places & 0xffffu) == FIXED || (places >> 16u) == FIXED {
                        read_outside(e);
                    }
                    kept[color].multiplier = relax(kept[color]);
                    // A color has at most half as many edges as the cluster has vertices that move, unless they end outside.
                    e += THREADS;
                }
                while e < end {
                    read_outside(e);
                    let multiplier = relax(read_edge(e));
                    if params.only_apply == 0u {
                        limits[e].multiplier = multiplier;
                    }
                    e += THREADS;
                }
                first = end;
                workgroupBarrier();
            }
        }
        if keeps && params.only_apply == 0u {
            var first = cluster.first_edge;
            for (var color = 0u; color < cluster.colors; color += 1u) {
                let end = color_ends[cluster.first_color + color];
                let e = edge_of(first, end, local.x);
                if e != NO_EDGE {
                    limits[e].multiplier = kept[color].multiplier;
                }
                first = end;
            }
        }
        if local.x < cluster.vertices {
            displacements[cluster_vertices[v]] = moved[local.x];
        }
        workgroupBarrier();
    }
}
