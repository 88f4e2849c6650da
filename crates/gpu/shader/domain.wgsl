// Inverses of the matrices of domains, eight groups of six rigid motions each, springs included; one workgroup per
// domain.

struct Params {
    domains: u32,
    // The first domain of this level, and where its inverse goes, in domains; the frame of its first group; the number of
    // groups of this level.
    first: u32,
    first_inverse: u32,
    first_part: u32,
    parts: u32,
    // The number of slots of a group.
    width: u32,
    // Whether there are springs.
    springs: u32,
    quantum: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
// Of each domain the blocks of its 64 pairs of groups; NONE for those that are zero.
@group(0) @binding(1) var<storage, read> tables: array<u32>;
@group(0) @binding(2) var<storage, read> couplings: array<f32>;
@group(0) @binding(3) var<storage, read> springs: array<Spring>;
// Where the springs of each domain begin, then the springs.
@group(0) @binding(4) var<storage, read> touching: array<u32>;
@group(0) @binding(5) var<storage, read> places: array<u32>;
@group(0) @binding(6) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(7) var<storage, read> frames: array<Frame>;
@group(0) @binding(8) var<storage, read_write> inverses: array<f32>;

// Added to the diagonal, relative to it: larger than the rounding of the entries, so that the inverse is positive.
const SHIFT: f32 = 4e-6;

// A pivot of at most this share of its diagonal entry counts as zero: the motion moves nothing that others do not.
const ZERO_PIVOT: f32 = 1e-6;

var<workgroup> matrix: array<f32, 2304>;
var<workgroup> pivot_row: array<f32, 48>;
var<workgroup> diagonal: array<f32, 48>;

// The group of this level that a node is in, NONE without one.
fn group_of(node: u32) -> u32 {
    let place = places[node];
    return select(NONE, place / params.width, place != NONE);
}

fn add(a: u32, b: u32, r: u32, k: u32, value: f32) {
    matrix[48u * (6u * a + r) + 6u * b + k] += value;
}

// Adds the springs of a domain to the block of the groups a and b.
fn press(d: u32, a: u32, b: u32) {
    let ga = 8u * d + a;
    let gb = 8u * d + b;
    let end = touching[params.first + d + 1u];
    for (var e = touching[params.first + d]; e < end; e += 1u) {
        let spring = springs[touching[e]];
        let h = mat3x3<f32>(spring.hessian[0].xyz, spring.hessian[1].xyz, spring.hessian[2].xyz);
        for (var m = 0u; m < 4u; m += 1u) {
            if spring.weights[m] == 0.0 || group_of(spring.nodes[m]) != ga {
                continue;
            }
            let own = frames[params.first_part + ga];
            let arm = between(own.center, positions[spring.nodes[m]].xyz, params.quantum) / own.size;
            for (var n = 0u; n < 4u; n += 1u) {
                if spring.weights[n] == 0.0 || group_of(spring.nodes[n]) != gb {
                    continue;
                }
                let frame = frames[params.first_part + gb];
                let other = between(frame.center, positions[spring.nodes[n]].xyz, params.quantum) / frame.size;
                let shift = h * (spring.weights[m] * spring.weights[n]);
                let spin = times_spin(shift, other);
                let turned_shift = moments(arm, shift);
                let turned_spin = moments(arm, spin);
                for (var r = 0u; r < 3u; r += 1u) {
                    for (var k = 0u; k < 3u; k += 1u) {
                        add(a, b, r, k, shift[k][r]);
                        add(a, b, r, k + 3u, spin[k][r]);
                        add(a, b, r + 3u, k, turned_shift[k][r]);
                        add(a, b, r + 3u, k + 3u, turned_spin[k][r]);
                    }
                }
            }
        }
    }
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_id) local: vec3<u32>,
) {
    let t = local.x;
    let a = t / 8u;
    let b = t % 8u;
    for (var d = group.x; d < params.domains; d += MOST_WORKGROUPS) {
        workgroupBarrier();
        // Blocks on and above the diagonal; the others are their transposes.
        if a <= b {
            let block = tables[64u * (params.first + d) + t];
            for (var k = 0u; k < 36u; k += 1u) {
                var value = 0.0;
                if block != NONE {
                    value = couplings[36u * block + k];
                }
                matrix[48u * (6u * a + k / 6u) + 6u * b + k % 6u] = value;
            }
            if params.springs == 1u {
                press(d, a, b);
            }
            for (var k = 0u; k < 36u; k += 1u) {
                let r = 6u * a + k / 6u;
                let c = 6u * b + k % 6u;
                if r < c {
                    matrix[48u * c + r] = matrix[48u * r + c];
                }
            }
        }
        workgroupBarrier();
        if t < 8u && 8u * d + t < params.parts {
            var stiffness = 0.0;
            for (var k = 0u; k < 6u; k += 1u) {
                stiffness += matrix[49u * (6u * t + k)];
            }
            let held = frames[params.first_part + 8u * d + t].held;
            var rows = array<vec3<f32>, 3>(
                vec3<f32>(held[0], held[1], held[2]),
                vec3<f32>(held[1], held[3], held[4]),
                vec3<f32>(held[2], held[4], held[5]),
            );
            for (var r = 0u; r < 3u; r += 1u) {
                for (var k = 0u; k < 3u; k += 1u) {
                    add(t, t, r + 3u, k + 3u, stiffness * rows[r][k]);
                }
            }
        }
        workgroupBarrier();
        if t < 48u {
            matrix[49u * t] *= 1.0 + SHIFT;
            diagonal[t] = matrix[49u * t];
        }
        // Gauss-Jordan elimination in place, without exchanges of rows: the matrix is positive semi-definite.
        for (var k = 0u; k < 48u; k += 1u) {
            workgroupBarrier();
            if t < 48u {
                pivot_row[t] = matrix[48u * k + t];
            }
            workgroupBarrier();
            let pivot = pivot_row[k];
            if t < 48u {
                if pivot > ZERO_PIVOT * diagonal[k] {
                    if t == k {
                        for (var j = 0u; j < 48u; j += 1u) {
                            matrix[48u * k + j] = pivot_row[j] / pivot;
                        }
                        matrix[49u * k] = 1.0 / pivot;
                    } else {
                        let factor = matrix[48u * t + k] / pivot;
                        for (var j = 0u; j < 48u; j += 1u) {
                            matrix[48u * t + j] -= factor * pivot_row[j];
                        }
                        matrix[48u * t + k] = -factor;
                    }
                } else {
                    if t == k {
                        for (var j = 0u; j < 48u; j += 1u) {
                            matrix[48u * k + j] = 0.0;
                        }
                    }
                    matrix[48u * t + k] = 0.0;
                }
            }
        }
        workgroupBarrier();
        if t < 48u {
            for (var j = 0u; j < 48u; j += 1u) {
                inverses[DOMAIN_WORDS * (params.first_inverse + d) + 48u * t + j] =
                    0.5 * (matrix[48u * t + j] + matrix[48u * j + t]);
            }
        }
    }
}
