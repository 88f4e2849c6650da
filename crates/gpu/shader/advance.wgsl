// Moves the vertices, and reports what is left of their ways and which prescribed vertices get on. Nothing moves if a buffer was too small for all pairs.

struct Params {
    vertices: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> targets: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(3) var<storage, read> paths: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> alphas: array<u32>;
@group(0) @binding(5) var<storage, read> group_alphas: array<u32>;
@group(0) @binding(6) var<storage, read_write> positions: array<vec4<i32>>;
@group(0) @binding(7) var<storage, read_write> control: Control;
@group(0) @binding(8) var<storage, read_write> late: array<Late>;

// Smallest decrease of the distance to the target that counts as progress, in local edge lengths.
const LEAST_PROGRESS: f32 = 1e-3;

fn note_progress(v: u32, left: f32, edge: f32) {
    var idle_steps = late[v].idle_steps + 1u;
    if left < late[v].smallest - LEAST_PROGRESS * edge {
        late[v].smallest = left;
        idle_steps = 0u;
    }
    late[v].idle_steps = select(idle_steps, 0u, left == 0.0);
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if atomicLoad(&control.overflow) != 0u {
        return;
    }
    for (var v = id.x; v < params.vertices; v += 256u * MOST_WORKGROUPS) {
        let vertex = vertices[v];
        var alpha = bitcast<f32>(alphas[v]);
        if vertex.group != NONE {
            alpha = bitcast<f32>(group_alphas[vertex.group]);
        }
        let position = positions[v].xyz;
        let displacement = vec3<f32>(targets[v].xyz - position);
        let length = sqrt(dot(displacement, displacement));
        let left = (1.0 - alpha) * length;
        if (vertex.flags & PRESCRIBED) != 0u {
            atomicMax(&control.lag, bitcast<u32>(left));
            note_progress(v, left, vertex.edge);
        } else {
            atomicMax(&control.free_remaining, bitcast<u32>(left));
            atomicMax(&control.free_move, bitcast<u32>(alpha * length));
        }
        atomicMax(&control.largest_move, bitcast<u32>(alpha * length));
        if alpha >= paths[v].w {
            atomicMax(&control.unhindered, bitcast<u32>(left));
            if (vertex.flags & PRESCRIBED) != 0u {
                atomicMax(&control.unhindered_lag, bitcast<u32>(left));
            }
        }
        // The whole way leads to the target to the bit; a part is rounded toward its start.
        if alpha == 1.0 {
            positions[v] = targets[v];
        } else {
            positions[v] = vec4<i32>(position + vec3<i32>(displacement * alpha), 0);
        }
    }
}
