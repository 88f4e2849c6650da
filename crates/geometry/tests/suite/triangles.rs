use crate::integer::{Fraction, Int3, distance_squared, edge_meets_triangle, square_at_most};
use crate::sampling::{Random, near_degenerate_pair};
use crate::slab_width::{certified, slab_between};
use bowknot_geometry::{PairKind, Point, TriangleFeature, TriangleSeparation, Vector, separation};

/// 2^-53.
const U: f64 = f64::EPSILON / 2.0;

fn separate(points: &[Point; 6]) -> TriangleSeparation {
    let [a0, a1, a2, b0, b1, b2] = points;
    separation::triangle_triangle([a0, a1, a2], [b0, b1, b2])
}

/// Largest coordinate difference.
fn extent(points: &[Point; 6]) -> f64 {
    points.iter().flat_map(|p| points.iter().map(move |q| (p - q).amax())).fold(0.0, f64::max)
}

/// The points of the two sides that the weights name, one minus the other.
fn offset(points: &[Point; 6], weights: &[[f64; 3]; 2]) -> Vector {
    (0..3)
        .map(|k| (points[k] - points[0]) * weights[0][k] - (points[k + 3] - points[0]) * weights[1][k])
        .sum()
}

fn edges([p, q, r]: [Int3; 3]) -> [[Int3; 2]; 3] {
    [[p, q], [q, r], [r, p]]
}

fn intersect(a: [Int3; 3], b: [Int3; 3]) -> bool {
    edges(a).into_iter().any(|edge| edge_meets_triangle(edge, b))
        || edges(b).into_iter().any(|edge| edge_meets_triangle(edge, a))
}

/// Squared distance by all fifteen pairs of features.
fn exact_squared(a: [Int3; 3], b: [Int3; 3]) -> Fraction {
    if intersect(a, b) {
        return Fraction { numerator: 0, denominator: 1 };
    }
    let faces = [(a, b), (b, a)].into_iter().flat_map(|(points, [p, q, r])| {
        points.map(|point| distance_squared(PairKind::VertexTriangle, [point, p, q, r]))
    });
    let sides = edges(a)
        .into_iter()
        .flat_map(|[p, q]| edges(b).map(|[r, s]| distance_squared(PairKind::EdgeEdge, [p, q, r, s])));
    let squares = faces.chain(sides);
    squares.reduce(|x, y| if y.to_f64() < x.to_f64() { y } else { x }).expect("fifteen pairs")
}

/// Six points on a grid; coarse grids and copies make degenerate and touching triangles common.
fn grid_triangles(random: &mut Random) -> [[Int3; 3]; 2] {
    let range = [1, 2, 4, 16, 256][random.below(5)];
    let mut p = [0; 6].map(|_| [0; 3].map(|_: i32| random.below(2 * range + 1) as i128 - range as i128));
    let [i, j, k] = [0; 3].map(|_: i32| random.below(6));
    match random.below(6) {
        0 => p[i] = p[j],
        1 => p[i] = [0, 1, 2].map(|c| (p[j][c] + p[k][c]) / 2),
        // Parallel planes, or one plane.
        2 => {
            let axis = random.below(3);
            let heights = [p[i][axis], p[j][axis]];
            (0..6).for_each(|v| p[v][axis] = heights[v / 3]);
        }
        _ => {}
    }
    [[p[0], p[1], p[2]], [p[3], p[4], p[5]]]
}

#[test]
fn distances_and_bounds_are_those_of_integer_arithmetic() {
    let mut random = Random::new(21);
    let mut seen = [0; 2];
    for i in 0..400_000 {
        let [a, b] = grid_triangles(&mut random);
        // From micrometers to thousands of kilometers, and far from the origin; all exact.
        let (spacing, shift) =
            [(1.0, 0.0), (2_f64.powi(-20), 0.0), (2_f64.powi(20), 0.0), (2_f64.powi(-20), 8192.0)][i % 4];
        let points =
            [a[0], a[1], a[2], b[0], b[1], b[2]].map(|p| Point::from(p.map(|x| x as f64 * spacing + shift)));
        let found = separate(&points);
        let squared = exact_squared(a, b);
        let expected = squared.to_f64().sqrt() * spacing;
        let tolerance = 8.0 * U * extent(&points);
        assert_eq!(found.intersect, squared.numerator == 0, "{a:?} {b:?} {found:?}");
        assert!((found.distance - expected).abs() <= tolerance, "{a:?} {b:?} {found:?} {expected}");
        assert!((found.normal.norm() - 1.0).abs() < 1e-14);
        // The weights name points at that distance.
        let named = offset(&points, &found.weights);
        assert!((named.norm() - expected).abs() <= 2.0 * tolerance, "{a:?} {b:?} {found:?} {expected}");
        for weights in found.weights {
            assert!(weights.iter().all(|w| (0.0..=1.0).contains(w)), "{a:?} {b:?} {found:?}");
            assert!((weights.iter().sum::<f64>() - 1.0).abs() <= 4.0 * U, "{a:?} {b:?} {found:?}");
        }
        if found.intersect {
            assert!(found.width <= 0.0 && found.distance == 0.0, "{a:?} {b:?} {found:?}");
        } else {
            assert!(square_at_most(found.width / spacing, squared), "{a:?} {b:?} {found:?}");
            assert!(found.width >= 0.99 * expected, "{a:?} {b:?} {found:?} {expected}");
        }
        seen[usize::from(found.intersect)] += 1;
        // Exchanged triangles.
        let swapped = separate(&[points[3], points[4], points[5], points[0], points[1], points[2]]);
        assert_eq!(swapped.intersect, found.intersect);
        assert!((swapped.distance - found.distance).abs() <= tolerance, "{a:?} {b:?}");
    }
    assert!(seen.iter().all(|&count| count > 50_000), "{seen:?}");
}

/// Two triangles, near-degenerate on purpose.
fn near_degenerate_triangles(random: &mut Random) -> [Point; 6] {
    let [p0, p1, p2, p3] = near_degenerate_pair(random);
    let mut points = [p0, p1, p2, p3, p0, p0];
    for v in 4..6 {
        let [i, j, k] = [0; 3].map(|_: i32| random.below(v));
        let base = points[i];
        let (s, t) = (1.5 * random.signed(), 1.5 * random.signed());
        let speck = random.speck((points[j] - points[k]).norm());
        points[v] = base + (points[j] - base) * s + (points[k] - base) * t + speck;
    }
    points
}

#[test]
fn widths_of_near_degenerate_triangles_are_certified() {
    let mut random = Random::new(22);
    let mut judged = 0;
    for _ in 0..300_000 {
        let points = near_degenerate_triangles(&mut random);
        let found = separate(&points);
        let scale = extent(&points);
        let exact = slab_between(&points[..3], &points[3..], &found.normal);
        assert!(certified(found.width, &found.normal, exact, scale), "{points:?} {found:?}");
        assert!(found.width <= found.distance && !(found.intersect && found.width > 0.0), "{found:?}");
        if !found.intersect && found.distance > 1e-13 * scale {
            judged += 1;
            assert!(found.width > 0.9 * found.distance, "{points:?} {found:?}");
        }
    }
    assert!(judged > 100_000, "{judged}");
}

#[test]
fn distances_agree_with_parry_in_general_position() {
    use parry3d_f64::math::{Pose, Vector};
    use parry3d_f64::query;
    use parry3d_f64::shape::Triangle;
    let mut random = Random::new(23);
    let mut apart = 0;
    for _ in 0..50_000 {
        let points = [0; 6].map(|_| Point::from(random.vector(1.0)));
        let [a0, a1, a2, b0, b1, b2] = points.map(|p| Vector::new(p.x, p.y, p.z));
        let (a, b) = (Triangle::new(a0, a1, a2), Triangle::new(b0, b1, b2));
        let theirs = query::distance(&Pose::IDENTITY, &a, &Pose::IDENTITY, &b).expect("supported").distance;
        let ours = separate(&points);
        // Theirs iterates to a tolerance.
        assert!((ours.distance - theirs).abs() < 1e-6, "{points:?} {ours:?} {theirs}");
        apart += usize::from(!ours.intersect);
    }
    assert!(apart > 10_000, "{apart}");
}

#[test]
fn segments_and_points_are_triangles_with_equal_vertices() {
    let p = |x: f64, y: f64, z: f64| Point::new(x, y, z);
    let face = [p(0.0, 0.0, 0.0), p(4.0, 0.0, 0.0), p(0.0, 4.0, 0.0)];
    let of = |[a0, a1, a2]: [Point; 3]| separate(&[a0, a1, a2, face[0], face[1], face[2]]);
    let (low, high) = (p(1.0, 1.0, 2.0), p(1.0, 1.0, 5.0));
    let standing = of([low, high, high]);
    assert_eq!((standing.distance, standing.normal, standing.intersect), (2.0, Vector::z(), false));
    assert_eq!(standing.features(), [TriangleFeature::Vertex(0), TriangleFeature::Face]);
    assert!(of([p(1.0, 1.0, -1.0), high, high]).intersect);
    assert!(of([face[1]; 3]).intersect && of([face[1]; 3]).distance == 0.0);
    assert_eq!(of([p(4.0, 0.0, 3.0); 3]).features()[1], TriangleFeature::Vertex(1));
    let beside = of([p(2.0, 3.0, 0.0), p(3.0, 2.0, 0.0), p(9.0, 9.0, 0.0)]);
    assert!((beside.distance - 0.5_f64.sqrt()).abs() < 1e-15);
    assert_eq!(beside.features()[1], TriangleFeature::Edge(1));
}

#[test]
fn coordinates_of_any_size_give_numbers_and_others_do_not() {
    let mut random = Random::new(24);
    for _ in 0..2_000 {
        let points = [0; 6].map(|_| Point::from(random.vector(1.0)));
        let plain = separate(&points);
        for exponent in [-1000, -900, -300, 300, 900, 1020] {
            let scale = 2_f64.powi(exponent);
            let scaled = separate(&points.map(|p| p * scale));
            // The exact test is out of its range, but it is asked only where nothing certifies a gap.
            if plain.intersect {
                continue;
            }
            assert!((scaled.distance / scale - plain.distance).abs() < 1e-14, "{exponent} {scaled:?}");
            assert!(scaled.width <= scaled.distance, "{exponent} {scaled:?}");
            assert!((scaled.width / scale - plain.width).abs() < 1e-10, "{exponent} {scaled:?}");
        }
        for bad in [f64::NAN, f64::INFINITY] {
            let mut points = points;
            points[random.below(6)][random.below(3)] = bad;
            let found = separate(&points);
            assert!(found.distance.is_nan() && found.width == 0.0 && !found.intersect);
        }
    }
    assert!(separate(&[Point::new(1.0, 2.0, 3.0); 6]).intersect);
}
