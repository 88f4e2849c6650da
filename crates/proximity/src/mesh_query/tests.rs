use super::*;
use bowknot_geometry::{distance, intersection};
use fastrand::Rng;

fn vector(random: &mut Rng, size: f64) -> Vector {
    Vector::from([0; 3].map(|_| size * (2.0 * random.f64() - 1.0)))
}

/// A ball with a bumpy surface, seen from outside counterclockwise: rings of quads, fans at the poles.
fn ball(rings: u32, sectors: u32, center: &Vector, random: &mut Rng) -> (Vec<Point>, Vec<[u32; 3]>) {
    let at = |random: &mut Rng, ring: u32, sector: u32| {
        let up = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
        let around = std::f64::consts::TAU * f64::from(sector) / f64::from(sectors);
        let place = Vector::new(up.sin() * around.cos(), up.sin() * around.sin(), up.cos());
        Point::from(center + place * (0.9 + 0.1 * random.f64()))
    };
    let mut x = vec![at(random, 0, 0), at(random, rings, 0)];
    let mut triangles = Vec::new();
    let place = |ring: u32, sector: u32| 2 + (ring - 1) * sectors + sector % sectors;
    for ring in 1..rings {
        for sector in 0..sectors {
            x.push(at(random, ring, sector));
            let (here, next) = (place(ring, sector), place(ring, sector + 1));
            if ring == 1 {
                triangles.push([0, here, next]);
            }
            if ring + 1 == rings {
                triangles.push([1, next, here]);
            } else {
                let (below, diagonal) = (place(ring + 1, sector), place(ring + 1, sector + 1));
                triangles.extend([[here, below, diagonal], [here, diagonal, next]]);
            }
        }
    }
    (x, triangles)
}

/// The surface of some cells of a grid of unit cubes, cells by `filled`.
fn cells(n: i32, filled: impl Fn([i32; 3]) -> bool) -> (Vec<Point>, Vec<[u32; 3]>) {
    let side = n + 1;
    let number = |[x, y, z]: [i32; 3]| ((x * side + y) * side + z) as u32;
    let places = (0..side).flat_map(|x| (0..side).flat_map(move |y| (0..side).map(move |z| [x, y, z])));
    let x = places.map(|p| Point::from(p.map(f64::from))).collect();
    let is_filled = |c: [i32; 3]| c.iter().all(|i| (0..n).contains(i)) && filled(c);
    let mut triangles = Vec::new();
    for cell in 0..n * n * n {
        let cell = [cell / (n * n), cell / n % n, cell % n];
        for axis in 0..3 {
            for side in [0, 1] {
                let mut beside = cell;
                beside[axis] += 2 * side - 1;
                if !is_filled(cell) || is_filled(beside) {
                    continue;
                }
                let corner = |u: i32, v: i32| {
                    let mut p = cell;
                    p[axis] += side;
                    p[(axis + 1) % 3] += u;
                    p[(axis + 2) % 3] += v;
                    number(p)
                };
                let mut square = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                if side == 0 {
                    square.reverse();
                }
                let [a, b, c, d] = square;
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    (x, triangles)
}

/// Every triangle, without a tree.
fn closest_of_all(x: &[Point], triangles: &[[u32; 3]], point: &Point) -> (u32, f64) {
    let distances =
        triangles.iter().map(|t| distance::vertex_triangle(point, t.map(|v| &x[v as usize])).distance);
    (0..).zip(distances).reduce(|a, b| if b.1 < a.1 { b } else { a }).expect("triangles")
}

#[test]
fn closest_points_are_those_of_all_triangles_whatever_positions_were_before() {
    let mut random = Rng::with_seed(1);
    for (size, shift) in [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e5), (1e-3, 10.0)] {
        let (x, triangles) = ball(20, 30, &Vector::zeros(), &mut random);
        let place = |x: &[Point]| -> Vec<Point> {
            x.iter().map(|p| Point::from(p.coords * size + Vector::repeat(shift))).collect()
        };
        let (start, end) = (place(&x), place(&ball(20, 30, &Vector::x(), &mut random).0));
        let mut mesh = MeshQuery::new(&start, &triangles).expect("valid");
        mesh.refit(&place(&x.iter().rev().copied().collect::<Vec<_>>())).expect("valid");
        mesh.refit(&end).expect("valid");
        let fresh = MeshQuery::new(&end, &triangles).expect("valid");
        let mut points = Vec::new();
        for _ in 0..300 {
            // Near and far, and vertices, which several triangles share.
            let reach = [0.5, 2.0, 1e3, 1e6][random.usize(..4)];
            points
                .push(Point::from((vector(&mut random, reach) + Vector::x()) * size + Vector::repeat(shift)));
            points.push(end[random.usize(..end.len())]);
        }
        let found = mesh.closest_points(&points, f64::INFINITY);
        for (point, found) in points.iter().zip(found) {
            let (triangle, distance) = closest_of_all(&end, &triangles, point);
            let found = found.expect("any distance will do");
            assert_eq!((found.triangle, found.distance), (triangle, distance), "{size} {shift} {point:?}");
            assert_eq!(fresh.closest_point(point, f64::INFINITY), Some(found));
            let scale = (point - found.point).norm() + point.coords.amax() + found.point.coords.amax();
            assert!(((point - found.point).norm() - distance).abs() <= 1e-14 * scale, "{found:?}");
            // The limit counts as near.
            assert_eq!(mesh.closest_point(point, distance), Some(found));
            if distance > 0.0 {
                assert_eq!(mesh.closest_point(point, distance.next_down()), None);
            }
        }
    }
}

/// The place where a ray meets a triangle, in general position.
fn meets(x: &[Point], t: &[u32; 3], origin: &Point, direction: &Vector) -> Option<f64> {
    let [a, b, c] = t.map(|v| x[v as usize]);
    let (e1, e2, r) = (b - a, c - a, origin - a);
    let p = direction.cross(&e2);
    let determinant = e1.dot(&p);
    let (u, q) = (r.dot(&p) / determinant, r.cross(&e1));
    let (v, t) = (direction.dot(&q) / determinant, e2.dot(&q) / determinant);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0).then_some(t)
}

#[test]
fn rays_meet_the_first_of_all_triangles() {
    let mut random = Rng::with_seed(2);
    let (x, triangles) = ball(20, 30, &Vector::zeros(), &mut random);
    let mesh = MeshQuery::new(&x, &triangles).expect("valid");
    let mut hits = 0;
    for _ in 0..3_000 {
        let origin = Point::from(vector(&mut random, 3.0));
        let direction = vector(&mut random, 1.0) * 10_f64.powi(random.i32(-3..4));
        let met = (0..).zip(&triangles).filter_map(|(i, t)| Some((i, meets(&x, t, &origin, &direction)?)));
        let first = met.reduce(|a: (u32, f64), b| if b.1 < a.1 { b } else { a });
        let found = mesh.cast_ray(&origin, &direction, f64::INFINITY);
        assert_eq!(found.map(|hit| hit.triangle), first.map(|first| first.0), "{origin:?} {direction:?}");
        if let (Some(found), Some((_, t))) = (found, first) {
            hits += 1;
            assert!((found.t - t).abs() < 1e-9 * t, "{found:?} {t}");
            assert!((origin + direction * t - found.point).norm() < 1e-9, "{found:?}");
            assert_eq!(mesh.cast_ray(&origin, &direction, 1.001 * t), Some(found));
            assert_eq!(mesh.cast_ray(&origin, &direction, 0.999 * t), None);
        }
    }
    assert!(hits > 150, "{hits}");
}

#[test]
fn no_ray_leaves_a_closed_mesh_through_edges_and_vertices() {
    let mut random = Rng::with_seed(3);
    let (x, triangles) = ball(40, 60, &Vector::repeat(7.0), &mut random);
    let mesh = MeshQuery::new(&x, &triangles).expect("valid");
    for _ in 0..20_000 {
        let origin = Point::from(Vector::repeat(7.0) + vector(&mut random, 0.4));
        let [a, b, c] = triangles[random.usize(..triangles.len())].map(|v| x[v as usize].coords);
        let target = [a, a + (b - a) * random.f64(), (a + b + c) / 3.0][random.usize(..3)];
        let direction = target - origin.coords;
        let hit = mesh.cast_ray(&origin, &direction, f64::INFINITY).expect("the mesh is closed");
        // Bumps may be before it, or behind it where the ray grazes them.
        assert!(hit.t > 0.5 && hit.t < 1.5, "{hit:?}");
    }
    // Along edges, and in the plane of faces: grids have many of both.
    let (x, triangles) = cells(3, |_| true);
    let mesh = MeshQuery::new(&x, &triangles).expect("valid");
    for (origin, direction, t) in [
        ([0.0, 0.0, -1.0], Vector::z(), 1.0),
        ([-2.0, 0.0, 0.0], Vector::x(), 2.0),
        ([-1.0, -1.0, 3.0], Vector::new(1.0, 1.0, 0.0), 1.0),
        ([1.5, 1.5, 0.0], Vector::x(), 0.0),
        ([1.5, 1.5, 1.5], Vector::new(0.0, 0.0, -0.5), 3.0),
        ([5.0, 1.0, 3.0], -Vector::x(), 2.0),
    ] {
        let hit = mesh.cast_ray(&Point::from(origin), &direction, f64::INFINITY).expect("it is met");
        assert_eq!(hit.t, t, "{origin:?} {hit:?}");
    }
    assert!(mesh.cast_ray(&Point::new(-1.0, -1e-12, 0.0), &Vector::x(), f64::INFINITY).is_none());
}

#[test]
fn inside_is_what_the_cells_say_on_faces_edges_and_vertices_too() {
    // With a hole, and a cavity.
    let filled = |[x, y, z]: [i32; 3]| [x, y] != [1, 1] && [x, y, z] != [3, 3, 3];
    let (mut x, triangles) = cells(5, filled);
    let mut mesh = MeshQuery::new(&x, &triangles).expect("valid");
    assert!(mesh.is_closed());
    for shear in [0.0, 0.25] {
        // Multiples of powers of two: the sheared cells are exact.
        let place = |p: [f64; 3]| Point::new(p[0] + shear * p[2], p[1] + shear * p[0], p[2]);
        mesh.refit(&x.iter().map(|p| place([p.x, p.y, p.z])).collect::<Vec<_>>()).expect("valid");
        let mut seen = [0; 2];
        for i in 0..24 * 24 * 24 {
            let half = [i / 576, i / 24 % 24, i % 24].map(|k| k - 1);
            let point = half.map(|k| 0.25 * f64::from(k));
            // Cells that contain the point; on a face, both.
            let of = |k: i32| {
                if k % 4 == 0 { [k.div_euclid(4) - 1, k.div_euclid(4)] } else { [k.div_euclid(4); 2] }
            };
            let [xs, ys, zs] = half.map(of);
            let cells = (0..8).map(|i| [xs[i & 1], ys[i >> 1 & 1], zs[i >> 2]]);
            let expected = cells.clone().any(|c| c.iter().all(|k| (0..5).contains(k)) && filled(c));
            assert_eq!(mesh.is_inside(&place(point)), Some(expected), "{point:?}");
            seen[usize::from(expected)] += 1;
        }
        assert!(seen.iter().all(|&count| count > 3_000), "{seen:?}");
    }
    // The other orientation, and both at once: one inside the other cancels.
    let turned: Vec<[u32; 3]> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    let point = Point::new(0.5, 0.5, 0.5);
    assert_eq!(MeshQuery::new(&x, &turned).expect("valid").is_inside(&point), Some(true));
    let both = MeshQuery::new(&x, &[triangles.clone(), turned].concat()).expect("valid");
    assert_eq!(both.is_inside(&point), Some(false));
    // A mesh with a border has no inside, and neither has one without a place.
    assert_eq!(MeshQuery::new(&x, &triangles[1..]).expect("valid").is_inside(&point), None);
    x[triangles[0][0] as usize].y = f64::NAN;
    mesh.refit(&x).expect("valid");
    assert_eq!(mesh.is_inside(&point), None);
}

#[test]
fn random_points_are_inside_as_often_as_rays_leave() {
    let mut random = Rng::with_seed(4);
    let (x, triangles) = ball(12, 16, &Vector::zeros(), &mut random);
    let mesh = MeshQuery::new(&x, &triangles).expect("valid");
    let far = vector(&mut random, 1.0) + Vector::repeat(9.0);
    let mut inside = 0;
    for _ in 0..2_000 {
        let point = Point::from(vector(&mut random, 1.0));
        let end = point + far;
        let passed = triangles
            .iter()
            .filter(|t| intersection::edge_triangle([&point, &end], t.map(|v| &x[v as usize])));
        let expected = passed.count() % 2 == 1;
        assert_eq!(mesh.is_inside(&point), Some(expected), "{point:?}");
        inside += usize::from(expected);
    }
    assert!((500..1_500).contains(&inside), "{inside}");
}

#[test]
fn input_without_a_place_finds_nothing() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [f64::NAN, 0.0, 1.0]].map(Point::from);
    let (point, all) = (Point::new(0.2, 0.2, 1.0), f64::INFINITY);
    for mesh in
        [MeshQuery::new(&[], &[]), MeshQuery::new(&corners, &[]), MeshQuery::new(&corners, &[[0, 1, 3]])]
    {
        let mesh = mesh.expect("valid");
        assert_eq!(mesh.closest_point(&point, all), None);
        assert_eq!(mesh.cast_ray(&point, &-Vector::z(), all), None);
        assert_eq!(mesh.is_inside(&point), None);
    }
    let mut mesh = MeshQuery::new(&corners, &[[0, 1, 3], [0, 1, 2]]).expect("valid");
    assert_eq!(mesh.closest_point(&point, all).map(|found| found.triangle), Some(1));
    assert_eq!(mesh.cast_ray(&point, &-Vector::z(), all).map(|hit| (hit.triangle, hit.t)), Some((1, 1.0)));
    for bad in [f64::NAN, f64::INFINITY, 1e16] {
        let nowhere = Point::new(0.0, bad, 0.0);
        assert_eq!(mesh.closest_point(&nowhere, all), None);
        assert_eq!(mesh.cast_ray(&nowhere, &Vector::z(), all), None);
        assert!(bad == 1e16 || mesh.cast_ray(&point, &Vector::new(0.0, bad, -1.0), all).is_none());
    }
    for limit in [f64::NAN, -1.0] {
        assert_eq!(mesh.closest_point(&point, limit), None);
        assert_eq!(mesh.cast_ray(&point, &-Vector::z(), limit), None);
    }
    for direction in [0.0, 1e-320, 1e-300] {
        assert_eq!(mesh.cast_ray(&point, &(Vector::z() * direction), all), None);
    }
    assert!(mesh.cast_ray(&point, &(Vector::z() * -1e300), all).is_some());
    assert_eq!(mesh.refit(&corners[1..]), Err(MeshQueryError::PositionCount { given: 3, vertices: 4 }));
    assert!(matches!(MeshQuery::new(&corners, &[[0, 1, 4]]), Err(MeshQueryError::Vertex(_))));
}
