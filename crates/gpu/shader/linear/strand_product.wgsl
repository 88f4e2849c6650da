// Parts: linear, strand.
//
// The product of the Hessians of strands with the search direction p, row by row. Edges are up to 10^7 times
// as stiff as their inertia: the second derivative by w acts on differences of p along one direction, so that
// what rounding leaves is along that direction too, where stiffness takes it up. Blocks of the matrix would
// leave it in all directions.

struct Params {
    rows: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> strands: array<Strand>;
@group(0) @binding(2) var<storage, read> curvatures: array<Curvature>;
// Of each row its node, its first entry and their end; then the entries, three times the element plus the
// place in it.
@group(0) @binding(3) var<storage, read> rows: array<u32>;
@group(0) @binding(4) var<storage, read> direction: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> image: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> progress: Progress;

fn product(e: u32) -> vec3<f32> {
    let strand = strands[e];
    let middle = direction[strand.nodes[1]].xyz;
    let w = jump_of(strand, middle - direction[strand.nodes[0]].xyz, direction[strand.nodes[2]].xyz - middle);
    let curvature = curvatures[e];
    let along = vec3<f32>(curvature.along[0], curvature.along[1], curvature.along[2]);
    return w * curvature.across + along * (curvature.axial * dot(along, w));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if atomicLoad(&progress.moving) == 0u {
        return;
    }
    for (var k = id.x; k < params.rows; k += 64u * MOST_WORKGROUPS) {
        var sum = vec3<f32>(0.0);
        for (var at = rows[3u * k + 1u]; at < rows[3u * k + 2u]; at += 1u) {
            let entry = rows[at];
            sum += product(entry / 3u) * weights_of(strands[entry / 3u])[entry % 3u];
        }
        image[rows[3u * k]] = vec4<f32>(sum, 0.0);
    }
}
