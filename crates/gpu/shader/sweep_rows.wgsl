// A sweep over the contact rows of some buckets, which share no vertex that moves (bricks.rs). A workgroup takes a bucket at
// a time and waits between its colors: rows of one color share no vertex that moves. The rows without a color of their
// own come last, one after the other. Vertices that do not move are read by many and written by none.

struct Params {
    // Buckets of the dispatch.
    first: u32,
    end: u32,
    // 1: multipliers are only applied, they do not change.
    only_apply: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> order: array<u32>;
@group(0) @binding(2) var<storage, read> buckets: array<Bucket>;
// Where each color of a bucket ends in the order, from the place where the bucket begins.
@group(0) @binding(3) var<storage, read> color_ends: array<u32>;
@group(0) @binding(4) var<storage, read_write> rows: array<Row>;
@group(0) @binding(5) var<storage, read_write> displacements: array<vec4<f32>>;

fn relax(r: u32) {
    let row = rows[r];
    if row.inverse_diagonal == 0.0 {
        return;
    }
    if params.only_apply != 0u {
        push(row, row.normal * row.multiplier + row.friction);
        return;
    }
    let value = row.value + dot(row.normal, relative_displacement(row));
    let multiplier = max(row.multiplier - value * row.inverse_diagonal, 0.0);
    push(row, row.normal * (multiplier - row.multiplier));
    rows[r].multiplier = multiplier;
    let has_friction = row.coefficient > 0.0 && (multiplier > 0.0 || any(row.friction != vec3<f32>(0.0)));
    if has_friction {
        // The motion along the normal is taken away once more, because the multiplier must stay across it.
        let moved = row.slip + relative_displacement(row);
        let slip = moved - row.normal * dot(row.normal, moved);
        let wanted = row.friction - slip * row.inverse_diagonal;
        let size = sqrt(dot(wanted, wanted));
        let largest = row.coefficient * multiplier;
        var friction = wanted;
        if size > largest {
            friction = wanted * (largest / size);
        }
        push(row, friction - row.friction);
        rows[r].friction = friction;
    }
}

// Displacement of side a less that of side b, at the closest points.
fn relative_displacement(row: Row) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < 4u; k += 1u) {
        sum += row.weights[k] * displacements[row.vertices[k]].xyz;
    }
    return sum;
}

// Moves the vertices of a row by a change of its multipliers.
fn push(row: Row, change: vec3<f32>) {
    for (var k = 0u; k < 4u; k += 1u) {
        let v = row.vertices[k];
        let displacement = displacements[v];
        let step = displacement.w * row.weights[k];
        if step != 0.0 {
            displacements[v] = vec4<f32>(displacement.xyz + change * step, displacement.w);
        }
    }
}

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    for (var k = params.first + group.x; k < params.end; k += MOST_WORKGROUPS) {
        let bucket = buckets[k];
        var start = bucket.first;
        for (var color = 0u; color < bucket.colors; color += 1u) {
            let end = color_ends[bucket.first + color];
            for (var place = start + local.x; place < end; place += 256u) {
                relax(order[place]);
            }
            start = end;
            storageBarrier();
        }
        if local.x == 0u {
            for (var place = start; place < bucket.end; place += 1u) {
                relax(order[place]);
            }
        }
    }
}
