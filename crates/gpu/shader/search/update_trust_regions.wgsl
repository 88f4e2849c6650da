// Parts: types.
//
// Gives each vertex whose path leaves its trust region a new one, a ball about the middle of the path.

struct Params {
    vertices: u32,
    // 1: all trust regions are new.
    all: u32,
    // By how much a ball is larger than half of the path, and its smallest radius, in local edge lengths. Any
    // numbers of at least 0 are safe.
    slack: f32,
    smallest: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> paths: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(4) var<storage, read_write> balls: array<Ball>;
@group(0) @binding(5) var<storage, read_write> control: Control;

// Share of a ball within which paths stay. The rest covers the rounding of this test and of the step.
const COVERED: f32 = 0.998;
// Added to the radius: a ball that is not at rest is so large that a fraction 0.002 of it exceeds all
// rounding.
const ROOM: f32 = 4096.0;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var v = id.x; v < params.vertices; v += 256u * MOST_WORKGROUPS) {
        let path = paths[v].xyz;
        let position = positions[v].xyz;
        let ball = balls[v];
        let start = vec3<f32>(position - ball.center);
        let end = start + path;
        let limit = COVERED * f32(ball.radius);
        if params.all == 0u && dot(start, start) <= limit * limit && dot(end, end) <= limit * limit {
            continue;
        }
        let vertex = vertices[v];
        let length = sqrt(dot(path, path));
        var radius = 0.0;
        if length > 0.0 || (vertex.flags & PRESCRIBED) == 0u {
            radius = max(0.5 * length / (COVERED * COVERED) + params.slack * vertex.edge, params.smallest * vertex.edge);
            radius = radius + ROOM;
        }
        balls[v] = Ball(position + vec3<i32>(path * 0.5), i32(radius));
        atomicStore(&control.changed, 1u);
    }
}
