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
        facing.turned(&topology, [Feature::Vertex(4), Feature::Edge(edge)], &n.normalize(), x, None)
    };
    assert!((turned(&x, Vector::new(0.1, 0.0, 1.0)) - Vector::z()).norm() < 1e-12);
    let (_, ridge) = roof(0.5, &[[0.1, 0.5, 0.1]]);
    let within = Vector::new(0.1, 0.0, 1.0).normalize();
    assert_eq!(turned(&ridge, within), within);
    let leaned = turned(&ridge, Vector::new(1.0, 0.0, 1.0));
    assert!((leaned - Vector::new(0.5, 0.0, 1.0).normalize()).norm() < 1e-12, "{leaned}");
}

/// A fan of six triangles around vertex 0, flat, and one triangle above it, tilted: vertices 7 to 9.
#[test]
fn the_normal_of_a_rigid_plane_counts_alone() {
    let rim = |k: u32| {
        let (sin, cos) = (f64::from(k) * 60.0f64.to_radians()).sin_cos();
        Point::new(cos, sin, 0.0)
    };
    let mut x = vec![Point::origin()];
    x.extend((0..6).map(rim));
    x.extend([[-0.3, -0.3, 0.1], [0.6, -0.3, 0.11], [-0.3, 0.6, 0.12]].map(Point::from));
    let mut triangles: Vec<[u32; 3]> = (0..6).map(|k| [0, 1 + k, 1 + (k + 1) % 6]).collect();
    triangles.push([7, 8, 9]);
    let topology = Topology::builder(x.len()).triangles(triangles).build().expect("valid");
    let facing = Facing::new(&topology);
    let normal = (x[8] - x[7]).cross(&(x[9] - x[7])).normalize();
    let features = [Feature::Vertex(0), Feature::Triangle(6)];
    let turned = |rigid| facing.turned(&topology, features, &-normal, &x, rigid);
    assert_eq!((turned(None), turned(Some(1))), (-normal, -normal));
    assert!((turned(Some(0)) + Vector::z()).norm() < 1e-15, "{}", turned(Some(0)));
    // Beyond its border, above one of its edges, and where it is bent.
    let turned = |features, normal: Vector, x: &[Point]| {
        facing.turned(&topology, features, &normal.normalize(), x, Some(1))
    };
    let [x_axis, tilted] = [Vector::x(), Vector::new(0.05, 0.02, 1.0)];
    assert_eq!(turned([Feature::Vertex(7), Feature::Vertex(1)], x_axis, &x), x_axis);
    let spoke = topology.edges.iter().position(|e| *e == [0, 1]).expect("an edge") as u32;
    for (feature, lowered) in [(Feature::Vertex(0), [1, 2, 6]), (Feature::Edge(spoke), [2, 6, 6])] {
        let features = [Feature::Vertex(7), feature];
        assert!((turned(features, tilted, &x) - Vector::z()).norm() < 1e-15);
        let mut bent = x.clone();
        lowered.iter().for_each(|&v: &usize| bent[v].z = -0.1);
        assert!((turned(features, tilted, &bent) - Vector::z()).norm() > 1e-3);
    }
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
