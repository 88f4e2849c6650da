use super::*;
use crate::Scene;
use crate::simulator::SimulationObserver;
use crate::simulator::{CollisionProblem, Simulator};
use bowknot_geometry::{BodyFilter, HalfSpace, PairKind, Point, Vector};
use bowknot_twoway::Params;
use bowknot_twoway::lcp::DistanceLimit;
use bowknot_twoway::{
    BodyContact, ContactSide, HalfSpaceContact, PairFriction, PairMultipliers, ResolveInput,
};
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

/// Solves each problem again from its file, and keeps both ends.
struct Again {
    recorder: Recorder,
    params: Params,
    path: std::path::PathBuf,
    ends: Vec<Vec<Point>>,
}

impl SimulationObserver for Again {
    fn problem(&mut self, problem: &CollisionProblem<'_>) -> ControlFlow<()> {
        let states = self.recorder.states(problem);
        states.write(&self.path).expect("written");
        let read = States::read(&self.path).expect("read");
        let model = read.collision_model().expect("a model");
        let mut resolver = read.resolver(model, self.params.clone()).expect("a resolver");
        let mut x = read.x.clone();
        resolver.resolve_with(&mut x, &read.y, &read.input(), &mut ()).expect("resolved");
        self.ends.push(x);
        ControlFlow::Continue(())
    }
}

/// Grains of their own size with friction on a plane, and a sheet with pins: the file holds all that matters.
#[test]
fn a_recorded_problem_ends_where_the_simulation_did() {
    let text = r#"
        [[body]]
        kind = "particles"
        shape = { type = "grains", count = [5, 5, 4], spacing = 0.0045 }
        delta = 0.004
        thickness = 0.003
        friction = 0.4
        translate = [0.0, 0.0, 0.012]

        [[body]]
        name = "sheet"
        shape = { type = "sheet", size = [0.1, 0.1], edge = 0.02 }
        translate = [0.0, 0.0, 0.06]

        [[pin]]
        body = "sheet"
        side = "x-max"
        motion = { keyframes = [{ time = 0.0 }, { time = 1.0, translate = [0.1, 0.0, -0.5] }] }

        [[obstacle]]
        shape = { type = "half-space" }
        friction = 0.3
    "#;
    solve_again(text, 8);
}

/// Makes time steps of a scene and solves each of their problems again from its file, to the same end.
/// Returns the last of them.
fn solve_again(text: &str, steps: usize) -> (Simulator, States) {
    let scene = Scene::from_toml(text, ".").expect("a scene");
    let folder = tempfile::tempdir().expect("a folder");
    let mut simulator = Simulator::new(&scene).expect("a simulator");
    let mut again = Again {
        recorder: Recorder::new(&simulator),
        params: scene.twoway(),
        path: folder.path().join("problem.npz"),
        ends: Vec::new(),
    };
    for step in 0..steps {
        simulator.step_observed(&mut again).expect("a step");
        let count = simulator.world().collision_vertices();
        let end = again.ends.last().expect("a problem in each step");
        assert!(*end == simulator.positions()[..count], "step {step} ends elsewhere");
    }
    let last = States::read(&again.path).expect("read");
    (simulator, last)
}

/// Bodies that pass through each other and one that passes through itself, as collision groups allow: without
/// the groups the recorded start would be refused, and the bodies pushed apart.
#[test]
fn bodies_of_other_collision_groups_pass_through_each_other_in_a_recorded_problem() {
    let text = r#"
        [[body]]
        shape = { type = "sheet", size = [0.1, 0.1], edge = 0.02 }
        self_collision = false

        [[body]]
        shape = { type = "sheet", size = [0.1, 0.1], edge = 0.02 }
        rotate = [80.0, 0.0, 0.0]
        groups = [2, 31]
        collides_with = [5]

        [[obstacle]]
        shape = { type = "sheet", size = [0.3, 0.3], edge = 0.05 }
        translate = [0.0, 0.0, -0.004]
        collides_with = [0]
    "#;
    let (simulator, read) = solve_again(text, 6);
    assert_eq!(read.collision_model().expect("a model").bodies(), simulator.world().collision.bodies());
}

/// A problem with every array, and numbers that do not survive a careless print.
fn states() -> States {
    let x = [
        [0.1, 1.0 / 3.0, -2.5e-7],
        [1e10, 0.0, -0.0],
        [f64::MIN_POSITIVE, 0.3, 0.7],
        [1.0, 2.0, 3.0],
        [-1.0, -2.0, -3.0],
        [4.0, 5.0, 6.0],
    ]
    .map(Point::from);
    States {
        x: x.to_vec(),
        y: x.iter().map(|p| p + Vector::new(0.1, 0.2, 0.3)).collect(),
        rest: x.iter().map(|p| p * 0.5).collect(),
        start: x.iter().map(|p| p * 0.75).collect(),
        triangles: vec![[0, 1, 2], [2, 1, 3]],
        strands: vec![[3, 4]],
        particles: vec![5],
        masses: vec![0.1, 0.2, 0.3, 0.4, 0.5, 0.6],
        fixed: vec![true, false, false, false, false, false],
        obstacle: vec![false, false, false, false, false, true],
        body: vec![0, 0, 0, 0, 1, 2],
        half_spaces: vec![HalfSpace { normal: Vector::new(0.6, 0.0, 0.8), offset: -0.25 }],
        time_step: Some(0.01),
        body_contacts: vec![
            BodyContact { thickness: Some(1e-3), friction: 0.25, ..BodyContact::default() },
            BodyContact { stretch_limit: Some(f64::INFINITY), ..BodyContact::default() },
            BodyContact { delta: Some(4e-3), ..BodyContact::default() },
        ],
        half_space_contacts: vec![HalfSpaceContact { thickness: Some(2e-3), friction: 0.5 }],
        pair_frictions: vec![PairFriction {
            sides: [ContactSide::Body(1), ContactSide::HalfSpace(0)],
            friction: 0.75,
        }],
        groups: vec![3, 3, ResolveInput::NO_GROUP, 0, ResolveInput::NO_GROUP, ResolveInput::NO_GROUP],
        known: vec![true, true, true, false, false, false],
        carried: vec![PairMultipliers {
            kind: PairKind::VertexHalfSpace,
            elements: [3, 0],
            normal: 1e-300,
            friction: Vector::new(0.1, -0.0, 1.0 / 3.0),
        }],
        yielding: vec![DistanceLimit { vertices: [2, 1], limit: 1.0 / 3.0 }],
        filters: vec![
            BodyFilter { groups: 1 << 31, self_collision: false, ..BodyFilter::DEFORMABLE },
            BodyFilter { groups: 0b1010, mask: 0x8000_0001, ..BodyFilter::DEFORMABLE },
            BodyFilter::OBSTACLE,
        ],
    }
}

#[test]
fn states_round_trip_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("states.npz");
    states().write(&path).unwrap();
    assert_eq!(States::read(&path).unwrap(), states());
}

#[test]
fn states_of_any_number_type_with_defaults() {
    use ndarray::{Array1, Array2, ShapeBuilder};
    use ndarray_npy::NpzWriter;
    let folder = tempfile::tempdir().unwrap();
    let write_with = |name: &str, compressed: bool, bad: Option<(&str, Array2<f64>)>| {
        let path = folder.path().join(name);
        let file = fs::File::create(&path).unwrap();
        let mut npz = if compressed { NpzWriter::new_compressed(file) } else { NpzWriter::new(file) };
        let x = Array2::from_shape_fn((4, 3), |(i, k)| (i * 3 + k) as f32);
        // Column-major, as numpy writes transposed arrays.
        let y = Array2::from_shape_fn((4, 3).f(), |(i, k)| (i * 3 + k) as f64);
        let arrays = ["x", "y", "F", "O"];
        if let Some((name, array)) = &bad {
            npz.add_array(*name, array).unwrap();
        }
        for array in arrays.iter().filter(|a| bad.as_ref().is_none_or(|(name, _)| name != *a)) {
            match *array {
                "x" => npz.add_array("x", &x),
                "y" => npz.add_array("y", &y),
                "F" => npz.add_array("F", &Array2::<i64>::from_shape_fn((1, 3), |(_, k)| k as i64)),
                _ => npz.add_array("O", &Array1::from_vec(vec![0_u8, 0, 0, 1])),
            }
            .unwrap();
        }
        npz.finish().unwrap();
        path
    };
    for compressed in [false, true] {
        let states = States::read(&write_with("a.npz", compressed, None)).unwrap();
        assert_eq!(states.x[1], Point::new(3.0, 4.0, 5.0));
        assert_eq!(states.x, states.y, "row-major f32 and column-major f64 hold the same numbers");
        assert_eq!((states.rest.clone(), states.masses), (states.x.clone(), vec![1.0; 4]));
        assert_eq!(states.body, [0, 0, 0, 1]);
        assert_eq!((states.fixed, states.time_step), (vec![false; 4], None));
    }
    let row = |values: &[f64]| Array2::from_shape_vec((1, values.len()), values.to_vec()).unwrap();
    for (name, array, words) in [
        ("y", row(&[0.0, 0.0, 0.0]), "array y: it has 1 row for 4 vertices"),
        ("y", Array2::zeros((4, 2)), "array y: its shape is [4, 2], it must be [n, 3]"),
        ("y", Array2::from_elem((4, 3), f64::NAN), "array y: row 0 is not finite"),
        ("x", Array2::zeros((0, 3)), "array x: it has no vertices"),
        ("F", row(&[0.0, 1.0, 4.0]), "array F: row 0 names vertex 4, but the archive has 4 vertices"),
        ("F", row(&[0.0, 1.0, -1.0]), "names vertex -1"),
        ("E", row(&[0.0, 0.5]), "array E: row 0 names vertex 0.5"),
        ("P", row(&[7.0]), "array P: row 0 names vertex 7"),
        ("mass", row(&[1.0]), "array mass: it has 1 entry for 4 vertices"),
        ("body", row(&[0.0, 0.0, 0.0, 9.0]), "vertex 3 has body 9"),
        ("planes", row(&[0.0, 0.0, 0.0, 1.0]), "array planes: row 0 needs a normal"),
        ("dt", row(&[-1.0]), "array dt"),
        ("thickness", row(&[0.0, 0.0, 0.0]), "array thickness: it has 3 entries for 2 bodies"),
        ("plane_friction", row(&[0.5]), "array plane_friction: it has 1 entry for 0 planes"),
        ("pair_friction", row(&[0.0, 2.0, 0.5]), "names side 2, but the archive has 2 bodies and 0 planes"),
        ("group", row(&[-2.0, 0.0, 0.0, 0.0]), "vertex 0 has group -2"),
        ("start", row(&[0.0, 0.0, 0.0]), "array start: it has 1 row for 4 vertices"),
    ] {
        let text = message(&write_with("bad.npz", true, Some((name, array))));
        assert!(text.contains("bad.npz") && text.contains(words), "{name}: {text}");
    }
    let path = folder.path().join("few.npz");
    write_result(&path, &states(), &states().y).unwrap();
    let result = States::read(&path).unwrap();
    assert_eq!(
        (&result.x, &result.triangles, &result.body),
        (&states().y, &states().triangles, &states().body)
    );
    fs::write(&path, b"\x93NUMPY\x01").unwrap();
    assert!(message(&path).contains("a single array, use np.savez"));
    fs::write(&path, "hello").unwrap();
    assert!(message(&path).contains("not an NPZ archive"));
}

/// What is wrong with a file.
fn message(path: &Path) -> String {
    States::read(path).expect_err("a refusal").to_string()
}

#[test]
fn truncated_problems_are_refused_and_damaged_ones_never_panic() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("whole.npz");
    states().write(&path).expect("written");
    let whole = fs::read(&path).expect("read");
    for length in (0..whole.len()).step_by(11) {
        fs::write(&path, &whole[..length]).expect("written");
        assert!(States::read(&path).is_err(), "{length} of {} bytes", whole.len());
    }
    let mut random = fastrand::Rng::with_seed(1);
    for _ in 0..300 {
        let mut bytes = whole.clone();
        for _ in 0..random.usize(1..5) {
            bytes[random.usize(..whole.len())] = random.u8(..);
        }
        fs::write(&path, bytes).expect("written");
        let _ = States::read(&path);
    }
}
