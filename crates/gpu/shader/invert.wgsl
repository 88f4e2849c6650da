// Block-Jacobi: the inverses of the diagonal blocks, springs included.

struct Params {
    slots: u32,
    springs: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> diagonal: array<f32>;
@group(0) @binding(2) var<storage, read> springs: array<Spring>;
@group(0) @binding(3) var<storage, read> spring_words: array<u32>;
@group(0) @binding(4) var<storage, read_write> slots: array<PatchSlot>;

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
        let a = m[3] * m[5] - m[4] * m[4];
        let b = m[2] * m[4] - m[1] * m[5];
        let c = m[1] * m[4] - m[2] * m[3];
        let determinant = m[0] * a + m[1] * b + m[2] * c;
        // The block is at least the inertia of the node: it is singular only by rounding or if numbers are not finite.
        var inverse = array<f32, 6>(unit, 0.0, 0.0, unit, 0.0, unit);
        if determinant > 1e-12 {
            let factor = unit / determinant;
            inverse[0] = factor * a;
            inverse[1] = factor * b;
            inverse[2] = factor * c;
            inverse[3] = factor * (m[0] * m[5] - m[2] * m[2]);
            inverse[4] = factor * (m[1] * m[2] - m[0] * m[4]);
            inverse[5] = factor * (m[0] * m[3] - m[1] * m[1]);
        }
        slots[t].inverse = inverse;
    }
}
