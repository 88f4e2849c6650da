use super::*;

#[test]
fn edges_are_joined_into_chains() {
    // A path of three edges given out of order, a fork at 5, a loop.
    let edges = [[2, 3], [0, 1], [2, 1], [4, 5], [5, 6], [5, 7], [8, 9], [9, 10], [10, 8]];
    let found = chains(&edges);
    let open = |vertices: &[u32]| Chain { vertices: vertices.to_vec(), closed: false };
    assert_eq!(
        found,
        [
            open(&[3, 2, 1, 0]),
            open(&[4, 5]),
            open(&[5, 6]),
            open(&[5, 7]),
            Chain { vertices: vec![8, 9, 10], closed: true }
        ]
    );
}

fn helix() -> Vec<Point> {
    (0..40).map(|k| f64::from(k) * 0.3).map(|a| Point::new(a.cos(), a.sin(), 0.1 * a)).collect()
}

#[test]
fn rings_lie_on_the_tube_and_do_not_twist() {
    let points = helix();
    let edges: Vec<[u32; 2]> = (1..points.len() as u32).map(|k| [k - 1, k]).collect();
    let (sides, radius) = (8, 0.05);
    let tubes = Tubes::new(&edges, sides);
    let vertices = tubes.vertices(&points, radius);
    assert_eq!(vertices.len(), (points.len() + 2 * CAP_RINGS) * sides);
    for v in &vertices {
        let distance = (v.position - points[v.source as usize]).norm();
        assert!((distance - radius).abs() < 1e-6 * radius + 2e-6, "{distance}");
        assert!((v.normal.norm() - 1.0).abs() < 1e-12);
    }
    // Neighboring rings are not twisted: the vector from a vertex to that of the next ring points along the
    // strand.
    let body = &vertices[CAP_RINGS * sides..(points.len() + CAP_RINGS) * sides];
    for k in 0..body.len() - sides {
        let (a, b) = (&body[k], &body[k + sides]);
        let along = points[b.source as usize] - points[a.source as usize];
        assert!((b.position - a.position).angle(&along) < 0.1);
    }
}

/// Checks that the surface is closed, each edge having two triangles of opposite orientation, and that it has
/// this volume [m3].
fn check_closed(tubes: &Tubes, vertices: &[TubeVertex], volume: f64) {
    let mut seen = std::collections::BTreeMap::new();
    let mut measured = 0.0;
    for &[i, j, k] in &tubes.triangles {
        for side in [[i, j], [j, k], [k, i]] {
            assert!(seen.insert(side, ()).is_none(), "{side:?} twice in the same direction");
        }
        let [a, b, c] = [i, j, k].map(|v| vertices[v as usize].position.coords);
        measured += a.dot(&b.cross(&c)) / 6.0;
    }
    let open = seen.keys().filter(|[a, b]| !seen.contains_key(&[*b, *a])).count();
    // The outermost ring at each end of an open chain bounds a hole of a thousandth of the radius.
    let ends = tubes.chains.iter().filter(|c| !c.closed).count();
    assert_eq!(open, 2 * ends * tubes.sides);
    assert!((measured / volume - 1.0).abs() < 0.03, "{measured} m3 for {volume} m3");
}

#[test]
fn tubes_are_closed_and_face_outward() {
    let radius = 0.1;
    let straight: Vec<Point> = (0..5).map(|k| Point::new(f64::from(k), 0.3, 0.0)).collect();
    let tubes = Tubes::new(&[[0, 1], [1, 2], [2, 3], [3, 4]], 32);
    let area = TAU / 2.0 * radius * radius;
    // Each end is half a ball, which adds two thirds of the radius to the length; two rings miss a part of
    // it.
    check_closed(&tubes, &tubes.vertices(&straight, radius), area * (4.0 + 2.0 * radius * 0.6));

    let n = 60;
    let ring: Vec<Point> = (0..n)
        .map(|k| (TAU * f64::from(k) / f64::from(n)).sin_cos())
        .map(|(s, c)| Point::new(c, s, 0.2 * c))
        .collect();
    let edges: Vec<[u32; 2]> = (0..n as u32).map(|k| [k, (k + 1) % n as u32]).collect();
    let tubes = Tubes::new(&edges, 16);
    let length: f64 = edges.iter().map(|&[a, b]| (ring[a as usize] - ring[b as usize]).norm()).sum();
    check_closed(&tubes, &tubes.vertices(&ring, radius), area * 0.974 * length);
}

#[test]
fn repeated_points_do_no_harm() {
    let points = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]].map(Point::from);
    let tubes = Tubes::new(&[[0, 1], [1, 2], [2, 3], [3, 3]], 6);
    assert!(tubes.vertices(&points, 0.1).iter().all(|v| v.position.iter().all(|c| c.is_finite())));
}
