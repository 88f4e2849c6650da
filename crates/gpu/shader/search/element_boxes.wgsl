// Parts: types.
//
// Boxes of the elements of a tree: around the trust regions of their vertices, with their margins. They are
// integers, so they contain exactly what they should.

struct Params {
    slots: u32,
    // Vertices of an element.
    count: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> slots: array<Slot>;
@group(0) @binding(2) var<storage, read> balls: array<Ball>;
@group(0) @binding(3) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(4) var<storage, read_write> boxes: array<NodeBox>;
@group(0) @binding(5) var<storage, read_write> control: Control;

const EMPTY: NodeBox = NodeBox(vec3<i32>(0x7fffffff), 0u, vec3<i32>(-0x7fffffff - 1), 0u);

fn grown(box: NodeBox, v: u32) -> NodeBox {
    let ball = balls[v];
    let vertex = vertices[v];
    let reach = vec3<i32>(ball.radius + i32(ceil(vertex.margin)));
    let deformable = box.deformable | (1u - (vertex.flags & OBSTACLE));
    return NodeBox(min(box.low, ball.center - reach), deformable, max(box.high, ball.center + reach), 0u);
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if atomicLoad(&control.changed) == 0u {
        return;
    }
    for (var s = id.x; s < params.slots; s += 256u * MOST_WORKGROUPS) {
        let slot = slots[s];
        var box = EMPTY;
        if slot.element != NONE {
            box = grown(box, slot.v0);
            if params.count > 1u {
                box = grown(box, slot.v1);
            }
            if params.count > 2u {
                box = grown(box, slot.v2);
            }
        }
        boxes[s] = box;
    }
}
