use crate::{Place, tetrahedron};

#[test]
fn scenes_are_listed_with_their_sizes() {
    let place = Place::new();
    let listed = place.run("scenes").ok().stdout;
    let scenes = place.run("scenes --json").ok().json();
    for (name, least, most) in [
        ("drape", 2000, 3000),
        ("needle", 9000, 11000),
        ("stack", 8000, 10000),
        ("sphere", 45000, 55000),
        ("tube", 22000, 28000),
    ] {
        assert!(listed.contains(name), "{listed}");
        let scene = scenes.as_array().unwrap().iter().find(|s| s["name"] == name).unwrap();
        let vertices = scene["vertices"].as_u64().unwrap();
        assert!((least..=most).contains(&vertices), "{name} has {vertices} vertices");
        assert!(scene["frames"].as_u64().unwrap() > 0);
    }
}

/// Every scene, small and for as many time steps as it takes to touch, under the judge.
#[test]
fn every_scene_runs_small_without_an_intersection() {
    let small = [
        ("drape", "0.3", 40),
        ("needle", "0.2", 20),
        ("stack", "0.15", 60),
        ("sphere", "0.1", 60),
        ("tube", "0.15", 60),
        ("blade", "0.1", 20),
        ("funnel", "0.15", 15),
        ("dress", "0.1", 15),
        ("gown", "0.1", 15),
        ("bow-knot", "0.1", 60),
        ("reef-knot", "0.15", 60),
        ("mat", "0.15", 125),
        ("hair", "0.08", 40),
        ("sand", "0.1", 60),
        ("trampoline", "0.3", 40),
        ("cards", "1", 100),
        ("woven", "0.3", 60),
    ];
    let place = Place::new();
    let scenes = place.run("scenes --json").ok().json();
    for scene in scenes.as_array().unwrap() {
        let name = scene["name"].as_str().unwrap();
        let (_, scale, frames) =
            small.iter().find(|(n, ..)| *n == name).unwrap_or_else(|| panic!("no size for {name}"));
        let run =
            format!("run {name} --scale {scale} --frames {frames} --check --json --threads 1 --out {name}");
        let summary = place.run(&run).ok().json();
        assert_eq!(summary["intersections"], 0, "{name}");
        assert!(
            summary["max"]["contact_rows"].as_f64().unwrap()
                + summary["max"]["pressing_contacts"].as_f64().unwrap()
                > 0.0,
            "nothing touches in {name}"
        );
        assert_eq!(summary["mean"]["converged"], 1.0, "{name} has time steps that ended at a limit");
    }
}

#[test]
fn info_counts_a_scene() {
    let place = Place::new();
    let info = place.run("info drape --json").ok().json();
    let number = |key: &str| info[key].as_f64().unwrap_or_else(|| panic!("{key} of {info}"));
    // Euler's formula for a disc.
    assert_eq!(number("vertices") - number("edges") + number("triangles"), 1.0);
    assert_eq!((number("tets"), number("strand_edges"), number("particles")), (0.0, 0.0, 0.0));
    assert!(number("obstacle_vertices") > 100.0 && number("time_step") > 0.0);
    assert_eq!(info["extent"].as_array().unwrap().len(), 3);
}

#[test]
fn info_counts_a_mesh() {
    let place = Place::new();
    tetrahedron(&place.path("t.obj"));
    let info = place.run("info t.obj --json").ok().json();
    assert_eq!((&info["vertices"], &info["edges"], &info["triangles"]), (&4.into(), &6.into(), &4.into()));
    assert_eq!(info["extent"], serde_json::json!([1.0, 1.0, 1.0]));
    let ended = place.run("info t.obj").ok();
    assert!(ended.stdout.contains("triangles          4"), "{ended:#?}");
    assert!(ended.stdout.contains("1.0000 (units of the file)"), "{ended:#?}");
    place.run("info").refused(2, &["SCENE"]);
}

/// A square of two triangles in centimeters, y up, beside a triangle of its own.
const SQUARE_AND_TRIANGLE: &str = "v 0 0 0\nv 100 0 0\nv 0 100 0\nv 100 100 0\nv 0 0 9\nv 9 0 9\nv 0 9 9\n\
                                   f 1 2 4\nf 1 4 3\nf 5 6 7\n";

#[test]
fn info_lists_the_structure_of_a_mesh_and_its_problems() {
    let place = Place::new();
    place.write("good.obj", SQUARE_AND_TRIANGLE);
    let info = place.run("info good.obj --scale 0.01 --up y --json").ok().json();
    let extent: Vec<f64> = info["extent"].as_array().unwrap().iter().map(|e| e.as_f64().unwrap()).collect();
    assert!((extent[0] - 1.0).abs() + (extent[1] - 0.09).abs() + (extent[2] - 1.0).abs() < 1e-12, "{info}");
    assert_eq!(
        (info["parts"][0]["triangles"].as_u64(), info["parts"][1]["vertex"].as_u64()),
        (Some(2), Some(4))
    );
    assert_eq!(
        (info["borders"][0]["edges"].as_u64(), info["borders"].as_array().unwrap().len()),
        (Some(4), 2)
    );
    assert_eq!(info["problems"].as_array().unwrap().len(), 0);
    place.run("info drape --up y").refused(2, &["--up", "meshes"]);

    // A third triangle at the diagonal, a repeated triangle.
    place.write("bad.obj", format!("{SQUARE_AND_TRIANGLE}f 1 4 5\nf 7 6 5\n"));
    let ended = place.run("info bad.obj").ok();
    for words in [
        "edges of three or more triangles 1\n    vertices 0, 3, triangles 0, 1, 3, at (50.0000, 50.0000, \
         0.0000)",
        "refuses the mesh as a body 1\n    triangle 4 repeats triangle 2 (vertices 6, 5, 4), at (3, 3, 9)",
    ] {
        assert!(ended.stdout.contains(words), "{words:?}: {ended:#?}");
    }
    let info = place.run("info bad.obj --json").ok().json();
    assert_eq!(info["branching_edges"][0]["vertices"], serde_json::json!([0, 3]));
    // What `run` refuses: it names the command that helps, and `check` does not pass it without a word.
    place.run("run bad.obj").refused(2, &["triangle 4 repeats triangle 2", "bowknot repair", "bowknot info"]);
    let ended = place.run("check bad.obj");
    assert!(ended.stderr.contains("bad.obj: triangle 4 repeats triangle 2"), "{ended:#?}");
    assert_eq!(place.run("check bad.obj --json").json()["mesh_problems"], 1);
    place.write("flat.t", "Vertex 0 0 0 0\nVertex 1 1 0 0\nVertex 2 0 1 0\nVertex 3 1 1 0\nTet 0 0 1 2 3\n");
    let info = place.run("info flat.t --json").ok().json();
    assert!(info["problems"][0].as_str().unwrap().contains("1 flat"), "{info}");
}

/// Two sheets 4 mm apart, and one far above them.
#[test]
fn pairs_that_start_too_near_are_counted_in_one_line() {
    let place = Place::new();
    let sheet = |name: &str, z: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\nshape = {{ type = \"sheet\", size = [0.1, 0.1], edge = 0.05 }}\n\
             translate = [0.0, 0.0, {z}]\n"
        )
    };
    let text = |gap: f64| {
        format!(
            "[contact]\ndelta = 0.01\n{}{}{}",
            sheet("low", 0.5),
            sheet("high", 0.5 + gap),
            sheet("far", 0.9)
        )
    };
    place.write("near.toml", text(0.004));
    let words = "start nearer than the contact distance: ";
    let nearest = " of low and high, the nearest 4.000 of 10.000 mm at (";
    let ended = place.run("info near.toml").ok();
    assert!(ended.stdout.contains(words) && ended.stdout.contains(nearest), "{ended:#?}");
    let info = place.run("info near.toml --json").ok().json();
    assert_eq!(info["near_starts"][0]["bodies"], serde_json::json!(["low", "high"]));
    assert_eq!(
        (&info["near_starts"][0]["within_part"], &info["near_starts"][1]),
        (&false.into(), &serde_json::Value::Null)
    );
    let ended = place.run("run near.toml --frames 2").ok();
    assert_eq!(ended.stderr.matches(words).count(), 1, "{ended:#?}");
    let note = ended.stderr.lines().find(|line| line.contains(words)).unwrap();
    assert!(note.starts_with("note: ") && note.contains(nearest), "{note}");
    // It started before.
    let ended = place.run("run near.toml --frames 3 --resume").ok();
    assert!(!ended.stderr.contains(words), "{ended:#?}");
    place.write("apart.toml", text(0.0101));
    assert!(!place.run("info apart.toml").ok().stdout.contains(words));
    assert!(!place.run("run apart.toml --frames 1").ok().stderr.contains(words));
    assert!(place.run("info apart.toml --json").ok().json().get("near_starts").is_none());
}
