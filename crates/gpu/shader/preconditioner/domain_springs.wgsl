// Parts: linear, groups.
//
// What springs add to the matrices of domains, on and above the diagonal: sums over chunks of the springs
// that touch a domain, one workgroup per chunk.

struct Params {
    chunks: u32,
    // Where the chunks begin, in words.
    first: u32,
    quantum: f32,
}

// Springs of a domain: their places in the list, the slots of a group of its level, its first group and the
// frame of that.
struct Chunk {
    begin: u32,
    end: u32,
    width: u32,
    group: u32,
    frame: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> springs: array<Spring>;
// Where the chunks of each domain begin, then the chunks, then springs.
@group(0) @binding(2) var<storage, read> touching: array<u32>;
@group(0) @binding(3) var<storage, read> places: array<u32>;
@group(0) @binding(4) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(5) var<storage, read> frames: array<Frame>;
@group(0) @binding(6) var<storage, read_write> pressed: array<f32>;

// Springs that the threads look up at once.
const BATCH: u32 = 32u;

// Of each spring its Hessian, and of each of its nodes the group in the domain, 8 without one, the weight and
// the arm.
var<workgroup> hessians: array<mat3x3<f32>, 32>;
var<workgroup> groups: array<u32, 128>;
var<workgroup> arms: array<vec4<f32>, 128>;

fn look_up(chunk: Chunk, spring: Spring, k: u32, at: u32) {
    let node = spring.nodes[k];
    var group = 8u;
    if spring.weights[k] != 0.0 && places[node] != NONE {
        group = min(places[node] / chunk.width - chunk.group, 8u);
    }
    groups[at] = group;
    if group < 8u {
        let frame = frames[chunk.frame + group];
        let arm = between(frame.center, positions[node].xyz, params.quantum) / frame.size;
        arms[at] = vec4<f32>(arm, spring.weights[k]);
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
    for (var c = group.x; c < params.chunks; c += MOST_WORKGROUPS) {
        let at = params.first + 5u * c;
        let chunk = Chunk(touching[at], touching[at + 1u], touching[at + 2u], touching[at + 3u], touching[at + 4u]);
        var shifts: mat3x3<f32>;
        var spins: mat3x3<f32>;
        var turned_shifts: mat3x3<f32>;
        var turned_spins: mat3x3<f32>;
        for (var begin = chunk.begin; begin < chunk.end; begin += BATCH) {
            let count = min(BATCH, chunk.end - begin);
            workgroupBarrier();
            for (var k = t; k < 4u * count; k += 64u) {
                let spring = springs[touching[begin + k / 4u]];
                look_up(chunk, spring, k % 4u, k);
                if k % 4u == 0u {
                    hessians[k / 4u] =
                        mat3x3<f32>(spring.hessian[0].xyz, spring.hessian[1].xyz, spring.hessian[2].xyz);
                }
            }
            workgroupBarrier();
            for (var s = 0u; s < count && a <= b; s += 1u) {
                for (var m = 4u * s; m < 4u * s + 4u; m += 1u) {
                    if groups[m] != a {
                        continue;
                    }
                    for (var n = 4u * s; n < 4u * s + 4u; n += 1u) {
                        if groups[n] != b {
                            continue;
                        }
                        let shift = hessians[s] * (arms[m].w * arms[n].w);
                        let spin = times_spin(shift, arms[n].xyz);
                        shifts += shift;
                        spins += spin;
                        turned_shifts += moments(arms[m].xyz, shift);
                        turned_spins += moments(arms[m].xyz, spin);
                    }
                }
            }
        }
        if a <= b {
            for (var r = 0u; r < 3u; r += 1u) {
                for (var k = 0u; k < 3u; k += 1u) {
                    let upper = DOMAIN_WORDS * c + 48u * (6u * a + r) + 6u * b + k;
                    pressed[upper] = shifts[k][r];
                    pressed[upper + 3u] = spins[k][r];
                    pressed[upper + 144u] = turned_shifts[k][r];
                    pressed[upper + 147u] = turned_spins[k][r];
                }
            }
        }
    }
}
