// Parts: types, closest, weights, pair.
//
// Contact geometry of the candidates: a direction and a slab that certainly lies between both sides.
//
// For a unit vector n, min over side a of n.x - max over side b of n.x is at most the distance of the sides.
// Let u = 2^-24 and m the largest coordinate of the differences x_a - x_b. Differences of grid points are
// exact as integers and rounded once as f32; a dot product of three terms adds 3 u: an error of 4.01 u
// sqrt(3) m. WGSL allows sqrt 5 ulp and a quotient 2.5 ulp, so | |n| - 1 | <= 18 u, which moves the width by
// 18 u sqrt(3) m. Together that is less than 41 u m; 64 u m are subtracted. Additions in another order, or
// fused, have smaller or equal bounds.

struct Params {
    // Candidates that the list holds.
    capacity: u32,
    // 1: nothing is to be done unless a search has changed the candidates.
    after_search: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> edges: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read> triangles: array<vec4<u32>>;
@group(0) @binding(4) var<storage, read> planes: array<Plane>;
@group(0) @binding(5) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(6) var<storage, read_write> separations: array<Separation>;
@group(0) @binding(7) var<storage, read_write> control: Control;

// 64 u.
const WIDTH_ROUNDING: f32 = 3.814697265625e-6;
// If the width is below this part of the distance, another direction is tried.
const MIN_WIDTH_RATIO: f32 = 0.9;
// The point of a plane is rounded to the grid, by less than this.
const POINT_ROUNDING: f32 = 1.0;

fn size(v: vec3<f32>) -> f32 {
    return max(max(abs(v.x), abs(v.y)), abs(v.z));
}

// The differences of all vertices of side a and all of side b.
struct Differences {
    d: array<vec3<f32>, 4>,
    count: u32,
    slack: f32,
}

fn width_along(n: vec3<f32>, differences: Differences) -> f32 {
    var width = dot(n, differences.d[0]);
    for (var k = 1u; k < differences.count; k += 1u) {
        width = min(width, dot(n, differences.d[k]));
    }
    return width - differences.slack;
}

// Edges whose ends lie on different points of the grid are at least 1 long.
fn sine_between(a: vec3<f32>, b: vec3<f32>) -> f32 {
    let product = cross(a / max(sqrt(dot(a, a)), 1.0), b / max(sqrt(dot(b, b)), 1.0));
    return sqrt(dot(product, product));
}

fn separate_plane(v: u32, p: u32) -> Separation {
    let plane = planes[p];
    let offset = vec3<f32>(positions[v].xyz - plane.point);
    let height = dot(plane.normal, offset);
    return Separation(plane.normal, height - plane.rounding * size(offset) - POINT_ROUNDING, vec2<f32>(0.0), height, 0.0, 0.0, 0.0, 0u, 0u);
}

fn separate_pair(candidate: Candidate) -> Separation {
    let pair = pair_of(candidate);
    if pair.kind == VERTEX_HALF_SPACE {
        return separate_plane(pair.vertices[0], candidate.b);
    }
    var differences: Differences;
    var closest: Closest;
    // A direction that no cancellation disturbs: the normal of a face or of two edges.
    var other = vec3<f32>(0.0);
    var sine = 0.0;
    let p = positions[pair.vertices[0]].xyz;
    let q = positions[pair.vertices[1]].xyz;
    if pair.kind == EDGE_EDGE {
        let b0 = positions[pair.vertices[2]].xyz;
        let b1 = positions[pair.vertices[3]].xyz;
        differences.d[0] = vec3<f32>(p - b0);
        differences.d[1] = vec3<f32>(p - b1);
        differences.d[2] = vec3<f32>(q - b0);
        differences.d[3] = vec3<f32>(q - b1);
        differences.count = 4u;
        let along = vec3<f32>(q - p);
        closest = closest_edge_edge(along, -differences.d[0], -differences.d[1]);
        let across = vec3<f32>(b1 - b0);
        other = cross(along, across);
        sine = sine_between(along, across);
    } else {
        differences.d[0] = vec3<f32>(p - q);
        differences.count = 1u;
        closest = Closest(differences.d[0], vec3<f32>(1.0, 0.0, 0.0));
        if pair.kind != VERTEX_VERTEX {
            let r = positions[pair.vertices[2]].xyz;
            differences.d[1] = vec3<f32>(p - r);
            differences.count = 2u;
            if pair.kind == VERTEX_EDGE {
                closest = closest_vertex_edge(-differences.d[0], -differences.d[1]);
            } else {
                let s = positions[pair.vertices[3]].xyz;
                differences.d[2] = vec3<f32>(p - s);
                differences.count = 3u;
                closest = closest_vertex_triangle(-differences.d[0], -differences.d[1], -differences.d[2]);
                other = cross(vec3<f32>(r - q), vec3<f32>(s - q));
            }
        }
    }
    var largest = 0.0;
    for (var k = 0u; k < differences.count; k += 1u) {
        largest = max(largest, size(differences.d[k]));
    }
    differences.slack = WIDTH_ROUNDING * largest;

    let distance = sqrt(dot(closest.offset, closest.offset));
    var weights = closest.weights.yz;
    if pair.kind == EDGE_EDGE {
        weights = closest.weights.xz;
    }
    var separation = Separation(vec3<f32>(0.0, 0.0, 1.0), -1.0, weights, distance, 0.0, 0.0, sine, 0u, 0u);
    if distance > 0.0 {
        separation.normal = closest.offset / distance;
        separation.width = width_along(separation.normal, differences);
    }
    if separation.width < MIN_WIDTH_RATIO * distance || distance <= 0.0 {
        // Scaled first, so that its square is a number.
        let scale = size(other);
        if scale > 0.0 {
            other = other / scale;
            other = other / sqrt(dot(other, other));
            let above = width_along(other, differences);
            let below = width_along(-other, differences);
            if above > separation.width {
                separation.normal = other;
                separation.width = above;
            }
            if below > separation.width {
                separation.normal = -other;
                separation.width = below;
            }
        }
    }
    return separation;
}

@compute @workgroup_size(128)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if params.after_search != 0u && atomicLoad(&control.changed) == 0u {
        return;
    }
    let count = min(atomicLoad(&control.candidates), params.capacity);
    for (var c = id.x; c < count; c += 128u * MOST_WORKGROUPS) {
        separations[c] = separate_pair(candidates[c]);
    }
}
