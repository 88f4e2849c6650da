use super::*;
use proptest::prelude::*;

/// A double and its exact distance above another, as the sign of the exact difference.
fn exceeds(sum_of: [f64; 2], bound: f64) -> bool {
    // Knuth's two-sum: a + b = s + e exactly.
    let [a, b] = sum_of;
    let s = a + b;
    let t = s - a;
    let e = (a - (s - t)) + (b - t);
    s > bound || (s == bound && e > 0.0)
}

fn boxes() -> impl Strategy<Value = Aabb> {
    let coordinate = prop_oneof![-10.0..10.0, (-3..3_i32).prop_map(f64::from), -1e4..1e4];
    proptest::array::uniform6(coordinate)
        .prop_map(|c| Aabb::of_points(&[Point::new(c[0], c[1], c[2]), Point::new(c[3], c[4], c[5])]))
}

/// A finite double of any size.
fn finite() -> impl Strategy<Value = f64> {
    prop_oneof![-10.0..10.0, any::<f64>().prop_filter("finite", |x| x.is_finite())]
}

/// Miri takes minutes for a thousand.
const CASES: u32 = if cfg!(miri) { 20 } else { 20_000 };

proptest! {
    #![proptest_config(ProptestConfig { cases: CASES, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn inflating_rounds_outward(bounds in boxes(), radius in prop_oneof![Just(0.0), 0.0..1e-3, 1e-20..1e-12]) {
        let inflated = bounds.inflated(radius);
        for k in 0..3 {
            prop_assert!(exceeds([bounds.min[k], -radius], inflated.min[k]));
            prop_assert!(exceeds([-bounds.max[k], -radius], -inflated.max[k]));
            let rounding = 4e-16 * (bounds.min[k].abs() + radius) + 1e-300;
            prop_assert!((inflated.min[k] - (bounds.min[k] - radius)).abs() <= rounding);
        }
    }

    #[test]
    fn the_distance_is_a_lower_bound_and_a_tight_one(a in boxes(), b in boxes()) {
        let bound = a.distance_lower_bound(&b);
        prop_assert_eq!(bound, b.distance_lower_bound(&a));
        prop_assert_eq!(bound == 0.0, a.overlaps(&b));
        // Corners or sides that face each other; the difference of coordinates is exact enough to judge
        // tightness, and the two-sum judges the bound along single axes.
        let gaps = [0, 1, 2].map(|k| (a.min[k] - b.max[k]).max(b.min[k] - a.max[k]).max(0.0));
        let distance = (gaps[0].powi(2) + gaps[1].powi(2) + gaps[2].powi(2)).sqrt();
        prop_assert!(bound < distance || distance == 0.0);
        prop_assert!(bound >= distance * (1.0 - 3e-15));
        if gaps.iter().filter(|g| **g > 0.0).count() == 1 {
            let k = gaps.iter().position(|g| *g > 0.0).unwrap_or_default();
            let (high, low) = if a.min[k] > b.max[k] { (a.min[k], b.max[k]) } else { (b.min[k], a.max[k]) };
            prop_assert!(exceeds([high, -low], bound));
        }
    }

    #[test]
    fn single_precision_rounds_to_the_stated_side(x in finite()) {
        let (down, up) = (round_down_f32(x), round_up_f32(x));
        prop_assert!(f64::from(down) <= x && x <= f64::from(up));
        prop_assert!(down == up || down.next_up() == up, "{} {}", down, up);
        prop_assert_eq!(down == up, f64::from(x as f32) == x);
    }
}

#[test]
fn single_precision_rounds_at_the_ends_of_its_range() {
    assert_eq!(round_down_f32(1e300), f32::MAX);
    assert_eq!(round_up_f32(1e300), f32::INFINITY);
    assert_eq!(round_down_f32(-1e300), f32::NEG_INFINITY);
    assert_eq!(round_up_f32(-1e300), -f32::MAX);
    assert_eq!(round_down_f32(1e-300), 0.0);
    assert_eq!(round_up_f32(1e-300), f32::from_bits(1));
    assert_eq!(round_down_f32(-1e-300), -f32::from_bits(1));
    assert_eq!((round_down_f32(0.5), round_up_f32(0.5)), (0.5, 0.5));
}

#[test]
fn boxes_grow_by_union_from_the_empty_box() {
    let points = [Point::new(1.0, -2.0, 3.0), Point::new(-1.0, 5.0, 3.0)];
    let bounds = Aabb::of_points(&points);
    assert_eq!((bounds.min, bounds.max), (Point::new(-1.0, -2.0, 3.0), Point::new(1.0, 5.0, 3.0)));
    assert_eq!(Aabb::default().union(&bounds), bounds);
    assert!(points.iter().all(|p| bounds.contains(p)) && !bounds.contains(&Point::origin()));
    assert!(!Aabb::EMPTY.overlaps(&bounds) && !Aabb::EMPTY.contains(&points[0]));
    // Closed: boxes that touch in a corner overlap.
    let corner = Aabb { min: bounds.max, max: bounds.max };
    assert!(bounds.overlaps(&corner));
    assert_eq!(bounds.distance_lower_bound(&corner), 0.0);
}

#[test]
fn distances_stay_bounds_where_squares_leave_the_range() {
    let at = |x: f64, y: f64| Aabb { min: Point::new(x, y, 0.0), max: Point::new(x, y, 0.0) };
    for scale in [1e-300, 1e-170, 1e160, 1e300] {
        let bound = at(0.0, 0.0).distance_lower_bound(&at(3.0 * scale, 4.0 * scale));
        assert!(bound < 5.0 * scale && bound > 3.9 * scale, "{scale} {bound}");
    }
    let least = f64::from_bits(1);
    assert!(at(0.0, 0.0).distance_lower_bound(&at(least, 0.0)) <= least);
    assert_eq!(at(f64::MAX, 0.0).distance_lower_bound(&at(-f64::MAX, 0.0)), f64::MAX);
}
