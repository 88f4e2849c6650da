// Parts: groups.
//
// Galerkin blocks of pairs of groups of groups: sums of those of their parts, with the motions of a part by
// that of its group.

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
// Of each pair of this and the coarser levels: its first part, the number of parts, the frames of both
// groups.
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

// Parts that the threads look up at once: the place of their block, whether its transpose counts, and both
// links.
const BATCH: u32 = 64u;

var<workgroup> blocks: array<vec2<u32>, 64>;
var<workgroup> own_links: array<vec4<f32>, 64>;
var<workgroup> other_links: array<vec4<f32>, 64>;

// An entry of C M_b: shifts as they are, spins turn the way and shrink.
fn image(at: u32, other: vec4<f32>, r: u32, k: u32) -> f32 {
    let row = at + 6u * r;
    if k < 3u {
        return couplings[row + k];
    }
    let moment = cross(other.xyz, vec3<f32>(couplings[row], couplings[row + 1u], couplings[row + 2u]));
    return moment[k - 3u] + other.w * couplings[row + k];
}

// An entry of M_a^T C M_b.
fn product(part: u32, r: u32, k: u32) -> f32 {
    let at = blocks[part].x;
    let other = other_links[part];
    if r < 3u {
        return image(at, other, r, k);
    }
    let force = vec3<f32>(image(at, other, 0u, k), image(at, other, 1u, k), image(at, other, 2u, k));
    let own = own_links[part];
    return cross(own.xyz, force)[r - 3u] + own.w * image(at, other, r, k);
}

// A workgroup per pair, and a thread per entry of its block.
@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let t = local.x;
    let r = t / 6u;
    let k = t % 6u;
    for (var pair = group.x; pair < params.pairs; pair += MOST_WORKGROUPS) {
        let sum = sums[params.first + pair];
        var total = 0.0;
        for (var begin = 0u; begin < sum.y; begin += BATCH) {
            let count = min(BATCH, sum.y - begin);
            workgroupBarrier();
            if t < count {
                let part = parts[sum.x + begin + t];
                blocks[t] = vec2<u32>(36u * part.block, part.both);
                own_links[t] = link(sum.z, part.a);
                other_links[t] = link(sum.w, part.b);
            }
            workgroupBarrier();
            for (var part = 0u; part < count && t < 36u; part += 1u) {
                if blocks[part].y == 0u {
                    total += product(part, r, k);
                } else {
                    total += product(part, max(r, k), min(r, k));
                    total += product(part, min(r, k), max(r, k));
                }
            }
        }
        if t < 36u {
            couplings[36u * (params.first + pair) + t] = total;
        }
    }
}
