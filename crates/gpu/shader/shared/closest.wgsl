// Closest points of two elements, in f32. They need not be accurate: what is certified is the width of a slab
// along some direction, whatever that is. All results are finite: coordinates are below 2^31, so that
// products of four of them are numbers, and no divisor is zero.

struct Closest {
    // From the point of side b to the point of side a.
    offset: vec3<f32>,
    // Weights of the second, third and fourth vertex.
    weights: vec3<f32>,
}

// A point at the origin and the edge from a to b: the weight of b.
fn on_edge(a: vec3<f32>, b: vec3<f32>) -> f32 {
    let along = b - a;
    let squared = dot(along, along);
    if squared <= 0.0 {
        return 0.0;
    }
    return clamp(-dot(a, along) / squared, 0.0, 1.0);
}

// A point at the origin and an edge.
fn closest_vertex_edge(a: vec3<f32>, b: vec3<f32>) -> Closest {
    let t = on_edge(a, b);
    return Closest(-(a + (b - a) * t), vec3<f32>(1.0 - t, t, 0.0));
}

// A point at the origin and a triangle, by the regions in which the point projects (Ericson, "Real-Time
// Collision Detection", 2004, section 5.1.5).
fn closest_vertex_triangle(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> Closest {
    let ab = b - a;
    let ac = c - a;
    let d1 = -dot(ab, a);
    let d2 = -dot(ac, a);
    let d3 = -dot(ab, b);
    let d4 = -dot(ac, b);
    let d5 = -dot(ab, c);
    let d6 = -dot(ac, c);
    let va = d3 * d6 - d5 * d4;
    let vb = d5 * d2 - d1 * d6;
    let vc = d1 * d4 - d3 * d2;
    var w = vec3<f32>(0.0);
    if d1 <= 0.0 && d2 <= 0.0 {
        w = vec3<f32>(1.0, 0.0, 0.0);
    } else if d3 >= 0.0 && d4 <= d3 {
        w = vec3<f32>(0.0, 1.0, 0.0);
    } else if d6 >= 0.0 && d5 <= d6 {
        w = vec3<f32>(0.0, 0.0, 1.0);
    } else if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = on_edge(a, b);
        w = vec3<f32>(1.0 - t, t, 0.0);
    } else if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = on_edge(a, c);
        w = vec3<f32>(1.0 - t, 0.0, t);
    } else if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let t = on_edge(b, c);
        w = vec3<f32>(0.0, 1.0 - t, t);
    } else {
        // Of a triangle without an area any point will do.
        let sum = va + vb + vc;
        w = vec3<f32>(1.0, 0.0, 0.0);
        if sum > 0.0 {
            let v = vb / sum;
            let u = vc / sum;
            w = vec3<f32>(1.0 - v - u, v, u);
        }
    }
    return Closest(-(a * w.x + b * w.y + c * w.z), w);
}

// Closer of two candidates.
fn closer(a: Closest, b: Closest) -> Closest {
    if dot(b.offset, b.offset) < dot(a.offset, a.offset) {
        return b;
    }
    return a;
}

// The edges from the origin to p and from q0 to q1. The weights are those of p, q0 and q1.
fn closest_edge_edge(p: vec3<f32>, q0: vec3<f32>, q1: vec3<f32>) -> Closest {
    let along = q1 - q0;
    let a = dot(p, p);
    let e = dot(along, along);
    let b = dot(p, along);
    let c = -dot(p, q0);
    let f = -dot(along, q0);
    let determinant = a * e - b * b;
    var best: Closest;
    if determinant > 1e-5 * a * e {
        let s = clamp((b * f - c * e) / determinant, 0.0, 1.0);
        let t = clamp((b * s + f) / e, 0.0, 1.0);
        let back = clamp((b * t - c) / a, 0.0, 1.0);
        best = Closest(p * back - (q0 + along * t), vec3<f32>(back, 1.0 - t, t));
    } else {
        // Nearly parallel: an end of one edge is closest.
        let s = on_edge(q0, q1);
        best = Closest(-(q0 + along * s), vec3<f32>(0.0, 1.0 - s, s));
        let t = on_edge(q0 - p, q1 - p);
        best = closer(best, Closest(p - (q0 + along * t), vec3<f32>(1.0, 1.0 - t, t)));
        let u = on_edge(-q0, p - q0);
        best = closer(best, Closest(p * u - q0, vec3<f32>(u, 1.0, 0.0)));
        let v = on_edge(-q1, p - q1);
        best = closer(best, Closest(p * v - q1, vec3<f32>(v, 0.0, 1.0)));
    }
    return best;
}
