// Parts: types.
//
// Finds the partners of elements: the elements of a tree whose boxes overlap theirs.
//
// It runs twice, since nobody knows before how many there are: first it counts those of each query, then,
// with the sums of these counts, each goes to its place in the list of candidates. Their order depends on the
// tree alone.

struct Params {
    queries: u32,
    // Vertices of a query element.
    count: u32,
    kind: u32,
    // 1: both sides come from one list, and each pair is found from the smaller element.
    symmetric: u32,
    // First row of these queries.
    first_row: u32,
    // 0: partners are counted; 1: they are listed.
    lists: u32,
    // Candidates that the list holds.
    capacity: u32,
    // Levels of the tree, and the first node of each in its boxes.
    levels: u32,
    level_first: array<vec4<u32>, 3>,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> queries: array<Slot>;
@group(0) @binding(2) var<storage, read> slots: array<Slot>;
@group(0) @binding(3) var<storage, read> boxes: array<NodeBox>;
@group(0) @binding(4) var<storage, read> balls: array<Ball>;
@group(0) @binding(5) var<storage, read> vertices: array<Vertex>;
// By row: how many partners it has, then where they begin.
@group(0) @binding(6) var<storage, read_write> starts: array<u32>;
@group(0) @binding(7) var<storage, read_write> candidates: array<Candidate>;
@group(0) @binding(8) var<storage, read_write> control: Control;

// A group of eight siblings: its level and its index there.
const LEVEL_SHIFT: u32 = 27u;
const GROUP_MASK: u32 = 0x7ffffffu;

fn shares_vertex(a: Slot, b: Slot) -> bool {
    return a.v0 == b.v0 || a.v0 == b.v1 || a.v0 == b.v2
        || a.v1 == b.v0 || a.v1 == b.v1 || a.v1 == b.v2
        || a.v2 == b.v0 || a.v2 == b.v1 || a.v2 == b.v2;
}

fn first_of(level: u32) -> u32 {
    return params.level_first[level / 4u][level % 4u];
}

fn find(q: u32) {
    let row = params.first_row + q;
    let query = queries[q];
    if query.element == NONE {
        if params.lists == 0u {
            starts[row] = 0u;
        }
        return;
    }
    var first = 0u;
    if params.lists != 0u {
        first = starts[row];
    }
    var low = vec3<i32>(0x7fffffff);
    var high = vec3<i32>(-0x7fffffff);
    let own = vertices[query.v0];
    for (var k = 0u; k < params.count; k += 1u) {
        let v = select(query.v0, query.v1, k == 1u);
        let ball = balls[v];
        let reach = vec3<i32>(ball.radius + i32(ceil(vertices[v].margin)));
        low = min(low, ball.center - reach);
        high = max(high, ball.center + reach);
    }
    let any_side = (own.flags & OBSTACLE) == 0u;
    var found = 0u;
    var stack: array<u32, 88>;
    stack[0] = (params.levels - 1u) << LEVEL_SHIFT;
    var depth = 1u;
    while depth > 0u {
        depth -= 1u;
        let level = stack[depth] >> LEVEL_SHIFT;
        let group = stack[depth] & GROUP_MASK;
        for (var k = 0u; k < 8u; k += 1u) {
            let node = 8u * group + k;
            let box = boxes[first_of(level) + node];
            let overlaps = all(box.low <= high) && all(low <= box.high);
            if !overlaps || !(any_side || box.deformable != 0u) {
                continue;
            }
            if level > 0u {
                stack[depth] = ((level - 1u) << LEVEL_SHIFT) | node;
                depth += 1u;
                continue;
            }
            let other = slots[node];
            if params.symmetric != 0u && other.element <= query.element {
                continue;
            }
            if shares_vertex(query, other) || !may_collide(own, vertices[other.v0]) {
                continue;
            }
            if params.lists != 0u && first < params.capacity && found < params.capacity - first {
                candidates[first + found] = Candidate((params.kind << ELEMENT_BITS) | query.element, other.element);
            }
            found += 1u;
        }
    }
    if params.lists == 0u {
        starts[row] = found;
    }
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if atomicLoad(&control.changed) == 0u {
        return;
    }
    for (var q = id.x; q < params.queries; q += 64u * MOST_WORKGROUPS) {
        find(q);
    }
}
