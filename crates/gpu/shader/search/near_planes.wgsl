// Parts: types.
//
// Finds the half-spaces near each vertex, in two runs as traverse_tree.wgsl.

struct Params {
    queries: u32,
    planes: u32,
    first_row: u32,
    lists: u32,
    capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> queries: array<Slot>;
@group(0) @binding(2) var<storage, read> planes: array<Plane>;
@group(0) @binding(3) var<storage, read> balls: array<Ball>;
@group(0) @binding(4) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(5) var<storage, read_write> starts: array<u32>;
@group(0) @binding(6) var<storage, read_write> candidates: array<Candidate>;
@group(0) @binding(7) var<storage, read_write> control: Control;

// The point of a plane is rounded to the grid, by less than this.
const POINT_ROUNDING: f32 = 1.0;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if atomicLoad(&control.changed) == 0u {
        return;
    }
    for (var q = id.x; q < params.queries; q += 256u * MOST_WORKGROUPS) {
        let row = params.first_row + q;
        let query = queries[q];
        var first = 0u;
        if params.lists != 0u {
            first = starts[row];
        }
        var found = 0u;
        if query.element != NONE && (vertices[query.v0].flags & OBSTACLE) == 0u {
            let ball = balls[query.v0];
            let reach = f32(ball.radius) + 2.0 * vertices[query.v0].margin;
            for (var p = 0u; p < params.planes; p += 1u) {
                let plane = planes[p];
                let offset = vec3<f32>(ball.center - plane.point);
                let height = dot(plane.normal, offset);
                let size = max(max(abs(offset.x), abs(offset.y)), abs(offset.z));
                if height - plane.rounding * size <= reach * 1.001 + POINT_ROUNDING {
                    if params.lists != 0u && first < params.capacity && found < params.capacity - first {
                        candidates[first + found] = Candidate((VERTEX_HALF_SPACE << ELEMENT_BITS) | query.element, p);
                    }
                    found += 1u;
                }
            }
        }
        if params.lists == 0u {
            starts[row] = found;
        }
    }
}
