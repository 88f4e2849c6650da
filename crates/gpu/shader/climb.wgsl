// A coarse level of the preconditioner: the motions of eight groups of a domain under the forces on them, and the force on
// the group that they form. One workgroup per domain, which go on with strides.

struct Params {
    // Groups of the level, and the places of the first of them and of the first of their parents.
    groups: u32,
    first: u32,
    first_parent: u32,
    // The first domain among those of coarse levels.
    first_domain: u32,
    domains: u32,
    workgroups: u32,
    // Where the partial sums of the squared norm begin: the present ones and the next ones.
    present: u32,
    next: u32,
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
var<workgroup> group_forces: array<f32, 48>;

@compute @workgroup_size(64)
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
        let child = 8u * k + t / 6u;
        let place = 6u * (params.first + child) + t % 6u;
        let parent = params.first_parent + k;
        let domain = params.first_domain + k;
        workgroupBarrier();
        if t < 48u {
            group_forces[t] = 0.0;
            if child < params.groups {
                group_forces[t] = forces[place];
            }
        }
        if t < 8u {
            let link = links[8u * domain + t];
            for (var c = 0u; c < 4u; c += 1u) {
                child_links[4u * t + c] = link[c];
            }
        }
        workgroupBarrier();
        if t < 48u && child < params.groups {
            var motion = 0.0;
            for (var m = 0u; m < 48u; m += 1u) {
                motion += coarse[DOMAIN_WORDS * domain + 48u * m + t] * group_forces[m];
            }
            group_motions[place] = motion;
            squares += motion * group_forces[t];
        }
        if t < 6u {
            forces[6u * parent + t] = force_on_parent(t);
        }
    }
    let sum = sum_of_threads(t, squares);
    if t == 0u {
        sums[params.next + group.x] = sum;
    }
}
