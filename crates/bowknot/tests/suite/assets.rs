//! The meshes and scenes of `assets` are what `assets/README.md` says.

use bowknot::check::{Judge, Parts, StateOptions};
use bowknot::geometry::check_mesh;
use bowknot::io::{Import, Mesh, read_mesh};
use bowknot::repair::{RepairParams, repair};
use bowknot::{BUILTIN, Scene, Simulator};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

fn assets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets")
}

fn mesh(name: &str) -> Mesh {
    let path = assets().join("meshes").join(name);
    read_mesh(&path, &Import::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// How often triangles run along each edge, from the smaller vertex and back.
fn edges(triangles: &[[u32; 3]]) -> BTreeMap<[u32; 2], [u32; 2]> {
    let mut edges: BTreeMap<[u32; 2], [u32; 2]> = BTreeMap::new();
    for &[a, b, c] in triangles {
        for [p, q] in [[a, b], [b, c], [c, a]] {
            edges.entry([p.min(q), p.max(q)]).or_default()[usize::from(p > q)] += 1;
        }
    }
    edges
}

/// The edges of one triangle.
fn borders(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    edges(triangles).into_iter().filter(|(_, count)| count[0] + count[1] == 1).map(|(edge, _)| edge).collect()
}

fn intersections(mesh: &Mesh) -> usize {
    let parts = Parts { vertex_count: mesh.positions.len(), triangles: &mesh.triangles, ..Parts::default() };
    let judge = Judge::new(&parts).expect("a mesh that can be judged");
    let options = StateOptions { limit: 3, distance: false };
    judge.check_state(&mesh.positions, &options).expect("finite").intersection_count
}

#[test]
fn every_small_scene_starts_without_intersections() {
    let mut scenes: Vec<PathBuf> = fs::read_dir(assets().join("scenes"))
        .expect("assets/scenes")
        .map(|entry| entry.expect("readable").path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        // The built-in scenes are large, and have tests of their own.
        .filter(|path| BUILTIN.iter().all(|scene| path.file_stem() != Some(scene.name.as_ref())))
        .collect();
    scenes.sort();
    assert!(scenes.len() >= 5, "{scenes:?}");
    for path in scenes {
        let name = path.display();
        let scene = Scene::load::<&str>(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
        let (world, report) =
            Simulator::start_intersections(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(world.warnings.is_empty(), "{name}: {:?}", world.warnings);
        assert!(report.is_clear(), "{name}: {:?}", report.intersections);
        // Each is for a reader who waits for it.
        assert!(scene.simulation.frames <= 60, "{name}");
        assert!(world.deformable_vertices <= 4000, "{name}: {} vertices", world.deformable_vertices);
    }
}

#[test]
fn the_character_is_closed_and_free_of_intersections() {
    let character = mesh("character.ply");
    assert_eq!(check_mesh(&character.positions, &character.triangles), []);
    assert!(character.particles.is_empty());
    assert!((10_000..=20_000).contains(&character.triangles.len()), "{}", character.triangles.len());
    let edges = edges(&character.triangles);
    assert!(edges.values().all(|count| *count == [1, 1]), "an edge with other than two triangles");
    // One surface without handles, so no finger is joined to another beyond the palm.
    let euler = character.positions.len() as i64 - edges.len() as i64 + character.triangles.len() as i64;
    assert_eq!(euler, 2);
    assert_eq!(intersections(&character), 0);
    // A horizontal line across the fingers of either hand passes through three of them.
    for side in [1.0, -1.0] {
        let mut across: Vec<f64> =
            character.positions.iter().filter(|p| (side * p.y - 0.535).abs() < 0.01).map(|p| p.x).collect();
        across.sort_by(f64::total_cmp);
        let gaps = across.windows(2).filter(|pair| pair[1] - pair[0] > 0.015).count();
        assert_eq!(gaps, 2, "{across:?}");
    }
}

#[test]
fn the_shirt_has_seams_and_repair_closes_them() {
    let shirt = mesh("shirt.obj");
    assert!((3000..=6000).contains(&shirt.positions.len()), "{}", shirt.positions.len());
    assert!(intersections(&shirt) > 0);
    // In millimeters: a seam vertex has a twin at most this far away, and never at the same place.
    const TOGETHER: f64 = 0.05;
    let mut border: Vec<u32> = borders(&shirt.triangles).into_iter().flatten().collect();
    border.sort_unstable();
    border.dedup();
    let x = |v: u32| shirt.positions[v as usize];
    let nearest = |v: u32| {
        border.iter().filter(|w| **w != v).map(|w| (x(v) - x(*w)).norm()).fold(f64::INFINITY, f64::min)
    };
    let together = border.iter().filter(|v| nearest(**v) < TOGETHER).count();
    assert!(together > border.len() / 2, "{together} of {}", border.len());

    let (repaired, report) = repair(&shirt, &RepairParams::default()).expect("repairable");
    let parts = report.before.map(|verdict| verdict.parts);
    assert_eq!((parts, report.after.parts, report.after.intersections), (Some(4), 1, 0));
    // Neckline, hem and cuffs stay open: four loops, so a border edge for each border vertex.
    let open = borders(&repaired.triangles);
    assert_eq!(open.len(), report.after.border_vertices);
    assert_eq!(repaired, mesh("shirt-repaired.obj"), "run `bowknot repair` on it again");
}

#[test]
fn the_shirt_faces_outwards() {
    let shirt = mesh("shirt-repaired.obj");
    // By the rule for closed surfaces, which holds about: the openings face in all directions.
    let volume: f64 = shirt
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| (shirt.positions[v as usize].coords) / 1e3);
            // About the middle of the shirt.
            let middle = bowknot::geometry::Vector::new(0.0, 0.6, 0.0);
            (a - middle).dot(&(b - middle).cross(&(c - middle))) / 6.0
        })
        .sum();
    assert!((0.02..0.06).contains(&volume), "{volume} m^3");
}

#[test]
fn the_tetrahedra_of_the_duck_are_positive() {
    let duck = mesh("duck.msh");
    assert!((2000..=5000).contains(&duck.tets.len()), "{}", duck.tets.len());
    for tet in &duck.tets {
        let [a, b, c, d] = tet.map(|v| duck.positions[v as usize]);
        let edges = [b - a, c - a, d - a, c - b, d - b, d - c];
        let volume = edges[0].cross(&edges[1]).dot(&edges[2]) / 6.0;
        // 1 for a regular tetrahedron.
        let mean = (edges.iter().map(|e| e.norm_squared()).sum::<f64>() / 6.0).sqrt();
        assert!(6.0 * 2.0f64.sqrt() * volume / mean.powi(3) > 0.2, "{tet:?}: {volume} m^3");
    }
    assert!(duck.unused_vertices().is_empty());
    let surface = duck.into_surface();
    assert!(edges(&surface.triangles).values().all(|count| *count == [1, 1]), "an open or pinched surface");
    assert_eq!(intersections(&surface), 0);
}
