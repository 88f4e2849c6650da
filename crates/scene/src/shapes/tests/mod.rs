mod arrays;
mod elements;

use super::mesh::segments;
use super::*;
use bowknot_errors::Parameters;
use bowknot_geometry::{Point, Topology, Vector, check_mesh};

/// Fields out of their range.
fn fields(shape: Shape) -> Vec<String> {
    shape.validate().err().into_iter().flatten().map(|error| error.path).collect()
}

/// Euler characteristic: vertices less edges plus triangles.
pub(super) fn euler(mesh: &TriangleMesh) -> i64 {
    let topology = Topology::builder(mesh.positions.len())
        .triangles(mesh.triangles.iter().copied())
        .build()
        .expect("topology");
    mesh.positions.len() as i64 - topology.edges.len() as i64 + mesh.triangles.len() as i64
}

/// Volume enclosed, positive if triangles are counter-clockwise from outside.
fn volume(mesh: &TriangleMesh) -> f64 {
    let corner = |v: u32| mesh.positions[v as usize].coords;
    mesh.triangles.iter().map(|&[a, b, c]| corner(a).dot(&corner(b).cross(&corner(c))) / 6.0).sum()
}

#[test]
fn shapes_have_the_right_topology_and_no_faults() {
    let cases: [(Shape, i64); 11] = [
        (Shape::Sheet(Sheet::default()), 1),
        (Shape::Tube(Tube::default()), 0),
        (Shape::Ball(Ball::default()), 2),
        (Shape::Cone(Cone::default()), 2),
        (Shape::Box(Cuboid::default()), 2),
        (Shape::Figure(Figure::default()), 2),
        (Shape::Garment(Garment::default()), 0),
        (Shape::Wedge(Wedge::default()), 2),
        (Shape::Lathe(Lathe::default()), 0),
        (Shape::Lathe(Lathe { closed: false, ..Lathe::default() }), 0),
        (Shape::Ribbon(Ribbon::default()), 1),
    ];
    for (shape, expected) in cases {
        let mesh = shape.mesh().expect("a mesh");
        assert_eq!(check_mesh(&mesh.positions, &mesh.triangles), [], "{shape:?}");
        assert_eq!(euler(&mesh), expected, "{shape:?}");
    }
}

#[test]
fn closed_shapes_enclose_their_volume() {
    let ball = Ball { radius: 0.5, edge: 0.02 };
    let exact = 4.0 / 3.0 * std::f64::consts::PI * 0.125;
    assert!((volume(&ball.mesh()) / exact - 1.0).abs() < 2e-3);
    let cone = Cone { radius: 0.3, height: 0.6, edge: 0.05, sides: 200 };
    let exact = std::f64::consts::PI * 0.09 * 0.6 / 3.0;
    assert!((volume(&cone.mesh()) / exact - 1.0).abs() < 1e-3);
    let wedge = Wedge { length: 2.0, thickness: 0.1, height: 0.5, edge: 0.03 };
    assert!((volume(&wedge.mesh()) - 0.05).abs() < 1e-12);
    // A ring of square cross-section, by Pappus' theorem, whichever way its profile runs.
    let mut profile = Lathe::default().profile;
    for _ in 0..2 {
        let ring = Lathe { profile: profile.clone(), edge: 0.005, ..Lathe::default() };
        assert!((volume(&ring.mesh()) / (std::f64::consts::TAU * 0.225 * 0.0025) - 1.0).abs() < 1e-3);
        profile.reverse();
    }
    let cuboid = Cuboid { size: [0.2, 0.3, 0.4], edge: 0.05 };
    assert!((volume(&cuboid.mesh()) - 0.024).abs() < 1e-12);
}

#[test]
fn edges_have_about_the_length_asked_for() {
    let mesh = Ball { radius: 0.3, edge: 0.03 }.mesh();
    let topology = Topology::builder(mesh.positions.len())
        .triangles(mesh.triangles.iter().copied())
        .build()
        .expect("topology");
    for &[a, b] in &topology.edges {
        let length = (mesh.positions[a as usize] - mesh.positions[b as usize]).norm();
        assert!((0.02..0.045).contains(&length), "{length}");
    }
    let mesh = Sheet { size: [1.0, 0.5], edge: 0.1, ..Sheet::default() }.mesh();
    assert_eq!(mesh.positions.len(), 11 * 6);
    assert_eq!(mesh.triangles.len(), 2 * 10 * 5);
}

#[test]
fn lengths_out_of_range_are_named() {
    let sheet = Shape::Sheet(Sheet { edge: 1e-6, ..Sheet::default() });
    assert!(sheet.validate().expect_err("too fine")[0].allowed.contains("must be larger"));
    assert_eq!(fields(Shape::Ball(Ball { radius: -1.0, edge: f64::NAN })), ["radius", "edge"]);
    let lathe = Lathe { profile: vec![[0.1, 0.0], [0.0, 1.0]], edge: 0.0, closed: false };
    assert_eq!(fields(Shape::Lathe(lathe)), ["profile", "edge"]);
    let points = vec![Point::origin(); 2];
    let ribbon = Ribbon { points, across: vec![Vector::zeros()], width: 0.0, edge: 0.1 };
    assert_eq!(fields(Shape::Ribbon(ribbon)), ["points", "across", "across", "width"]);
}

/// Largest departure of an edge from its length in the flat strip, relative.
fn distortion(ribbon: &Ribbon) -> f64 {
    let mesh = ribbon.mesh();
    let topology = Topology::builder(mesh.positions.len())
        .triangles(mesh.triangles.iter().copied())
        .build()
        .expect("topology");
    let wide = segments(ribbon.width, ribbon.edge);
    let along = mesh.positions.len() as u32 / (wide + 1) - 1;
    let flat = |v: u32| {
        let (i, j) = (f64::from(v % (wide + 1)), f64::from(v / (wide + 1)));
        let (x, y) = (i / f64::from(wide) * ribbon.width, j / f64::from(along) * ribbon.length());
        Point::new(x, y, 0.0)
    };
    let place = |v: u32| mesh.positions[v as usize];
    let strain = |&[a, b]: &[u32; 2]| ((place(a) - place(b)).norm() / (flat(a) - flat(b)).norm() - 1.0).abs();
    topology.edges.iter().map(strain).fold(0.0, f64::max)
}

#[test]
fn a_ribbon_wound_around_a_cylinder_is_not_distorted() {
    // A quarter turn of a helix. Bent as paper bends, the strip keeps its lengths, but for the chords and for
    // the spline, which is rounder by a sixth of the squared angle between control points, 6e-5, and
    // straightens at its ends.
    let steps = 80;
    let angle = |k: i32| 0.5 * std::f64::consts::PI * f64::from(k) / f64::from(steps);
    let points = (0..=steps).map(|k| Point::new(angle(k).cos(), angle(k).sin(), 0.3 * angle(k)));
    let slope = (1.0f64 + 0.09).sqrt();
    let across = (0..=steps).map(|k| Vector::new(0.3 * angle(k).sin(), -0.3 * angle(k).cos(), 1.0) / slope);
    let ribbon = Ribbon { points: points.collect(), across: across.collect(), width: 0.1, edge: 0.01 };
    assert!(distortion(&ribbon) < 2e-4, "{}", distortion(&ribbon));
    assert!((ribbon.length() / (0.5 * std::f64::consts::PI * slope) - 1.0).abs() < 1e-3);
    // Of itself it does not turn about its center-line either; the same curve, turned steadily, is sheared.
    let free = Ribbon { across: Vec::new(), ..ribbon };
    assert!(distortion(&free) < 0.06);
}

#[test]
fn a_ribbon_starts_and_ends_at_its_outer_points_and_runs_straight_between_two() {
    let ribbon = Ribbon { width: 0.1, edge: 0.05, ..Ribbon::default() };
    let mesh = ribbon.mesh();
    assert_eq!(mesh.positions.len(), 21 * 3);
    for (v, p) in mesh.positions.iter().enumerate() {
        let expected = Point::new(-0.5 + 0.05 * (v / 3) as f64, -0.05 + 0.05 * (v % 3) as f64, 0.0);
        assert!((p - expected).norm() < 1e-12, "{v}: {p}");
    }
}

#[test]
fn figures_and_garments_out_of_range_are_named() {
    assert!(fields(Shape::Figure(Figure::default())).is_empty());
    let figure = Figure { edge: 0.05, cadence: f64::NAN, end: 0.1, ..Figure::default() };
    assert_eq!(fields(Shape::Figure(figure)), ["edge", "cadence", "end"]);
    assert_eq!(fields(Shape::Figure(Figure { edge: 1e-5, ..Figure::default() })), ["edge"]);
    assert!(fields(Shape::Garment(Garment::default())).is_empty());
    let garment = Garment { edge: 0.0, top: 1.4, waist: 0.3, ..Garment::default() };
    assert_eq!(fields(Shape::Garment(garment)), ["edge", "top", "waist"]);
    assert_eq!(fields(Shape::Garment(Garment { edge: 1e-5, ..Garment::default() })), ["edge"]);
}
