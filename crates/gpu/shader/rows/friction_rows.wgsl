// Parts: types.
//
// Friction of the contact rows: how far each contact has slipped since the start of the time step, and the
// multipliers that its pair keeps, both across the normal. Coulomb's law at the level of positions: over a
// time step the slip is the relative velocity at its end times the time step (implicit Euler), and the
// multiplier along it is at most the coefficient times that of the normal.

struct Params {
    capacity: u32,
    pair_frictions: u32,
    // The half-spaces lie behind the vertices.
    first_half_space: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> slip_start: array<vec4<i32>>;
@group(0) @binding(3) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(4) var<storage, read> pair_frictions: array<PairFriction>;
@group(0) @binding(5) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(6) var<storage, read> states: array<PairState>;
@group(0) @binding(7) var<storage, read_write> rows: array<Row>;
@group(0) @binding(8) var<storage, read_write> control: Control;

fn across(normal: vec3<f32>, v: vec3<f32>) -> vec3<f32> {
    return v - normal * dot(normal, v);
}

// The coefficient of the two sides if they have one (the list is sorted), else the geometric mean of both
// sides'.
fn friction_of(one: u32, other: u32) -> f32 {
    let a = min(vertices[one].body, vertices[other].body);
    let b = max(vertices[one].body, vertices[other].body);
    var low = 0u;
    var high = params.pair_frictions;
    while low < high {
        let middle = (low + high) / 2u;
        let pair = pair_frictions[middle];
        if pair.a == a && pair.b == b {
            return pair.coefficient;
        }
        if pair.a < a || (pair.a == a && pair.b < b) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return vertices[one].root_of_friction * vertices[other].root_of_friction;
}

@compute @workgroup_size(128)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.rows), params.capacity);
    for (var r = id.x; r < count; r += 128u * MOST_WORKGROUPS) {
        let c = rows[r].candidate;
        let v = rows[r].vertices;
        let candidate = candidates[c];
        let kind = candidate.kind_and_a >> ELEMENT_BITS;
        var other = v.y;
        if kind == VERTEX_HALF_SPACE {
            other = params.first_half_space + candidate.b;
        } else if kind == EDGE_EDGE {
            other = v.z;
        }
        var slip = vec3<f32>(0.0);
        for (var k = 0u; k < 4u; k += 1u) {
            slip += rows[r].weights[k] * vec3<f32>(positions[v[k]].xyz - slip_start[v[k]].xyz);
        }
        rows[r].coefficient = friction_of(v.x, other);
        rows[r].slip = across(rows[r].normal, slip);
        rows[r].friction = across(rows[r].normal, states[c].friction);
    }
}
