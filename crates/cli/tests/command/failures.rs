//! `--dump-on-failure`: the smallest state that shows a failure.

use crate::{Place, tetrahedron};
use ndarray::{Array2, array};
use ndarray_npy::{NpzReader, NpzWriter};
use std::fs::File;

/// Triangles and vertices of an archive.
fn sizes(place: &Place, name: &str) -> (usize, usize) {
    let mut npz = NpzReader::new(File::open(place.path(name)).unwrap()).unwrap();
    let triangles: Array2<i32> = npz.by_name("F").unwrap();
    let x: Array2<f64> = npz.by_name("x").unwrap();
    (triangles.nrows(), x.nrows())
}

/// A sheet through a ball, and another sheet far away.
const OVERLAPPING: &str = r#"
    [[body]]
    shape = { type = "sheet", size = [0.4, 0.4], edge = 0.02 }

    [[body]]
    shape = { type = "sheet", size = [0.4, 0.4], edge = 0.02 }
    translate = [0.0, 0.0, 2.0]

    [[obstacle]]
    shape = { type = "ball", radius = 0.1 }
"#;

#[test]
fn of_a_start_that_intersects_two_triangles_are_written() {
    let place = Place::new();
    place.write("scene.toml", OVERLAPPING);
    let words = "run scene.toml --out run --dump-on-failure small.npz";
    place.run(words).refused(2, &["the start already intersects", "bowknot check small.npz", "none of them"]);
    assert_eq!(sizes(&place, "small.npz"), (2, 6));
    // Both commands show it again.
    place.run("check small.npz").refused(1, &[]);
    place.run("resolve small.npz --out out.npz").refused(2, &["at the start"]);
    // A problem is reduced in the same way, and so is a mesh.
    place.run("resolve small.npz --out out.npz --dump-on-failure again.npz").refused(2, &["again.npz"]);
    assert_eq!(sizes(&place, "again.npz"), (2, 6));
    place.run("run scene.toml --out run --dump mesh.ply").refused(2, &["mesh.ply"]);
    place.run("check mesh.ply --dump-on-failure mesh.npz").refused(1, &["mesh.npz"]);
    assert_eq!(sizes(&place, "mesh.npz"), (2, 6));
    place.run("check mesh.npz").refused(1, &[]);
}

#[test]
fn of_a_step_that_does_not_converge_few_elements_are_written() {
    let place = Place::new();
    let limits = "--set solver.stop.max_steps=1";
    let words =
        format!("run drape --scale 0.3 --frames 30 --dt 0.03 --out run --dump-on-failure small.npz {limits}");
    let ended = place.run(&words).ok();
    assert!(ended.stderr.contains("none of them can be left out"), "{ended:#?}");
    let command = "bowknot resolve small.npz --out result.npz --set 'solver.stop.max_steps=1'";
    assert!(ended.stderr.contains(command), "{ended:#?}");
    let (triangles, _) = sizes(&place, "small.npz");
    assert!((1..=6).contains(&triangles), "{triangles} triangles");
    place.run("check small.npz").ok();
    let again = place.run(&format!("resolve small.npz --out result.npz --check --json {limits}")).ok().json();
    assert_eq!((&again["converged"], &again["intersections"]), (&false.into(), &0.into()));
    // With the steps that it needs it converges: it was the limit that failed.
    let again = place.run("resolve small.npz --out result.npz --json").ok().json();
    assert_eq!(again["converged"], true, "{again}");
}

#[test]
fn of_a_call_that_is_refused_one_element_is_written() {
    let place = Place::new();
    let mut npz = NpzWriter::new(File::create(place.path("far.npz")).unwrap());
    let x = array![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let mut y = x.clone();
    y[[3, 2]] = 1e14;
    npz.add_array("x", &x).unwrap();
    npz.add_array("y", &y).unwrap();
    npz.add_array("F", &array![[0_u32, 1, 2], [1, 3, 2]]).unwrap();
    npz.finish().unwrap();
    let ended = place.run("resolve far.npz --out out.npz --dump-on-failure small.npz");
    ended.refused(2, &["of the largest coordinate", "wrote 1 element of 2 to small.npz"]);
    assert_eq!(sizes(&place, "small.npz"), (1, 3));
    place.run("resolve small.npz --out out.npz").refused(2, &["of the largest coordinate"]);
}

#[test]
fn runs_that_do_not_fail_write_nothing() {
    let place = Place::new();
    let words = format!("{} --out run --check --dump-on-failure small.npz", crate::SMALL);
    let ended = place.run(&words).ok();
    assert!(!ended.stderr.contains("small.npz") && !place.path("small.npz").exists(), "{ended:#?}");
    tetrahedron(&place.path("clear.obj"));
    place.run("check clear.obj --dump-on-failure small.npz").ok();
    assert!(!place.path("small.npz").exists());
    // Files that could not be written, or would be lost, are refused before the work.
    place.run("run drape --dump-on-failure small.ply").refused(2, &["must end in .npz"]);
    place.run("run drape --dump-on-failure none/small.npz").refused(2, &["no such folder none"]);
    place.run("check clear.obj --dump-on-failure clear.obj").refused(2, &["is the file that is read"]);
}

/// Half-spaces and collision groups of a problem count when `check` judges it.
#[test]
fn problems_are_checked_with_their_half_spaces() {
    let place = Place::new();
    let write = |name: &str, offset: f64| {
        let mut npz = NpzWriter::new(File::create(place.path(name)).unwrap());
        let x = array![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        npz.add_array("x", &x).unwrap();
        npz.add_array("y", &x).unwrap();
        npz.add_array("F", &array![[0_u32, 1, 2]]).unwrap();
        npz.add_array("planes", &array![[0.0, 0.0, 1.0, offset]]).unwrap();
        npz.finish().unwrap();
    };
    write("above.npz", -0.5);
    place.run("check above.npz").ok();
    write("below.npz", 0.5);
    let ended = place.run("check below.npz").refused(1, &[]);
    assert!(ended.stdout.contains("3 intersections"), "{ended:#?}");
}
