// What tells a contact from others: the vertices of the features that its closest points are on. A vertex
// near a vertex of a mesh is near all triangles and edges around it, and the closest points are the same.
// Stages that use it have `edges`, `triangles`, `candidates` and `separations` among their bindings.

// A closest point is on the border of its primitive if a weight is at most this.
const ON_BORDER: f32 = 1e-6;

struct Contact {
    // Whether other pairs can have the same closest points: not if these are inside of two edges or of a
    // triangle.
    is_shared: bool,
    // The vertex of one side, and the vertices of the other side in the order of their numbers; NONE for no
    // second one.
    vertices: vec3<u32>,
}

fn contact_of(c: u32) -> Contact {
    let pair = pair_of(candidates[c]);
    var weights = signed_weights(pair, separations[c]);
    // Vertices of both sides at the closest points, up to two of each.
    var sides = vec4<u32>(NONE);
    var counts = vec2<u32>(0u);
    for (var k = 0u; k < pair.count; k += 1u) {
        if abs(weights[k]) <= ON_BORDER {
            continue;
        }
        let v = pair.vertices[k];
        if k < pair.side_a {
            sides = select(vec4<u32>(v, sides.yzw), vec4<u32>(sides.x, v, sides.zw), counts.x == 1u);
            counts.x += 1u;
        } else {
            sides = select(vec4<u32>(sides.xy, v, sides.w), vec4<u32>(sides.xyz, v), counts.y == 1u);
            counts.y += 1u;
        }
    }
    let is_shared = pair.kind != VERTEX_HALF_SPACE && counts.x + counts.y <= 3u && all(counts > vec2<u32>(0u));
    let a = vec2<u32>(min(sides.x, sides.y), max(sides.x, sides.y));
    let b = vec2<u32>(min(sides.z, sides.w), max(sides.z, sides.w));
    // The side with one vertex comes first, of two such sides that with the smaller number.
    let swaps = counts.x == 2u || (counts.y == 1u && b.x < a.x);
    return Contact(is_shared, select(vec3<u32>(a.x, b), vec3<u32>(b.x, a), swaps));
}

// The place of a contact in a table whose size is a power of two. Two contacts may have the same.
fn place_of(contact: Contact, mask: u32) -> u32 {
    let v = contact.vertices;
    var hash = v.x * 0x9e3779b1u ^ (v.y * 0x85ebca6bu + 0x7feb352du) ^ (v.z * 0xc2b2ae35u);
    hash = (hash ^ (hash >> 15u)) * 0x2c1b3c6du;
    hash = (hash ^ (hash >> 12u)) * 0x297a2d39u;
    return (hash ^ (hash >> 15u)) & mask;
}
