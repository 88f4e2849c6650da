use super::*;
use crate::repair::repair as repair_mesh;

/// A block of n x n x n cubes of side 1, five tetrahedra in each.
fn block(n: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let at = |i: u32, j: u32, k: u32| (k * (n + 1) + j) * (n + 1) + i;
    for (k, j, i) in cells(n + 1) {
        mesh.positions.push(Point::new(f64::from(i), f64::from(j), f64::from(k)));
    }
    for (k, j, i) in cells(n) {
        // Mirrored in every other cube, so that the diagonals of faces meet.
        let odd = (i + j + k) % 2;
        let c = |x: u32, y: u32, z: u32| at(i + (x ^ odd), j + y, k + z);
        let (a, b) = (
            [c(0, 0, 0), c(1, 1, 0), c(1, 0, 1), c(0, 1, 1)],
            [c(1, 0, 0), c(0, 1, 0), c(0, 0, 1), c(1, 1, 1)],
        );
        let corner = [
            [a[0], a[1], a[2], b[0]],
            [a[0], a[1], a[3], b[1]],
            [a[0], a[2], a[3], b[2]],
            [a[1], a[2], a[3], b[3]],
        ];
        mesh.tets.extend(corner.into_iter().chain([a]));
    }
    turn(&mut mesh);
    mesh
}

fn cells(n: u32) -> impl Iterator<Item = (u32, u32, u32)> {
    (0..n).flat_map(move |k| (0..n).flat_map(move |j| (0..n).map(move |i| (k, j, i))))
}

fn turn(mesh: &mut Mesh) {
    let turned = check_tets(&mesh.positions, &mesh.tets).turned;
    turned.into_iter().for_each(|tet| mesh.tets[tet].swap(2, 3));
}

/// Repairs, and checks what holds of every repaired solid: its tetrahedra are sound, and the same again
/// changes nothing.
fn repaired(mesh: &Mesh) -> (Mesh, RepairReport, SolidRepair) {
    let (clean, report) = repair_mesh(mesh, &RepairParams::default()).expect("repairs");
    assert_eq!(check_tets(&clean.positions, &clean.tets), Default::default());
    let (again, second) = repair_mesh(&clean, &RepairParams::default()).expect("repairs");
    assert_eq!(again, clean, "{second:?}");
    let solid = report.solid.clone().expect("a solid");
    (clean, report, solid)
}

#[test]
fn a_sound_solid_stays_as_it_is() {
    let mesh = block(3);
    let (clean, report, solid) = repaired(&mesh);
    assert_eq!(clean, mesh);
    assert_eq!((report.before.as_ref(), report.after.intersections), (Some(&report.after), 0));
    assert_eq!((report.after.tets, report.after.triangles, report.after.parts), (135, 108, 1));
    assert!((solid.volume[0] - 27.0).abs() < 1e-12 && (solid.volume[1] - 27.0).abs() < 1e-12);
    assert_eq!((solid.thin.count, solid.turned.count, report.welded_vertices), (0, 0, 0));
    let (thinnest, _) = solid.thinnest.expect("one");
    assert!((thinnest - 1.0 / 6.0_f64.sqrt()).abs() < 1e-12, "{thinnest}");
}

/// Tetrahedra that share no vertices, as some programs write them.
#[test]
fn a_soup_becomes_one_solid() {
    let mesh = block(3);
    let mut soup = Mesh::default();
    for (k, tet) in mesh.tets.iter().enumerate() {
        soup.tets.push([0, 1, 2, 3].map(|c| 4 * k as u32 + c));
        let jitter = 1e-6 * (k % 7) as f64;
        soup.positions
            .extend(tet.iter().map(|&v| mesh.positions[v as usize] + Vector::new(jitter, 0.0, -jitter)));
    }
    let (clean, report, solid) = repaired(&soup);
    assert_eq!((clean.positions.len(), clean.tets.len(), report.after.parts), (64, 135, 1));
    assert_eq!((report.welded_vertices, report.after.intersections), (4 * 135 - 64, 0));
    assert!(report.before.is_some_and(|before| before.intersections > 0 && before.parts == 135));
    assert!(report.largest_move < 1e-5 && report.largest_move > 1e-6);
    assert!((solid.volume[1] - 27.0).abs() < 1e-4, "{:?}", solid.volume);
}

#[test]
fn repeated_turned_and_stray_elements() {
    let mut mesh = block(2);
    let count = mesh.tets.len();
    mesh.tets.iter_mut().step_by(3).for_each(|tet| tet.swap(0, 1));
    let [a, b, c, d] = mesh.tets[4];
    mesh.tets.extend([[b, a, d, c], [a, a, b, c]]);
    mesh.positions.extend([Point::new(9.0, 9.0, 9.0), Point::new(5.0, 0.0, 0.0)]);
    let far = mesh.positions.len() as u32 - 1;
    mesh.triangles.extend([[a, c, b], [a, b, far], [a, a, b]]);
    mesh.strands.extend([[a, b], [a, far], [c, c]]);
    mesh.particles.push(a);
    let (clean, report, solid) = repaired(&mesh);
    assert_eq!((solid.repeated_tets.count, solid.repeated_vertices.count, report.unused_vertices), (1, 1, 1));
    assert_eq!(solid.turned.count, count.div_ceil(3));
    assert_eq!((solid.dropped_triangles, solid.triangles.count, clean.triangles.len()), (2, 1, 1));
    assert_eq!((report.dropped_strands, report.lines, clean.particles.len()), (2, 1, 0));
    let all = RepairParams { drop_lines: true, drop_triangles: true, ..RepairParams::default() };
    let (clean, report) = repair_mesh(&mesh, &all).expect("repairs");
    assert_eq!((clean.triangles.len(), clean.strands.len(), clean.positions.len()), (0, 0, 27));
    assert_eq!((clean.tets.len(), report.after.parts, report.after.intersections), (count, 1, 0));
}

/// A flat tetrahedron on the outside covers a part of the surface twice.
#[test]
fn a_flat_tetrahedron_outside_is_dropped() {
    let mut mesh = block(1);
    // The bottom face is split along one diagonal; the flat one has both.
    mesh.tets.push([0, 1, 2, 3]);
    let (clean, report, solid) = repaired(&mesh);
    assert_eq!((clean, report.after.intersections), (block(1), 0));
    assert_eq!((solid.flat_dropped.count, solid.flat_collapsed.count), (1, 0));
    assert_eq!(solid.flat_dropped.first, Some([0.5, 0.5, 0.0]));
}

/// Two blocks of one cube on each other whose common faces have crossing diagonals, with a flat tetrahedron
/// between.
#[test]
fn a_flat_tetrahedron_between_crossing_diagonals_gets_a_vertex_there() {
    let mut mesh = block(1);
    let top = [4, 5, 6, 7];
    // Mirrored in z = 1, then in x, so that its diagonal is the other one.
    let mirror = |v: u32| [8, 9, 10, 11, 5, 4, 7, 6][v as usize];
    let above: Vec<[u32; 4]> = mesh.tets.iter().map(|tet| tet.map(mirror)).collect();
    for k in 0..4_u32 {
        // The mirror image of vertex k has number 8 + k.
        mesh.positions.push(Point::new(1.0 - f64::from(k % 2), f64::from(k / 2), 2.0));
    }
    mesh.tets.extend(above);
    mesh.tets.push(top);
    turn(&mut mesh);
    let (clean, report, solid) = repaired(&mesh);
    assert_eq!((solid.flat_collapsed.count, solid.added_vertices, solid.flat_dropped.count), (1, 1, 0));
    assert_eq!(clean.positions.last(), Some(&Point::new(0.5, 0.5, 1.0)));
    assert_eq!((report.after.intersections, report.after.parts), (0, 1), "{report:?}");
    assert!((solid.volume[1] - 2.0).abs() < 1e-12);
    // Nothing is left of the face between: both halves share the four triangles around the new vertex.
    let surface = bowknot_geometry::boundary_triangles(&clean.tets);
    assert_eq!(surface.len(), 20);
}

/// The other kinds of flat ones: a vertex on a face, on an edge, and at another vertex.
#[test]
fn flat_tetrahedra_with_a_vertex_on_a_face_an_edge_or_a_vertex_are_collapsed() {
    let p = |x: f64, y: f64, z: f64| Point::new(x, y, z);
    // A face above, split in three below by a vertex in its middle.
    let face = Mesh {
        positions: vec![
            p(0., 0., 0.),
            p(1., 0., 0.),
            p(0., 1., 0.),
            p(0.3, 0.3, 0.),
            p(0., 0., 1.),
            p(0., 0., -1.),
        ],
        tets: vec![[0, 1, 2, 4], [0, 1, 3, 5], [1, 2, 3, 5], [2, 0, 3, 5], [0, 1, 2, 3]],
        ..Mesh::default()
    };
    let (clean, report, solid) = repaired(&face);
    assert_eq!((solid.flat_collapsed.count, solid.added_vertices, clean.tets.len()), (1, 0, 6));
    assert_eq!((report.after.triangles, report.after.intersections), (6, 0));
    // An edge on the one side, split in two on the other, with flat ones between.
    let edge = Mesh {
        positions: vec![
            p(0., 0., 0.),
            p(2., 0., 0.),
            p(1., 0., 0.),
            p(0., 1., 0.),
            p(1., 0., 1.),
            p(1., 0., -1.),
        ],
        tets: vec![[0, 1, 3, 4], [0, 2, 3, 5], [2, 1, 3, 5], [0, 1, 2, 3]],
        ..Mesh::default()
    };
    let (clean, report, solid) = repaired(&edge);
    assert_eq!((solid.flat_collapsed.count, solid.added_vertices, clean.tets.len()), (1, 0, 4));
    assert_eq!((report.after.intersections, report.after.parts), (0, 1));
    // An edge without length: both of its tetrahedra are flat.
    let mut vertex = block(2);
    let middle = 13_u32;
    vertex.positions.push(vertex.positions[middle as usize]);
    let twin = vertex.positions.len() as u32 - 1;
    let own: Vec<usize> = (0..vertex.tets.len()).filter(|&t| vertex.tets[t].contains(&middle)).collect();
    let above: Vec<usize> =
        own.iter().copied().filter(|&t| center(&vertex.positions, &vertex.tets[t]).z > 1.0).collect();
    let between: Vec<[u32; 4]> = above
        .iter()
        .filter_map(|&t| {
            let flat: Vec<u32> = vertex.tets[t]
                .into_iter()
                .filter(|&v| vertex.positions[v as usize].z == 1.0 && v != middle)
                .collect();
            <[u32; 2]>::try_from(flat).ok().map(|[a, b]| [middle, twin, a, b])
        })
        .collect();
    for t in above {
        vertex.tets[t].iter_mut().filter(|v| **v == middle).for_each(|v| *v = twin);
    }
    assert!(!between.is_empty());
    vertex.tets.extend(&between);
    let (clean, report, solid) = repaired(&vertex);
    assert_eq!((clean.tets.len(), clean.positions.len()), (40, 27), "{solid:?}");
    assert_eq!((report.after.intersections, report.after.triangles), (0, 48));
    assert!((solid.volume[1] - 8.0).abs() < 1e-12);
}

#[test]
fn of_overlapping_tetrahedra_the_stray_one_is_dropped_with_its_place() {
    let mut mesh = block(2);
    mesh.positions.push(Point::new(1.0, 1.0, 1.3));
    let apex = mesh.positions.len() as u32 - 1;
    let [a, b, c, _] = mesh.tets[4];
    mesh.tets.insert(0, [a, b, c, apex]);
    turn(&mut mesh);
    let (clean, report, solid) = repaired(&mesh);
    assert_eq!(
        (solid.overlapping.count, report.after.intersections, clean.tets.len()),
        (1, 0, 40),
        "{report:?}"
    );
    let place = center(&mesh.positions, &mesh.tets[0]);
    assert_eq!(solid.overlapping.first, Some(place.coords.into()));
    assert!((solid.volume[1] - 8.0).abs() < 1e-12);
}

#[test]
fn thin_tetrahedra_are_named_and_stay() {
    let mut mesh = block(1);
    mesh.positions.push(Point::new(0.5, 0.5, -0.004));
    let below = bowknot_geometry::boundary_triangles(&mesh.tets)
        .into_iter()
        .find(|t| t.iter().all(|&v| mesh.positions[v as usize].z == 0.0))
        .expect("a face below");
    mesh.tets.push([below[0], below[1], below[2], 8]);
    let (clean, _, solid) = repaired(&mesh);
    assert_eq!((solid.thin.count, clean.tets.len()), (1, 6));
    let (thinnest, place) = solid.thinnest.expect("one");
    assert!(thinnest < 0.004 && place[2] == -0.001, "{thinnest} {place:?}");
}
