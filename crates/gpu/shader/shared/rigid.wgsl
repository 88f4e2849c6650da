// From the rigid motions of the eight children of a domain to that of the parent: with a child's link l, the way from the
// parent's center over the parent's size, and the ratio s of sizes, child shift = shift + spin x l, child spin = s spin.
// A link is (l, s).

var<workgroup> child_links: array<f32, 32>;

// Component c of the force on the motion of the parent, from the `group_forces` on the children.
fn force_on_parent(c: u32) -> f32 {
    var sum = 0.0;
    for (var m = 0u; m < 8u; m += 1u) {
        if c < 3u {
            sum += group_forces[6u * m + c];
        } else {
            let a = (c - 2u) % 3u;
            let b = (c - 1u) % 3u;
            sum += child_links[4u * m + 3u] * group_forces[6u * m + c] + child_links[4u * m + a] * group_forces[6u * m + b]
                - child_links[4u * m + b] * group_forces[6u * m + a];
        }
    }
    return sum;
}
