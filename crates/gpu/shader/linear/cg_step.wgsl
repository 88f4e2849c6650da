// Parts: linear, sum, two_sums, rigid.
//
// A step of conjugate gradients along the direction p with the image q, and the fine part of the
// preconditioner: block-Jacobi, and rigid motions of the groups of each patch. See linear/patches.rs. One
// workgroup per four patches, which go on with strides.
//
// z overwrites q. The squared norm r . M r is summed level by level: r . D^-1 r + sum f . A^-1 f, with the
// forces f on the rigid motions of a level and the matrix A of a domain.

struct Params {
    nodes: u32,
    patches: u32,
    // Patches with groups come first.
    grouped: u32,
    // 1 at the start: p is the residual then, and nothing is stepped. Nothing is done unless it is moving.
    start: u32,
    workgroups: u32,
    curvatures: u32,
    // Partial sums of the squared norm: their number, and where the present ones and the next ones begin.
    norms: u32,
    present: u32,
    next: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> slots: array<PatchSlot>;
// Inverses of the domains of patches.
@group(0) @binding(2) var<storage, read> domains: array<f32>;
@group(0) @binding(3) var<storage, read> direction: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> image: array<vec4<f32>>;
// Of each node x, then of each node r.
@group(0) @binding(5) var<storage, read_write> solution: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> forces: array<f32>;
@group(0) @binding(7) var<storage, read_write> sums: array<f32>;
@group(0) @binding(8) var<storage, read_write> progress: Progress;

var<workgroup> decision: u32;
// Of each slot of four patches the force and its moment; of each group both, and its motion.
var<workgroup> slot_forces: array<f32, 1536>;
var<workgroup> group_forces: array<f32, 192>;
var<workgroup> motions: array<f32, 192>;

fn is_positive(number: f32) -> bool {
    return number > 0.0 && (bitcast<u32>(number) & 0x7f800000u) != 0x7f800000u;
}

fn solve(slot: PatchSlot, r: vec3<f32>) -> vec3<f32> {
    let f = slot.factors;
    let y = r.y - f[0] * r.x;
    let z = f[5] * (r.z - f[1] * r.x - f[2] * y);
    let y_solved = f[4] * y - f[2] * z;
    return vec3<f32>(f[3] * r.x - f[0] * y_solved - f[1] * z, y_solved, z);
}

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let t = local.x;
    var step = 0.0;
    var norm = 0.0;
    var curvature = 1.0;
    if params.start == 0u {
        let both = two_sums_of_parts(t, vec2<u32>(params.present, 0u), vec2<u32>(params.norms, params.curvatures));
        norm = both.x;
        curvature = both.y;
    }
    if t == 0u {
        let goes_on = norm > progress.goal && is_positive(norm) && is_positive(curvature);
        let is_moving = atomicLoad(&progress.moving) == 1u;
        decision = select(0u, 1u, is_moving && (goes_on || params.start == 1u));
    }
    if workgroupUniformLoad(&decision) == 0u {
        if t == 0u {
            sums[params.next + group.x] = sums[params.present + group.x];
            atomicStore(&progress.moving, 0u);
        }
        return;
    }
    if params.start == 0u {
        step = norm / curvature;
    }
    // 64 threads per patch, one per slot.
    let q = t / 64u;
    let slot_index = t % 64u;
    var squares = 0.0;
    for (var first = 4u * group.x; first < params.patches; first += 4u * params.workgroups) {
        let k = first + q;
        var slot: PatchSlot;
        slot.node = NONE;
        if k < params.patches {
            slot = slots[64u * k + slot_index];
        }
        let i = slot.node;
        var r = vec3<f32>(0.0);
        if i != NONE {
            let p = direction[i].xyz;
            if params.start == 1u {
                r = p;
                solution[i] = vec4<f32>(0.0);
            } else {
                r = solution[params.nodes + i].xyz - step * image[i].xyz;
                solution[i] = vec4<f32>(solution[i].xyz + step * p, 0.0);
            }
            solution[params.nodes + i] = vec4<f32>(r, 0.0);
        }
        var z = solve(slot, r);
        squares += dot(r, z);
        if first < params.grouped {
            let is_grouped = k < params.grouped;
            let arm = vec3<f32>(slot.arm[0], slot.arm[1], slot.arm[2]);
            let moment = cross(arm, r);
            if t % 8u < 2u {
                child_links[4u * (t / 8u) + 2u * (t % 8u)] = slot.link[0];
                child_links[4u * (t / 8u) + 2u * (t % 8u) + 1u] = slot.link[1];
            }
            for (var c = 0u; c < 3u; c += 1u) {
                slot_forces[6u * t + c] = r[c];
                slot_forces[6u * t + 3u + c] = moment[c];
            }
            workgroupBarrier();
            // Six numbers of each group, those of the patches one after the other.
            let at = 48u * q + slot_index;
            if slot_index < 48u {
                var f = 0.0;
                for (var m = 0u; m < 8u; m += 1u) {
                    f += slot_forces[6u * (8u * (at / 6u) + m) + at % 6u];
                }
                group_forces[at] = f;
            }
            workgroupBarrier();
            if slot_index < 48u && is_grouped {
                var motion = 0.0;
                for (var m = 0u; m < 48u; m += 1u) {
                    motion += domains[DOMAIN_WORDS * k + 48u * m + slot_index] * group_forces[48u * q + m];
                }
                motions[at] = motion;
                squares += motion * group_forces[at];
            }
            // The force on the rigid motion of the patch.
            if slot_index < 6u && is_grouped {
                forces[6u * k + slot_index] = force_on_parent(q, slot_index);
            }
            workgroupBarrier();
            if is_grouped {
                let g = 6u * (t / 8u);
                let spin = vec3<f32>(motions[g + 3u], motions[g + 4u], motions[g + 5u]);
                z += vec3<f32>(motions[g], motions[g + 1u], motions[g + 2u]) + cross(spin, arm);
            }
        }
        if i != NONE {
            image[i] = vec4<f32>(z, 0.0);
        }
    }
    let sum = sum_of_threads(t, squares);
    if t == 0u {
        sums[params.next + group.x] = sum;
    }
}
