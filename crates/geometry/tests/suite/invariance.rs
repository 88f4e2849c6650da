use crate::sampling::{KINDS, Random, extent, near_degenerate_pair};
use bowknot_geometry::{PairKind, Point, Vector, distance, separation};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use proptest::prelude::*;

/// Orders of the vertices that describe the same pair; the flag says whether the sides are swapped.
fn reorderings(kind: PairKind) -> &'static [([usize; 4], bool)] {
    match kind {
        PairKind::VertexVertex => &[([1, 0, 2, 3], true)],
        PairKind::VertexEdge => &[([0, 2, 1, 3], false)],
        PairKind::VertexTriangle => &[([0, 2, 3, 1], false), ([0, 1, 3, 2], false), ([0, 3, 2, 1], false)],
        PairKind::EdgeEdge => &[([1, 0, 2, 3], false), ([0, 1, 3, 2], false), ([2, 3, 0, 1], true)],
        PairKind::VertexHalfSpace => &[],
    }
}

fn kind_and_pair() -> impl Strategy<Value = (PairKind, [Point; 4])> {
    (0..4_usize, any::<u64>()).prop_map(|(k, seed)| (KINDS[k], near_degenerate_pair(&mut Random::new(seed))))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_order_of_vertices_and_sides_does_not_matter((kind, points) in kind_and_pair()) {
        let scale = extent(kind, &points);
        let closest = distance::closest(kind, &points);
        for (order, swapped) in reorderings(kind) {
            let other = distance::closest(kind, &order.map(|i| points[i]));
            prop_assert!((closest.distance - other.distance).abs() <= 4e-15 * scale, "{:?}", order);
            // Directions agree where they are determined: except for parallel edges, the closest points are
            // unique, up to the square root of rounding.
            let turned = if *swapped { -other.offset } else { other.offset };
            prop_assert!((turned - closest.offset).norm() <= 1e-6 * scale || kind == PairKind::EdgeEdge);
        }
    }

    #[test]
    fn a_rigid_motion_moves_the_answer_along((kind, points) in kind_and_pair(), seed in any::<u64>()) {
        let mut random = Random::new(seed);
        let turn = UnitQuaternion::from_scaled_axis(random.vector(3.0));
        let motion = Isometry3::from_parts(Translation3::from(random.vector(1.0)), turn);
        let moved = points.map(|p| motion * p);
        // The motion itself rounds by the size of the coordinates.
        let rounding = 1e-14 * points.iter().map(|p| p.coords.norm() + 1.0).fold(0.0, f64::max);
        let (before, after) = (separation::separate(kind, &points), separation::separate(kind, &moved));
        prop_assert!((before.distance - after.distance).abs() <= rounding);
        if before.distance > 1e3 * rounding && before.width > 0.9 * before.distance {
            prop_assert!(after.width > 0.89 * before.distance, "{:?} {:?}", before, after);
        }
    }
}

#[test]
fn gradients_are_signed_weights_times_the_normal() {
    let mut random = Random::new(8);
    let mut checked = 0;
    while checked < 20_000 {
        let points = [0; 4].map(|_| Point::from(random.vector(1.0)));
        let kind = KINDS[random.below(4)];
        let separation = separation::separate(kind, &points);
        // The second derivative is about 1/distance, more for edges that are almost parallel.
        let directions = (points[1] - points[0]).normalize().cross(&(points[3] - points[2]).normalize());
        if separation.distance < 0.05 || (kind == PairKind::EdgeEdge && directions.norm() < 0.1) {
            continue;
        }
        checked += 1;
        let signed = separation.signed_weights(kind);
        for i in 0..kind.vertex_count() {
            for axis in 0..3 {
                const STEP: f64 = 1e-6;
                let at = |t: f64| {
                    let mut moved = points;
                    moved[i] += Vector::ith(axis, t);
                    distance::closest(kind, &moved).distance
                };
                let difference = (at(STEP) - at(-STEP)) / (2.0 * STEP);
                let gradient = signed[i] * separation.normal[axis];
                assert!(
                    (difference - gradient).abs() < 1e-3 * STEP.sqrt() + 400.0 * STEP,
                    "{kind:?} {points:?} {i} {axis}"
                );
            }
        }
    }
}
