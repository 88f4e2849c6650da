// From the rigid motions of the eight children of a domain to that of the parent: with a child's link l, the
// way from the parent's center over the parent's size, and the ratio s of sizes, child shift = shift + spin x
// l, child spin = s spin. A link is (l, s).

// Of up to four domains at once.
var<workgroup> child_links: array<f32, 128>;

// Component c of the force on the motion of the parent, from the `group_forces` on the children of domain q.
fn force_on_parent(q: u32, c: u32) -> f32 {
    let forces = 48u * q;
    let links = 32u * q;
    var sum = 0.0;
    for (var m = 0u; m < 8u; m += 1u) {
        if c < 3u {
            sum += group_forces[forces + 6u * m + c];
        } else {
            let a = (c - 2u) % 3u;
            let b = (c - 1u) % 3u;
            sum += child_links[links + 4u * m + 3u] * group_forces[forces + 6u * m + c] + child_links[links + 4u * m + a] * group_forces[forces + 6u * m + b]
                - child_links[links + 4u * m + b] * group_forces[forces + 6u * m + a];
        }
    }
    return sum;
}
