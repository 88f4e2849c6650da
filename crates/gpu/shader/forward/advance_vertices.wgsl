// Parts: types, most.
//
// Moves the vertices, and reports what is left of their ways and which prescribed vertices make progress.
// Nothing moves if a buffer was too small for all pairs.

struct Params {
    vertices: u32,
    // Smallest decrease of the distance to the target that counts as progress.
    progress: f32,
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

const LAG: u32 = 0u;
const FREE_REMAINING: u32 = 1u;
const FREE_MOVE: u32 = 2u;
const LARGEST_MOVE: u32 = 3u;
const UNHINDERED: u32 = 4u;
const UNHINDERED_LAG: u32 = 5u;
const WORDS: u32 = 6u;

var<workgroup> shared_overflow: u32;

fn note_progress(v: u32, left: f32) {
    var idle_steps = late[v].idle_steps + 1u;
    if left < late[v].smallest - params.progress {
        late[v].smallest = left;
        idle_steps = 0u;
    }
    late[v].idle_steps = select(idle_steps, 0u, left == 0.0);
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    if local.x == 0u {
        shared_overflow = atomicLoad(&control.overflow);
    }
    if workgroupUniformLoad(&shared_overflow) != 0u {
        return;
    }
    // Bits of numbers of at least 0 are ordered as they are.
    var largest = array<u32, WORDS>();
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
            largest[LAG] = max(largest[LAG], bitcast<u32>(left));
            note_progress(v, left);
        } else {
            largest[FREE_REMAINING] = max(largest[FREE_REMAINING], bitcast<u32>(left));
            largest[FREE_MOVE] = max(largest[FREE_MOVE], bitcast<u32>(alpha * length));
        }
        largest[LARGEST_MOVE] = max(largest[LARGEST_MOVE], bitcast<u32>(alpha * length));
        if alpha >= paths[v].w {
            largest[UNHINDERED] = max(largest[UNHINDERED], bitcast<u32>(left));
            if (vertex.flags & PRESCRIBED) != 0u {
                largest[UNHINDERED_LAG] = max(largest[UNHINDERED_LAG], bitcast<u32>(left));
            }
        }
        // The whole way leads to the target to the bit; a part is rounded toward its start.
        if alpha == 1.0 {
            positions[v] = targets[v];
        } else {
            positions[v] = vec4<i32>(position + vec3<i32>(displacement * alpha), 0);
        }
    }
    find_most(local.x, largest);
    if local.x == 0u {
        atomicMax(&control.lag, most[256u * LAG]);
        atomicMax(&control.free_remaining, most[256u * FREE_REMAINING]);
        atomicMax(&control.free_move, most[256u * FREE_MOVE]);
        atomicMax(&control.largest_move, most[256u * LARGEST_MOVE]);
        atomicMax(&control.unhindered, most[256u * UNHINDERED]);
        atomicMax(&control.unhindered_lag, most[256u * UNHINDERED_LAG]);
    }
}
