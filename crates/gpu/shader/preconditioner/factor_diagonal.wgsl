// Parts: linear.
//
// Block-Jacobi: the diagonal blocks, springs included, as products L D L^T. The rounding of an inverse is
// relative to its largest entry, that of the softest direction; in stiff directions it would be larger than
// the entry itself.

struct Params {
    slots: u32,
    springs: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> diagonal: array<f32>;
@group(0) @binding(2) var<storage, read> springs: array<Spring>;
@group(0) @binding(3) var<storage, read> spring_words: array<u32>;
@group(0) @binding(4) var<storage, read_write> slots: array<PatchSlot>;

// Smallest pivot as a share of the trace. Smaller ones are mostly rounding; a larger one keeps the block
// positive.
const MIN_PIVOT: f32 = 2e-7;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var t = id.x; t < params.slots; t += 64u * MOST_WORKGROUPS) {
        let i = slots[t].node;
        if i == NONE {
            continue;
        }
        var m: array<f32, 6>;
        for (var k = 0u; k < 6u; k += 1u) {
            m[k] = diagonal[6u * i + k];
        }
        if params.springs > 0u {
            let end = spring_words[i + 1u];
            for (var e = spring_words[i]; e < end; e += 2u) {
                let weight = bitcast<f32>(spring_words[e + 1u]);
                let hessian = springs[spring_words[e]].hessian;
                let squared = weight * weight;
                m[0] += squared * hessian[0].x;
                m[1] += squared * hessian[0].y;
                m[2] += squared * hessian[0].z;
                m[3] += squared * hessian[1].y;
                m[4] += squared * hessian[1].z;
                m[5] += squared * hessian[2].z;
            }
        }
        // Over the trace, so that no unit is too large for products of three numbers.
        let trace = m[0] + m[3] + m[5];
        let unit = 1.0 / trace;
        for (var k = 0u; k < 6u; k += 1u) {
            m[k] *= unit;
        }
        let first = max(m[0], MIN_PIVOT);
        let xy = m[1] / first;
        let xz = m[2] / first;
        let second = max(m[3] - xy * m[1], MIN_PIVOT);
        let rest = m[4] - xy * m[2];
        let yz = rest / second;
        let third = max(m[5] - xz * m[2] - yz * rest, MIN_PIVOT);
        slots[t].factors = array<f32, 6>(xy, xz, yz, unit / first, unit / second, unit / third);
    }
}
