// Parts: linear, groups.
//
// Galerkin blocks P^T H P of pairs of groups, six rigid motions each, without springs. Rows of H multiply
// differences, as in matrix_product.wgsl, so that motions of a group as a whole do not feel the stiffness
// within it.

struct Params {
    pairs: u32,
    // The first pair, which is also the first block; slots of a group.
    first: u32,
    width: u32,
    first_frame: u32,
    quantum: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> pairs: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read> slices: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read> words: array<u32>;
@group(0) @binding(4) var<storage, read> slots: array<PatchSlot>;
// The slot of each node; NONE for nodes of no group.
@group(0) @binding(5) var<storage, read> places: array<u32>;
@group(0) @binding(6) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(7) var<storage, read> frames: array<Frame>;
@group(0) @binding(8) var<storage, read_write> couplings: array<f32>;

const SLICE: u32 = 32u;
const BLOCK_WORDS: u32 = 10u;

fn number(at: u32) -> f32 {
    return bitcast<f32>(words[at]);
}

// A row of H times the motions of the second group.
struct Row {
    shift: mat3x3<f32>,
    spin: mat3x3<f32>,
}

fn arm_of(node: u32, frame: Frame) -> vec3<f32> {
    return between(frame.center, positions[node].xyz, params.quantum) / frame.size;
}

fn add(row: Row, pair: vec2<u32>, j: u32, h: mat3x3<f32>, arm: vec3<f32>, frame: Frame) -> Row {
    var sum = row;
    let place = places[j];
    let is_in_b = place != NONE && place / params.width == pair.y;
    if pair.x != pair.y {
        if is_in_b {
            sum.shift += h;
            sum.spin += times_spin(h, arm_of(j, frame));
        }
    } else if is_in_b {
        sum.spin += times_spin(h, arm_of(j, frame) - arm);
    } else {
        sum.shift -= h;
        sum.spin -= times_spin(h, arm);
    }
    return sum;
}

// What each node adds to the block of its pair.
var<workgroup> shares: array<f32, 2368>;
const SHARE: u32 = 37u;

fn row_of(i: u32, pair: vec2<u32>, arm: vec3<f32>, frame: Frame) -> Row {
    let slice = slices[i / SLICE];
    var at = slice.x + i % SLICE;
    var row: Row;
    for (var k = 0u; k < slice.y; k += 1u) {
        let h = mat3x3<f32>(
            vec3<f32>(number(at + SLICE), number(at + 2u * SLICE), number(at + 3u * SLICE)),
            vec3<f32>(number(at + 4u * SLICE), number(at + 5u * SLICE), number(at + 6u * SLICE)),
            vec3<f32>(number(at + 7u * SLICE), number(at + 8u * SLICE), number(at + 9u * SLICE)),
        );
        // The first block is the sum of the row.
        if k > 0u {
            row = add(row, pair, words[at], h, arm, frame);
        } else if pair.x == pair.y {
            row.shift = h;
            row.spin = times_spin(h, arm);
        }
        at += BLOCK_WORDS * SLICE;
    }
    for (var k = 0u; k < slice.z; k += 1u) {
        let q = number(at + SLICE);
        let h = mat3x3<f32>(vec3<f32>(q, 0.0, 0.0), vec3<f32>(0.0, q, 0.0), vec3<f32>(0.0, 0.0, q));
        row = add(row, pair, words[at], h, arm, frame);
        at += 2u * SLICE;
    }
    return row;
}

// A thread per slot of the first group, and pairs side by side if groups have fewer slots than there are
// threads.
@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let t = local.x;
    let beside = 64u / params.width;
    for (var begin = beside * group.x; begin < params.pairs; begin += beside * MOST_WORKGROUPS) {
        workgroupBarrier();
        let p = begin + t / params.width;
        var shift: mat3x3<f32>;
        var spin: mat3x3<f32>;
        var arm: vec3<f32>;
        if p < params.pairs {
            let pair = pairs[params.first + p];
            let i = slots[params.width * pair.x + t % params.width].node;
            if i != NONE {
                arm = arm_of(i, frames[params.first_frame + pair.x]);
                let row = row_of(i, pair, arm, frames[params.first_frame + pair.y]);
                shift = row.shift;
                spin = row.spin;
            }
        }
        let turned_shift = moments(arm, shift);
        let turned_spin = moments(arm, spin);
        for (var r = 0u; r < 3u; r += 1u) {
            for (var k = 0u; k < 3u; k += 1u) {
                shares[SHARE * t + 6u * r + k] = shift[k][r];
                shares[SHARE * t + 6u * r + 3u + k] = spin[k][r];
                shares[SHARE * t + 6u * (r + 3u) + k] = turned_shift[k][r];
                shares[SHARE * t + 6u * (r + 3u) + 3u + k] = turned_spin[k][r];
            }
        }
        workgroupBarrier();
        let end = 36u * min(beside, params.pairs - begin);
        for (var k = t; k < end; k += 64u) {
            var sum = 0.0;
            let first = SHARE * params.width * (k / 36u) + k % 36u;
            for (var m = 0u; m < params.width; m += 1u) {
                sum += shares[first + SHARE * m];
            }
            couplings[36u * (params.first + begin) + k] = sum;
        }
    }
}
