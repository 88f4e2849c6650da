// Parts: types.
//
// Boxes of the nodes of a level of a tree: around those of their eight children.

struct Params {
    // First node of the level in the boxes of the tree, and the number of its nodes.
    first: u32,
    nodes: u32,
    // First node of the level below, and the number of its nodes.
    first_child: u32,
    children: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> boxes: array<NodeBox>;
@group(0) @binding(2) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if atomicLoad(&control.changed) == 0u {
        return;
    }
    for (var n = id.x; n < params.nodes; n += 256u * MOST_WORKGROUPS) {
        var box = boxes[params.first_child + 8u * n];
        let end = min(8u * n + 8u, params.children);
        for (var child = 8u * n + 1u; child < end; child += 1u) {
            let other = boxes[params.first_child + child];
            box = NodeBox(min(box.low, other.low), box.deformable | other.deformable, max(box.high, other.high), 0u);
        }
        boxes[params.first + n] = box;
    }
}
