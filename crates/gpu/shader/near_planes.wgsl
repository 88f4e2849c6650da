// Finds the half-spaces near each vertex; rows of words as in traverse.wgsl.

struct Params {
    queries: u32,
    planes: u32,
    first_row: u32,
    stride: u32,
    most: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> queries: array<Slot>;
@group(0) @binding(2) var<storage, read> planes: array<Plane>;
@group(0) @binding(3) var<storage, read> balls: array<Ball>;
@group(0) @binding(4) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(5) var<storage, read_write> partners: array<u32>;
@group(0) @binding(6) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if atomicLoad(&control.changed) == 0u {
        return;
    }
    for (var q = id.x; q < params.queries; q += 256u * MOST_WORKGROUPS) {
        let row = (params.first_row + q) * params.stride;
        let query = queries[q];
        var found = 0u;
        if query.element != NONE && (vertices[query.v0].flags & OBSTACLE) == 0u {
            let ball = balls[query.v0];
            let reach = f32(ball.radius) + 2.0 * vertices[query.v0].margin;
            for (var p = 0u; p < params.planes; p += 1u) {
                let plane = planes[p];
                let offset = vec3<f32>(ball.center - plane.point);
                let height = dot(plane.normal, offset);
                let size = max(max(abs(offset.x), abs(offset.y)), abs(offset.z));
                if height - plane.rounding * size <= reach * 1.001 {
                    if found < params.most {
                        partners[row + 2u + found] = p;
                    }
                    found += 1u;
                }
            }
        }
        partners[row] = found;
        partners[row + 1u] = (VERTEX_HALF_SPACE << ELEMENT_BITS) | query.element;
    }
}
