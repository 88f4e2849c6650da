// Parts: linear, sum, two_sums.
//
// The next search direction p = z + (rz' / rz) p. The motions of the coarse levels are added to z here: each
// group of a patch moves with all groups above it. One workgroup per four patches, which go on with strides.

struct Params {
    patches: u32,
    grouped: u32,
    start: u32,
    workgroups: u32,
    // Coarse levels, and the place of the first group of each.
    levels: u32,
    norms: u32,
    present: u32,
    next: u32,
    firsts: array<vec4<u32>, 3>,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> slots: array<PatchSlot>;
// Of the children of domains of coarse levels.
@group(0) @binding(2) var<storage, read> links: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> group_motions: array<f32>;
@group(0) @binding(4) var<storage, read> image: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> direction: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> sums: array<f32>;
@group(0) @binding(7) var<storage, read_write> progress: Progress;

var<workgroup> is_moving: u32;
var<workgroup> shifts: array<vec3<f32>, 32>;
var<workgroup> spins: array<vec3<f32>, 32>;

fn first_of(level: u32) -> u32 {
    return params.firsts[level / 4u][level % 4u];
}

// Motion of group g of patch k, the q-th of this turn, with all groups above it.
fn find_motion(k: u32, q: u32, g: u32) {
    var shift = vec3<f32>(0.0);
    var spin = vec3<f32>(0.0);
    for (var level = params.levels; level > 0u; level -= 1u) {
        let index = k >> (3u * (level - 1u));
        if level < params.levels {
            let parent = first_of(level) - first_of(1u) + (index >> 3u);
            let link = links[8u * parent + (index & 7u)];
            shift += cross(spin, link.xyz);
            spin *= link.w;
        }
        let at = 6u * (first_of(level - 1u) + index);
        shift += vec3<f32>(group_motions[at], group_motions[at + 1u], group_motions[at + 2u]);
        spin += vec3<f32>(group_motions[at + 3u], group_motions[at + 4u], group_motions[at + 5u]);
    }
    let first = slots[64u * k + 8u * g].link;
    let second = slots[64u * k + 8u * g + 1u].link;
    shifts[8u * q + g] = shift + cross(spin, vec3<f32>(first[0], first[1], second[0]));
    spins[8u * q + g] = spin * second[1];
}

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let t = local.x;
    if t == 0u {
        is_moving = atomicLoad(&progress.moving);
    }
    if workgroupUniformLoad(&is_moving) == 0u {
        return;
    }
    var ratio = 0.0;
    if params.start == 0u {
        let both = two_sums_of_parts(t, vec2<u32>(params.present, params.next), vec2<u32>(params.norms));
        ratio = both.y / both.x;
        if group.x == 0u && t == 0u {
            atomicAdd(&progress.iterations, 1u);
        }
    }
    // 64 threads per patch, one per slot.
    let q = t / 64u;
    for (var first = 4u * group.x; first < params.patches; first += 4u * params.workgroups) {
        let k = first + q;
        var slot: PatchSlot;
        slot.node = NONE;
        if k < params.patches {
            slot = slots[64u * k + t % 64u];
        }
        let i = slot.node;
        var z = vec3<f32>(0.0);
        if i != NONE {
            z = image[i].xyz;
        }
        if first < params.grouped && params.levels > 0u {
            let is_grouped = k < params.grouped;
            workgroupBarrier();
            if t % 64u < 8u && is_grouped {
                find_motion(k, q, t % 64u);
            }
            workgroupBarrier();
            if is_grouped {
                let arm = vec3<f32>(slot.arm[0], slot.arm[1], slot.arm[2]);
                z += shifts[t / 8u] + cross(spins[t / 8u], arm);
            }
        }
        if i != NONE {
            if params.start == 0u {
                z += ratio * direction[i].xyz;
            }
            direction[i] = vec4<f32>(z, 0.0);
        }
    }
}
