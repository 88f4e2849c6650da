use super::*;
use bowknot_geometry::separation;

/// Two triangles that share the edge 0-1 along y, at x = +-1, `height` below it; and free vertices.
fn roof(height: f64, others: &[[f64; 3]]) -> (Topology, Vec<Point>) {
    let mut x: Vec<Point> = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.5, -height], [-1.0, 0.5, -height]]
        .map(Point::from)
        .to_vec();
    x.extend(others.iter().map(|p| Point::from(*p)));
    let mut triangles = vec![[0, 2, 1], [0, 1, 3]];
    if others.len() == 4 {
        triangles.extend([[4, 6, 5], [4, 5, 7]]);
    }
    let particles: Vec<u32> = if others.len() == 4 { vec![] } else { (4..x.len() as u32).collect() };
    (Topology::builder(x.len()).triangles(triangles).particles(particles).build().expect("valid"), x)
}

fn above(height: f64, point: [f64; 3]) -> Vec<bool> {
    let (topology, x) = roof(height, &[point]);
    let facing = Facing::new(&topology);
    (0..2u32)
        .map(|t| {
            let [a, b, c] = topology.triangles[t as usize];
            let pair = Pair { elements: [4, t], vertices: [4, a, b, c] };
            let kind = PairKind::VertexTriangle;
            let s = separation::separate(kind, &pair.vertices.map(|v| x[v as usize]));
            let features = Facing::features(&topology, kind, &pair, &s);
            facing.is_contact(&topology, features, &s.normal, &x, 0.01)
        })
        .collect()
}

#[test]
fn above_a_flat_surface_only_the_face_below_is_a_contact() {
    assert_eq!(above(0.0, [0.1, 0.5, 0.1]), [true, false]);
    assert_eq!(above(0.0, [-0.1, 0.5, 0.1]), [false, true]);
    // Exactly above the edge both are contacts.
    assert_eq!(above(0.0, [0.0, 0.5, 0.1]), [true, true]);
}

#[test]
fn a_tilted_normal_turns_into_the_cone_and_one_within_stays() {
    let (topology, x) = roof(0.0, &[[0.1, 0.5, 0.1]]);
    let facing = Facing::new(&topology);
    let edge = topology.edges.iter().position(|e| *e == [0, 1]).expect("an edge") as u32;
    let turned = |x: &[Point], n: Vector| {
        facing.turned(&topology, [Feature::Vertex(4), Feature::Edge(edge)], &n.normalize(), x)
    };
    assert!((turned(&x, Vector::new(0.1, 0.0, 1.0)) - Vector::z()).norm() < 1e-12);
    let (_, ridge) = roof(0.5, &[[0.1, 0.5, 0.1]]);
    let within = Vector::new(0.1, 0.0, 1.0).normalize();
    assert_eq!(turned(&ridge, within), within);
    let leaned = turned(&ridge, Vector::new(1.0, 0.0, 1.0));
    assert!((leaned - Vector::new(0.5, 0.0, 1.0).normalize()).norm() < 1e-12, "{leaned}");
}

#[test]
fn above_a_ridge_the_edge_is_a_contact_and_in_a_valley_both_faces_are() {
    assert_eq!(above(0.5, [0.01, 0.5, 0.1]), [true, true]);
    assert_eq!(above(-0.5, [0.01, 0.5, 0.1]), [true, true]);
    assert_eq!(above(0.5, [0.1, 0.5, 0.02]), [true, false]);
}

#[test]
fn crossing_edges_are_contacts_if_one_of_them_is_a_ridge() {
    let crossing = |lower: f64, upper: f64| {
        let h = 0.05;
        // A second roof turned by 90 degrees about the vertical, upside down.
        let over = [[-0.5, 0.5, h], [0.5, 0.5, h], [0.0, 1.5, h + upper], [0.0, -0.5, h + upper]];
        let (topology, x) = roof(lower, &over);
        let facing = Facing::new(&topology);
        let edge = |v: [u32; 2]| topology.edges.iter().position(|e| *e == v).expect("an edge") as u32;
        let (a, b) = (edge([0, 1]), edge([4, 5]));
        let pair = Pair { elements: [a, b], vertices: [0, 1, 4, 5] };
        let s = separation::separate(PairKind::EdgeEdge, &pair.vertices.map(|v| x[v as usize]));
        let features = Facing::features(&topology, PairKind::EdgeEdge, &pair, &s);
        assert_eq!(features, [Feature::Edge(a), Feature::Edge(b)]);
        facing.is_contact(&topology, features, &s.normal, &x, 0.01)
    };
    assert!(crossing(0.5, 0.5) && crossing(0.5, 0.0) && crossing(0.0, 0.5));
    assert!(!crossing(0.0, 0.0), "within flat surfaces vertices and faces represent the contact");
    assert!(!crossing(-0.5, 0.5), "a valley makes no contact");
}
