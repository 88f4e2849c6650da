// Galerkin blocks P^T H P of pairs of groups, six rigid motions each, without springs. Rows of H multiply
// differences, as in multiply.wgsl, so that motions of a group as a whole do not feel the stiffness within it.

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

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var t = id.x; t < params.pairs; t += 64u * MOST_WORKGROUPS) {
        let pair = pairs[params.first + t];
        let own = frames[params.first_frame + pair.x];
        let frame = frames[params.first_frame + pair.y];
        var a: mat3x3<f32>;
        var b: mat3x3<f32>;
        var c: mat3x3<f32>;
        var d: mat3x3<f32>;
        for (var s = params.width * pair.x; s < params.width * (pair.x + 1u); s += 1u) {
            let i = slots[s].node;
            if i == NONE {
                continue;
            }
            let arm = arm_of(i, own);
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
            a += row.shift;
            b += row.spin;
            c += moments(arm, row.shift);
            d += moments(arm, row.spin);
        }
        let at = 36u * (params.first + t);
        for (var r = 0u; r < 3u; r += 1u) {
            for (var k = 0u; k < 3u; k += 1u) {
                couplings[at + 6u * r + k] = a[k][r];
                couplings[at + 6u * r + 3u + k] = b[k][r];
                couplings[at + 6u * (r + 3u) + k] = c[k][r];
                couplings[at + 6u * (r + 3u) + 3u + k] = d[k][r];
            }
        }
    }
}
