use crate::integer::{Int3, cross, distance_squared, dot, edge_meets_triangle, sub};
use crate::sampling::Random;
use bowknot_geometry::{PairKind, Point, intersection};

fn check(edge: [Int3; 2], triangle: [Int3; 3], to_point: impl Fn(Int3) -> Point) {
    let [p, q] = edge.map(&to_point);
    let [a, b, c] = triangle.map(&to_point);
    assert_eq!(
        intersection::edge_triangle([&p, &q], [&a, &b, &c]),
        edge_meets_triangle(edge, triangle),
        "{edge:?} {triangle:?}"
    );
}

fn as_they_are(p: Int3) -> Point {
    Point::from(p.map(|x| x as f64))
}

/// Scaled by 2^-20 and moved far away, without rounding.
fn far_away(p: Int3) -> Point {
    Point::new(8192.0, -4096.0, 1024.0) + nalgebra::Vector3::from(p.map(|x| x as f64 * 2_f64.powi(-20)))
}

#[test]
fn every_edge_and_triangle_of_the_smallest_grid() {
    let grid: Vec<Int3> = (0..27).map(|i| [i % 3, i / 3 % 3, i / 9]).collect();
    let n = grid.len();
    let edges: Vec<[Int3; 2]> =
        (0..n).flat_map(|i| (i..n).map(move |j| (i, j))).map(|(i, j)| [grid[i], grid[j]]).collect();
    for i in 0..n {
        for j in i..n {
            for k in j..n {
                for &edge in &edges {
                    check(edge, [grid[i], grid[j], grid[k]], as_they_are);
                }
            }
        }
    }
}

#[test]
fn random_edges_and_triangles_in_every_order_and_far_away() {
    let mut random = Random::new(6);
    for i in 0..1_000_000 {
        let range = [3, 5, 9, 64][i % 4];
        let mut point = || [0; 3].map(|_: i32| random.below(range) as i128);
        let edge = [point(), point()];
        let triangle = [point(), point(), point()];
        if i % 2 == 0 { check(edge, triangle, as_they_are) } else { check(edge, triangle, far_away) }
    }
}

#[test]
fn points_and_edges_meet_where_their_exact_distance_is_zero() {
    let mut random = Random::new(7);
    let mut met = [0; 3];
    for i in 0..600_000 {
        let range = [2, 3, 5][i % 3];
        let grid = [0; 4].map(|_| [0; 3].map(|_: i32| random.below(range) as i128));
        let to_point = if i % 2 == 0 { as_they_are } else { far_away };
        let [p0, p1, p2, p3] = &grid.map(to_point);
        let found = [
            (PairKind::VertexEdge, intersection::point_on_edge(p0, [p1, p2])),
            (PairKind::VertexTriangle, intersection::point_on_triangle(p0, [p1, p2, p3])),
            (PairKind::EdgeEdge, intersection::edge_edge([p0, p1], [p2, p3])),
        ];
        for (k, (kind, meets)) in found.into_iter().enumerate() {
            assert_eq!(meets, distance_squared(kind, grid).numerator == 0, "{kind:?} {grid:?}");
            met[k] += usize::from(meets);
        }
    }
    assert!(met.iter().all(|&m| m > 10_000), "{met:?}");
}

#[test]
fn crossings_of_a_tetrahedron_wind_around_its_inside_alone() {
    let mut random = Random::new(25);
    let mut seen = [0; 3];
    for i in 0..400_000 {
        // Coarse grids: rays pass through edges and vertices all the time.
        let range = [3, 4, 6][i % 3];
        let mut place = || [0; 3].map(|_: i32| random.below(range) as i128);
        let (corners, point) = ([place(), place(), place(), place()], place());
        let volume = |[a, b, c, d]: [Int3; 4]| dot(sub(a, d), cross(sub(b, d), sub(c, d))).signum();
        let whole = volume(corners);
        let parts = [0, 1, 2, 3].map(|k: usize| {
            let mut part = corners;
            part[k] = point;
            volume(part)
        });
        if whole == 0 || !parts.contains(&-whole) && parts.contains(&0) {
            // Flat, or the point is on the surface.
            continue;
        }
        let inside = parts == [whole; 4];
        let to_point = if i % 2 == 0 { as_they_are } else { far_away };
        let [a, b, c, d] = corners.map(to_point);
        let at = to_point(point);
        let faces = [[&a, &b, &c], [&a, &c, &d], [&a, &d, &b], [&b, &d, &c]];
        let winding: i8 = faces.iter().map(|face| intersection::upward_crossing(&at, *face)).sum();
        // These faces are seen from outside counterclockwise if the volume is positive.
        let expected = if inside { whole as i8 } else { 0 };
        assert_eq!(winding, expected, "{corners:?} {point:?}");
        seen[(expected + 1) as usize] += 1;
    }
    assert!(seen.iter().all(|&count| count > 500), "{seen:?}");
}
