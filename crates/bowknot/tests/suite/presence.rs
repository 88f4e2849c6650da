use super::scene;
use bowknot::check::StateOptions;
use bowknot::geometry::Point;
use bowknot::io::{FrameStack, MeshView, write_obj, write_ply};
use bowknot::run::{Progress, RunOptions, run};
use bowknot::simulator::Checkpoint;
use bowknot::{Scene, Simulator, StepStatistics, World};
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

const DT: f64 = 0.01;

/// A small cloth, level, at a height.
fn cloth(z: f64) -> String {
    format!(
        "[[body]]\nname = \"cloth\"\nshape = {{ type = \"sheet\", size = [0.2, 0.2], edge = 0.04 }}\n\
         translate = [0, 0, {z}]\n"
    )
}

/// A cube of jelly that stands at a place.
fn cube(name: &str, x: f64, z: f64) -> String {
    format!(
        "[[body]]\nname = \"{name}\"\nkind = \"solid\"\nmaterial = \"jelly\"\n\
         shape = {{ type = \"block\", size = [0.1, 0.1, 0.1], edge = 0.05 }}\ntranslate = [{x}, 0, {z}]\n"
    )
}

/// A board 2 cm thick whose top is at a height.
fn board(name: &str, top: f64, rest: &str) -> String {
    let z = top - 0.01;
    format!(
        "[[obstacle]]\nname = \"{name}\"\nshape = {{ type = \"box\", size = [0.5, 0.5, 0.02] }}\n\
         translate = [0, 0, {z}]\n{rest}\n"
    )
}

fn simulator(text: &str) -> Simulator {
    Simulator::new(&scene(text)).unwrap_or_else(|error| panic!("{error}"))
}

/// A time step, whose end is judged with the obstacles that were there in it and with those that are there
/// after it.
fn step(simulator: &mut Simulator) -> StepStatistics {
    let before = simulator.judge();
    let statistics = simulator.step().unwrap_or_else(|error| panic!("{error}"));
    let positions = &simulator.positions()[..simulator.world().collision_vertices()];
    for judge in [before, simulator.judge()] {
        let report = judge
            .check_state(positions, &StateOptions { limit: 3, distance: false })
            .expect("finite positions");
        assert!(report.is_clear(), "time step {}: {:?}", statistics.step, report.intersections);
    }
    statistics
}

fn steps(simulator: &mut Simulator, count: usize) -> Vec<StepStatistics> {
    (0..count).map(|_| step(simulator)).collect()
}

/// Mean height of a body's vertices [m].
fn height(simulator: &Simulator, body: usize) -> f64 {
    let vertices = &simulator.world().bodies[body].vertices;
    let own = &simulator.positions()[vertices.start as usize..vertices.end as usize];
    own.iter().map(|p| p.z).sum::<f64>() / own.len() as f64
}

/// Way of a free fall from rest in so many time steps of implicit Euler [m].
fn fall(steps: usize) -> f64 {
    9.81 * DT * DT * (steps * (steps + 1)) as f64 / 2.0
}

fn bits(points: &[Point]) -> Vec<[u64; 3]> {
    points.iter().map(|p| [p.x, p.y, p.z].map(f64::to_bits)).collect()
}

#[test]
fn what_lay_on_a_board_that_vanishes_falls_freely() {
    for (body, start, top) in [(cloth(0.504), 0.504, 0.5), (cube("cube", 0.0, 0.56), 0.56, 0.5)] {
        let mut simulator = simulator(&format!("{body}{}", board("board", top, "vanishes = 0.5")));
        let on_board = steps(&mut simulator, 49);
        assert!(on_board.iter().all(|statistics| statistics.absent.is_empty()));
        assert!(on_board.iter().any(|statistics| statistics.pressing_contacts > 0), "it lay on the board");
        let vanished = step(&mut simulator);
        let rests_at = vanished.center_of_mass[2];
        assert_eq!(vanished.absent.into_iter().collect::<Vec<_>>(), [("board".to_owned(), None)]);
        assert!((rests_at - start).abs() < 0.01, "{rests_at}");
        for count in 1..=20 {
            let statistics = step(&mut simulator);
            assert_eq!((statistics.pressing_contacts, statistics.repulsion_springs), (0, 0));
            let fallen = rests_at - statistics.center_of_mass[2];
            // It may still have sunk or swung by a few mm/s.
            let slack = 5e-3 * DT * count as f64;
            assert!((fallen - fall(count)).abs() < slack, "step {count}: {fallen} m");
        }
    }
}

#[test]
fn bodies_asleep_wake_where_what_they_lie_on_vanishes() {
    let sleep = "[solver.sleep]\nenabled = true\ntime = 0.1\n";
    let ground = "[[obstacle]]\nname = \"ground\"\nshape = \"half-space\"\nvanishes = 2\n";
    let mut simulator = simulator(&format!(
        "{sleep}{}{}{}{ground}",
        cube("on board", 0.0, 0.56),
        cube("on ground", 1.0, 0.06),
        board("board", 0.5, "vanishes = 1.5")
    ));
    steps(&mut simulator, 149);
    assert_eq!(simulator.asleep()[..2], [true; 2]);
    let before = [0, 1].map(|body| height(&simulator, body));
    step(&mut simulator);
    assert_eq!(simulator.asleep()[..2], [false, true]);
    steps(&mut simulator, 10);
    // It expands as it falls.
    assert!((before[0] - height(&simulator, 0) - fall(10)).abs() < 2e-3);
    assert_eq!(height(&simulator, 1).to_bits(), before[1].to_bits());
    // The first lands. When the ground vanishes under both, nothing holds them.
    steps(&mut simulator, 40);
    assert_eq!(simulator.asleep()[..2], [false; 2]);
    let before = height(&simulator, 1);
    steps(&mut simulator, 10);
    assert!((before - height(&simulator, 1) - fall(10)).abs() < 2e-3);
}

#[test]
fn an_obstacle_that_appears_catches_what_falls_and_lets_through_before() {
    // The first board vanishes as the cloth comes, the second appears below it.
    let mut simulator = simulator(&format!(
        "{}{}{}",
        cloth(0.5),
        board("upper", 0.4, "vanishes = 0.01"),
        board("lower", 0.2, "appears = 0.195")
    ));
    let all = steps(&mut simulator, 80);
    let names = |step: usize| all[step - 1].absent.keys().cloned().collect::<Vec<_>>();
    assert_eq!(
        (names(1), names(19), names(20)),
        (
            vec!["lower".to_owned(), "upper".to_owned()],
            vec!["lower".to_owned(), "upper".to_owned()],
            vec!["upper".to_owned()]
        )
    );
    let z = height(&simulator, 0);
    assert!((0.2..0.206).contains(&z), "{z}");
}

#[test]
fn an_obstacle_waits_while_its_place_is_not_clear() {
    let mut simulator = simulator(&format!(
        "{}{}",
        cloth(0.5),
        board("lid", 0.505, "appears = 0.02\nmotion = { spin = 30 }")
    ));
    let all = steps(&mut simulator, 40);
    let waited: Vec<(usize, String)> =
        all.iter().filter_map(|s| Some((s.step, s.absent.get("lid")?.clone()?))).collect();
    let (first, words) = &waited[0];
    assert_eq!(*first, 2);
    assert!(words.starts_with("cloth would be inside of it"), "{words}");
    // At 0.495 - 0.01 m the lid ends, and the cloth falls on.
    assert!(waited.iter().any(|(_, words)| words.starts_with("it would ")), "{waited:?}");
    let last = waited.last().expect("waits").0;
    let appeared = all.iter().find(|s| s.step > 2 && s.absent.is_empty()).expect("it appears").step;
    assert_eq!(appeared, last + 1);
    assert!(fall(appeared) > 0.015 && fall(last) < 0.0165, "it appears as soon as it can, after {appeared}");
    assert!(simulator.present().iter().all(|present| *present));
    // Nothing holds the cloth.
    assert!((0.5 - height(&simulator, 0) - fall(40)).abs() < 2e-3);
}

/// A gap below the minimum separation, and cuts of surfaces that enclose nothing.
#[test]
fn what_is_cut_or_too_near_is_named() {
    let wait = |top: f64, rest: &str| {
        let text = format!(
            "[simulation]\ngravity = [0, 0, 0]\n{}{rest}appears = 0.01\ntranslate = [0, 0, {top}]\n",
            cloth(0.5)
        );
        let mut simulator = simulator(&text);
        step(&mut simulator).absent.remove("x").flatten().unwrap_or_default()
    };
    let sheet = "[[obstacle]]\nname = \"x\"\nrotate = [90, 0, 0]\nshape = \
                 { type = \"sheet\", size = [0.3, 0.3], edge = 0.1 }\n";
    let cut = wait(0.5, sheet);
    assert!(cut.starts_with("it would cut cloth at (") && cut.contains(", 0.000000, 0.500000) m"), "{cut}");
    let plane = "[[obstacle]]\nname = \"x\"\nshape = \"half-space\"\n";
    let cut = wait(0.5001, plane);
    assert!(cut.starts_with("it would cut cloth at ("), "{cut}");
    // The minimum separation is 0.01 of an edge.
    let near = wait(0.49975, plane);
    assert!(near.starts_with("it would be 2.500e-4 m from cloth at ("), "{near}");
    let thick = wait(0.49, &format!("{plane}thickness = 0.03\n"));
    assert!(thick.starts_with("it would be 1.000e-2 m from cloth at ("), "{thick}");
    assert_eq!(wait(0.4995, plane), "");
    // Who does not meet it is not in its way.
    assert_eq!(wait(0.5, &format!("{sheet}groups = [1]\ncollides_with = [1]\n")), "");
}

#[test]
fn an_obstacle_does_not_appear_inside_of_a_solid() {
    let inner = "[[obstacle]]\nname = \"seed\"\nshape = \
                 { type = \"ball\", radius = 0.02, edge = 0.02 }\nappears = 0.01\n";
    let mut simulator =
        simulator(&format!("[simulation]\ngravity = [0, 0, 0]\n{}{inner}", cube("cube", 0.0, 0.0)));
    let words = step(&mut simulator).absent.remove("seed").flatten();
    assert_eq!(words.as_deref(), Some("it would be inside of cube"));
}

#[test]
fn a_moving_obstacle_appears_where_its_motion_has_led_it() {
    let motion =
        "motion = { keyframes = [{ time = 0, translate = [0, 0, 0] }, { time = 1, translate = [2, 0, 0] }] }";
    let mut simulator =
        simulator(&format!("{}{}", cloth(3.0), board("sled", 0.0, &format!("{motion}\nappears = 0.305"))));
    let corner =
        |simulator: &Simulator| simulator.positions()[simulator.world().bodies[1].vertices.start as usize].x;
    let start = corner(&simulator);
    for count in 1..=60 {
        let statistics = step(&mut simulator);
        assert!((corner(&simulator) - start - 2.0 * DT * f64::from(count)).abs() < 1e-9);
        assert_eq!(statistics.absent.is_empty(), count >= 31);
        assert!(statistics.waiting.is_empty(), "{:?}", statistics.waiting);
    }
}

/// Obstacles that are not there at the start may be anywhere.
#[test]
fn the_start_is_judged_with_what_is_there() {
    let inside = |rest: &str| Simulator::new(&scene(&format!("{}{}", cloth(0.49), board("lid", 0.49, rest))));
    let error = inside("").expect_err("it intersects").to_string();
    assert!(error.contains("already intersects"), "{error}");
    inside("appears = 1.0").expect("not there yet");
}

#[test]
fn a_checkpoint_tells_what_is_there_to_the_same_bits() {
    let text = format!(
        "[solver.sleep]\nenabled = true\ntime = 0.1\n{}{}{}",
        cloth(0.504),
        board("board", 0.5, "vanishes = 0.4"),
        board("lid", 0.47, "appears = 0.48\nmotion = { spin = 30 }")
    );
    let mut straight = simulator(&text);
    let mut checkpoints = Vec::new();
    for _ in 0..70 {
        step(&mut straight);
        checkpoints.push(straight.checkpoint());
    }
    assert!(checkpoints[48].present != checkpoints[69].present, "the lid waits for the cloth to pass");
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("state.npz");
    for after in [38, 39, 46, 47, 49, 50, 65] {
        checkpoints[after].write(&file).expect("written");
        let mut resumed = simulator(&text);
        resumed.restore(&Checkpoint::read(&file).expect("read")).expect("a state of the scene");
        steps(&mut resumed, 69 - after);
        assert_eq!(bits(resumed.positions()), bits(straight.positions()), "from {after}");
        assert_eq!(resumed.checkpoint(), checkpoints[69], "from {after}");
    }
    let mut other = checkpoints[0].clone();
    other.present.pop();
    assert_eq!(
        straight.restore(&other).expect_err("too few").to_string(),
        "its obstacles are not those of the scene"
    );
}

/// Vertices of a plate of 40 cm, and its triangles.
fn plate(z: f64) -> (Vec<Point>, [[u32; 3]; 2]) {
    let corners = [[-0.2, -0.2], [0.2, -0.2], [0.2, 0.2], [-0.2, 0.2]];
    (corners.map(|[x, y]| Point::new(x, y, z)).to_vec(), [[0, 1, 2], [0, 2, 3]])
}

fn with_sequence(folder: &Path, sequence: &str) -> Scene {
    let text = format!(
        "simulation.frames = 60\n{}[[obstacle]]\nname = \"plate\"\nsequence = \"{sequence}\"\nsequence_rate \
         = 20\nsequence_start = 0.02\n",
        cloth(0.5)
    );
    Scene::from_toml(&text, folder).expect("a scene")
}

#[test]
fn an_obstacle_is_not_there_during_empty_frames() {
    let folder = tempfile::tempdir().expect("a folder");
    let (frames, archive) = (folder.path().join("frames"), folder.path().join("frames.npz"));
    fs::create_dir(&frames).expect("a folder");
    let (_, triangles) = plate(0.0);
    let view = MeshView { triangles: &triangles, ..MeshView::default() };
    let mut stack = FrameStack::new(&view, &[]);
    for frame in 0..10 {
        let lower = if frame < 6 { 0.0 } else { 0.1 };
        let (positions, _) = plate(0.4 - 0.02 * f64::from(frame) - lower);
        // Without vertices, or scaled to nothing, as exports have it.
        let nothing = vec![Point::new(1.0, 2.0, 3.0); 4];
        let is_empty = matches!(frame, 0 | 1 | 5 | 8 | 9);
        assert!(stack.push(if is_empty { &nothing } else { &positions }));
        let path = |ending: &str| frames.join(format!("{frame}.{ending}"));
        let header = "ply\nformat ascii 1.0\nelement vertex 0\nproperty double x\nproperty double y\n\
                      property double z\nelement face 0\nproperty list uchar int \
                      vertex_indices\nend_header\n";
        match frame {
            0 | 5 => fs::write(path("obj"), "# exported\no Plate\n").expect("a frame"),
            1 => fs::write(path("ply"), header).expect("a frame"),
            8 | 9 => write_obj(&path("obj"), &MeshView { positions: &nothing, ..view }).expect("a frame"),
            3 => write_ply(&path("ply"), &MeshView { positions: &positions, ..view }).expect("a frame"),
            _ => write_obj(&path("obj"), &MeshView { positions: &positions, ..view }).expect("a frame"),
        }
    }
    stack.write(&archive).expect("an archive");

    let mut heights = Vec::new();
    for sequence in ["frames", "frames.npz"] {
        let scene = with_sequence(folder.path(), sequence);
        let mut simulator = Simulator::new(&scene).expect("a simulator");
        assert!(!simulator.present()[1], "empty frames come first");
        let there: Vec<usize> =
            steps(&mut simulator, 60).iter().filter(|s| s.absent.is_empty()).map(|s| s.step).collect();
        // Frames 2 to 4 and 6 to 7 begin 0.02 s + 0.05 s times their number after the start.
        assert_eq!(there, (12..27).chain(32..42).collect::<Vec<_>>());
        heights.push(height(&simulator, 0));
    }
    assert_eq!(heights[0].to_bits(), heights[1].to_bits());
    // It lay on the plate meanwhile.
    assert!(heights[0] > 0.5 - fall(60) + 0.1, "{}", heights[0]);

    for entry in fs::read_dir(&frames).expect("a folder") {
        fs::remove_file(entry.expect("a file").path()).expect("removed");
    }
    let refusal = |name: &str, content: &str| {
        fs::write(frames.join(name), content).expect("a frame");
        World::new(&with_sequence(folder.path(), "frames")).expect_err("no frame to show").to_string()
    };
    assert!(refusal("0.obj", "# exported\n").contains("frames: all of its frames are empty"));
    // A file of nothing at all is none of an export.
    assert!(refusal("1.obj", "").contains("1.obj: no vertices"));
}

#[test]
fn runs_are_checked_with_what_is_there_and_frames_show_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("run");
    let scene = scene(&format!(
        "simulation.frames = 40\noutput.formats = [\"ply\", \"npz\"]\n{}{}{}",
        cloth(0.5),
        board("lid", 0.505, "appears = 0.02"),
        "[[obstacle]]\nname = \"ground\"\nshape = \"half-space\"\ntranslate = [0, 0, 0.42]\nvanishes = 0.1\n"
    ));
    let options = RunOptions { out: out.clone(), check: true, ..RunOptions::default() };
    let outcome = run(&scene, &options, &mut |_: &Progress<'_>| ControlFlow::Continue(())).expect("a run");
    assert_eq!((outcome.summary.intersections, outcome.findings.len()), (Some(0), 0));
    let wait = &outcome.summary.waits_to_appear["lid"];
    assert!(wait.steps > 3 && wait.in_the_way == "cloth would be inside of it", "{wait:?}");

    let world = World::new(&scene).expect("a world");
    let (lid, first_corner) = (world.bodies[1].vertices.clone(), world.collision_vertices());
    let lines = fs::read_to_string(out.join("stats.jsonl")).expect("statistics");
    let absent: Vec<Vec<String>> = lines
        .lines()
        .map(|line| serde_json::from_str::<StepStatistics>(line).expect("statistics"))
        .map(|statistics| statistics.absent.into_keys().collect())
        .collect();
    let stack = FrameStack::read(&out.join("frames.npz")).expect("an archive");
    for frame in 0..=40 {
        let path = out.join(format!("frames/{frame:06}.ply"));
        let mesh = bowknot::io::read_mesh(&path, &bowknot::io::Import::default()).expect("a frame");
        assert_eq!(stack.frame(frame), Some(mesh.positions.clone()));
        let is_point = |mut vertices: std::ops::Range<usize>| {
            let first = mesh.positions[vertices.start];
            vertices.all(|v| mesh.positions[v] == first)
        };
        let names = if frame == 0 { vec!["lid".to_owned()] } else { absent[frame - 1].clone() };
        let told = |name: &str| names.iter().any(|other| other == name);
        assert_eq!(is_point(lid.start as usize..lid.end as usize), told("lid"), "frame {frame}");
        assert_eq!(is_point(first_corner..first_corner + 4), told("ground"), "frame {frame}");
        let marked = mesh.absent(&mesh.positions);
        assert_eq!(marked.get(lid.start as usize) == Some(&true), told("lid"));
        assert_eq!(marked.get(first_corner) == Some(&true), told("ground"));
        assert!(marked.iter().take(lid.start as usize).all(|absent| !absent), "cloth is always there");
    }
    assert!(
        absent.iter().any(Vec::is_empty) || absent.iter().any(|names| !names.contains(&"lid".to_owned()))
    );
}

#[test]
fn times_are_validated() {
    for (rest, expected) in [
        ("appears = -1", "obstacle[0].appears: -1 must be finite and at least 0"),
        ("appears = inf", "obstacle[0].appears: inf must be finite and at least 0"),
        ("appears = 0.5\nvanishes = 0.5", "obstacle[0].vanishes: 0.5 must be later than appears, 0.5"),
        ("vanishes = nan", "obstacle[0].vanishes: NaN must be later than appears, 0"),
    ] {
        let text = format!("{}{}", cloth(1.0), board("x", 0.0, rest));
        let error = Scene::from_toml(&text, "").expect_err("refused");
        assert!(error.to_string().contains(expected), "{error}");
    }
    let world = |rest: &str| {
        World::new(&scene(&format!("{}{}", cloth(1.0), board("x", 0.0, rest)))).expect("a world")
    };
    let told = world("appears = 0.101\nvanishes = 0.109").warnings;
    assert!(
        told.len() == 1 && told[0].starts_with("obstacle x is never there: none of the 100 time steps"),
        "{told:?}"
    );
    assert!(world("appears = 0.1").warnings.is_empty());
    // A jump is none while it is not there.
    let jumps =
        "motion = { keyframes = [{ time = 0 }, { time = 0.5 }, { time = 0.501, translate = [9, 0, 0] }] }";
    assert_eq!(world(jumps).warnings.len(), 1);
    assert!(world(&format!("{jumps}\nappears = 0.52")).warnings.is_empty());
}
