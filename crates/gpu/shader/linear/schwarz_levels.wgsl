// Parts: linear, sum, rigid.
//
// Up to four coarse levels of the preconditioner at once: the motions of the eight groups of each domain
// under the forces on them, and the force on the group that they form. The force on a group is the sum of
// those on its parts of the first of these levels, 32 threads per group, so no level waits for the one below.
// One workgroup per domain, which go on with strides.

struct Params {
    // Groups of each of these levels; 0 beyond the last one.
    groups: vec4<u32>,
    // Places of the first groups of these levels; that of the first parent of the last one is the next, or
    // `parents`.
    firsts: vec4<u32>,
    // The first domains of these levels among those of all coarse levels; beyond the last one all bits.
    first_domains: vec4<u32>,
    domains: u32,
    workgroups: u32,
    // Where the partial sums of the squared norm begin: the present ones and the next ones.
    present: u32,
    next: u32,
    // Place of the first parent of the fourth level.
    parents: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
// Inverses of the domains, and links of their children.
@group(0) @binding(1) var<storage, read> coarse: array<f32>;
@group(0) @binding(2) var<storage, read> links: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> forces: array<f32>;
@group(0) @binding(4) var<storage, read_write> group_motions: array<f32>;
@group(0) @binding(5) var<storage, read_write> sums: array<f32>;
@group(0) @binding(6) var<storage, read_write> progress: Progress;

var<workgroup> is_moving: u32;
// What each thread has summed: the force and the torque on its group.
var<workgroup> lane_forces: array<array<f32, 6>, 256>;
var<workgroup> group_forces: array<f32, 48>;

// Threads per group.
const LANES: u32 = 32u;

// Level of a domain above the first one.
fn rise_of(domain: u32) -> u32 {
    let firsts = params.first_domains.yzw;
    let above = select(vec3<u32>(0u), vec3<u32>(1u), vec3<u32>(domain) >= firsts);
    return above.x + above.y + above.z;
}

// Place of the first parent of the groups of a level.
fn first_parent(rise: u32) -> u32 {
    return select(params.firsts[(rise + 1u) % 4u], params.parents, rise == 3u);
}

// Threads that have parts of a group: one part each up to the second level, beyond it eight that follow each
// other.
fn lanes_of(rise: u32) -> u32 {
    return select(min(1u << (3u * rise), 8u), LANES, rise == 3u);
}

struct Wrench {
    force: vec3<f32>,
    torque: vec3<f32>,
}

// The force on a part of the first of these levels.
fn force_on(part: u32) -> Wrench {
    let at = 6u * (params.firsts.x + part);
    return Wrench(vec3<f32>(forces[at], forces[at + 1u], forces[at + 2u]), vec3<f32>(forces[at + 3u], forces[at + 4u], forces[at + 5u]));
}

// The torque on the parent of a group of that level.
fn lifted(on_group: Wrench, level: u32, group: u32) -> vec3<f32> {
    let link = links[8u * params.first_domains[level] + group];
    return link.w * on_group.torque + cross(link.xyz, on_group.force);
}

// The share of thread `lane` in the force on a group `rise` levels above the first one.
fn sum_of_lane(group: u32, rise: u32, lane: u32) -> array<f32, 6> {
    var sum = Wrench();
    if rise < 2u {
        let part = (group << (3u * rise)) + lane;
        if lane < lanes_of(rise) && part < params.groups.x {
            sum = force_on(part);
            if rise == 1u {
                sum.torque = lifted(sum, 0u, part);
            }
        }
    } else {
        let shift = 3u * (rise - 1u);
        let end = min((group + 1u) << shift, (params.groups.x + 7u) / 8u);
        for (var eight = (group << shift) + lane; eight < end; eight += LANES) {
            var of_eight = Wrench();
            for (var m = 0u; m < 8u; m += 1u) {
                let part = 8u * eight + m;
                if part < params.groups.x {
                    let own = force_on(part);
                    of_eight.force += own.force;
                    of_eight.torque += lifted(own, 0u, part);
                }
            }
            for (var level = 1u; level < rise; level += 1u) {
                of_eight.torque = lifted(of_eight, level, eight >> (3u * (level - 1u)));
            }
            sum.force += of_eight.force;
            sum.torque += of_eight.torque;
        }
    }
    let force = sum.force;
    let torque = sum.torque;
    return array<f32, 6>(force.x, force.y, force.z, torque.x, torque.y, torque.z);
}

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let t = local.x;
    if t == 0u {
        is_moving = atomicLoad(&progress.moving);
    }
    if workgroupUniformLoad(&is_moving) == 0u {
        if t == 0u {
            sums[params.next + group.x] = sums[params.present + group.x];
        }
        return;
    }
    var squares = 0.0;
    for (var k = group.x; k < params.domains; k += params.workgroups) {
        let domain = params.first_domains.x + k;
        let rise = rise_of(domain);
        let parent = domain - params.first_domains[rise];
        workgroupBarrier();
        lane_forces[t] = sum_of_lane(8u * parent + t / LANES, rise, t % LANES);
        if t < 8u {
            let link = links[8u * domain + t];
            for (var c = 0u; c < 4u; c += 1u) {
                child_links[4u * t + c] = link[c];
            }
        }
        workgroupBarrier();
        if t < 48u {
            var sum = 0.0;
            for (var lane = 0u; lane < lanes_of(rise); lane += 1u) {
                sum += lane_forces[LANES * (t / 6u) + lane][t % 6u];
            }
            group_forces[t] = sum;
        }
        workgroupBarrier();
        let child = 8u * parent + t / 6u;
        if t < 48u && child < params.groups[rise] {
            var motion = 0.0;
            for (var m = 0u; m < 48u; m += 1u) {
                motion += coarse[DOMAIN_WORDS * domain + 48u * m + t] * group_forces[m];
            }
            group_motions[6u * (params.firsts[rise] + child) + t % 6u] = motion;
            squares += motion * group_forces[t];
        }
        if t < 6u {
            forces[6u * (first_parent(rise) + parent) + t] = force_on_parent(0u, t);
        }
    }
    let sum = sum_of_threads(t, squares);
    if t == 0u {
        sums[params.next + group.x] = sum;
    }
}
