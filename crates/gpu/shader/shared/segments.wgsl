// Sums over the segments of a window of 256 nodes: nodes of one component. In a fixed order: sums of
// neighbors, then of these, and so on.

const WINDOW: u32 = 256u;
const NO_SEGMENT: u32 = 0xffffffffu;

var<workgroup> shared_values: array<vec4<f32>, 256>;
var<workgroup> shared_segments: array<u32, 256>;

// The sum over the threads of the segment from this one on.
fn sum_of_segment(thread: u32, segment: u32, value: vec4<f32>) -> vec4<f32> {
    workgroupBarrier();
    shared_values[thread] = value;
    shared_segments[thread] = segment;
    for (var reach = 1u; reach < WINDOW; reach *= 2u) {
        workgroupBarrier();
        var other = vec4<f32>(0.0);
        if thread + reach < WINDOW && shared_segments[thread + reach] == segment {
            other = shared_values[thread + reach];
        }
        workgroupBarrier();
        shared_values[thread] += other;
    }
    return shared_values[thread];
}

fn is_first_of_segment(thread: u32, segment: u32) -> bool {
    return segment != NO_SEGMENT && (thread == 0u || shared_segments[thread - 1u] != segment);
}
