use super::borders::border_edges;
use super::*;
use bowknot_geometry::Point;

/// A panel of `n` x `m` squares of `edge` from a corner, in the plane z = 0, as its own vertices; appended to
/// `mesh`.
fn panel(mesh: &mut Mesh, corner: [f64; 2], n: u32, m: u32, edge: [f64; 2]) {
    let first = mesh.positions.len() as u32;
    let at = |i: u32, j: u32| first + j * (n + 1) + i;
    for j in 0..=m {
        for i in 0..=n {
            let [x, y] = [corner[0] + f64::from(i) * edge[0], corner[1] + f64::from(j) * edge[1]];
            mesh.positions.push(Point::new(x, y, 0.0));
        }
    }
    for (i, j) in (0..m).flat_map(|j| (0..n).map(move |i| (i, j))) {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
        mesh.triangles.extend([[a, b, d], [a, d, c]]);
    }
}

/// Two panels of 4 x 4 squares that meet at x = 0.4, the second shifted along by `gap` and up by `lift`.
fn two_panels(gap: f64, lift: f64) -> Mesh {
    let mut mesh = Mesh::default();
    panel(&mut mesh, [0.0, 0.0], 4, 4, [0.1, 0.1]);
    let count = mesh.positions.len();
    panel(&mut mesh, [0.4 + gap, 0.0], 4, 4, [0.1, 0.1]);
    mesh.positions[count..].iter_mut().for_each(|p| p.z += lift);
    mesh
}

fn repaired(mesh: &Mesh) -> (Mesh, RepairReport) {
    repair(mesh, &RepairParams::default()).unwrap()
}

#[test]
fn a_coincident_seam_is_welded() {
    let mesh = two_panels(0.0, 0.0);
    let (clean, report) = repaired(&mesh);
    let before = report.before.clone().unwrap();
    assert!(before.intersections > 0 && before.parts == 2, "{before:?}");
    assert_eq!(report.after.intersections, 0, "{report:?}");
    assert_eq!((report.welded_vertices, report.largest_move, report.after.parts), (5, 0.0, 1));
    assert_eq!((clean.positions.len(), clean.triangles.len()), (45, 64));
    assert_eq!(report.after.border_vertices, 24, "the seam is no border any more");
    assert_eq!(report.weld_places[0], [0.4, 0.0, 0.0]);
    // The same again changes nothing.
    let (again, report) = repaired(&clean);
    assert_eq!((again, report.welded_vertices, report.split_triangles), (clean, 0, 0));
}

#[test]
fn a_seam_that_crosses_a_little_is_welded_in_the_middle() {
    // Overlapping by a thousandth of an edge, and tilted through each other.
    let mut mesh = two_panels(-1e-4, 0.0);
    let n = mesh.positions.len();
    for (v, p) in mesh.positions.iter_mut().enumerate().skip(n / 2) {
        p.z += if v % 2 == 0 { 5e-5 } else { -5e-5 };
    }
    let (clean, report) = repaired(&mesh);
    assert!(report.before.unwrap().intersections > 0);
    assert_eq!((report.after.intersections, report.welded_vertices), (0, 5));
    assert!(report.largest_move < 1e-4 && report.largest_move > 4e-5, "{}", report.largest_move);
    assert!((clean.positions[4].x - (0.4 - 0.5e-4)).abs() < 1e-12);
    // A seam farther apart than the weld distance stays open, and one within a given distance closes.
    let wide = two_panels(0.02, 0.0);
    assert_eq!(repaired(&wide).1.welded_vertices, 0);
    let given = RepairParams { weld_distance: Some(0.021), ..RepairParams::default() };
    assert_eq!(repair(&wide, &given).unwrap().1.welded_vertices, 5);
}

#[test]
fn a_t_seam_splits_the_longer_edges() {
    let mut mesh = Mesh::default();
    panel(&mut mesh, [0.0, 0.0], 2, 2, [0.2, 0.2]);
    // Half the edge along the seam: three of its five vertices have a partner.
    panel(&mut mesh, [0.4, 0.0], 2, 4, [0.2, 0.1]);
    let (clean, report) = repaired(&mesh);
    assert!(report.before.unwrap().intersections > 0);
    assert_eq!((report.after.intersections, report.after.parts), (0, 1), "{:?}", report.after);
    assert_eq!((report.welded_vertices, report.split_triangles), (3, 2));
    assert_eq!((clean.positions.len(), clean.triangles.len()), (9 + 15 - 3, 8 + 16 + 2));
    let borders = border_edges(&clean.triangles);
    assert!(borders.iter().all(|([a, b], _)| {
        let [p, q] = [clean.positions[*a as usize], clean.positions[*b as usize]];
        (p.x - 0.4).abs() > 1e-9 || (q.x - 0.4).abs() > 1e-9
    }));
    // No triangle is turned over by its split.
    for &[i, j, k] in &clean.triangles {
        let [p, q, r] = [i, j, k].map(|v| clean.positions[v as usize]);
        assert!((q - p).cross(&(r - p)).z > 0.0);
    }
}

#[test]
fn what_stands_for_nothing_is_dropped() {
    let mut mesh = two_panels(0.3, 0.0);
    let triangles = mesh.triangles.len();
    mesh.positions.push(Point::new(9.0, 9.0, 9.0));
    mesh.triangles.extend([[0, 1, 2], [6, 0, 1], [3, 3, 4]]);
    mesh.strands = vec![[0, 1], [1, 0], [5, 5]];
    let (clean, report) = repaired(&mesh);
    assert_eq!((report.zero_area_triangles, report.repeated_triangles), (2, 1), "{report:?}");
    assert_eq!((report.dropped_strands, report.unused_vertices), (2, 1));
    assert_eq!((clean.triangles.len(), clean.positions.len(), clean.strands), (triangles, 50, vec![[0, 1]]));
    assert_eq!(report.lines, 1);
    let (clean, report) =
        repair(&mesh, &RepairParams { drop_lines: true, ..RepairParams::default() }).expect("repairs");
    assert_eq!((clean.strands.len(), report.dropped_strands, report.lines), (0, 3, 0));
    assert!(report.before.is_none(), "a triangle of two vertices is not judged");
    assert_eq!(report.after.intersections, 0);
}

#[test]
fn closed_surfaces_and_what_crosses_away_from_borders_stay() {
    let mut mesh = two_panels(0.0, 0.0);
    // A sheet through the middle of the first panel.
    let count = mesh.positions.len();
    panel(&mut mesh, [0.0, 0.0], 2, 2, [0.1, 0.1]);
    for p in &mut mesh.positions[count..] {
        *p = Point::new(0.13, 0.11 + p.x, p.y - 0.083);
    }
    let (_, report) = repaired(&mesh);
    assert_eq!((report.welded_vertices, report.after.parts), (5, 2));
    assert!(report.after.intersections > 0);
    assert_eq!(report.after.by_parts.len(), 1);
    assert_eq!(report.after.by_parts[0].parts, [0, 1]);
    assert_eq!(report.after.by_parts[0].count, report.after.intersections);
}

#[test]
fn what_cannot_be_repaired_is_refused() {
    let mesh = two_panels(0.0, 0.0);
    let with =
        |distance| repair(&mesh, &RepairParams { weld_distance: Some(distance), ..RepairParams::default() });
    for distance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(with(distance), Err(RepairError::WeldDistance(_))));
    }
    let empty = Mesh { triangles: Vec::new(), ..mesh };
    assert_eq!(repair(&empty, &RepairParams::default()), Err(RepairError::NoElements));
}

/// Whatever the distance, no edge collapses: welding never joins two vertices of one triangle.
#[test]
fn no_edge_collapses_however_large_the_distance() {
    let mesh = two_panels(1e-3, 1e-3);
    for distance in [0.01, 0.1, 0.2, 1.0, 10.0] {
        let mut welded = mesh.clone();
        let border = border_vertices(&welded.triangles);
        weld::weld(&mut welded, &border, distance, &mut RepairReport::default());
        for [i, j, k] in welded.triangles {
            assert!(i != j && j != k && k != i, "at {distance}");
        }
    }
}
