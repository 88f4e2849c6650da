// Colors the rows that have no color, in rounds, by one workgroup. In a round each such row claims its vertices that move,
// and the smallest key holds a vertex. A row that holds all of its vertices takes the first color that none of them has in
// use. So rows of one color share no vertex that moves, and the colors depend on the keys alone, not on the order of the
// threads. In each round the smallest key of all is among those that settle.

struct Params {
    capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> displacements: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> rows: array<Row>;
@group(0) @binding(3) var<storage, read_write> in_use: array<vec4<u32>>;
@group(0) @binding(4) var<storage, read_write> claims: array<atomic<u32>>;
// The rows that wait, and room for those of the next round.
@group(0) @binding(5) var<storage, read_write> waiting: array<u32>;
@group(0) @binding(6) var<storage, read_write> control: Control;

var<workgroup> left: atomic<u32>;
var<workgroup> shared_count: u32;

// Keys are unique, and they stay the same as long as the candidates do: a product with an odd number permutes them.
fn key_of(candidate: u32) -> u32 {
    return candidate * 0x9e3779b1u;
}

fn first_free(used: vec4<u32>) -> u32 {
    for (var word = 0u; word < 4u; word += 1u) {
        if used[word] != 0xffffffffu {
            return 32u * word + countTrailingZeros(~used[word]);
        }
    }
    return COLORS;
}

fn moves(v: u32) -> bool {
    return displacements[v].w > 0.0;
}

fn holds_all(r: u32) -> bool {
    let key = key_of(rows[r].candidate);
    for (var k = 0u; k < 4u; k += 1u) {
        let v = rows[r].vertices[k];
        if moves(v) && atomicLoad(&claims[v]) != key {
            return false;
        }
    }
    return true;
}

fn settle(r: u32) {
    var used = vec4<u32>(0u);
    for (var k = 0u; k < 4u; k += 1u) {
        let v = rows[r].vertices[k];
        if moves(v) {
            used |= in_use[v];
        }
    }
    let color = first_free(used);
    rows[r].color = color;
    if color == COLORS {
        return;
    }
    var bit = vec4<u32>(0u);
    bit[color / 32u] = 1u << (color % 32u);
    for (var k = 0u; k < 4u; k += 1u) {
        let v = rows[r].vertices[k];
        if moves(v) {
            in_use[v] |= bit;
        }
    }
}

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_id) local: vec3<u32>) {
    if local.x == 0u {
        shared_count = min(atomicLoad(&control.waiting), params.capacity);
    }
    var count = workgroupUniformLoad(&shared_count);
    var here = 0u;
    var next = params.capacity;
    while count > 0u {
        if local.x == 0u {
            atomicStore(&left, 0u);
        }
        for (var place = local.x; place < count; place += 256u) {
            let r = waiting[here + place];
            for (var k = 0u; k < 4u; k += 1u) {
                atomicStore(&claims[rows[r].vertices[k]], NONE);
            }
        }
        storageBarrier();
        for (var place = local.x; place < count; place += 256u) {
            let r = waiting[here + place];
            for (var k = 0u; k < 4u; k += 1u) {
                let v = rows[r].vertices[k];
                if moves(v) {
                    atomicMin(&claims[v], key_of(rows[r].candidate));
                }
            }
        }
        storageBarrier();
        for (var place = local.x; place < count; place += 256u) {
            let r = waiting[here + place];
            if holds_all(r) {
                settle(r);
            } else {
                waiting[next + atomicAdd(&left, 1u)] = r;
            }
        }
        storageBarrier();
        workgroupBarrier();
        if local.x == 0u {
            shared_count = atomicLoad(&left);
        }
        count = workgroupUniformLoad(&shared_count);
        let swapped = here;
        here = next;
        next = swapped;
    }
}
