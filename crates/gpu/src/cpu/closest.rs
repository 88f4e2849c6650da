//! Twin of `shader/shared/closest.wgsl`.

use super::{added, dot, negated, scaled, subtracted};

type V3 = [f32; 3];

#[derive(Clone, Copy)]
pub struct Closest {
    pub offset: V3,
    pub weights: V3,
}

fn on_edge(a: V3, b: V3) -> f32 {
    let along = subtracted(b, a);
    let squared = dot(along, along);
    if squared <= 0.0 {
        return 0.0;
    }
    (-dot(a, along) / squared).clamp(0.0, 1.0)
}

pub fn vertex_edge(a: V3, b: V3) -> Closest {
    let t = on_edge(a, b);
    Closest { offset: negated(added(a, scaled(subtracted(b, a), t))), weights: [1.0 - t, t, 0.0] }
}

pub fn vertex_triangle(a: V3, b: V3, c: V3) -> Closest {
    let ab = subtracted(b, a);
    let ac = subtracted(c, a);
    let d1 = -dot(ab, a);
    let d2 = -dot(ac, a);
    let d3 = -dot(ab, b);
    let d4 = -dot(ac, b);
    let d5 = -dot(ab, c);
    let d6 = -dot(ac, c);
    let va = d3 * d6 - d5 * d4;
    let vb = d5 * d2 - d1 * d6;
    let vc = d1 * d4 - d3 * d2;
    let w = if d1 <= 0.0 && d2 <= 0.0 {
        [1.0, 0.0, 0.0]
    } else if d3 >= 0.0 && d4 <= d3 {
        [0.0, 1.0, 0.0]
    } else if d6 >= 0.0 && d5 <= d6 {
        [0.0, 0.0, 1.0]
    } else if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = on_edge(a, b);
        [1.0 - t, t, 0.0]
    } else if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = on_edge(a, c);
        [1.0 - t, 0.0, t]
    } else if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let t = on_edge(b, c);
        [0.0, 1.0 - t, t]
    } else {
        let sum = va + vb + vc;
        if sum > 0.0 {
            let v = vb / sum;
            let u = vc / sum;
            [1.0 - v - u, v, u]
        } else {
            [1.0, 0.0, 0.0]
        }
    };
    let point = added(added(scaled(a, w[0]), scaled(b, w[1])), scaled(c, w[2]));
    Closest { offset: negated(point), weights: w }
}

fn closer(a: Closest, b: Closest) -> Closest {
    if dot(b.offset, b.offset) < dot(a.offset, a.offset) { b } else { a }
}

pub fn edge_edge(p: V3, q0: V3, q1: V3) -> Closest {
    let along = subtracted(q1, q0);
    let a = dot(p, p);
    let e = dot(along, along);
    let b = dot(p, along);
    let c = -dot(p, q0);
    let f = -dot(along, q0);
    let determinant = a * e - b * b;
    if determinant > 1e-5 * a * e {
        let s = ((b * f - c * e) / determinant).clamp(0.0, 1.0);
        let t = ((b * s + f) / e).clamp(0.0, 1.0);
        let back = ((b * t - c) / a).clamp(0.0, 1.0);
        let other = added(q0, scaled(along, t));
        return Closest { offset: subtracted(scaled(p, back), other), weights: [back, 1.0 - t, t] };
    }
    let s = on_edge(q0, q1);
    let first = Closest { offset: negated(added(q0, scaled(along, s))), weights: [0.0, 1.0 - s, s] };
    let t = on_edge(subtracted(q0, p), subtracted(q1, p));
    let other = added(q0, scaled(along, t));
    let best = closer(first, Closest { offset: subtracted(p, other), weights: [1.0, 1.0 - t, t] });
    let u = on_edge(negated(q0), subtracted(p, q0));
    let best = closer(best, Closest { offset: subtracted(scaled(p, u), q0), weights: [u, 1.0, 0.0] });
    let v = on_edge(negated(q1), subtracted(p, q1));
    closer(best, Closest { offset: subtracted(scaled(p, v), q1), weights: [v, 0.0, 1.0] })
}
