// Parts: types.
//
// Subtracts from a row's target distance what its prescribed vertices lack. Where they end nearer than
// desired, the free vertices of their side would have to make up for it. With a closest point near a
// prescribed vertex they have a short lever, and would have to go far. It runs after
// unconstrained_minimum.wgsl, which says where prescribed vertices go.
//
// Rounding. The lever can be as short as rounding makes a weight that should be 0, and a row that is off by a
// part of a quantum then throws its free vertices. So a row asks for less by what rounding can do to it: with
// u = 2^-24 and the largest coordinate L of places and ways, the value, what is lacking and the sums of a
// sweep are each off by less than 4 u L.

struct Params {
    capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> displacements: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(4) var<storage, read> separations: array<Separation>;
@group(0) @binding(5) var<storage, read_write> rows: array<Row>;
@group(0) @binding(6) var<storage, read_write> control: Control;

// At least 12 u, and what the grid adds to it.
const ROUNDING: f32 = 9.5367431640625e-7;
const ON_GRID: f32 = 4.0;

// By how much the prescribed vertices from `first` to `end` of a side are nearer to the opposite point, in
// the direction `outward`, than the row asks for, times their weights; and rounding. 0 if the whole side is
// prescribed, or nothing of it.
fn lacking_of(
    first: u32, end: u32, opposite: vec3<f32>, outward: vec3<f32>, wanted: f32, rounding: f32,
    places: ptr<function, array<vec4<f32>, 4>>, weights: ptr<function, array<f32, 4>>
) -> f32 {
    var lacking = rounding;
    var any_free = false;
    var any_prescribed = false;
    for (var k = first; k < end; k += 1u) {
        let place = (*places)[k];
        if place.w != 0.0 {
            any_free = true;
            continue;
        }
        any_prescribed = true;
        lacking += abs((*weights)[k]) * max(wanted - dot(outward, place.xyz - opposite), 0.0);
    }
    return select(0.0, lacking, any_free && any_prescribed);
}

fn lower_target(r: u32) {
    let row = rows[r];
    let kind = candidates[row.candidate].kind_and_a >> ELEMENT_BITS;
    if kind == VERTEX_VERTEX || kind == VERTEX_HALF_SPACE {
        return;
    }
    let count = select(4u, 3u, kind == VERTEX_EDGE);
    let side_a = select(1u, 2u, kind == EDGE_EDGE);
    let wanted = separations[row.candidate].wanted;
    // Where free vertices are and prescribed ones go, from the first vertex of the row.
    let origin = positions[row.vertices.x].xyz;
    var places: array<vec4<f32>, 4>;
    var weights: array<f32, 4>;
    var means: array<vec3<f32>, 2>;
    var longest = 0.0;
    for (var k = 0u; k < count; k += 1u) {
        let v = row.vertices[k];
        let displacement = displacements[v];
        var place = vec3<f32>(positions[v].xyz - origin);
        let reach = max(abs(place), abs(displacement.xyz));
        longest = max(longest, max(max(reach.x, reach.y), reach.z));
        if displacement.w == 0.0 {
            place += displacement.xyz;
        }
        places[k] = vec4<f32>(place, displacement.w);
        weights[k] = row.weights[k];
        means[u32(k >= side_a)] += place * abs(row.weights[k]);
    }
    let rounding = ON_GRID + ROUNDING * longest;
    let of_a = lacking_of(0u, side_a, means[1], row.normal, wanted, rounding, &places, &weights);
    let of_b = lacking_of(side_a, count, means[0], -row.normal, wanted, rounding, &places, &weights);
    rows[r].value = row.value + (of_a + of_b);
}

@compute @workgroup_size(128)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.rows), params.capacity);
    for (var r = id.x; r < count; r += 128u * MOST_WORKGROUPS) {
        lower_target(r);
    }
}
