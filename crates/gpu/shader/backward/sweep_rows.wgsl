// Parts: types.
//
// Sweeps over the contact rows of some buckets, which share no vertex that moves (bricks.rs). A workgroup
// takes a bucket at a time, goes over it as often as it is told, and waits between its colors: rows of one
// color share no vertex that moves. Vertices that do not move are read by many and written by none.
//
// The rows without a color come last, all at once, with masses that are split (color_rows.wgsl). What they
// move a vertex by is added as integers, in a unit that has room for all of them, so that the sums do not
// depend on their order.
//
// Most buckets have no more rows than a workgroup has threads. Each thread then keeps a row, and the
// workgroup the displacements of all vertices in its own memory, in the slots of a hash table: between colors
// nothing is read from the memory of the device, which takes ten times as long as waiting. Other buckets are
// swept there. The arithmetic is the same.
//
// First all threads look whether any row would change. Where none would, because nothing presses or because
// sweeps have come to their end in single precision, as in most buckets, a sweep changes nothing and is left
// out.

struct Params {
    // Buckets of the dispatch.
    first: u32,
    end: u32,
    // 1: multipliers are only applied, they do not change.
    only_apply: u32,
    // Sweeps over each bucket.
    sweeps: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> order: array<u32>;
@group(0) @binding(2) var<storage, read> buckets: array<Bucket>;
// Where each color of a bucket ends in the order, from the place where the bucket begins.
@group(0) @binding(3) var<storage, read> color_ends: array<u32>;
@group(0) @binding(4) var<storage, read_write> rows: array<Row>;
@group(0) @binding(5) var<storage, read_write> displacements: array<vec4<f32>>;
// By how much rows without a color move each vertex, and whether any does; zeros between two uses.
@group(0) @binding(6) var<storage, read_write> pushes: array<atomic<i32>>;

const THREADS: u32 = 256u;
const SLOTS: u32 = 512u;
const EMPTY: u32 = 0xffffffffu;

// The vertex of each slot, and its displacement.
var<workgroup> keys: array<atomic<u32>, 512>;
var<workgroup> moved: array<vec4<f32>, 512>;
// Whether the bucket needs more slots than there are, counted and as all threads read it.
var<workgroup> overflow: atomic<u32>;
var<workgroup> is_full: u32;
// Whether a row of the bucket changes, likewise.
var<workgroup> changes: atomic<u32>;
var<workgroup> is_changing: u32;
// Bits of the largest component by which a row without a color moves a vertex, likewise.
var<workgroup> largest: atomic<u32>;
var<workgroup> largest_of_all: u32;

// The row that is relaxed. In place of vertices it has slots if `is_kept` is true.
var<private> row: Row;
var<private> is_kept: bool;

fn displacement(v: u32) -> vec4<f32> {
    if is_kept {
        return moved[v];
    }
    return displacements[v];
}

// Displacement of side a less that of side b, at the closest points.
fn relative_displacement() -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < 4u; k += 1u) {
        sum += row.weights[k] * displacement(row.vertices[k]).xyz;
    }
    return sum;
}

// Moves the vertices of the row by a change of its multipliers.
fn push(change: vec3<f32>) {
    for (var k = 0u; k < 4u; k += 1u) {
        let v = row.vertices[k];
        let old = displacement(v);
        let step = old.w * row.weights[k];
        if step != 0.0 {
            let pushed = vec4<f32>(old.xyz + change * step, old.w);
            if is_kept {
                moved[v] = pushed;
            } else {
                displacements[v] = pushed;
            }
        }
    }
}

// The multiplier of the row once it is relaxed.
fn pressed() -> f32 {
    let value = row.value + dot(row.normal, relative_displacement());
    return max(row.multiplier - value * row.inverse_diagonal, 0.0);
}

// The multiplier of its friction then, where the multiplier of the row is that.
fn rubbed(multiplier: f32) -> vec3<f32> {
    if row.coefficient <= 0.0 || (multiplier <= 0.0 && all(row.friction == vec3<f32>(0.0))) {
        return row.friction;
    }
    // The motion along the normal is taken away once more, because the multiplier must stay across it.
    let slipped = row.slip + relative_displacement();
    let slip = slipped - row.normal * dot(row.normal, slipped);
    let wanted = row.friction - slip * row.inverse_diagonal;
    let size = sqrt(dot(wanted, wanted));
    let largest = row.coefficient * multiplier;
    if size > largest {
        return wanted * (largest / size);
    }
    return wanted;
}

// Whether the row would change if it were relaxed, or moves something if its multipliers are applied.
fn would_change() -> bool {
    if row.inverse_diagonal == 0.0 {
        return false;
    }
    if params.only_apply != 0u {
        return row.multiplier != 0.0 || any(row.friction != vec3<f32>(0.0));
    }
    let multiplier = pressed();
    return multiplier != row.multiplier || any(rubbed(multiplier) != row.friction);
}

fn relax() {
    if row.inverse_diagonal == 0.0 {
        return;
    }
    if params.only_apply != 0u {
        push(row.normal * row.multiplier + row.friction);
        return;
    }
    let multiplier = pressed();
    push(row.normal * (multiplier - row.multiplier));
    row.multiplier = multiplier;
    let friction = rubbed(multiplier);
    if any(friction != row.friction) {
        push(friction - row.friction);
        row.friction = friction;
    }
}

fn store(r: u32) {
    if params.only_apply == 0u {
        rows[r].multiplier = row.multiplier;
        rows[r].friction = row.friction;
    }
}

// Relaxes a row in the memory of the device.
fn relax_there(r: u32) {
    row = rows[r];
    relax();
    store(r);
}

// Relaxes the row with all other vertices where they are, and returns what it pushes its vertices by.
fn relax_alone() -> vec3<f32> {
    if row.inverse_diagonal == 0.0 {
        return vec3<f32>(0.0);
    }
    if params.only_apply != 0u {
        return row.normal * row.multiplier + row.friction;
    }
    let multiplier = pressed();
    let friction = rubbed(multiplier);
    let change = row.normal * (multiplier - row.multiplier) + (friction - row.friction);
    row.multiplier = multiplier;
    row.friction = friction;
    return change;
}

// Relaxes the rows of a bucket from a place on, all at once. All threads call it.
fn relax_together(first: u32, bucket: Bucket, thread: u32) {
    if thread == 0u {
        atomicStore(&largest, 0u);
    }
    workgroupBarrier();
    var own = 0.0;
    for (var there = first + thread; there < bucket.end; there += THREADS) {
        row = rows[order[there]];
        let change = abs(relax_alone());
        for (var k = 0u; k < 4u; k += 1u) {
            let share = abs(displacements[row.vertices[k]].w * row.weights[k]);
            own = max(own, share * max(change.x, max(change.y, change.z)));
        }
    }
    atomicMax(&largest, bitcast<u32>(own));
    workgroupBarrier();
    if thread == 0u {
        largest_of_all = atomicLoad(&largest);
    }
    let bits = bitcast<u32>(bitcast<f32>(workgroupUniformLoad(&largest_of_all)) * f32(bucket.most));
    // Nothing moves, or what moves is no number.
    if bits == 0u || bits >= 0x7f000000u {
        return;
    }
    // A sum is below 2^30 units.
    let exponent = max((bits >> 23u) + 1u, 31u) - 30u;
    let unit = bitcast<f32>(exponent << 23u);
    let inverse = bitcast<f32>((254u - exponent) << 23u);
    for (var there = first + thread; there < bucket.end; there += THREADS) {
        let r = order[there];
        row = rows[r];
        let change = relax_alone() * inverse;
        for (var k = 0u; k < 4u; k += 1u) {
            let v = row.vertices[k];
            let share = displacements[v].w * row.weights[k];
            if share != 0.0 {
                let push = vec3<i32>(round(share * change));
                for (var c = 0u; c < 3u; c += 1u) {
                    atomicAdd(&pushes[4u * v + c], push[c]);
                }
                atomicStore(&pushes[4u * v + 3u], 1i);
            }
        }
        store(r);
    }
    storageBarrier();
    workgroupBarrier();
    for (var there = first + thread; there < bucket.end; there += THREADS) {
        let vertices = rows[order[there]].vertices;
        for (var k = 0u; k < 4u; k += 1u) {
            let v = vertices[k];
            // One thread has the vertex.
            if atomicExchange(&pushes[4u * v + 3u], 0i) != 0i {
                var push = vec3<f32>(0.0);
                for (var c = 0u; c < 3u; c += 1u) {
                    push[c] = f32(atomicExchange(&pushes[4u * v + c], 0i));
                }
                displacements[v] = vec4<f32>(displacements[v].xyz + push * unit, displacements[v].w);
            }
        }
    }
}

// The slot of a vertex, which takes the first free one from its hash on; SLOTS if all are taken.
fn slot_of(v: u32) -> u32 {
    var slot = (v * 0x9e3779b1u) >> 23u;
    var tries = 0u;
    while tries < SLOTS {
        let found = atomicCompareExchangeWeak(&keys[slot], EMPTY, v);
        if found.exchanged || found.old_value == v {
            return slot;
        }
        // A weak exchange may fail at an empty slot.
        if found.old_value != EMPTY {
            slot = (slot + 1u) % SLOTS;
            tries += 1u;
        }
    }
    return SLOTS;
}

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    for (var k = params.first + group.x; k < params.end; k += MOST_WORKGROUPS) {
        let bucket = buckets[k];
        if bucket.first == bucket.end {
            continue;
        }
        let place = bucket.first + local.x;
        let has_row = place < bucket.end;
        var colored_end = bucket.first;
        if bucket.colors > 0u {
            colored_end = color_ends[bucket.first + bucket.colors - 1u];
        }
        is_kept = bucket.end - bucket.first <= THREADS && colored_end == bucket.end;
        for (var s = local.x; s < SLOTS; s += THREADS) {
            atomicStore(&keys[s], EMPTY);
        }
        if local.x == 0u {
            atomicStore(&overflow, 0u);
            atomicStore(&changes, 0u);
        }
        workgroupBarrier();
        var r = 0u;
        if is_kept && has_row {
            r = order[place];
            row = rows[r];
            for (var c = 0u; c < 4u; c += 1u) {
                let slot = slot_of(row.vertices[c]);
                if slot == SLOTS {
                    atomicStore(&overflow, 1u);
                }
                row.vertices[c] = slot;
            }
        }
        workgroupBarrier();
        if local.x == 0u {
            is_full = atomicLoad(&overflow);
        }
        if workgroupUniformLoad(&is_full) != 0u {
            is_kept = false;
        }
        if is_kept {
            for (var s = local.x; s < SLOTS; s += THREADS) {
                let v = atomicLoad(&keys[s]);
                if v != EMPTY {
                    moved[s] = displacements[v];
                }
            }
        }
        workgroupBarrier();
        var any_changes = false;
        if is_kept {
            any_changes = has_row && would_change();
        } else {
            for (var there = place; there < bucket.end && !any_changes; there += THREADS) {
                row = rows[order[there]];
                any_changes = would_change();
            }
        }
        if any_changes {
            atomicStore(&changes, 1u);
        }
        workgroupBarrier();
        if local.x == 0u {
            is_changing = atomicLoad(&changes);
        }
        if workgroupUniformLoad(&is_changing) == 0u {
            continue;
        }
        for (var sweep = 0u; sweep < params.sweeps; sweep += 1u) {
            var start = bucket.first;
            for (var color = 0u; color < bucket.colors; color += 1u) {
                if is_kept {
                    if has_row && row.color == color {
                        relax();
                    }
                } else {
                    let end = color_ends[bucket.first + color];
                    for (var there = start + local.x; there < end; there += THREADS) {
                        relax_there(order[there]);
                    }
                    start = end;
                }
                storageBarrier();
                workgroupBarrier();
            }
            if colored_end < bucket.end {
                relax_together(colored_end, bucket, local.x);
            }
            storageBarrier();
            workgroupBarrier();
        }
        if is_kept {
            for (var s = local.x; s < SLOTS; s += THREADS) {
                let v = atomicLoad(&keys[s]);
                if v != EMPTY && moved[s].w > 0.0 {
                    displacements[v] = moved[s];
                }
            }
            if has_row {
                store(r);
            }
        }
        workgroupBarrier();
    }
}
