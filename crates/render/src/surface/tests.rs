use super::*;

/// Two triangles that share an edge, the second turned up by an angle [deg].
fn hinge(angle: f64) -> ([[u32; 3]; 2], Vec<Point>) {
    let (s, c) = angle.to_radians().sin_cos();
    let points = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [c, 0.0, s]].map(Point::from);
    ([[0, 1, 2], [1, 0, 3]], points.to_vec())
}

#[test]
fn smooth_edges_share_normals_and_creases_do_not() {
    let (triangles, points) = hinge(30.0);
    let smooth = Surface::new(&triangles, &points);
    assert_eq!(smooth.sources, [0, 1, 2, 3]);
    let n = smooth.normals(&points);
    assert!((n[0] - n[1]).norm() < 1e-12);
    // Half way between the two triangles' normals.
    assert!((n[0].angle(&n[2]).to_degrees() - 15.0).abs() < 1e-9, "{n:?}");

    let (triangles, points) = hinge(90.0);
    let crease = Surface::new(&triangles, &points);
    assert_eq!(crease.sources, [0, 1, 2, 1, 0, 3]);
    let n = crease.normals(&points);
    assert!((n[0] - n[2]).norm() < 1e-12 && n[0].dot(&n[3]).abs() < 1e-12);
}

/// What is smooth at rest stays smooth however it folds.
#[test]
fn creases_are_those_at_rest() {
    let (triangles, flat) = hinge(0.0);
    let surface = Surface::new(&triangles, &flat);
    let (_, folded) = hinge(120.0);
    let n = surface.normals(&folded);
    assert!((n[0].angle(&n[2]).to_degrees() - 60.0).abs() < 1e-9);
}

#[test]
fn a_cube_keeps_its_edges() {
    let points: Vec<Point> =
        (0..8).map(|k| Point::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2))).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let surface = Surface::new(&triangles, &points);
    assert_eq!(surface.sources.len(), 24);
    for (n, &v) in surface.normals(&points).iter().zip(&surface.sources) {
        assert!((n.abs().max() - 1.0).abs() < 1e-12);
        assert!(n.dot(&(points[v as usize] - Point::new(0.5, 0.5, 0.5))) > 0.0, "it points outward");
    }
}

#[test]
fn flat_triangles_get_a_normal() {
    let points = vec![Point::origin(); 3];
    let surface = Surface::new(&[[0, 1, 2]], &points);
    assert!(surface.normals(&points).iter().all(|n| (n.norm() - 1.0).abs() < 1e-12));
}
