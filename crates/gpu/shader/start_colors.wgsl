// Where the rows of each color start in their order: sums of the numbers of rows. The numbers are reset.

struct Params {
    colors: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> tally: array<u32>;
@group(0) @binding(2) var<storage, read_write> starts: array<u32>;

@compute @workgroup_size(1)
fn main() {
    var sum = 0u;
    for (var color = 0u; color < params.colors; color += 1u) {
        starts[color] = sum;
        sum += tally[color];
        tally[color] = 0u;
    }
}
