use crate::Place;
use ndarray::{Array2, array};
use ndarray_npy::{NpzReader, NpzWriter};
use std::fs::File;

/// Two layers, 1 cm apart; the target moves the upper one 5 cm below the lower.
fn problem(place: &Place, name: &str) {
    let sheet = |z: f64| array![[0.0, 0.0, z], [0.1, 0.0, z], [0.0, 0.1, z], [0.1, 0.1, z]];
    let stack = |z: f64| ndarray::concatenate![ndarray::Axis(0), sheet(0.0), sheet(z)];
    let mut npz = NpzWriter::new_compressed(File::create(place.path(name)).unwrap());
    npz.add_array("x", &stack(0.01).mapv(|v| v as f32)).unwrap();
    npz.add_array("y", &stack(-0.05)).unwrap();
    npz.add_array("F", &array![[0_u16, 1, 2], [1, 3, 2], [4, 5, 6], [5, 7, 6]]).unwrap();
    npz.finish().unwrap();
}

fn heights(place: &Place, name: &str) -> (f64, f64) {
    let mut npz = NpzReader::new(File::open(place.path(name)).unwrap()).unwrap();
    let x: Array2<f64> = npz.by_name("x").unwrap();
    let column = x.column(2);
    let mean = |range: std::ops::Range<usize>| range.map(|i| column[i]).sum::<f64>() / 4.0;
    (mean(0..4), mean(4..8))
}

#[test]
fn layers_stay_in_order() {
    let place = Place::new();
    problem(&place, "in.npz");
    let runs = [
        ("fast", "--preset fast", 0.005),
        ("quick", "--preset quick", 0.02),
        ("paper", "--preset paper", 0.005),
        ("gpu", "--backend gpu", 0.005),
    ];
    for (preset, options, error) in runs {
        let out = format!("{preset}.npz");
        let ended = place.run(&format!("resolve in.npz --out {out} {options} --json")).ok();
        let summary = ended.json();
        for key in ["steps", "searches"] {
            assert!(summary[key].as_u64().unwrap() >= 1, "{key}: {summary}");
        }
        for key in ["seconds", "cpu_seconds", "distance_to_target", "remaining_m", "stationarity_m"] {
            assert!(summary[key].as_f64().unwrap() >= 0.0, "{key}: {summary}");
        }
        assert!(summary["min_gap_m"].as_f64().unwrap() > 0.0, "{summary}");
        assert!(summary["max_step_stretch"].as_f64().unwrap() > 0.5, "{summary}");
        assert!(summary["converged"].is_boolean());
        let (lower, upper) = heights(&place, &out);
        assert!(upper > lower, "{preset}: {upper} is below {lower}");
        // Equal masses meet half-way between their targets.
        assert!((lower + upper + 0.05).abs() < error, "{preset}: {lower} and {upper}");
    }
    let ended = place.run("resolve in.npz --out again.npz").ok();
    assert!(
        ended.stdout.contains("converged after") && ended.stdout.contains("wrote again.npz"),
        "{ended:#?}"
    );
}

#[test]
fn a_limit_leaves_a_valid_state() {
    let place = Place::new();
    problem(&place, "in.npz");
    let ended =
        place.run("resolve in.npz --out out.npz --set solver.stop.max_steps=1 --max-seconds 100 --json").ok();
    assert_eq!(ended.json()["steps"], 1);
    let (lower, upper) = heights(&place, "out.npz");
    assert!(upper > lower);
}

#[test]
fn recorded_problems_resolve_to_the_same_steps() {
    let place = Place::new();
    let once = "--set simulation.newton_iterations=1";
    let run = place.run(&format!("run drape --scale 0.3 --frames 35 --record --out run --json {once}")).ok();
    assert!(run.json()["frames"].as_u64() == Some(35));
    let states = place.files("run/states");
    assert_eq!(states.len(), 35);
    let steps = place.run(&format!("resolve run/states/{} --out out.npz --json", states[34])).ok().json();
    let stats: Vec<serde_json::Value> =
        place.read("run/stats.jsonl").lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(steps["steps"], stats[34]["two_way_steps"]);
    assert_eq!(steps["min_gap_m"], stats[34]["min_gap_m"]);
}

/// An archive of a state `x`, the same target but for the last vertex `y`, and further arrays.
fn archive(place: &Place, name: &str, last: [f64; 3], add: impl Fn(&mut NpzWriter<File>)) {
    let x = array![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.2, 0.2, 0.5]];
    let mut y = x.clone();
    y.row_mut(3).assign(&ndarray::arr1(&last));
    let mut npz = NpzWriter::new(File::create(place.path(name)).unwrap());
    npz.add_array("x", &x).unwrap();
    npz.add_array("y", &y).unwrap();
    add(&mut npz);
    npz.finish().unwrap();
}

#[test]
fn unknown_arrays_and_a_problem_without_elements_are_named() {
    let place = Place::new();
    let triangle = array![[0_u32, 1, 2]];
    let below = [0.2, 0.2, -0.5];
    archive(&place, "faces.npz", below, |npz| npz.add_array("faces", &triangle).unwrap());
    place.run("resolve faces.npz --out out.npz").refused(2, &["faces.npz", "array faces", "F"]);
    archive(&place, "masses.npz", below, |npz| npz.add_array("masses", &array![1.0, 1.0, 1.0, 1.0]).unwrap());
    place.run("resolve masses.npz --out out.npz").refused(2, &["array masses", "mass"]);
    archive(&place, "rets.npz", below, |npz| npz.add_array("rets", &triangle).unwrap());
    place.run("resolve rets.npz --out out.npz").refused(2, &["array rets", "rest"]);
    assert!(!place.path("out.npz").exists());
    archive(&place, "empty.npz", below, |_| ());
    let ended = place.run("resolve empty.npz --out out.npz").ok();
    assert!(ended.stderr.contains("no elements (F, E, P): nothing can collide"), "{ended:#?}");
}

#[test]
fn prescribed_vertices_that_wait_are_reported() {
    let place = Place::new();
    let triangle = array![[0_u32, 1, 2]];
    archive(&place, "in.npz", [0.2, 0.2, -0.5], |npz| {
        npz.add_array("F", &triangle).unwrap();
        npz.add_array("P", &array![3_u32]).unwrap();
        npz.add_array("fixed", &array![1_u8, 1, 1, 1]).unwrap();
    });
    let summary = place.run("resolve in.npz --out out.npz --json").ok().json();
    let lag = summary["prescribed_lag_m"].as_f64().unwrap();
    assert!((0.5..0.6).contains(&lag), "{summary}");
    assert_eq!((&summary["prescribed_waiting"], &summary["distance_to_target_m"]), (&1.into(), &0.0.into()));
    let ended = place.run("resolve in.npz --out out.npz").ok();
    assert!(ended.stdout.contains("1 prescribed vertex is not at its target"), "{ended:#?}");
}

/// No command writes over a file that it reads, whatever the name that it goes by.
#[test]
fn the_input_is_not_overwritten() {
    let place = Place::new();
    problem(&place, "in.npz");
    let before = std::fs::read(place.path("in.npz")).unwrap();
    place.run("resolve in.npz --out in.npz").refused(2, &["in.npz", "is the file that is read"]);
    place.run("resolve in.npz --out ./in.npz").refused(2, &["in.npz"]);
    assert_eq!(std::fs::read(place.path("in.npz")).unwrap(), before);
    place.write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for words in
        ["repair mesh.obj --out mesh.obj", "check mesh.obj --dump mesh.obj", "run mesh.obj --dump mesh.obj"]
    {
        place.run(words).refused(2, &["mesh.obj", "is the file that is read"]);
    }
}

#[test]
fn devices_are_listed_by_number() {
    let ended = Place::new().run("info --gpus").ok();
    assert!(ended.stdout.starts_with("0: "), "{ended:#?}");
}

#[test]
fn what_is_refused() {
    let place = Place::new();
    problem(&place, "in.npz");
    place.run("resolve none.npz --out out.npz").refused(2, &["none.npz", "no such file"]);
    place.write("bad.npz", "PK\x03\x04");
    place.run("resolve bad.npz --out out.npz").refused(2, &["bad.npz", "not an NPZ archive"]);
    place.run("resolve in.npz").refused(2, &["--out"]);
    place.run("resolve in.npz --out none/out.npz").refused(2, &["none/out.npz", "no such"]);
    place.run("resolve in.npz --out out.npz --max-seconds 0").refused(2, &["--max-seconds"]);
    place.run("resolve in.npz --out out.npz --set contact.gama=1").refused(2, &["contact.gama"]);
    place.run("resolve in.npz --out out.npz --backend gpu --device 99").refused(3, &["no device 99"]);
    place
        .run("resolve in.npz --out out.npz --backend gpu --preset paper")
        .refused(3, &["contact.form", "--backend cpu", "--preset fast"]);
    assert!(!place.path("out.npz").exists());

    let start = |name: &str, x: Array2<f64>, extra: Option<(&str, Array2<f64>)>| {
        let mut npz = NpzWriter::new(File::create(place.path(name)).unwrap());
        npz.add_array("y", &x).unwrap();
        npz.add_array("x", &x).unwrap();
        npz.add_array("F", &array![[0_i64, 1, 2], [3, 4, 5]]).unwrap();
        if let Some((key, values)) = extra {
            npz.add_array(key, &values).unwrap();
        }
        npz.finish().unwrap();
    };
    let pierced = array![
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.2, 0.2, -1.0],
        [0.3, 0.2, 1.0],
        [5.0, 5.0, 0.0]
    ];
    start("pierced.npz", pierced.clone(), None);
    place
        .run("resolve pierced.npz --out out.npz")
        .refused(2, &["pierced.npz", "intersect at the start", "edge", "triangle", "at ("]);
    let mut apart = pierced;
    apart.row_mut(3)[2] = 2.0;
    let column = |values: [f64; 6]| Array2::from_shape_vec((6, 1), values.to_vec()).unwrap();
    start("mass.npz", apart.clone(), Some(("mass", column([1.0, 1.0, 0.0, 1.0, 1.0, 1.0]))));
    place.run("resolve mass.npz --out out.npz").refused(2, &["mass.npz", "vertex 2", "above 0"]);
    start("mixed.npz", apart.clone(), Some(("O", column([0.0, 0.0, 0.0, 0.0, 0.0, 1.0]))));
    place.run("resolve mixed.npz --out out.npz").refused(2, &["mixed.npz"]);
    start("far.npz", apart + 1e13, None);
    place.run("resolve far.npz --out out.npz").refused(2, &["far.npz", "16 ulp"]);
}
