use super::scene;
use bowknot::simulator::SimulationError;
use bowknot::{Scene, Simulator, World};
use std::fs;
use std::path::Path;

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn refusal(text: &str) -> String {
    Simulator::new(&scene(text)).map(|_| ()).expect_err("refused").to_string()
}

/// What is said about a mesh file, as a body or as an obstacle.
fn mesh(content: &str, obstacle: bool) -> Result<World, String> {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("mesh.obj"), content).expect("a mesh");
    let text = if obstacle {
        "[[body]]\nshape = { type = \"sheet\", edge = 0.5 }\ntranslate = [0, 0, 5]\n\
         [[obstacle]]\nname = \"thing\"\nmesh = \"mesh.obj\"\n"
    } else {
        "[[body]]\nname = \"cloth\"\nmesh = \"mesh.obj\"\n"
    };
    let path = folder.path().join("scene.toml");
    fs::write(&path, text).expect("a scene");
    let none: &[&str] = &[];
    let scene = Scene::load(&path, none).map_err(|e| e.to_string())?;
    let hide = |message: String| message.replace(&format!("{}/", folder.path().display()), "");
    World::new(&scene).map_err(|e| hide(e.to_string()))
}

#[test]
fn meshes_are_refused_by_name_and_place() {
    for (content, expected) in [
        (format!("{SQUARE}f 1 2 9\n"), "scene.toml:3: mesh.obj:5: "),
        ("v 0 0\nf 1 1 1\n".to_owned(), "scene.toml:3: mesh.obj:1: "),
        ("v 0 0 nan\n".to_owned(), "scene.toml:3: mesh.obj:1: "),
        ("v 0 0 0\n".to_owned(), "scene.toml:3: body cloth: the mesh has no triangles"),
        (
            format!("{SQUARE}v 2 0 0\nf 1 2 3\nf 1 3 4\nf 1 2 5\n"),
            "scene.toml:3: body cloth: triangle 2 (vertices 0, 1, 4) has zero area, at (1, 0, 0)",
        ),
        (
            format!("{SQUARE}f 1 2 3\nf 1 3 4\nf 3 1 2\n"),
            "scene.toml:3: body cloth: triangle 2 repeats triangle 0 (vertices 2, 0, 1), at",
        ),
        (
            format!("{SQUARE}f 1 2 3\nf 1 3 4\nl 2 4\n"),
            "scene.toml:3: body cloth: the mesh has 1 line between vertices of its triangles, the first \
             joins vertices 1 and 3",
        ),
    ] {
        let message = mesh(&content, false).expect_err("refused");
        assert!(message.starts_with(expected), "{message}\nexpected {expected}");
    }
}

#[test]
fn loose_vertices_and_degenerate_obstacle_triangles_are_dropped_with_a_warning() {
    let world = mesh(&format!("{SQUARE}f 1 2 3\n"), false).expect("a world");
    assert_eq!(world.positions.len(), 3);
    assert!(
        world.warnings[0].starts_with("body cloth: left out 1 vertex that belongs"),
        "{:?}",
        world.warnings
    );
    let world =
        mesh(&format!("{SQUARE}v 2 0 0\nf 1 2 3\nf 1 3 4\nf 1 2 5\nf 3 2 1\n"), true).expect("a world");
    assert_eq!(world.bodies[1].vertices.len(), 4);
    assert_eq!(world.collision.topology().triangles.len(), 8 + 2);
    assert!(
        world.warnings[0].starts_with("obstacle thing: dropped 2 triangles that are no obstacle: triangle 2"),
        "{:?}",
        world.warnings
    );
    let message = mesh("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", true).expect_err("nothing left");
    assert_eq!(message, "scene.toml:6: obstacle thing: no triangle of the mesh has an area");
}

#[test]
fn polygons_of_obstacles_lose_the_triangles_that_are_dropped() {
    // Two corners of the pentagon are at one place. So the first triangle of its fan has no area, and its
    // second vertex no other triangle.
    let pentagon = format!("{SQUARE}v 1 0 0\nvt 0 1\nvt 1 0\nusemtl wood\nf 1/1 2 5/2 3 4\n");
    let world = mesh(&pentagon, true).expect("a world");
    let thing = &world.bodies[1];
    let surface = thing.surface.as_ref().expect("a surface");
    let polygons: Vec<_> = surface.polygons().collect();
    let texture: Vec<_> = polygons[0].corners.iter().map(|corner| corner.texture()).collect();
    assert_eq!((polygons.len(), texture), (1, vec![Some(0), Some(1), None, None]));
    assert_eq!(polygons[0].labels.material.as_deref(), Some("wood"));
    let own: Vec<[u32; 3]> = surface.triangles().map(|t| t.map(|v| v + thing.vertices.start)).collect();
    assert_eq!(own, world.collision.topology().triangles[8..]);
}

#[test]
fn pins_name_vertices_of_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("mesh.obj"), format!("v 9 9 9\n{SQUARE}f 2 3 4\nf 2 4 5\n"))
        .expect("a mesh");
    let world = |vertices: &str| {
        let text =
            format!("[[body]]\nname = \"cloth\"\nmesh = \"mesh.obj\"\n[[pin]]\nvertices = {vertices}\n");
        Scene::from_toml(&text, folder.path()).and_then(|scene| World::new(&scene)).map_err(|e| e.to_string())
    };
    assert_eq!(world("[1, 4]").expect("a world").pins[0].vertices, [0, 3]);
    assert_eq!(
        world("[0]").expect_err("loose"),
        "scene.toml:5: pin[0] of cloth: vertex 0 belongs to no triangle of body cloth"
    );
    assert_eq!(
        world("[5]").expect_err("range"),
        "scene.toml:5: pin[0] of cloth: vertex 5, but body cloth has 5 vertices, counted from 0"
    );
}

#[test]
fn pins_name_groups_of_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = format!("v 9 9 9\n{SQUARE}f 2 3 4\ng left hem\nf 2 4 5\ng dots\np 1\n");
    fs::write(folder.path().join("mesh.obj"), mesh).expect("a mesh");
    let body = "[[body]]\nname = \"cloth\"\nmesh = \"mesh.obj\"\n[[pin]]\nstart = 0\n";
    let world = |selectors: &str| {
        let text = format!("{body}{selectors}\n");
        Scene::from_toml(&text, folder.path()).and_then(|scene| World::new(&scene)).map_err(|e| e.to_string())
    };
    let held = |selectors: &str| world(selectors).expect("a world").pins[0].vertices.clone();
    // Vertex 0 of the mesh belongs to no triangle.
    assert_eq!(held("group = \"hem\""), [0, 2, 3]);
    assert_eq!(held("group = [\"dots\", \"left\"]"), [0, 2, 3]);
    assert_eq!(held("group = \"hem\"\nvertices = [2]"), [0, 1, 2, 3]);
    for (selectors, says) in [
        (
            "group = \"hen\"",
            "scene.toml:6: pin[0] of cloth: no group \"hen\"; there are: dots, hem, left; did you mean hem?",
        ),
        ("group = \"dots\"", "scene.toml:4: pin[0] of cloth: it selects no vertex of the body"),
        ("group = 3", "scene.toml:6: pin[0].group: must be a name or a list of names, not the number 3"),
        ("group = [3]", "scene.toml:6: pin[0].group: must be a string, not an array with the number 3"),
        ("group = []", "a pin needs vertices, a group, a box, a side or roots"),
    ] {
        let error = world(selectors).expect_err(selectors);
        assert!(error.contains(says), "{selectors}: {error}");
    }
    let sheet = "[[body]]\nname = \"sheet\"\nshape = { type = \"sheet\", edge = 0.5 }\n";
    assert_eq!(
        refusal(&format!("{sheet}[[pin]]\ngroup = \"hem\"\n")),
        "scene.toml:5: pin[0] of sheet: no group \"hem\": the mesh of body sheet has no groups"
    );
}

#[test]
fn pins_must_select_and_not_quarrel() {
    let sheet = "[[body]]\nname = \"sheet\"\nshape = { type = \"sheet\", edge = 0.5 }\n";
    assert_eq!(
        refusal(&format!("{sheet}[[pin]]\nbox = {{ min = [5, 5, 5] }}\n")),
        "scene.toml:4: pin[0] of sheet: it selects no vertex of the body"
    );
    let two = format!("{sheet}[[pin]]\nside = \"x-min\"\nend = 1\n[[pin]]\nside = \"y-min\"\nstart = 0.5\n");
    assert_eq!(
        refusal(&two),
        "scene.toml:7: pin[1] of sheet: vertex 0 of body sheet is held by pin[0] at the same time"
    );
    let later = two.replace("start = 0.5", "start = 1.5");
    assert!(Simulator::new(&scene(&later)).is_ok());
}

#[test]
fn a_start_that_intersects_names_bodies_and_places() {
    let text = "[[body]]\nname = \"sheet\"\nshape = { type = \"sheet\", edge = 0.1 }\n\
                [[obstacle]]\nname = \"ball\"\nshape = { type = \"ball\", radius = 0.3, edge = 0.1 }\n\
                [[obstacle]]\nname = \"ground\"\nshape = \"half-space\"\ntranslate = [0, 0, -1]\n";
    let error = Simulator::new(&scene(text)).map(|_| ()).expect_err("intersects");
    let SimulationError::StartIntersects { lines, count, advice } = &error else { panic!("{error}") };
    assert_eq!(lines.len(), 5);
    assert!(*count > 20 && advice[0].starts_with("sheet and ball overlap: move sheet by "), "{advice:?}");
    assert!(
        lines[0].starts_with("edge (vertices ") && lines[0].contains(" of sheet and triangle (vertices ")
    );
    assert!(lines[0].contains(" of ball at ("), "{}", lines[0]);
    let message = error.to_string();
    assert!(
        message.contains(&format!("and {} more pairs", count - 5)) && message.contains(&advice[0]),
        "{message}"
    );

    let (world, report) = Simulator::start_intersections(&scene(text)).expect("a report");
    assert_eq!(report.intersections.len(), *count);
    assert_eq!(world.bodies[1].name, "ball");
    let below = "[[body]]\nname = \"sheet\"\nshape = \"sheet\"\n[[obstacle]]\nname = \"ground\"\nshape \
                 = \"half-space\"\n";
    assert!(refusal(below).contains("vertex 0 of sheet and half-space ground at"), "{}", refusal(below));
}

#[test]
fn motion_beyond_all_bounds_is_an_error_and_no_panic() {
    let text = |velocity: f64, place: f64| {
        format!(
            "[[body]]\nname = \"sheet\"\nshape = {{ type = \"sheet\", edge = 0.5 }}\n\
             translate = [{place:?}, 0, 0]\nvelocity = [{velocity:?}, 0, 0]\n"
        )
    };
    let step = |text: &str| {
        let mut simulator = Simulator::new(&scene(text)).expect("a simulator");
        let before = simulator.checkpoint();
        let message = simulator.step().expect_err("refused").to_string();
        assert_eq!(simulator.checkpoint(), before);
        message
    };
    let message = step(&text(1e300, 0.0));
    assert!(message.starts_with("time step 1: ") && message.contains("sheet"), "{message}");
    // Before anything is written.
    let message = refusal(&text(0.0, 1e13));
    assert!(
        message.contains("set contact.min_separation above") && message.contains("body sheet"),
        "{message}"
    );
}

#[test]
fn a_missing_mesh_is_named_with_its_path() {
    let scene = Scene::from_toml("[[body]]\nmesh = \"gone.ply\"\n", Path::new("/nowhere")).expect("a scene");
    let message = World::new(&scene).map(|_| ()).expect_err("missing").to_string();
    assert_eq!(message, "scene.toml:2: cannot read /nowhere/gone.ply: no such file or folder");
}
