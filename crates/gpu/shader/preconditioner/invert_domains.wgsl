// Parts: linear, groups.
//
// Inverses of the matrices of domains, eight groups of six rigid motions each, springs included; one
// workgroup per domain.

struct Params {
    domains: u32,
    // The first domain of this level, and where its inverse goes, in domains; the frame of its first group;
    // the number of groups of this level.
    first: u32,
    first_inverse: u32,
    first_part: u32,
    parts: u32,
    // Whether there are springs.
    springs: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
// Of each domain the blocks of its 64 pairs of groups; NONE for those that are zero.
@group(0) @binding(1) var<storage, read> tables: array<u32>;
@group(0) @binding(2) var<storage, read> couplings: array<f32>;
// Where the chunks of springs of each domain begin, and what they add.
@group(0) @binding(3) var<storage, read> touching: array<u32>;
@group(0) @binding(4) var<storage, read> pressed: array<f32>;
@group(0) @binding(5) var<storage, read> frames: array<Frame>;
@group(0) @binding(6) var<storage, read_write> inverses: array<f32>;

// Added to the diagonal, relative to it: larger than the rounding of the entries, so that the inverse is
// positive.
const SHIFT: f32 = 4e-6;

// A pivot of at most this share of its diagonal entry counts as zero: the motion moves nothing that others do
// not.
const ZERO_PIVOT: f32 = 1e-6;

// Threads, and words of a row in the memory of the workgroup: threads of neighboring rows then use different
// banks.
const WIDE: u32 = 192u;
const ROW: u32 = 49u;

var<workgroup> matrix: array<f32, 2352>;
var<workgroup> pivot_row: array<f32, 48>;
var<workgroup> pivot_column: array<f32, 48>;
var<workgroup> diagonal: array<f32, 48>;

// The entry of row r and column k >= r of domain d.
fn entry(d: u32, r: u32, k: u32) -> f32 {
    let block = tables[64u * d + 8u * (r / 6u) + k / 6u];
    var value = 0.0;
    if block != NONE {
        value = couplings[36u * block + 6u * (r % 6u) + k % 6u];
    }
    if params.springs == 1u {
        let end = touching[d + 1u];
        for (var c = touching[d]; c < end; c += 1u) {
            value += pressed[DOMAIN_WORDS * c + 48u * r + k];
        }
    }
    return value;
}

@compute @workgroup_size(192)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_id) local: vec3<u32>,
) {
    let t = local.x;
    // Each row has four threads, which take every fourth column.
    let row = t / 4u;
    let lane = t % 4u;
    for (var d = group.x; d < params.domains; d += MOST_WORKGROUPS) {
        workgroupBarrier();
        for (var k = t; k < DOMAIN_WORDS; k += WIDE) {
            let r = k / 48u;
            let c = k % 48u;
            matrix[ROW * r + c] = entry(params.first + d, min(r, c), max(r, c));
        }
        workgroupBarrier();
        if t < 8u && 8u * d + t < params.parts {
            var stiffness = 0.0;
            for (var k = 0u; k < 6u; k += 1u) {
                stiffness += matrix[(ROW + 1u) * (6u * t + k)];
            }
            let held = frames[params.first_part + 8u * d + t].held;
            var rows = array<vec3<f32>, 3>(
                vec3<f32>(held[0], held[1], held[2]),
                vec3<f32>(held[1], held[3], held[4]),
                vec3<f32>(held[2], held[4], held[5]),
            );
            for (var r = 0u; r < 3u; r += 1u) {
                for (var k = 0u; k < 3u; k += 1u) {
                    matrix[ROW * (6u * t + r + 3u) + 6u * t + k + 3u] += stiffness * rows[r][k];
                }
            }
        }
        workgroupBarrier();
        if t < 48u {
            matrix[(ROW + 1u) * t] *= 1.0 + SHIFT;
            diagonal[t] = matrix[(ROW + 1u) * t];
        }
        // Gauss-Jordan elimination in place, without exchanges of rows: the matrix is positive semi-definite.
        for (var k = 0u; k < 48u; k += 1u) {
            workgroupBarrier();
            if t < 48u {
                pivot_row[t] = matrix[ROW * k + t];
                pivot_column[t] = matrix[ROW * t + k];
            }
            workgroupBarrier();
            let pivot = pivot_row[k];
            let is_zero = !(pivot > ZERO_PIVOT * diagonal[k]);
            let factor = pivot_column[row] / pivot;
            for (var j = lane; j < 48u; j += 4u) {
                let at = ROW * row + j;
                if is_zero {
                    if row == k || j == k {
                        matrix[at] = 0.0;
                    }
                } else if row == k {
                    matrix[at] = select(pivot_row[j], 1.0, j == k) / pivot;
                } else if j == k {
                    matrix[at] = -factor;
                } else {
                    matrix[at] -= factor * pivot_row[j];
                }
            }
        }
        workgroupBarrier();
        for (var k = t; k < DOMAIN_WORDS; k += WIDE) {
            let r = k / 48u;
            let c = k % 48u;
            inverses[DOMAIN_WORDS * (params.first_inverse + d) + k] =
                0.5 * (matrix[ROW * r + c] + matrix[ROW * c + r]);
        }
    }
}
