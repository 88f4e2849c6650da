// Parts: linear, groups, eigen.
//
// Centers and sizes of groups of nodes, or of groups of eight groups; arms of nodes from the center of their
// group, and links from a group to the one that it is part of.

const ORDER: u32 = 3u;

// Spins about axes with at most about this share of the largest moment of inertia are held.
const SMALLEST_MOMENT: f32 = 1e-4;

struct Params {
    count: u32,
    // The first frame to write, and that of the parts; slots of a group, or 0 for groups of groups.
    first: u32,
    first_part: u32,
    parts: u32,
    width: u32,
    // The first domain among those of coarse levels.
    first_domain: u32,
    quantum: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read_write> slots: array<PatchSlot>;
@group(0) @binding(3) var<storage, read_write> frames: array<Frame>;
@group(0) @binding(4) var<storage, read_write> links: array<vec4<f32>>;

// For eigen.wgsl: 1 for eigenvalues that are not positive.
fn filtered(value: f32) -> f32 {
    return select(0.0, 1.0, value <= 0.0);
}

fn moment_of(way: vec3<f32>) -> array<f32, 6> {
    return array<f32, 6>(
        way.x * way.x, way.x * way.y, way.x * way.z, way.y * way.y, way.y * way.z, way.z * way.z
    );
}

// The axes about which spins are held: the moments of inertia tr(m) I - m about them are small.
fn held_by(m: array<f32, 6>) -> array<f32, 6> {
    let trace = m[0] + m[3] + m[5];
    let shift = (1.0 - SMALLEST_MOMENT) * trace;
    let matrix = array<f32, 9>(
        shift - m[0], -m[1], -m[2],
        -m[1], shift - m[3], -m[4],
        -m[2], -m[4], shift - m[5],
    );
    var held: array<f32, 6>;
    if !is_definite(matrix, trace) {
        let sum = filtered_matrix(matrix);
        held = array<f32, 6>(sum[0], sum[1], sum[2], sum[4], sum[5], sum[8]);
    }
    return held;
}

fn of_nodes(g: u32) -> Frame {
    var frame: Frame;
    var count = 0.0;
    var sum = vec3<f32>(0.0);
    let first = slots[params.width * g].node;
    // Slots are filled from the front of each group of eight on.
    if first == NONE {
        return frame;
    }
    let origin = positions[first].xyz;
    for (var s = params.width * g; s < params.width * (g + 1u); s += 1u) {
        let node = slots[s].node;
        if node != NONE {
            sum += vec3<f32>(positions[node].xyz - origin);
            count += 1.0;
        }
    }
    frame.center = origin + vec3<i32>(sum / count);
    for (var s = params.width * g; s < params.width * (g + 1u); s += 1u) {
        let node = slots[s].node;
        if node != NONE {
            frame.size = max(frame.size, length(between(frame.center, positions[node].xyz, params.quantum)));
        }
    }
    if frame.size <= params.quantum {
        frame.size = 1.0;
    }
    for (var s = params.width * g; s < params.width * (g + 1u); s += 1u) {
        let node = slots[s].node;
        if node != NONE {
            let arm = between(frame.center, positions[node].xyz, params.quantum) / frame.size;
            let moment = moment_of(arm);
            for (var k = 0u; k < 6u; k += 1u) {
                frame.moment[k] += moment[k] / count;
            }
            if params.width == 8u {
                slots[s].arm = array<f32, 3>(arm.x, arm.y, arm.z);
            }
        }
    }
    frame.held = held_by(frame.moment);
    return frame;
}

fn of_groups(g: u32) -> Frame {
    var frame: Frame;
    let count = min(8u, params.parts - 8u * g);
    let first = params.first_part + 8u * g;
    let origin = frames[first].center;
    var sum = vec3<f32>(0.0);
    for (var m = 0u; m < count; m += 1u) {
        sum += vec3<f32>(frames[first + m].center - origin);
    }
    frame.center = origin + vec3<i32>(sum / f32(count));
    for (var m = 0u; m < count; m += 1u) {
        let part = frames[first + m];
        frame.size = max(frame.size, length(between(frame.center, part.center, params.quantum)) + part.size);
    }
    for (var m = 0u; m < count; m += 1u) {
        let part = frames[first + m];
        let moment = moment_of(between(frame.center, part.center, params.quantum) / frame.size);
        let ratio = part.size / frame.size;
        for (var k = 0u; k < 6u; k += 1u) {
            frame.moment[k] += (moment[k] + ratio * ratio * part.moment[k]) / f32(count);
        }
    }
    frame.held = held_by(frame.moment);
    return frame;
}

// The link of part m of group g, whose frame is `whole`; zero for one that is empty or missing.
fn link_of(g: u32, m: u32, whole: Frame) -> vec4<f32> {
    if 8u * g + m < params.parts {
        let part = frames[params.first_part + 8u * g + m];
        if part.size > 0.0 {
            return vec4<f32>(between(whole.center, part.center, params.quantum), part.size) / whole.size;
        }
    }
    return vec4<f32>(0.0);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var g = id.x; g < params.count; g += 64u * MOST_WORKGROUPS) {
        var frame: Frame;
        if params.width > 0u {
            frame = of_nodes(g);
        } else {
            frame = of_groups(g);
        }
        frames[params.first + g] = frame;
        for (var m = 0u; m < 8u && params.parts > 0u; m += 1u) {
            let link = link_of(g, m, frame);
            if params.width > 0u {
                slots[64u * g + 8u * m].link = array<f32, 2>(link.x, link.y);
                slots[64u * g + 8u * m + 1u].link = array<f32, 2>(link.z, link.w);
            } else {
                links[8u * (params.first_domain + g) + m] = link;
            }
        }
    }
}
