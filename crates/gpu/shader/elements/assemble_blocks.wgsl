// Sums the blocks of elements to those of the matrix, each in a fixed order: see linear/matrix.rs for how the
// matrix lies. The first block of a row is its sum, which elements do not change.

struct Entry {
    at: u32,
    first: u32,
    count: u32,
    bending: f32,
}

struct Params {
    entries: u32,
    nodes: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> entries: array<Entry>;
@group(0) @binding(2) var<storage, read> sources: array<u32>;
@group(0) @binding(3) var<storage, read> blocks: array<f32>;
@group(0) @binding(4) var<storage, read> slices: array<vec4<u32>>;
// Sums of the rows: xx, xy, xz, yy, yz, zz of each node.
@group(0) @binding(5) var<storage, read> row_sums: array<f32>;
@group(0) @binding(6) var<storage, read_write> words: array<u32>;

const SLICE: u32 = 32u;

fn write(at: u32, columns: mat3x3<f32>) {
    for (var c = 0u; c < 3u; c += 1u) {
        words[at + (1u + 3u * c) * SLICE] = bitcast<u32>(columns[c].x);
        words[at + (2u + 3u * c) * SLICE] = bitcast<u32>(columns[c].y);
        words[at + (3u + 3u * c) * SLICE] = bitcast<u32>(columns[c].z);
    }
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var t = id.x; t < params.entries + params.nodes; t += 64u * MOST_WORKGROUPS) {
        if t >= params.entries {
            let i = t - params.entries;
            let a = 6u * i;
            let xx = row_sums[a];
            let xy = row_sums[a + 1u];
            let xz = row_sums[a + 2u];
            let yy = row_sums[a + 3u];
            let yz = row_sums[a + 4u];
            let zz = row_sums[a + 5u];
            let at = slices[i / SLICE].x + i % SLICE;
            write(at, mat3x3<f32>(vec3<f32>(xx, xy, xz), vec3<f32>(xy, yy, yz), vec3<f32>(xz, yz, zz)));
            continue;
        }
        let entry = entries[t];
        var sum = mat3x3<f32>(
            vec3<f32>(entry.bending, 0.0, 0.0),
            vec3<f32>(0.0, entry.bending, 0.0),
            vec3<f32>(0.0, 0.0, entry.bending),
        );
        for (var k = entry.first; k < entry.first + entry.count; k += 1u) {
            let source = sources[k];
            let b = 9u * (source / 2u);
            let block = mat3x3<f32>(
                vec3<f32>(blocks[b], blocks[b + 1u], blocks[b + 2u]),
                vec3<f32>(blocks[b + 3u], blocks[b + 4u], blocks[b + 5u]),
                vec3<f32>(blocks[b + 6u], blocks[b + 7u], blocks[b + 8u]),
            );
            if source % 2u == 1u {
                sum += transpose(block);
            } else {
                sum += block;
            }
        }
        write(entry.at, sum);
    }
}
