use super::*;
use bowknot_geometry::{Topology, check_mesh};

fn euler(mesh: &TriangleMesh) -> i64 {
    let topology = Topology::new(mesh.positions.len(), mesh.triangles.clone(), &[], &[]).expect("topology");
    mesh.positions.len() as i64 - topology.edges.len() as i64 + mesh.triangles.len() as i64
}

/// Volume enclosed, positive if triangles are counter-clockwise from outside.
fn volume(mesh: &TriangleMesh) -> f64 {
    let corner = |v: u32| mesh.positions[v as usize].coords;
    mesh.triangles.iter().map(|&[a, b, c]| corner(a).dot(&corner(b).cross(&corner(c))) / 6.0).sum()
}

#[test]
fn shapes_have_the_right_topology_and_no_faults() {
    let cases: [(Shape, i64); 7] = [
        (Shape::Sheet(Sheet::default()), 1),
        (Shape::Tube(Tube::default()), 0),
        (Shape::Ball(Ball::default()), 2),
        (Shape::Cone(Cone::default()), 2),
        (Shape::Box(Cuboid::default()), 2),
        (Shape::Figure(Figure::default()), 2),
        (Shape::Garment(Garment::default()), 0),
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
    let cuboid = Cuboid { size: [0.2, 0.3, 0.4], edge: 0.05 };
    assert!((volume(&cuboid.mesh()) - 0.024).abs() < 1e-12);
}

#[test]
fn edges_have_about_the_length_asked_for() {
    let mesh = Ball { radius: 0.3, edge: 0.03 }.mesh();
    let topology = Topology::new(mesh.positions.len(), mesh.triangles.clone(), &[], &[]).expect("topology");
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
    let mut problems = Vec::new();
    Shape::Ball(Ball { radius: -1.0, edge: f64::NAN }).validate(&mut problems);
    assert_eq!(problems.iter().map(|p| p.0).collect::<Vec<_>>(), ["radius", "edge"]);
    problems.clear();
    Shape::Sheet(Sheet { edge: 1e-6, ..Sheet::default() }).validate(&mut problems);
    assert!(problems[0].1.contains("must be larger"));
}

#[test]
fn figures_and_garments_out_of_range_are_named() {
    let fields = |shape: Shape| {
        let mut problems = Vec::new();
        shape.validate(&mut problems);
        problems.into_iter().map(|p| p.0).collect::<Vec<_>>()
    };
    assert!(fields(Shape::Figure(Figure::default())).is_empty());
    let figure = Figure { edge: 0.05, cadence: f64::NAN, end: 0.1, ..Figure::default() };
    assert_eq!(fields(Shape::Figure(figure)), ["edge", "cadence", "end"]);
    assert_eq!(fields(Shape::Figure(Figure { edge: 1e-5, ..Figure::default() })), ["edge"]);
    assert!(fields(Shape::Garment(Garment::default())).is_empty());
    let garment = Garment { edge: 0.0, top: 1.4, waist: 0.3, ..Garment::default() };
    assert_eq!(fields(Shape::Garment(garment)), ["edge", "top", "waist"]);
    assert_eq!(fields(Shape::Garment(Garment { edge: 1e-5, ..Garment::default() })), ["edge"]);
}
