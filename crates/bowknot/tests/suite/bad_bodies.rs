use super::scene;
use bowknot::geometry::Point;
use bowknot::io::{MeshView, write_obj};
use bowknot::{Scene, Simulator, World};
use std::fs;

const SHEET: &str = "shape = { type = \"sheet\", edge = 0.5 }\n";

/// What a scene without files is refused for.
fn refusal(text: &str) -> String {
    let made = Scene::from_toml(text, "").map_err(|error| error.to_string());
    made.and_then(|scene| Simulator::new(&scene).map_err(|error| error.to_string()))
        .map_or_else(|message| message.replace("scene.toml:", ""), |_| panic!("accepted: {text}"))
}

/// What a body of a kind from a mesh file is refused for, or its world.
fn with_mesh(kind: &str, name: &str, content: &str) -> Result<World, String> {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join(name), content).expect("a mesh");
    let text = format!("[[body]]\nname = \"it\"\nkind = \"{kind}\"\nmesh = \"{name}\"\n");
    Scene::from_toml(&text, folder.path())
        .and_then(|scene| World::new(&scene))
        .map_err(|error| error.to_string())
}

#[test]
fn keys_of_bodies_are_refused_one_by_one() {
    for (body, expected) in [
        ("kind = \"clot\"", "2: body[0].kind: \"clot\" must be one of cloth, solid"),
        ("friction = -0.1", "2: body[0].friction: -0.1 must be finite and at least 0"),
        ("friction = nan", "2: body[0].friction: NaN must be finite and at least 0"),
        ("thickness = -1", "2: body[0].thickness: -1 must be finite and at least 0"),
        ("delta = 0", "2: body[0].delta: 0 must be finite and above 0"),
        ("stretch_limit = 1", "2: body[0].stretch_limit: 1 must be above 1, inf included"),
        ("gravity = [0, nan, 0]", "2: body[0].gravity: [0.0, NaN, 0.0] must be finite"),
        ("angular_velocity = [inf, 0, 0]", "2: body[0].angular_velocity: [inf, 0.0, 0.0] must be finite"),
        (
            "material = { young_modulus = 1e6 }",
            "2: body[0].material.young_modulus: a key of kind solid, but this body is of kind cloth",
        ),
        (
            "material = \"sand\"",
            "2: body[0].material: the string \"sand\" must be one of cotton, wool, wool-lycra, polyester, \
             silk, denim; that is a material of kind particles",
        ),
        (
            "material = { base = \"cottn\" }",
            "2: body[0].material.base: the string \"cottn\" must be one of cotton, wool, wool-lycra, \
             polyester, silk, denim; did you mean cotton?",
        ),
        ("kind = \"solid\"", "3: body[0].shape: makes a body of kind cloth, but this one is of kind solid"),
    ] {
        let found = refusal(&format!("[[body]]\n{body}\n{SHEET}"));
        assert!(found.starts_with(expected), "{body}\n  gave     {found}\n  expected {expected}");
    }
    let both = refusal(&format!("[[body]]\nfriction = -1\nthickness = -1\ndelta = -1\n{SHEET}"));
    assert_eq!(both.lines().count(), 3, "{both}");
}

#[test]
fn keys_of_obstacles_pins_and_pairs_are_refused_one_by_one() {
    let body = format!("[[body]]\nname = \"a\"\n{SHEET}");
    for (rest, expected) in [
        ("[[obstacle]]\nshape = \"half-space\"\nfriction = -1", "obstacle[0].friction: -1 must be finite"),
        (
            "[[obstacle]]\nshape = \"strands\"",
            "obstacle[0].shape: makes a body of kind strands, which is no obstacle",
        ),
        (
            "[[obstacle]]\nshape = \"box\"\nsequence = \"x\"",
            "obstacle[0].sequence: stands beside a mesh or a shape",
        ),
        (
            "[[obstacle]]\nsequence = \"x\"\nsequence_rate = 0",
            "obstacle[0].sequence_rate: 0 must be a number",
        ),
        (
            "[[obstacle]]\nsequence = \"x\"\nmotion = { spin = 1 }",
            "obstacle[0].motion: the obstacle moves by itself already",
        ),
        ("[[pin]]\nroots = 1", "pin[0].roots: only strands have roots"),
        (
            "[[contact.friction_pairs]]\nbodies = [\"a\", \"aa\"]",
            "contact.friction_pairs[0].bodies: no body or obstacle \"aa\"",
        ),
        (
            "[[contact.friction_pairs]]\nbodies = [\"a\", \"a\"]\nfriction = -2",
            "contact.friction_pairs[0].friction: -2 must be finite",
        ),
        (
            "[[contact.friction_pairs]]\nbodies = [\"a\", \"a\"]\n[[contact.friction_pairs]]\nbodies = \
             [\"a\", \"a\"]",
            "contact.friction_pairs[1].bodies: the pair is named by an entry above",
        ),
        ("[solver.repulsion]\nstiffness = -1", "solver.repulsion.stiffness: -1 must be finite"),
    ] {
        let found = refusal(&format!("{body}{rest}\n"));
        assert!(found.contains(expected), "{rest}\n  gave     {found}\n  expected {expected}");
    }
}

#[test]
fn meshes_must_be_of_the_elements_of_their_kind() {
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let message = with_mesh("solid", "mesh.obj", triangle).expect_err("refused");
    let refused = |what: &str| format!("scene.toml:4: body it: the mesh has 1 triangle, but {what}");
    assert_eq!(message, refused("a solid is made of tetrahedra only"));
    let message = with_mesh("strands", "mesh.obj", triangle).expect_err("refused");
    assert_eq!(message, refused("strands are made of edges only"));
    let message = with_mesh("particles", "mesh.obj", triangle).expect_err("refused");
    assert_eq!(message, refused("particles are loose points only"));
    let message = with_mesh("strands", "mesh.obj", "v 0 0 0\n").expect_err("refused");
    assert_eq!(message, "scene.toml:4: body it: the mesh has no strand edges");
}

#[test]
fn lines_that_lead_nowhere_are_left_out_of_cloth_and_those_to_sew_along_are_refused() {
    // Two triangles, and three vertices away from them.
    let cloth =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 3 0 0\nv 4 0 0\nv 3 1 0\nv 8 8 0\nv 9 9 0\nv 9 9 9\nf 1 2 3\nf 4 5 6\n";
    for (lines, count) in [("l 7 8 9", 2), ("l 1 7", 1), ("l 1 2", 1), ("l 3 2 1\nl 9 4", 3), ("l 3 3", 1)] {
        let world = with_mesh("cloth", "mesh.obj", &format!("{cloth}{lines}\n")).expect("a world");
        assert_eq!((world.positions.len(), world.bodies[0].strands.len()), (6, 0), "{lines}");
        let expected = format!("body it: left out {count} line");
        assert!(world.warnings.iter().any(|warning| warning.starts_with(&expected)), "{:?}", world.warnings);
    }
    let sewing = format!("{cloth}l 7 8\nl 2 4\nl 3 6\n");
    let message = with_mesh("cloth", "mesh.obj", &sewing).expect_err("refused");
    let expected = "scene.toml:4: body it: the mesh has 2 lines between vertices of its triangles, the first \
                    joins vertices 1 and 3: other programs sew";
    assert!(message.starts_with(expected) && message.contains("drop_lines = true"), "{message}");
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("mesh.obj"), sewing).expect("a mesh");
    let text = "body = [{ mesh = \"mesh.obj\", drop_lines = true }]";
    let world = Scene::from_toml(text, folder.path()).and_then(|scene| World::new(&scene)).expect("a world");
    assert!(
        world.warnings[0].contains("left out 3 lines, the first joins vertices 1 and 3"),
        "{:?}",
        world.warnings
    );
}

#[test]
fn obstacles_that_jump_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    for (frame, x) in [(1, 0.0), (2, 0.3), (3, 0.9)] {
        let arm = format!("v {x} 0 -2\nv {x} 1 -2\nv {x} 0 -3\nf 1 2 3\n");
        fs::write(folder.path().join(format!("{frame}.obj")), arm).expect("a frame");
    }
    let warnings = |obstacle: &str| {
        let text = format!(
            "simulation = {{ frames = 100 }}\nbody = [{{ shape = {{ type = \"sheet\", edge = 0.05 }} }}]\n\
             [[obstacle]]\nname = \"arm\"\n{obstacle}"
        );
        let world =
            Scene::from_toml(&text, folder.path()).and_then(|scene| World::new(&scene)).expect("a world");
        let jumps = |warning: &&String| warning.starts_with("obstacle arm moves by up to");
        world.warnings.iter().filter(jumps).cloned().collect::<Vec<_>>()
    };
    let keyed = |time: f64| {
        let motion = format!(
            "motion = {{ keyframes = [{{ time = 0.2 }}, {{ time = {time}, translate = [2.0, 0, 0] }}] }}"
        );
        warnings(&format!("shape = {{ type = \"ball\" }}\ntranslate = [0, 0, -2]\n{motion}\n"))
    };
    assert_eq!(keyed(1.0), [""; 0]);
    let told = keyed(0.22);
    assert!(told[0].contains("1.000 m in a time step") && told[0].contains("at 0.2"), "{told:?}");
    let in_frames = |rate: f64| warnings(&format!("sequence = \".\"\nsequence_rate = {rate:?}\n"));
    assert_eq!(in_frames(24.0), [""; 0]);
    let told = in_frames(100.0);
    assert!(told[0].contains("0.600 m in a time step") && told[0].contains("at 0.010 s"), "{told:?}");
}

#[test]
fn roots_are_at_the_end_that_is_asked_for_and_tips_are_told() {
    // Two strands off a ball, the second written tip first, and a ring.
    let strands = "v 0 0 0.12\nv 0 0 0.2\nv 0 0 0.3\nv 0.3 0 0\nv 0.2 0 0\nv 0.12 0 0\nl 1 2 3\nl 4 5 6\n";
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("hair.obj"), strands).expect("a mesh");
    let world = |end: &str, obstacle: &str| {
        let text = format!(
            "body = [{{ name = \"hair\", kind = \"strands\", material = \"lock\", mesh = \"hair.obj\" }}]\n\
             pin = [{{ body = \"hair\", roots = 2{end} }}]\n{obstacle}"
        );
        Scene::from_toml(&text, folder.path()).and_then(|scene| World::new(&scene)).expect("a world")
    };
    let ball = "obstacle = [{ shape = { type = \"ball\", radius = 0.1, edge = 0.02 } }]";
    let tips =
        |world: &World| world.warnings.iter().filter(|w| w.contains("1 of 2 strands begin farther")).count();
    for (end, held, warnings) in [
        ("", vec![0, 1, 3, 4], 1),
        (", root_end = \"last\"", vec![1, 2, 4, 5], 0),
        (", root_end = \"nearest\"", vec![0, 1, 4, 5], 0),
    ] {
        let world = world(end, ball);
        assert_eq!((&world.pins[0].vertices, tips(&world)), (&held, warnings), "{end}: {:?}", world.warnings);
    }
    let ground = "obstacle = [{ shape = { type = \"half-space\" } , translate = [0.0, 0.0, -1.0] }]";
    assert_eq!(tips(&world("", ground)), 0, "the second strand is level");
    assert_eq!(world(", root_end = \"nearest\"", "").pins[0].vertices, [0, 1, 3, 4]);
}

#[test]
fn strands_with_repeated_points_are_listed() {
    let mesh = "v 9 9 9\nv 0 0 0\nv 0 0 0\nv 1 0 0\nv 1 0 0\nl 2 3 4 5\nl 4 3\n";
    let message = with_mesh("strands", "mesh.obj", mesh).expect_err("refused");
    assert_eq!(
        message,
        "scene.toml:4: body it: 3 strand edges are faulty: edge 0 joins vertices 1 and 2, both at (0, 0, 0), \
         edge 2 joins vertices 3 and 4, both at (1, 0, 0), edge 3 repeats edge 1 (vertices 3, 2); merge \
         repeated points"
    );
}

/// A Gmsh file of tetrahedra.
fn msh(tets: &[[usize; 4]]) -> String {
    let nodes = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 \
                 0\n\
                 $EndNodes\n";
    let element = |(k, [a, b, c, d]): (usize, &[usize; 4])| format!("{} 4 2 0 1 {a} {b} {c} {d}\n", k + 1);
    let elements: String = tets.iter().enumerate().map(element).collect();
    format!("{nodes}$Elements\n{}\n{elements}$EndElements\n", tets.len())
}

#[test]
fn overlapping_and_flat_tetrahedra_are_listed() {
    let world = with_mesh("solid", "mesh.msh", &msh(&[[1, 2, 3, 4]])).expect("a world");
    assert_eq!((world.positions.len(), world.bodies[0].tets.len()), (4, 1));
    assert!(
        world.warnings[0].contains("left out 1 vertex that belongs to no tetrahedron, the first is vertex 4")
    );
    let message = with_mesh("solid", "mesh.msh", &msh(&[[1, 2, 3, 4], [1, 3, 2, 4], [1, 2, 3, 5]]));
    assert_eq!(
        message.expect_err("refused"),
        "scene.toml:4: body it: of 3 tetrahedra, 1 flat: 2; 1 on the same side of a face as another: 1; \
         the command `bowknot repair` mends or drops them"
    );
    let world = with_mesh("solid", "mesh.msh", &msh(&[[1, 3, 2, 4]])).expect("a world");
    assert!(world.warnings[0].contains("1 of 1 tetrahedron had their vertices in the opposite order"));
}

#[test]
fn bodies_that_begin_in_each_other_are_named() {
    let text = "[[body]]\nname = \"cube\"\nkind = \"solid\"\nshape = \"block\"\n\
                [[body]]\nname = \"hair\"\nkind = \"strands\"\nshape = \"strands\"\ntranslate = [0.003, \
                0.004, 0.25]\n";
    let message = refusal(text);
    assert!(
        message.contains("of hair and triangle (vertices") && message.contains("of cube at ("),
        "{message}"
    );
}

#[test]
fn a_sequence_must_keep_its_topology() {
    let folder = tempfile::tempdir().expect("a folder");
    let frames = folder.path().join("frames");
    let run = || {
        let text = format!("[[body]]\n{SHEET}translate = [0, 0, 5]\n[[obstacle]]\nsequence = \"frames\"\n");
        let scene = Scene::from_toml(&text, folder.path()).expect("a scene");
        World::new(&scene).map_err(|e| e.to_string().replace(&*folder.path().to_string_lossy(), ""))
    };
    assert_eq!(run().expect_err("missing"), "scene.toml:5: cannot read /frames: no such file or folder");
    fs::create_dir(&frames).expect("a folder");
    assert_eq!(run().expect_err("empty"), "scene.toml:5: /frames: no meshes in it, so no sequence");
    let positions: Vec<Point> =
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point::from).into();
    let write = |name: &str, count: usize, triangles: &[[u32; 3]]| {
        let view = MeshView { positions: &positions[..count], triangles, ..MeshView::default() };
        write_obj(&frames.join(name), &view).expect("a frame");
    };
    write("2.obj", 4, &[[0, 1, 2], [0, 1, 3]]);
    write("10.obj", 4, &[[0, 1, 2], [0, 1, 3]]);
    assert_eq!(run().expect("a world").bodies[1].vertices.len(), 4);
    write("11.obj", 4, &[[0, 1, 2], [0, 2, 3]]);
    let message = run().expect_err("other triangles");
    assert_eq!(
        message,
        "scene.toml:5: /frames/11.obj: joins its vertices to other triangles than /frames/2.obj; a sequence \
         keeps its topology"
    );
    write("11.obj", 3, &[[0, 1, 2]]);
    let message = run().expect_err("other vertices");
    assert!(
        message.starts_with("scene.toml:5: /frames/11.obj: has 3 vertices, not 4, so another topology than"),
        "{message}"
    );
}

#[test]
fn numbers_reach_the_world() {
    let scene = scene(
        "[[body]]\nname = \"a\"\nkind = \"particles\"\nmaterial = { base = \"gravel\", density = 2000 }\n\
         shape = \"grains\"\nfriction = 0.4\n[[body]]\nname = \"b\"\nthickness = 0.001\nstretch_limit = inf\n\
         shape = { type = \"sheet\", edge = 0.5 }\ntranslate = [0, 0, 1]\n\
         [[obstacle]]\nname = \"c\"\nshape = \"half-space\"\ntranslate = [0, 0, -1]\nfriction = 0.2\n",
    );
    let world = World::new(&scene).expect("a world");
    let [grains, sheet] = &world.contact.bodies[..] else { panic!("two bodies") };
    // Grains keep their diameter.
    assert_eq!((grains.delta, grains.friction), (Some(0.01), 0.4));
    assert_eq!((sheet.thickness, sheet.stretch_limit, sheet.delta), (Some(0.001), Some(f64::INFINITY), None));
    assert_eq!(world.contact.half_spaces[0].friction, 0.2);
    let info = world.info(0.01);
    assert_eq!((info.particles, info.vertices), (1000, 1009));
    let text = scene.to_toml();
    assert_eq!(Scene::from_toml(&text, "").expect("what was written"), scene, "{text}");
    let set = scene.with_sets(&["body.a.material.radius=0.002"]).expect("a set");
    let world = World::new(&set).expect("a world");
    assert_eq!(world.contact.bodies[0].delta, Some(0.004));
}
