// Friction of the contact rows: how far each contact has slipped since the start of the time step, and the multipliers that
// its pair keeps, both across the normal. Coulomb's law at the level of positions: over a time step the slip is the
// relative velocity at its end times the time step (implicit Euler), and the multiplier along it is at most the
// coefficient times that of the normal.

struct Params {
    capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> slip_start: array<vec4<i32>>;
@group(0) @binding(3) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(4) var<storage, read> planes: array<Plane>;
@group(0) @binding(5) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(6) var<storage, read> states: array<PairState>;
@group(0) @binding(7) var<storage, read_write> rows: array<Row>;

fn across(normal: vec3<f32>, v: vec3<f32>) -> vec3<f32> {
    return v - normal * dot(normal, v);
}

@compute @workgroup_size(128)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    for (var r = id.x; r < params.capacity; r += 128u * groups.x) {
        let c = rows[r].candidate;
        if c == NONE {
            continue;
        }
        let v = rows[r].vertices;
        let candidate = candidates[c];
        let kind = candidate.kind_and_a >> ELEMENT_BITS;
        // Geometric mean of the coefficients of both sides.
        var root = vertices[v.x].root_of_friction;
        if kind == VERTEX_HALF_SPACE {
            root *= planes[candidate.b].root_of_friction;
        } else if kind == EDGE_EDGE {
            root *= vertices[v.z].root_of_friction;
        } else {
            root *= vertices[v.y].root_of_friction;
        }
        var slip = vec3<f32>(0.0);
        for (var k = 0u; k < 4u; k += 1u) {
            slip += rows[r].weights[k] * vec3<f32>(positions[v[k]].xyz - slip_start[v[k]].xyz);
        }
        rows[r].coefficient = root;
        rows[r].slip = across(rows[r].normal, slip);
        rows[r].friction = across(rows[r].normal, states[c].friction);
    }
}
