// Galerkin blocks of pairs of groups of groups: sums of those of their parts, with the motions of a part by that of
// its group.

struct Params {
    pairs: u32,
    // The first pair, which is also the first block.
    first: u32,
    quantum: f32,
}

// A block of a pair of parts: its number, the frames of both parts, and whether its transpose counts as well.
struct Part {
    block: u32,
    a: u32,
    b: u32,
    both: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
// Of each pair of this and the coarser levels: its first part, the number of parts, the frames of both groups.
@group(0) @binding(1) var<storage, read> sums: array<vec4<u32>>;
@group(0) @binding(2) var<storage, read> parts: array<Part>;
@group(0) @binding(3) var<storage, read> frames: array<Frame>;
@group(0) @binding(4) var<storage, read_write> couplings: array<f32>;

// Way and ratio of sizes from a group to its part.
fn link(group: u32, part: u32) -> vec4<f32> {
    let parent = frames[group];
    let child = frames[part];
    return vec4<f32>(between(parent.center, child.center, params.quantum), child.size) / parent.size;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var t = id.x; t < params.pairs; t += 64u * MOST_WORKGROUPS) {
        let sum = sums[params.first + t];
        var total: array<f32, 36>;
        for (var p = sum.x; p < sum.x + sum.y; p += 1u) {
            let part = parts[p];
            let own = link(sum.z, part.a);
            let other = link(sum.w, part.b);
            // C M_b, row by row: shifts as they are, spins turn the way and shrink.
            var image: array<f32, 36>;
            for (var r = 0u; r < 6u; r += 1u) {
                let at = 36u * part.block + 6u * r;
                let force = vec3<f32>(couplings[at], couplings[at + 1u], couplings[at + 2u]);
                let moment = cross(other.xyz, force);
                for (var k = 0u; k < 3u; k += 1u) {
                    image[6u * r + k] = force[k];
                    image[6u * r + 3u + k] = moment[k] + other.w * couplings[at + 3u + k];
                }
            }
            // M_a^T of that, column by column.
            for (var k = 0u; k < 6u; k += 1u) {
                let force = vec3<f32>(image[k], image[6u + k], image[12u + k]);
                let moment = cross(own.xyz, force)
                    + own.w * vec3<f32>(image[18u + k], image[24u + k], image[30u + k]);
                for (var r = 0u; r < 3u; r += 1u) {
                    total[6u * r + k] += force[r];
                    total[6u * (r + 3u) + k] += moment[r];
                    if part.both == 1u {
                        total[6u * k + r] += force[r];
                        total[6u * k + 3u + r] += moment[r];
                    }
                }
            }
        }
        for (var k = 0u; k < 36u; k += 1u) {
            couplings[36u * (params.first + t) + k] = total[k];
        }
    }
}
