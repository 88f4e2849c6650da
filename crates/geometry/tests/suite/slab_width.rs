//! `width` against the slab evaluated in double-double arithmetic, rounded against it.

use crate::sampling::{KINDS, Random, extent, near_degenerate_pair};
use bowknot_geometry::{HalfSpace, PairKind, Point, Vector, distance, separation};

/// An unevaluated sum of two numbers, good to about 2^-104 of itself (Dekker 1971).
#[derive(Clone, Copy, Debug)]
pub struct Double(f64, f64);

impl Double {
    fn sum(a: f64, b: f64) -> Self {
        let s = a + b;
        let t = s - a;
        Self(s, (a - (s - t)) + (b - t))
    }

    fn product(a: f64, b: f64) -> Self {
        let p = a * b;
        Self(p, a.mul_add(b, -p))
    }

    fn plus(self, other: Self) -> Self {
        let high = Self::sum(self.0, other.0);
        let low = Self::sum(self.1, other.1);
        let first = Self::sum(high.0, high.1 + low.0);
        Self::sum(first.0, first.1 + low.1)
    }

    fn times(self, factor: f64) -> Self {
        let high = Self::product(self.0, factor);
        Self::sum(high.0, high.1 + self.1 * factor)
    }

    fn is_at_most(self, other: Self) -> bool {
        let difference = other.plus(Self(-self.0, -self.1));
        difference.0 >= 0.0
    }
}

/// n.(p - q); p - q is exact as a double.
fn projection(n: &Vector, p: &Point, q: &Point) -> Double {
    (0..3).map(|k| Double::sum(p[k], -q[k]).times(n[k])).fold(Double(0.0, 0.0), Double::plus)
}

/// An upper bound of |n|, tight to 1e-29, for |n|^2 = 1 + e with |e| < 1e-14: 1 + e/2.
fn length(n: &Vector) -> Double {
    let squared = (0..3).map(|k| Double::product(n[k], n[k])).fold(Double(0.0, 0.0), Double::plus);
    let excess = squared.plus(Double(-1.0, 0.0));
    assert!(excess.0.abs() < 1e-14, "{n:?} is not unit");
    Double(1.0, 0.0).plus(excess.times(0.5))
}

/// width * |n| + 2^-85 scale <= s, in exact arithmetic.
pub fn certified(width: f64, n: &Vector, s: Double, scale: f64) -> bool {
    length(n).times(width).plus(Double(scale * 2_f64.powi(-85), 0.0)).is_at_most(s)
}

fn slab(kind: PairKind, points: &[Point; 4], n: &Vector) -> Double {
    let (a, b) = points[..kind.vertex_count()].split_at(kind.side_a());
    slab_between(a, b, n)
}

/// min over a of n.p - max over b of n.q.
pub fn slab_between(a: &[Point], b: &[Point], n: &Vector) -> Double {
    a.iter()
        .flat_map(|p| b.iter().map(move |q| projection(n, p, q)))
        .reduce(|x, y| if x.is_at_most(y) { x } else { y })
        .expect("both sides have vertices")
}

#[test]
fn a_million_widths_are_certified() {
    let mut random = Random::new(1);
    let mut judged = 0;
    for _ in 0..1_000_000 {
        let points = near_degenerate_pair(&mut random);
        let kind = KINDS[random.below(4)];
        let separation = separation::separate(kind, &points);
        let scale = extent(kind, &points);
        if scale > 0.0 {
            let exact = slab(kind, &points, &separation.normal);
            assert!(
                certified(separation.width, &separation.normal, exact, scale),
                "{kind:?} {points:?} {separation:?}"
            );
        } else {
            assert!(separation.width <= 0.0);
        }
        if separation.distance > 1e-13 * scale {
            judged += 1;
            assert!(separation.width > 0.9 * separation.distance, "{kind:?} {points:?} {separation:?}");
        }
    }
    assert!(judged > 500_000, "{judged}");
}

#[test]
fn half_space_widths_are_certified() {
    let mut random = Random::new(2);
    for _ in 0..200_000 {
        let n = random.vector(1.0).normalize() * (1.0 + 1e-15 * random.signed());
        let far = [1.0, 1e4][random.below(2)];
        let at = Point::from(random.vector(far));
        let plane = HalfSpace { normal: n, offset: n.dot(&at.coords) };
        let height = random.power(-13.0, 1.0);
        let point = at + n * height + n.cross(&random.vector(1.0));
        let separation = separation::separate_half_space(&point, &plane);
        let exact = projection(&n, &point, &Point::origin()).plus(Double(-plane.offset, 0.0));
        let scale = point.coords.amax() + plane.offset.abs();
        // The plane is that of the stored normal: (n.x - offset) / |n|.
        assert!(certified(separation.width, &n, exact, scale), "{plane:?} {point:?} {separation:?}");
        assert!((exact.0 - separation.width).abs() < 1e-14 * scale, "{plane:?} {point:?} {separation:?}");
    }
}

#[test]
fn coordinates_of_any_finite_size_give_numbers() {
    let mut random = Random::new(4);
    let sizes =
        [0.0, f64::from_bits(1), 1e-310, 1e-160, 1e-80, 1e-40, 1.0, 1e60, 1e100, 1e160, 1e300, f64::MAX];
    for _ in 0..300_000 {
        let mut points = [Point::origin(); 4];
        for x in points.iter_mut().flat_map(|p| p.iter_mut()) {
            let whole = [1.0, -1.0, random.signed()][random.below(3)];
            *x = whole * sizes[random.below(sizes.len())];
        }
        // Most coordinates have one size, so that the bound is tested at that size and not only at the
        // largest.
        if random.below(2) == 0 {
            let size = sizes[random.below(sizes.len())];
            points = [0; 4].map(|_| Point::from(random.vector(size)));
        }
        for kind in KINDS {
            let closest = distance::closest(kind, &points);
            assert!(
                closest.weights.iter().all(|w| (0.0..=1.0).contains(w)),
                "{kind:?} {points:?} {closest:?}"
            );
            assert!(closest.distance >= 0.0, "{kind:?} {points:?} {closest:?}");
            let separation = separation::separate(kind, &points);
            assert!(!separation.width.is_nan(), "{kind:?} {points:?} {separation:?}");
            assert!((separation.normal.norm() - 1.0).abs() < 1e-14, "{kind:?} {points:?} {separation:?}");
            assert!(separation.width <= separation.distance, "{kind:?} {points:?} {separation:?}");
        }
        let plane = HalfSpace { normal: points[1] - points[2], offset: points[1].x };
        let separation = separation::separate_half_space(&points[0], &plane);
        assert!(
            !separation.width.is_nan() && (separation.normal.norm() - 1.0).abs() < 1e-14,
            "{points:?} {plane:?}"
        );
    }
}

#[test]
fn tiny_and_huge_pairs_are_as_good_as_plain_ones() {
    let mut random = Random::new(5);
    for _ in 0..20_000 {
        let points = [0; 4].map(|_| Point::from(random.vector(1.0)));
        let kind = KINDS[random.below(4)];
        let plain = separation::separate(kind, &points);
        for exponent in [-900, -500, -300, 300, 500, 900] {
            let scale = 2_f64.powi(exponent);
            let scaled = separation::separate(kind, &points.map(|p| p * scale));
            assert!(
                (scaled.distance / scale - plain.distance).abs() < 1e-14,
                "{kind:?} {points:?} {exponent}"
            );
            // Scaling by a power of two is exact, so the slab of the unscaled points is the reference.
            let exact = slab(kind, &points, &scaled.normal);
            assert!(
                certified(scaled.width / scale, &scaled.normal, exact, 1.0),
                "{kind:?} {points:?} {exponent}"
            );
            assert!(
                scaled.width / scale >= plain.width - 1e-13,
                "{kind:?} {points:?} {exponent} {scaled:?} {plain:?}"
            );
        }
    }
}
