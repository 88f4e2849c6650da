//! Triangles fill polygons of any outline.

use super::*;
use crate::{Corner, Labels, PolygonFaults, Surface};
use bowknot_geometry::Vector;

/// A mesh of one polygon, whose triangles are its fan.
fn polygon(positions: Vec<Point>) -> Mesh {
    let mut surface = Surface::default();
    let corners = (0..positions.len() as u32).map(|v| Corner::new(v, Some(v), None));
    surface.push(corners, &Labels::default());
    let mut textured = Surface::new(vec![[0.0; 2]; positions.len()], 0, Vec::new());
    surface.polygons().for_each(|p| textured.push(p.corners.iter().copied(), p.labels));
    Mesh { positions, triangles: textured.triangles().collect(), surface: Some(textured), ..Mesh::default() }
}

fn flat(outline: &[[f64; 2]]) -> Vec<Point> {
    outline.iter().map(|&[x, y]| Point::new(x, y, 0.0)).collect()
}

fn area(mesh: &Mesh, [a, b, c]: [u32; 3]) -> Vector {
    let [a, b, c] = [a, b, c].map(|v| mesh.positions[v as usize]);
    (b - a).cross(&(c - a)) / 2.0
}

/// Fills the polygon of these corners, and asserts that triangles of all of them fill it without overlap:
/// they all face its side, and have its area together.
fn assert_filled(positions: Vec<Point>, what: &str) -> Mesh {
    let mut mesh = polygon(positions);
    let fan: Vector = mesh.triangles.iter().map(|&t| area(&mesh, t)).sum();
    let normal = fan.normalize();
    assert_eq!(mesh.triangulate(), PolygonFaults::default(), "{what}");
    assert_eq!(mesh.triangles.len(), mesh.positions.len() - 2, "{what}");
    assert_eq!(
        mesh.surface.as_ref().expect("sound").triangles().collect::<Vec<_>>(),
        mesh.triangles,
        "{what}"
    );
    assert!(
        mesh.triangles.iter().all(|&t| area(&mesh, t).dot(&normal) > 0.0),
        "{what}: {:?}",
        mesh.triangles
    );
    let sum: f64 = mesh.triangles.iter().map(|&t| area(&mesh, t).norm()).sum();
    assert!((sum / fan.norm() - 1.0).abs() < 1e-9, "{what}: {sum}, not {}", fan.norm());
    assert!(mesh.unused_vertices().is_empty(), "{what}");
    mesh
}

const DART: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.4], [2.0, 0.0], [1.0, 2.0]];
const ELL: [[f64; 2]; 6] = [[2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0], [0.0, 0.0]];
/// No corner sees all others.
const CEE: [[f64; 2]; 8] =
    [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [3.0, 2.0], [3.0, 3.0], [0.0, 3.0]];
/// A square with a square hole, bridged between the first corners of both.
const FRAME: [[f64; 2]; 10] = [
    [0.0, 0.0],
    [3.0, 0.0],
    [3.0, 3.0],
    [0.0, 3.0],
    [0.0, 0.0],
    [1.0, 1.0],
    [1.0, 2.0],
    [2.0, 2.0],
    [2.0, 1.0],
    [1.0, 1.0],
];

/// The outline with `count` corners more on each side.
fn divided(outline: &[[f64; 2]], count: usize) -> Vec<[f64; 2]> {
    let sides = outline.iter().zip(outline.iter().cycle().skip(1));
    let corner = |(a, b): (&[f64; 2], &[f64; 2]), k: usize| {
        let share = k as f64 / (count + 1) as f64;
        [0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis]))
    };
    sides.flat_map(|side| (0..=count).map(move |k| corner(side, k))).collect()
}

#[test]
fn triangles_fill_concave_polygons_from_every_first_corner_in_any_place() {
    let outlines: [(&str, &[[f64; 2]]); 4] =
        [("dart", &DART), ("ell", &ELL), ("cee", &CEE), ("frame", &FRAME)];
    for (name, outline) in outlines {
        for more in 0..4 {
            let outline = divided(outline, more);
            for first in 0..outline.len() {
                let mut turned = outline.clone();
                turned.rotate_left(first);
                let what = format!("{name}, {more} corners on each side, from corner {first}");
                assert_filled(flat(&turned), &what);
                turned.reverse();
                let tilted = flat(&turned).into_iter().map(|p| {
                    let x = Vector::new(0.3, 0.5, -0.7) * p.x + Vector::new(0.9, -0.1, 0.2) * p.y;
                    Point::from(x * 1e-3 + Vector::new(7.0, -3.0, 11.0))
                });
                assert_filled(tilted.collect(), &format!("{what}, turned over"));
            }
        }
    }
}

#[test]
fn stars_and_combs_of_any_size_are_filled() {
    for count in [5, 12, 63, 64, 65, 500, 20_000] {
        let star = (0..2 * count).map(|k| {
            let (radius, angle) = ([1.0, 0.3][k % 2], std::f64::consts::PI * k as f64 / count as f64);
            [radius * angle.cos(), radius * angle.sin()]
        });
        assert_filled(flat(&star.collect::<Vec<_>>()), &format!("star of {count}"));
        let teeth = (0..2 * count).map(|k| [(2 * count - k) as f64, [1.0, 9.0][k % 2]]);
        let comb: Vec<[f64; 2]> = [[0.0, 0.0], [2.0 * count as f64, 0.0]].into_iter().chain(teeth).collect();
        assert_filled(flat(&comb), &format!("comb of {count}"));
    }
    // Corners at random heights over a line that goes forth, and others below it that goes back.
    let mut random = fastrand::Rng::with_seed(1);
    for case in 0..200 {
        let count = random.usize(2..40);
        let mut height = |k: usize, sign: f64| [k as f64, sign * random.f64().powi(3)];
        let mut outline: Vec<[f64; 2]> = (0..count).map(|k| height(k, -1.0)).collect();
        outline.extend((0..count).rev().map(|k| height(k, 1.0)));
        outline.dedup();
        assert_filled(flat(&outline), &format!("case {case}"));
    }
}

#[test]
fn a_polygon_that_a_fan_fills_stays_whole() {
    let whole = |outline: &[[f64; 2]]| {
        let mesh = assert_filled(flat(outline), "an outline");
        let surface = mesh.surface.expect("sound");
        assert_eq!(surface.texture_coordinates().len(), outline.len());
        surface.polygons().map(|p| p.corners.iter().map(|c| c.vertex).collect()).collect::<Vec<Vec<u32>>>()
    };
    assert_eq!(whole(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), [[0, 1, 2, 3]]);
    assert_eq!(whole(&DART), [[1, 2, 3, 0]]);
    assert_eq!(whole(&ELL), [[2, 3, 4, 5, 0, 1]]);
    assert_eq!(whole(&CEE).len(), 6);
}

#[test]
fn other_polygons_and_their_labels_stay() {
    let folder = folder();
    let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 1.5 0.2 0\nv 1.2 1 0\n\
        g a\nf 1 2 3 4\ng b\nf 5 7 2 6\ng c\nf 1 3 2\n";
    let mut mesh = read_obj(&write(&folder, "a.obj", obj), &Import::default()).expect("sound");
    let before = mesh.clone();
    assert_eq!(mesh.triangulate(), PolygonFaults::default());
    let names = |mesh: &Mesh| -> Vec<_> {
        let polygons = mesh.surface.as_ref().expect("sound").polygons();
        polygons.map(|p| (p.labels.group.clone(), p.corners.len())).collect()
    };
    assert_eq!(names(&mesh), names(&before));
    assert_eq!(mesh.triangles[..2], before.triangles[..2]);
    assert_eq!(mesh.triangles[4], before.triangles[4]);
    assert_ne!(mesh.triangles[2..4], before.triangles[2..4]);
}

#[test]
fn corners_beside_straight_sides_give_no_slivers() {
    let house = |y: f64| [[0.0, 0.0], [0.5, y], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let ell = |d: f64| {
        [
            [2.0, 0.0],
            [2.0, 1.0],
            [1.5, 1.0 + d],
            [1.0, 1.0],
            [1.0, 1.5],
            [1.0 - d, 2.0],
            [0.0, 2.0],
            [0.0, 0.0],
        ]
    };
    for d in [1e-7, -1e-7, 1e-12, -1e-12, 0.0] {
        for outline in [&house(d)[..], &ell(d)] {
            let mut mesh = polygon(flat(outline));
            assert_eq!(mesh.triangulate(), PolygonFaults::default());
            let least = mesh.triangles.iter().map(|&t| area(&mesh, t).z).fold(f64::INFINITY, f64::min);
            assert!(least > 0.1, "{d}: {:?}", mesh.triangles);
        }
    }
}

#[test]
fn what_has_no_outline_is_told_and_stays() {
    let turn =
        |angle: f64, radius: f64| [radius * angle.to_radians().cos(), radius * angle.to_radians().sin()];
    let pentagram: Vec<[f64; 2]> = (0..5).map(|k| turn(144.0 * f64::from(k), 1.0)).collect();
    // Around its first corner, more than once.
    let spiral: Vec<[f64; 2]> = std::iter::once([0.0, 0.0])
        .chain((0..6).map(|k| turn(100.0 * f64::from(k), f64::from(k + 1))))
        .collect();
    let bow = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 1.0]];
    // It turns around once.
    let notch = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, -1.0], [0.0, 2.0]];
    // Teeth that reach through the base, more than can be tried one by one.
    let mut comb = vec![[0.0, 0.0], [4001.0, 0.0]];
    comb.extend((0..4000).map(|k| [f64::from(4000 - k), [9.0, -1.0][k as usize % 2]]));
    for outline in [&pentagram[..], &spiral, &bow, &notch, &comb] {
        let mut mesh = polygon(flat(outline));
        let before = mesh.clone();
        let found = mesh.triangulate();
        assert!(
            found.crossing == [0] && found.warped.is_empty() && mesh == before,
            "{:?}",
            &outline[..5.min(outline.len())]
        );
        assert!(found.describe().is_some_and(|text| text.contains("crosses")), "{found:?}");
    }
    let mut bent = flat(&CEE);
    bent.iter_mut().step_by(2).for_each(|p| p.z = 2.0);
    let mut mesh = polygon(bent);
    let before = mesh.clone();
    let found = mesh.triangulate();
    assert!(found.warped == [0] && found.crossing.is_empty() && mesh == before, "{found:?}");
    assert!(found.describe().is_some_and(|text| text.contains("flat")), "{found:?}");
    // Others say what is wrong with these.
    let repeated = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
    for outline in [&repeated[..], &[[0.0; 2]; 5], &[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]] {
        let mut mesh = polygon(flat(outline));
        let before = mesh.clone();
        assert_eq!((mesh.triangulate(), mesh), (PolygonFaults::default(), before));
    }
}

/// Their corners have moved, and other triangles would be other states.
#[test]
fn frames_of_a_ply_keep_their_fans() {
    let folder = folder();
    let path = folder.path().join("a.ply");
    let mut mesh = polygon(flat(&ELL));
    mesh.triangulate();
    mesh.positions.iter_mut().for_each(|p| p.z = p.x * p.y);
    write_ply(&path, &mesh.view()).expect("sound");
    let again = read_ply(&path, &Import::default()).expect("sound");
    assert_eq!(again.triangles, mesh.triangles);
    assert_eq!(again.surface.expect("sound").len(), 1);
}
