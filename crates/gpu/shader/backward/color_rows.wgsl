// Parts: types.
//
// Colors the rows of each bucket and sorts them by color. A workgroup takes a bucket at a time; the buckets
// of a dispatch share no vertex that moves.
//
// In a round each row without a color claims its vertices that move, and the smallest key holds a vertex. A
// row that holds all of its vertices takes the first color that none of them has in use. So rows of one color
// share no vertex that moves, and the colors depend on the keys alone, not on the order of the threads. In
// each round the smallest key of all is among those that settle.
//
// A vertex that many rows share, as one of a coarse sheet on a fine one, settles one of them per round. Where
// a round settles less than a 64th of those that wait, the others get no color. They are swept at once: each
// vertex is split into as many parts as it has of them, with an equal share of its mass each, and moves by
// the mean of its parts (Tonge et al. 2012). So the diagonals of these rows count the inverse mass of a
// vertex as often as it has such rows.

struct Params {
    // Buckets of the dispatch.
    first: u32,
    end: u32,
    capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> displacements: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> rows: array<Row>;
@group(0) @binding(3) var<storage, read_write> buckets: array<Bucket>;
// Colors in use at each vertex.
@group(0) @binding(4) var<storage, read_write> in_use: array<vec4<u32>>;
@group(0) @binding(5) var<storage, read_write> claims: array<atomic<u32>>;
// The rows that wait, and room for those of the next round.
@group(0) @binding(6) var<storage, read_write> waiting: array<u32>;
@group(0) @binding(7) var<storage, read_write> order: array<u32>;
// Where each color of a bucket ends in the order, from the place where the bucket begins: it has no more
// colors than rows.
@group(0) @binding(8) var<storage, read_write> color_ends: array<u32>;

// One in so many rows that wait must settle in a round.
const FEWEST_SETTLED: u32 = 64u;

var<workgroup> left: atomic<u32>;
var<workgroup> shared_first: u32;
var<workgroup> shared_count: u32;
// Most rows without a color of one vertex.
var<workgroup> most: atomic<u32>;
// Number of rows of each color and of those without one; then where the next of them goes.
var<workgroup> places: array<atomic<u32>, 129>;

// Keys are unique: a product with an odd number permutes them.
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

fn claim(r: u32) {
    for (var k = 0u; k < 4u; k += 1u) {
        let v = rows[r].vertices[k];
        if moves(v) {
            atomicMin(&claims[v], key_of(rows[r].candidate));
        }
    }
}

// No color is in use yet at the vertices that a row holds.
fn clear(r: u32) {
    for (var k = 0u; k < 4u; k += 1u) {
        let v = rows[r].vertices[k];
        if moves(v) && atomicLoad(&claims[v]) == key_of(rows[r].candidate) {
            in_use[v] = vec4<u32>(0u);
        }
    }
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

fn color_row(r: u32) {
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
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    for (var bucket = params.first + group.x; bucket < params.end; bucket += MOST_WORKGROUPS) {
        if local.x == 0u {
            shared_first = buckets[bucket].first;
            shared_count = buckets[bucket].end - buckets[bucket].first;
        }
        let first = workgroupUniformLoad(&shared_first);
        let all = workgroupUniformLoad(&shared_count);
        if all == 0u {
            if local.x == 0u {
                buckets[bucket].colors = 0u;
            }
            continue;
        }
        for (var place = local.x; place < all; place += 256u) {
            waiting[first + place] = order[first + place];
        }
        var here = first;
        var next = params.capacity + first;
        var count = all;
        for (var round = 0u; count > 0u; round += 1u) {
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
                claim(waiting[here + place]);
            }
            storageBarrier();
            if round == 0u {
                for (var place = local.x; place < count; place += 256u) {
                    clear(waiting[here + place]);
                }
            }
            storageBarrier();
            for (var place = local.x; place < count; place += 256u) {
                let r = waiting[here + place];
                if holds_all(r) {
                    color_row(r);
                } else {
                    waiting[next + atomicAdd(&left, 1u)] = r;
                }
            }
            storageBarrier();
            workgroupBarrier();
            if local.x == 0u {
                shared_count = atomicLoad(&left);
            }
            let before = count;
            count = workgroupUniformLoad(&shared_count);
            let swapped = here;
            here = next;
            next = swapped;
            if FEWEST_SETTLED * (before - count) < before {
                break;
            }
        }
        for (var place = local.x; place < count; place += 256u) {
            rows[waiting[here + place]].color = COLORS;
        }
        storageBarrier();
        workgroupBarrier();
        sort_by_color(bucket, first, all, local.x);
    }
}

// Their order within a color does not matter, nor that of rows without one.
fn sort_by_color(bucket: u32, first: u32, all: u32, thread: u32) {
    for (var color = thread; color <= COLORS; color += 256u) {
        atomicStore(&places[color], 0u);
    }
    if thread == 0u {
        atomicStore(&most, 0u);
    }
    workgroupBarrier();
    for (var place = first + thread; place < first + all; place += 256u) {
        let r = order[place];
        waiting[place] = r;
        atomicAdd(&places[rows[r].color], 1u);
    }
    storageBarrier();
    workgroupBarrier();
    if thread == 0u {
        var sum = first;
        var color = 0u;
        // A color is used only where those before it are.
        for (; color < COLORS; color += 1u) {
            let rows_of_color = atomicLoad(&places[color]);
            if rows_of_color == 0u {
                break;
            }
            atomicStore(&places[color], sum);
            sum += rows_of_color;
            color_ends[first + color] = sum;
        }
        buckets[bucket].colors = color;
        shared_first = sum;
        shared_count = atomicLoad(&places[COLORS]);
        atomicStore(&places[COLORS], sum);
    }
    workgroupBarrier();
    for (var place = first + thread; place < first + all; place += 256u) {
        let r = waiting[place];
        order[atomicAdd(&places[rows[r].color], 1u)] = r;
    }
    storageBarrier();
    workgroupBarrier();
    let uncolored = workgroupUniformLoad(&shared_count);
    if uncolored > 0u {
        split_masses(workgroupUniformLoad(&shared_first), first + all, thread);
    }
    if thread == 0u {
        buckets[bucket].most = atomicLoad(&most);
    }
    workgroupBarrier();
}

// Whether vertex k of a row takes part in it; unused ones have no weight.
fn has_part(r: u32, k: u32) -> bool {
    return moves(rows[r].vertices[k]) && rows[r].weights[k] != 0.0;
}

// The diagonals of the rows without a color.
fn split_masses(first: u32, end: u32, thread: u32) {
    for (var place = first + thread; place < end; place += 256u) {
        let r = order[place];
        for (var k = 0u; k < 4u; k += 1u) {
            if has_part(r, k) {
                atomicStore(&claims[rows[r].vertices[k]], 0u);
            }
        }
    }
    storageBarrier();
    workgroupBarrier();
    for (var place = first + thread; place < end; place += 256u) {
        let r = order[place];
        for (var k = 0u; k < 4u; k += 1u) {
            if has_part(r, k) {
                atomicAdd(&claims[rows[r].vertices[k]], 1u);
            }
        }
    }
    storageBarrier();
    workgroupBarrier();
    for (var place = first + thread; place < end; place += 256u) {
        let r = order[place];
        var diagonal = 0.0;
        for (var k = 0u; k < 4u; k += 1u) {
            if has_part(r, k) {
                let v = rows[r].vertices[k];
                let parts = atomicLoad(&claims[v]);
                atomicMax(&most, parts);
                diagonal += f32(parts) * displacements[v].w * rows[r].weights[k] * rows[r].weights[k];
            }
        }
        rows[r].inverse_diagonal = select(0.0, 1.0 / diagonal, diagonal > 0.0);
    }
    workgroupBarrier();
}
