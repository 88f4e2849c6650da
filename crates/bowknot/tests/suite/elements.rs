//! Linear and quadratic elements of solids, from the scene on.

use super::scene;
use bowknot::Simulator;
use bowknot::World;
use bowknot::geometry::{Point, Vector};
use std::fmt::Write;

/// A cantilever of soft rubber, 20 cm long, `across` elements of `side` [m] wide and high, with more keys of
/// the body.
fn cantilever(side: f64, edge: f64, keys: &str) -> String {
    format!(
        "simulation = {{ dt = 0.02 }}\n[[body]]\nname = \"beam\"\nkind = \"solid\"\n{keys}\n\
         shape = {{ type = \"block\", size = [0.2, {side}, {side}], edge = {edge} }}\n\
         material = {{ density = 300, young_modulus = 1e6, poisson_ratio = 0.45, damping = 0.05 }}\n\
         [[pin]]\nside = \"x-min\"\n"
    )
}

/// Mean displacement of the free end after 2 s [m].
fn sag(text: &str) -> Vector {
    let mut simulator = Simulator::new(&scene(text)).unwrap_or_else(|error| panic!("{error}"));
    let start = simulator.positions().to_vec();
    for _ in 0..100 {
        let statistics = simulator.step().unwrap_or_else(|error| panic!("{error}"));
        assert!(statistics.solved && statistics.inverted_tets == 0, "{statistics:?}");
    }
    let moved = start.iter().zip(simulator.positions()).filter(|(p, _)| p.x > 0.1 - 1e-9);
    let moved: Vec<Vector> = moved.map(|(a, b)| b - a).collect();
    moved.iter().sum::<Vector>() / moved.len() as f64
}

#[test]
fn thin_blocks_bend_as_beams_do() {
    // q L^4 / (8 EI) + 1.2 q L^2 / (2 G A), less 2.5 % for a deflection of a twelfth of the length.
    let theory =
        0.975 * 9.81 * 300.0 * (0.2f64.powi(4) * 1.5 / (1e6 * 0.02 * 0.02) + 1.2 * 0.04 * 1.45 / 1e6);
    for (edge, least) in [(0.02, 0.86), (0.01, 0.93)] {
        let end = sag(&cantilever(0.02, edge, ""));
        let share = -end.z / theory;
        assert!((least..1.0).contains(&share) && end.y.abs() < 0.01 * -end.z, "{edge}: {share}, {end}");
    }
    let linear = -sag(&cantilever(0.02, 0.02, "elements = \"linear\"")).z / theory;
    assert!(linear < 0.3, "{linear}");
}

#[test]
fn elements_are_chosen_where_the_scene_does_not() {
    let quadratic = |text: &str| {
        let world = World::new(&scene(text)).unwrap_or_else(|error| panic!("{error}"));
        assert!(world.warnings.is_empty(), "{:?}", world.warnings);
        (world.info(0.02).tets, world.info(0.02).quadratic_tets, world.positions.len())
    };
    assert_eq!(quadratic(&cantilever(0.02, 0.02, "")), (480, 60, 189));
    assert_eq!(quadratic(&cantilever(0.02, 0.02, "elements = \"linear\"")), (60, 0, 44));
    assert_eq!(quadratic(&cantilever(0.02, 0.005, "")), (3840, 0, 1025));
    assert_eq!(quadratic(&cantilever(0.02, 0.01, "elements = \"quadratic\"")), (3840, 480, 1025));
    // As thick as long.
    assert_eq!(quadratic(&cantilever(0.2, 0.2, "")), (6, 0, 8));
}

/// A row of cubes, each of six tetrahedra, as a Gmsh file. The group `end` is the face at x = 0.
fn row_of_cubes(count: usize) -> String {
    let corner = |k: usize| (k / 4, k / 2 % 2, k % 2);
    let mut text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 7 \"end\"\n$EndPhysicalNames\n$Nodes\n{}\n",
        4 * (count + 1)
    );
    for k in 0..4 * (count + 1) {
        let (x, y, z) = corner(k);
        writeln!(text, "{} {} {} {}", k + 1, 0.02 * x as f64, 0.02 * y as f64, 0.02 * z as f64)
            .expect("memory");
    }
    write!(text, "$EndNodes\n$Elements\n{}\n998 2 2 7 1 1 2 4\n999 2 2 7 1 1 4 3\n", 6 * count + 2)
        .expect("memory");
    for cube in 0..count {
        for (k, [a, b]) in [[1, 3], [3, 2], [2, 6], [6, 4], [4, 5], [5, 1]].into_iter().enumerate() {
            let [p, q, r, s] = [0, a, b, 7].map(|c| 4 * cube + c + 1);
            writeln!(text, "{} 4 2 0 1 {p} {q} {r} {s}", 6 * cube + k + 1).expect("memory");
        }
    }
    text + "$EndElements\n"
}

#[test]
fn a_thin_mesh_is_named_and_keeps_its_vertices() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("row.msh"), row_of_cubes(8)).expect("a file");
    let pinned_world = |keys: &str, selector: &str| {
        let text = format!(
            "body = [{{ name = \"row\", kind = \"solid\", mesh = \"row.msh\" {keys} }}]\n\
             [[pin]]\nbody = \"row\"\n{selector}\n"
        );
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, text).expect("a file");
        let scene = bowknot::Scene::open(path.to_str().expect("a path"), None, &[""; 0]).expect("a scene");
        World::new(&scene).unwrap_or_else(|error| panic!("{error}"))
    };
    let world = |keys: &str| pinned_world(keys, "vertices = [0, 1, 2, 3]");
    let plain = world("");
    assert_eq!((plain.positions.len(), plain.bodies[0].quadratic_tets.len()), (36, 0));
    assert!(
        plain
            .warnings
            .iter()
            .any(|w| w.contains("body row: it is 1.0 tetrahedra thick")
                && w.contains("elements = \"quadratic\"")),
        "{:?}",
        plain.warnings
    );
    let accepted = world(", elements = \"linear\"");
    assert!(accepted.warnings.iter().all(|w| !w.contains("thick")), "{:?}", accepted.warnings);
    let quadratic = world(", elements = \"quadratic\"");
    assert!(quadratic.warnings.iter().all(|w| !w.contains("thick")), "{:?}", quadratic.warnings);
    assert_eq!((quadratic.bodies[0].tets.len(), quadratic.bodies[0].quadratic_tets.len()), (384, 48));
    // Vertices keep their numbers, in pins and in messages. A pin holds the middles of edges whose ends it
    // names.
    let pinned: Vec<Point> =
        quadratic.pins[0].vertices.iter().map(|&v| quadratic.positions[v as usize]).collect();
    assert!(pinned.len() == 9 && pinned.iter().all(|p| p.x == 0.0), "{pinned:?}");
    let grouped = pinned_world(", elements = \"quadratic\"", "group = \"end\"");
    assert_eq!(grouped.pins, quadratic.pins);
    let mixed = pinned_world(", elements = \"quadratic\"", "group = [\"end\"]\nvertices = [4, 5, 6, 7]");
    // 8 vertices of the first cube with the middles of its 19 edges.
    assert_eq!(mixed.pins[0].vertices.len(), 27);
    let number = |v: u32| quadratic.bodies[0].mesh_number(v) as usize;
    for v in (0..quadratic.positions.len() as u32).filter(|&v| number(v) < 36) {
        let k = number(v);
        let place = Point::new(0.02 * (k / 4) as f64, 0.02 * (k / 2 % 2) as f64, 0.02 * (k % 2) as f64);
        assert_eq!(quadratic.positions[v as usize], place);
    }
}

#[test]
fn elements_of_what_is_no_solid_have_no_effect() {
    let world =
        World::new(&scene("[[body]]\nelements = \"quadratic\"\nshape = \"sheet\"\n")).expect("a world");
    assert!(world.warnings[0].contains("body[0].elements has no effect"), "{:?}", world.warnings);
}
