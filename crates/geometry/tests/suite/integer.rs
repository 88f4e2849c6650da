//! Exact squared distances and intersections of simplices with small integer coordinates.
//!
//! Written from definitions, apart from the library's ways: a squared distance is the least over all features
//! of the pair whose closest points lie inside them, as a fraction. Coordinates up to 2^19 keep every
//! numerator below 2^127; up to 2^8, fractions are compared exactly as well.

use bowknot_geometry::PairKind;

/// A point or vector.
pub type Int3 = [i128; 3];

/// A non-negative fraction.
#[derive(Clone, Copy, Debug)]
pub struct Fraction {
    pub numerator: u128,
    pub denominator: u128,
}

impl Fraction {
    fn less(self, other: Self) -> bool {
        let cross = |a: Self, b: Self| a.numerator.checked_mul(b.denominator);
        match (cross(self, other), cross(other, self)) {
            (Some(left), Some(right)) => left < right,
            // To rounding: an error here is one of the same size in the least of the two.
            _ => self.to_f64() < other.to_f64(),
        }
    }

    pub fn to_f64(self) -> f64 {
        self.numerator as f64 / self.denominator as f64
    }
}

pub fn sub(a: Int3, b: Int3) -> Int3 {
    [0, 1, 2].map(|k| a[k] - b[k])
}

pub fn dot(a: Int3, b: Int3) -> i128 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

pub fn cross(a: Int3, b: Int3) -> Int3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn scaled(a: Int3, factor: i128) -> Int3 {
    a.map(|x| x * factor)
}

/// Squared distance of a pair of any kind but half-spaces.
pub fn distance_squared(kind: PairKind, [p0, p1, p2, p3]: [Int3; 4]) -> Fraction {
    match kind {
        PairKind::VertexVertex => points(p0, p1),
        PairKind::VertexEdge => point_edge(p0, [p1, p2]),
        PairKind::VertexTriangle => point_triangle(p0, [p1, p2, p3]),
        PairKind::EdgeEdge => edges([p0, p1], [p2, p3]),
        PairKind::VertexHalfSpace => unreachable!("no half-spaces here"),
    }
}

fn least(fractions: &[Fraction]) -> Fraction {
    fractions.iter().copied().reduce(|a, b| if b.less(a) { b } else { a }).expect("at least one candidate")
}

fn points(p: Int3, q: Int3) -> Fraction {
    let d = sub(p, q);
    Fraction { numerator: dot(d, d) as u128, denominator: 1 }
}

fn point_edge(p: Int3, [a, b]: [Int3; 2]) -> Fraction {
    let (e, r) = (sub(b, a), sub(p, a));
    let (ee, re) = (dot(e, e), dot(r, e));
    if ee == 0 || re <= 0 || re >= ee {
        return least(&[points(p, a), points(p, b)]);
    }
    let moment = cross(r, e);
    Fraction { numerator: dot(moment, moment) as u128, denominator: ee as u128 }
}

pub fn point_triangle(p: Int3, [a, b, c]: [Int3; 3]) -> Fraction {
    let boundary = least(&[point_edge(p, [a, b]), point_edge(p, [b, c]), point_edge(p, [c, a])]);
    let (e1, e2, r) = (sub(b, a), sub(c, a), sub(p, a));
    let n = cross(e1, e2);
    let nn = dot(n, n);
    let (w1, w2) = (dot(cross(r, e2), n), dot(cross(e1, r), n));
    if nn == 0 || w1 < 0 || w2 < 0 || w1 + w2 > nn {
        return boundary;
    }
    let height = dot(n, r);
    Fraction { numerator: (height * height) as u128, denominator: nn as u128 }
}

pub fn edges([a0, a1]: [Int3; 2], [b0, b1]: [Int3; 2]) -> Fraction {
    let ends = least(&[
        point_edge(a0, [b0, b1]),
        point_edge(a1, [b0, b1]),
        point_edge(b0, [a0, a1]),
        point_edge(b1, [a0, a1]),
    ]);
    let (d1, d2, r) = (sub(a1, a0), sub(b1, b0), sub(a0, b0));
    let n = cross(d1, d2);
    let nn = dot(n, n);
    let (s, t) = (dot(cross(d2, r), n), dot(cross(d1, r), n));
    if nn == 0 || s < 0 || t < 0 || s > nn || t > nn {
        return ends;
    }
    let height = dot(n, r);
    Fraction { numerator: (height * height) as u128, denominator: nn as u128 }
}

/// Whether a closed segment and a closed triangle, either degenerate or not, share a point: by the point
/// where the segment meets the plane, or by distances within the plane.
pub fn edge_meets_triangle(edge: [Int3; 2], triangle: [Int3; 3]) -> bool {
    let [p, q] = edge;
    let [a, b, c] = triangle;
    let n = cross(sub(b, a), sub(c, a));
    let (p_height, q_height) = (dot(n, sub(p, a)), dot(n, sub(q, a)));
    if p_height.signum() * q_height.signum() > 0 {
        return false;
    }
    if p_height != q_height {
        // The point p + (q - p) p_height / (p_height - q_height), times the denominator.
        let sign = (p_height - q_height).signum();
        let (whole, part) = ((p_height - q_height) * sign, p_height * sign);
        let along = sub(q, p);
        let place: Int3 = [0, 1, 2].map(|k| p[k] * whole + along[k] * part);
        let beside = |x, y| dot(n, cross(sub(y, x), sub(place, scaled(x, whole)))) >= 0;
        return beside(a, b) && beside(b, c) && beside(c, a);
    }
    point_triangle(p, triangle).numerator == 0
        || point_triangle(q, triangle).numerator == 0
        || [[a, b], [b, c], [c, a]].iter().any(|&side| edges(edge, side).numerator == 0)
}

/// Whether w^2 <= fraction for a finite w >= 0, exactly. `numerator` must be below 2^64.
pub fn square_at_most(w: f64, fraction: Fraction) -> bool {
    if w == 0.0 {
        return true;
    }
    // w = mantissa * 2^exponent.
    let bits = w.to_bits();
    let biased = (bits >> 52) as i32;
    assert!(biased > 0, "subnormal widths do not occur");
    let mantissa = u128::from((bits & ((1 << 52) - 1)) | (1 << 52));
    let exponent = biased - 1075;
    // mantissa^2 * denominator <= numerator * 2^(-2 exponent)?
    let left = wide_product(mantissa * mantissa, fraction.denominator);
    let shift = -2 * exponent;
    assert!(shift >= 0, "widths below 2^52 only");
    if fraction.numerator == 0 {
        return false;
    }
    if shift >= 192 {
        // The right side is at least 2^192, the left below 2^106 * 2^64.
        return true;
    }
    assert!(fraction.numerator < 1 << 64 && fraction.denominator < 1 << 64);
    let right = if shift >= 128 {
        (fraction.numerator << (shift - 128), 0)
    } else if shift == 0 {
        (0, fraction.numerator)
    } else {
        (fraction.numerator >> (128 - shift), fraction.numerator << shift)
    };
    left <= right
}

/// Product as high and low halves.
fn wide_product(a: u128, b: u128) -> (u128, u128) {
    const LOW: u128 = u64::MAX as u128;
    let (a1, a0, b1, b0) = (a >> 64, a & LOW, b >> 64, b & LOW);
    let low = a0 * b0;
    let middle = a1 * b0 + (low >> 64);
    let carried = a0 * b1 + (middle & LOW);
    (a1 * b1 + (middle >> 64) + (carried >> 64), (carried << 64) | (low & LOW))
}

#[test]
fn wide_products_and_squares_are_exact() {
    assert_eq!(wide_product(u128::MAX, u128::MAX), (u128::MAX - 1, 1));
    assert_eq!(wide_product(1 << 100, 1 << 60), (1 << 32, 0));
    let nine_quarters = Fraction { numerator: 9, denominator: 4 };
    assert!(square_at_most(1.5, nine_quarters));
    assert!(!square_at_most(1.5_f64.next_up(), nine_quarters));
    assert!(square_at_most(2_f64.sqrt().next_down(), Fraction { numerator: 2, denominator: 1 }));
    assert!(!square_at_most(1e-300, Fraction { numerator: 0, denominator: 1 }));
    assert!(square_at_most(1e-300, nine_quarters));
}
