use crate::{Place, SMALL, tetrahedron};

/// Two unit triangles, one above the other by `gap`.
fn layers(gap: f64) -> String {
    format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 {gap}\nv 1 0 {gap}\nv 0 1 {gap}\nf 1 2 3\nf 4 5 6\n")
}

/// A triangle and one that its edge pierces.
const PIERCED: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 -1\nv 0.3 0.2 1\nv 5 5 0\nf 1 2 3\nf 4 5 6\n";

#[test]
fn clear_states() {
    let place = Place::new();
    place.write("a.obj", layers(0.5));
    tetrahedron(&place.path("b.obj"));
    let ended = place.run("check a.obj b.obj").ok();
    assert!(ended.stdout.contains("2 states: no intersection; smallest distance 5.000e-1 m"), "{ended:#?}");
    let report = place.run("check a.obj b.obj --json").ok().json();
    assert_eq!((&report["clear"], &report["states"]), (&true.into(), &2.into()));
    assert_eq!(report["files"][0]["min_distance_m"], 0.5);
}

#[test]
fn frames_written_in_two_formats_are_counted_once() {
    let place = Place::new();
    place.run(&format!("{SMALL} --format ply,obj --out run")).ok();
    assert_eq!(place.files("run/frames").len(), 8);
    assert_eq!(place.run("check run --json").ok().json()["states"], 4);
}

#[test]
fn an_intersection_is_found() {
    let place = Place::new();
    place.write("a.obj", layers(0.5));
    place.write("b.obj", PIERCED);
    let ended = place.run("check a.obj b.obj");
    assert_eq!(ended.code, 1, "{ended:#?}");
    assert!(ended.stdout.contains("b.obj: edge") && ended.stdout.contains("intersect at ("), "{ended:#?}");
    let ended = place.run("check a.obj b.obj --json");
    assert_eq!((ended.code, &ended.json()["clear"]), (1, &false.into()));
    assert_eq!(ended.json()["files"][0]["intersections"], 0);
}

#[test]
fn a_distance_below_the_least() {
    let place = Place::new();
    place.write("a.obj", layers(0.01));
    place.run("check a.obj --min-distance 0.0099").ok();
    let ended = place.run("check a.obj --min-distance 0.0101");
    assert_eq!(ended.code, 1, "{ended:#?}");
    assert!(ended.stdout.contains("apart") && ended.stdout.contains("below 1.010e-2 m"), "{ended:#?}");
    place.run("check a.obj --min-distance 0").refused(2, &["--min-distance", "above 0"]);
}

/// The upper layer passes through the lower one between two states that are clear by themselves.
#[test]
fn paths_are_judged_within_a_trace_only() {
    let place = Place::new();
    for folder in ["frames", "trace"] {
        std::fs::create_dir(place.path(folder)).unwrap();
        // In natural order 10 comes last.
        for (name, gap) in [("2", 0.5), ("9", 0.25), ("10", -0.25)] {
            place.write(&format!("{folder}/{name}.obj"), layers(gap));
        }
    }
    let ended = place.run("check frames").ok();
    assert!(ended.stdout.starts_with("3 states: no intersection"), "{ended:#?}");
    let ended = place.run("check trace --json");
    assert_eq!(ended.code, 1, "{ended:#?}");
    let report = ended.json();
    assert_eq!((&report["paths"], &report["intersections"]), (&2.into(), &0.into()));
    assert!(report["path_hits"].as_u64().unwrap() > 0);
    assert_eq!(
        (&report["files"][1]["path_hits"], report["files"][2]["file"].as_str().unwrap()),
        (&0.into(), "trace/10.obj")
    );
    let ended = place.run("check trace");
    assert!(ended.stdout.contains("trace/10.obj: ") && ended.stdout.contains("of the path"), "{ended:#?}");

    place.write("trace/11.obj", layers(0.5).replace("f 4 5 6", "f 4 6 5"));
    place.run("check trace").refused(2, &["trace/11.obj", "differ"]);
}

#[test]
fn a_whole_run_with_its_trace() {
    let place = Place::new();
    place.run(&format!("{SMALL} --trace --out run --format ply,npz")).ok();
    let report = place.run("check run --json").ok().json();
    let files = place.files("run/trace").len();
    assert_eq!(report["paths"].as_u64().unwrap() as usize, files - 1);
    assert_eq!(report["states"].as_u64().unwrap() as usize, files + 4 + 4, "trace, frames, frames.npz");
}

#[test]
fn what_cannot_be_judged() {
    let place = Place::new();
    std::fs::create_dir(place.path("empty")).unwrap();
    place.run("check empty").refused(2, &["empty", "no frames"]);
    place.run("check none").refused(2, &["none"]);
    place.run("check").refused(2, &["PATH"]);
    place.write("bad.ply", "ply\nformat ascii 1.0\nend_header\n");
    place.run("check bad.ply").refused(2, &["bad.ply", "no vertices"]);
    place.write("bad.npz", "PK");
    place.run("check bad.npz").refused(2, &["bad.npz", "not an NPZ archive"]);
    place.write("twice.obj", "v 0 0 0\nv 1 0 0\nf 1 2 2\n");
    place.run("check twice.obj").refused(2, &["twice.obj", "triangle 0 names vertex 1 twice"]);
}

/// One tetrahedron, in Gmsh's text.
const SOLID: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 \
                     0.2 0.2 0.2\n\
                     $EndNodes\n$Elements\n4\n1 4 0 1 2 3 5\n2 4 0 1 4 2 5\n3 4 0 2 4 3 5\n4 4 0 1 3 4 \
                     5\n$EndElements\n";

#[test]
fn the_surface_of_a_solid_is_judged() {
    let place = Place::new();
    place.write("solid.msh", SOLID);
    let ended = place.run("check solid.msh").ok();
    assert!(ended.stdout.contains("no intersection; smallest distance 5.774e-1 m"), "{ended:#?}");
    // Inside, the vertex belongs to no surface; a second solid around it does intersect.
    let pierced = "Vertex 0 0 0 0\nVertex 1 1 0 0\nVertex 2 0 1 0\nVertex 3 0 0 1\nVertex 4 -1 0.2 0.2\n\
                   Vertex 5 3 0.2 0.2\nVertex 6 3 0.3 0.2\nVertex 7 3 0.2 0.3\nTet 0 0 1 2 3\nTet 1 4 5 6 \
                   7\n";
    place.write("pierced.t", pierced);
    let ended = place.run("check pierced.t");
    assert_eq!(ended.code, 1, "{ended:#?}");
    place.write("bad.msh", SOLID.replace("1 2 3 5", "1 2 3 6"));
    place.run("check bad.msh").refused(2, &["bad.msh:14", "node 6"]);
}

#[test]
fn solids_and_strands_are_counted() {
    let place = Place::new();
    place.write("solid.msh", SOLID);
    place.write("strand.seg", "v 0 0 0\nv 1 0 0\nv 2 0 0\ns 1 2\ns 2 3\n");
    let info = place.run("info solid.msh --json").ok().json();
    assert_eq!((&info["vertices"], &info["tets"], &info["triangles"]), (&5.into(), &4.into(), &4.into()));
    place.write("groups.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\ng hem\nf 1 2 3\ng hem top\nf 2 4 3\n");
    let info = place.run("info groups.obj").ok();
    assert!(
        info.stdout.contains("groups             2\n    hem: 4 vertices\n    top: 3 vertices"),
        "{info:#?}"
    );
    let info = place.run("info groups.obj --json").ok().json();
    assert_eq!((&info["groups"]["hem"], &info["groups"]["top"]), (&4.into(), &3.into()));
    let info = place.run("info strand.seg").ok();
    assert!(info.stdout.contains("strand edges       2"), "{info:#?}");
}

/// A lid that waits while a cloth falls through its place, and a ground that vanishes.
const COMING_AND_GOING: &str = "[[body]]\nname = \"cloth\"\ntranslate = [0, 0, 0.5]\n\
     shape = { type = \"sheet\", size = [0.2, 0.2], edge = 0.04 }\n\
     [[obstacle]]\nname = \"lid\"\nshape = { type = \"box\", size = [0.5, 0.5, 0.02] }\ntranslate = [0, 0, \
     0.49]\n\
     motion = { spin = 90 }\nappears = 0.045\n\
     [[obstacle]]\nname = \"ground\"\nshape = \"half-space\"\ntranslate = [0, 0, 0.45]\nvanishes = 0.2\n";

#[test]
fn obstacles_that_are_not_there_are_not_judged() {
    let place = Place::new();
    place.write("scene.toml", COMING_AND_GOING);
    for backend in ["cpu", "gpu"] {
        let options = "--frames 30 --trace --check --format ply,npz,obj --threads 1";
        let ended = place.run(&format!("run scene.toml --backend {backend} {options} --out {backend}")).ok();
        assert!(ended.stdout.contains("obstacle lid waited "), "{ended:#?}");
        assert!(ended.stdout.contains("no intersection"), "{ended:#?}");
        // The minimum separation is a hundredth of an edge.
        let report = place.run(&format!("check {backend} --min-distance 0.0004 --json")).ok().json();
        assert_eq!((&report["clear"], &report["mesh_problems"]), (&true.into(), &0.into()), "{report}");
        assert!(report["paths"].as_u64().unwrap() > 30, "{report}");
        place.run(&format!("check {backend}/frames.npz")).ok();
    }
}

/// Two objects that pierce each other, beside a third one that pierces itself.
const OBJECTS: &str = "o left\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no right\nv 0.2 0.2 -1\nv 0.3 0.2 1\nv 5 5 0\nf 4 5 6\n\
                       o knot\nv 20 0 0\nv 21 0 0\nv 20 1 0\nv 20.2 0.2 -0.1\nv 20.3 0.2 1\nv 25 5 0\nf 7 8 9\nf 10 11 12\n";

#[test]
fn pairs_of_parts_are_counted_and_may_be_exempt() {
    let place = Place::new();
    place.write("a.obj", OBJECTS);
    let report = place.run("check a.obj --json").json();
    let pair = |index: usize| {
        let pair = &report["pairs"][index];
        (pair["parts"].to_string(), pair["states"].as_u64(), pair["most"].as_u64())
    };
    assert_eq!(pair(0), ("[\"left\",\"right\"]".to_owned(), Some(1), Some(2)), "{report}");
    assert_eq!(pair(1), ("[\"knot\",\"knot\"]".to_owned(), Some(1), Some(2)), "{report}");
    // One edge goes 0.1 deep; the other ends farther from the plane that it crosses.
    let depth = report["pairs"][1]["depth_m"].as_f64().unwrap();
    assert!(depth > 0.1 && depth < 1.0, "{report}");

    place.run("check a.obj --may-intersect knot --obstacle right --obstacle l*t").ok();
    place.run("check a.obj --leave-out knot --leave-out left").ok();
    let ended = place.run("check a.obj --may-intersect *");
    assert_eq!(ended.code, 1, "{ended:#?}");
    assert!(ended.stdout.contains("of left") && !ended.stdout.contains("knot"), "{ended:#?}");
    place.run("check a.obj --obstacle lft").refused(2, &["lft", "left, right, knot"]);
}

/// A layer that passes through another one between two frames, and lies in it in the next.
#[test]
fn frames_of_an_animation_and_the_ways_between_them() {
    let place = Place::new();
    std::fs::create_dir(place.path("frames")).unwrap();
    for (name, gap) in [("1", 0.5), ("2", -0.25), ("3", 0.0)] {
        place.write(&format!("frames/{name}.obj"), layers(gap));
    }
    let report = place.run("check frames --json --table table.csv").json();
    assert_eq!((&report["intersecting_states"], &report["paths"]), (&1.into(), &0.into()), "{report}");
    let table = place.read("table.csv");
    let rows: Vec<&str> = table.lines().collect();
    assert!(rows.len() == 4 && rows[1].starts_with("frames/1.obj,,,,0,"), "{table}");
    assert!(rows[3].starts_with("frames/3.obj,,frames,frames,"), "{table}");

    place.write("frames/3.obj", layers(0.5));
    let ended = place.run("check frames --paths").ok();
    assert!(ended.stdout.contains("(a hint: straight between the frames)"), "{ended:#?}");
    assert!(ended.stdout.contains("on the straight way between frames"), "{ended:#?}");
    let report = place.run("check frames --paths --json").ok().json();
    assert!(report["hints_between_frames"].as_u64().unwrap() > 0, "{report}");
    assert_eq!((&report["path_hits"], &report["paths"]), (&0.into(), &2.into()), "{report}");
}

/// A triangle whose lowest corner is at each of these heights, over one at rest.
fn falling(heights: &[f64]) -> String {
    let samples: Vec<String> = heights
        .iter()
        .enumerate()
        .map(|(k, z)| {
            format!("{}: [(0.2, 0.2, {z}), (0.3, 0.2, {}), (5, 5, {})]", 10 + 5 * k, z + 2.0, z + 1.0)
        })
        .collect();
    let mesh = |name: &str, points: &str| {
        format!(
            "def Mesh \"{name}\" {{ int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\n\
             uniform token subdivisionScheme = \"none\"\n{points} }}\n"
        )
    };
    format!(
        "#usda 1.0\n( timeCodesPerSecond = 10 )\n{}{}",
        mesh("still", "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]"),
        mesh("moving", &format!("point3f[] points.timeSamples = {{ {} }}", samples.join(", ")))
    )
}

/// Time codes, times, and elements by their part are those of the file.
#[test]
fn findings_have_the_numbers_of_the_file() {
    let place = Place::new();
    place.write("a.usda", falling(&[2.0, 1.0, -0.25]));
    let ended = place.run("check a.usda");
    assert_eq!(ended.code, 1, "{ended:#?}");
    assert!(ended.stdout.contains("a.usda[2] (2.000000 s, time code 20): edge"), "{ended:#?}");
    assert!(
        ended
            .stdout
            .contains("; by its part: edge [0, 1] of moving and triangle 0 (vertices [0, 1, 2]) of still"),
        "{ended:#?}"
    );
    let report = place.run("check a.usda --json").json();
    let state = &report["files"][2];
    assert_eq!((&state["time_code"], &state["time_s"]), (&20.0.into(), &2.0.into()), "{report}");
    let [edge, triangle] = [0, 1].map(|side| &state["elements"][1][side]);
    assert_eq!(
        (&edge["kind"], &edge["part"], &edge["number"]),
        (&"edge".into(), &"moving".into(), &serde_json::Value::Null),
        "{report}"
    );
    assert_eq!((&triangle["part"], &triangle["number"]), (&"still".into(), &0.into()), "{report}");
    assert_eq!(triangle["vertices"], serde_json::json!([0, 1, 2]), "{report}");
    // Hints by pairs of parts.
    place.write("b.usda", falling(&[2.0, 1.0, -4.0, 1.0]));
    let ended = place.run("check b.usda --paths").ok();
    let header = ended
        .stdout
        .lines()
        .position(|line| line.starts_with("meet between frames (hints)"))
        .expect("a table");
    let row = ended.stdout.lines().nth(header + 1).expect("a row");
    assert!(
        row.starts_with("still and moving") && row.ends_with("b.usda[2] (2.000000 s, time code 20)"),
        "{ended:#?}"
    );
    let report = place.run("check b.usda --paths --json").ok().json();
    let [pair] = report["hint_pairs"].as_array().expect("pairs").as_slice() else { panic!("{report}") };
    assert_eq!((&pair["paths"], &pair["first"]), (&2.into(), &"b.usda[2]".into()), "{report}");
    let all: u64 = report["files"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|state| state["hint_pairs"][0]["hints"].as_u64())
        .sum();
    assert_eq!(report["hints_between_frames"], all, "{report}");
}

#[test]
fn what_lies_inside_of_a_closed_part_is_a_hint() {
    let place = Place::new();
    let ball = "o ball\nv 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    let sheet =
        |x: f64| format!("{ball}o sheet\nv {x} 0.5 0.5\nv {} 0.5 0.5\nv {x} 0.7 0.5\nf 5 6 7\n", x + 0.2);
    place.write("in.obj", sheet(0.5));
    let ended = place.run("check in.obj").ok();
    assert!(
        ended.stdout.contains("sheet lies inside of ball, which is closed, in 1 state, the first in.obj"),
        "{ended:#?}"
    );
    let report = place.run("check in.obj --json").ok().json();
    assert_eq!(report["inside"][0]["within"], "ball", "{report}");
    // Beside it, within its box; through its surface; inside of one with a hole.
    place.write("beside.obj", sheet(3.6));
    place.write("through.obj", sheet(-0.1));
    place.write("open.obj", sheet(0.5).replace("f 3 1 4\n", ""));
    for name in ["beside", "through", "open"] {
        let ended = place.run(&format!("check {name}.obj"));
        assert!(
            !ended.stdout.contains("lies inside") && (ended.code == 1) == (name == "through"),
            "{ended:#?}"
        );
    }
}

#[test]
fn files_that_are_parts_of_one_scene() {
    let place = Place::new();
    place.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    place.write("b.obj", "v 0.2 0.2 -1\nv 0.3 0.2 1\nv 5 5 0\nf 1 2 3\n");
    place.run("check a.obj b.obj").ok();
    let ended = place.run("check a.obj b.obj --together --json");
    assert_eq!(ended.code, 1, "{ended:#?}");
    let report = ended.json();
    assert_eq!(report["pairs"][0]["parts"].to_string(), "[\"a\",\"b\"]", "{report}");
    // Frames of one beside the other, which stands still.
    std::fs::create_dir(place.path("moving")).unwrap();
    for (frame, height) in [(0, 3.0), (1, 2.0), (2, 0.5)] {
        let moved =
            format!("v 0.2 0.2 {}\nv 0.3 0.2 {}\nv 5 5 {height}\nf 1 2 3\n", height - 1.0, height + 1.0);
        place.write(&format!("moving/{frame}.obj"), moved);
    }
    let report = place.run("check a.obj moving --together --json").json();
    assert_eq!((&report["states"], &report["intersecting_states"]), (&3.into(), &1.into()), "{report}");
    std::fs::create_dir(place.path("short")).unwrap();
    for frame in 0..2 {
        place.write(&format!("short/{frame}.obj"), layers(0.5));
    }
    place.run("check short moving --together").refused(2, &["moving", "3 frames", "2"]);
}

#[cfg(feature = "render")]
#[test]
fn the_first_state_that_intersects_is_drawn() {
    let place = Place::new();
    place.write("a.obj", OBJECTS);
    let ended = place.run("check a.obj --picture picture.png");
    if ended.code == 3 {
        assert!(std::env::var_os("BOWKNOT_NEED_DRIVER").is_none(), "{ended:#?}");
        return;
    }
    assert_eq!(ended.code, 1, "{ended:#?}");
    assert_eq!(&std::fs::read(place.path("picture.png")).unwrap()[1..4], b"PNG");
    place.run("check a.obj --picture picture.jpg").refused(2, &["picture.jpg", ".png"]);
}
