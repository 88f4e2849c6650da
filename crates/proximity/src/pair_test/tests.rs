use super::*;
use crate::frame::localize;
use crate::tree::Tree;
use bowknot_geometry::{Point, Vector, distance};
use fastrand::Rng;

/// Uniform in [-1, 1).
fn signed(random: &mut Rng) -> f64 {
    2.0 * random.f64() - 1.0
}

/// Uniform in the cube [-size, size)^3.
fn vector(random: &mut Rng, size: f64) -> Vector {
    Vector::new(signed(random), signed(random), signed(random)) * size
}

/// Pairs whose radii are their distance but for a part of about the slack: what the test claims must be true,
/// and it must not leave everything undecided.
fn check<K: PairTest<A, B>, const A: usize, const B: usize>(place: f64) {
    let mut random = Rng::with_seed(K::KIND as u64 + 17);
    let origin = Point::new(1.0, 2.0, -1.0);
    let mut counts = [0; 3];
    let mut tight = 0;
    for round in 0..20_000 {
        let center = origin + vector(&mut random, place);
        // Some pairs are flat, aligned or nearly touching.
        let flat = if round % 3 == 0 { 1e-6 } else { 1.0 };
        let mut points = [center; 4];
        for point in &mut points {
            let step = vector(&mut random, 0.01);
            *point += Vector::new(step.x, step.y, flat * step.z);
        }
        if round % 5 == 0 {
            points[3] = points[2] + (points[1] - points[0]) * signed(&mut random);
        }
        let distance = distance::closest(K::KIND, &points).distance;
        let radii = distance * (1.0 + 2e-4 * place.max(0.01) * signed(&mut random) / distance.max(1e-3));
        let share = 0.5 * signed(&mut random) + 0.5;

        let local: Vec<_> = (0..4)
            .map(|i| {
                let radius = if i < A { radii * share } else { radii * (1.0 - share) };
                localize(&points[i], &Vector::zeros(), radius, &origin)
            })
            .collect();
        let (mut a, mut b) = (Tree::<A>::default(), Tree::<B>::default());
        a.build(&[(0, std::array::from_fn(|i| i as u32))], &local);
        b.build(&[(0, std::array::from_fn(|i| (A + i) as u32))], &local);
        a.refit(&local, None);
        b.refit(&local, None);
        let (a, b) = (&a.leaves[0].rows[0], &b.leaves[0].rows[0]);
        let batch = Batch {
            a: a.positions.map(|p| p.map(|x| [x; LANES])),
            b: b.positions.map(|p| p.map(|x| [x; LANES])),
            radius: [a.radius + b.radius; LANES],
            slack: [a.slack + b.slack; LANES],
        };
        let verdicts = classify::<K, A, B>(&batch);
        // The oracle is right to 8 units of the pair's size.
        let rounding = 1e-16 * 16.0 * 0.03;
        let bound = f64::from(verdicts.bounds[0]);
        assert!(bound <= distance + rounding, "{points:?} at {distance} not below {bound}");
        tight += usize::from(bound >= 0.99 * distance - 4.0 * f64::from(batch.slack[0]));
        if verdicts.rejected & 1 != 0 {
            assert!(distance > radii - rounding, "{points:?} at {distance} rejected for {radii}");
            counts[0] += 1;
        } else if verdicts.accepted & 1 != 0 {
            assert!(distance < radii + rounding, "{points:?} at {distance} accepted for {radii}");
            counts[1] += 1;
        } else {
            counts[2] += 1;
        }
    }
    assert!(counts.iter().all(|&count| count > 500), "{counts:?}");
    assert!(tight > 19_000, "{tight}");
}

#[test]
fn verdicts_of_vertices_are_certain() {
    check::<VertexVertex, 1, 1>(0.1);
    check::<VertexEdge, 1, 2>(0.1);
}

#[test]
fn verdicts_of_vertex_and_triangle_are_certain() {
    check::<VertexTriangle, 1, 3>(0.1);
    check::<VertexTriangle, 1, 3>(10.0);
}

#[test]
fn verdicts_of_edges_are_certain() {
    check::<EdgeEdge, 2, 2>(0.1);
    check::<EdgeEdge, 2, 2>(10.0);
}
