use bowknot::check::{Judge, PathOptions, StateOptions};
use bowknot::geometry::{Point, Vector};
use bowknot::io::{FrameStack, Import, read_mesh};
use bowknot::recording::States;
use bowknot::run::{ExportOptions, Outcome, Progress, Rate, RunOptions, export, run};
use bowknot::scene::Format;
use bowknot::simulator::SimulationError;
use bowknot::{Scene, Simulator, World};
use serde_json::Value;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A small sheet about to meet the ball, for a few frames.
fn falling(frames: usize, sets: &[&str]) -> Scene {
    let frames = format!("simulation.frames={frames}");
    let fall = ["body.0.velocity=[0, 0, -3]", "body.0.translate=[0.013, 0.007, 0.53]", &frames];
    Scene::builtin("drape", 0.2).and_then(|s| s.with_sets(&[&fall, sets].concat())).expect("a scene")
}

fn options(out: &Path) -> RunOptions {
    RunOptions { out: out.to_owned(), ..RunOptions::default() }
}

fn go(scene: &Scene, options: &RunOptions) -> Result<Outcome, SimulationError> {
    run(scene, options, &mut |_: &Progress<'_>| ControlFlow::Continue(()))
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn lines(folder: &Path) -> Vec<Value> {
    let text = fs::read_to_string(folder.join("stats.jsonl")).expect("statistics");
    text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().expect("an object").keys().map(String::as_str).collect()
}

#[test]
fn a_run_leaves_the_folder_that_other_tools_rely_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("deep/er/out");
    let scene = falling(6, &["output.checkpoint_every=4"]);
    let outcome = go(&scene, &RunOptions { check: true, ..options(&out) }).expect("a run");
    assert!(!outcome.interrupted && outcome.findings.is_empty());
    assert_eq!(
        names(&out),
        ["backends.json", "checkpoint", "frames", "scene.toml", "stats.jsonl", "summary.json"]
    );
    let frames: Vec<String> = (0..7).map(|frame| format!("{frame:06}.ply")).collect();
    assert_eq!(names(&out.join("frames")), frames);
    assert_eq!(names(&out.join("checkpoint")), ["lock", "previous.npz", "state.npz"]);

    let lines = lines(&out);
    assert_eq!(lines.len(), 6);
    let mut expected = vec![
        "step",
        "time",
        "newton_iterations",
        "cg_iterations",
        "two_way_steps",
        "searches",
        "pairs",
        "contact_rows",
        "edge_rows",
        "active_rows",
        "frozen_pairs",
        "remaining_r",
        "remaining_m",
        "stationarity_m",
        "converged",
        "min_gap_m",
        "max_stretch",
        "max_step_stretch",
        "max_speed",
        "energy",
        "momentum",
        "center_of_mass",
        "seconds",
        "cpu_seconds",
        "skipped",
        "slowest_body",
        "prescribed_lag_m",
        "pressing_contacts",
        "waiting",
        "injected_energy_j",
        "collision_energy_j",
        "friction_rows",
        "repulsion_springs",
        "inverted_tets",
        "interior_solves",
        "asleep_vertices",
        "residual_n",
        "residual_m",
        "solved",
        "tolerance_m",
    ];
    expected.sort_unstable();
    for (index, line) in lines.iter().enumerate() {
        let mut found = keys(line);
        found.sort_unstable();
        found.retain(|key| *key != "unsolved");
        assert_eq!(found, expected);
        assert_eq!(line.get("unsolved").is_some(), line["solved"] == false, "{line}");
        assert_eq!(line["step"], index as u64 + 1);
        let parts = line["seconds"].as_object().expect("seconds");
        let total = parts["total"].as_f64().expect("a number");
        let sum: f64 = parts.iter().filter(|p| p.0 != "total").filter_map(|p| p.1.as_f64()).sum();
        assert!((sum - total).abs() <= 1e-3 * total + 1e-6, "{sum} of {total}");
    }
    assert!(lines.iter().any(|line| line["pressing_contacts"].as_u64() > Some(0)));

    let summary: Value =
        serde_json::from_str(&fs::read_to_string(out.join("summary.json")).expect("summary")).expect("JSON");
    assert_eq!(summary["scene"], "drape");
    assert_eq!(summary["frames"], 6);
    assert_eq!(summary["intersections"], 0);
    assert_eq!(summary["backend"], "cpu");
    let vertices = outcome.summary.info.vertices;
    assert_eq!(summary["vertices"], vertices as u64);
    let steps: f64 = lines.iter().filter_map(|line| line["two_way_steps"].as_f64()).sum();
    assert!((summary["mean"]["two_way_steps"].as_f64().expect("a mean") - steps / 6.0).abs() < 1e-12);
    assert_eq!(
        fs::read_to_string(out.join("summary.json")).expect("summary"),
        serde_json::to_string_pretty(&outcome.summary).expect("JSON") + "\n"
    );

    // The frame's vertices: deformable, obstacle, then the corners of the ground's square.
    let frame = read_mesh(&out.join("frames/000006.ply"), &Import::default()).expect("a frame");
    let obstacle = frame.obstacle.expect("flags");
    assert_eq!(obstacle.iter().position(|o| *o), Some(vertices));
    let total = vertices + outcome.summary.info.obstacle_vertices;
    assert_eq!(frame.positions.len(), total + 4);
    assert!(frame.positions[total..].iter().all(|p| p.z == 0.0));
    assert_eq!(frame.body.expect("bodies")[total - 1..], [1, 2, 2, 2, 2]);
    let none: &[&str] = &[];
    assert_eq!(Scene::load(out.join("scene.toml"), none).expect("resolved").to_toml(), scene.to_toml());
}

#[test]
fn a_folder_with_a_run_is_refused_and_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    go(&falling(1, &[]), &options(folder.path())).expect("a run");
    let before = fs::read(folder.path().join("frames/000001.ply")).expect("a frame");
    let error = go(&falling(3, &[]), &options(folder.path())).expect_err("refused");
    assert!(error.to_string().contains("already holds a run: resume it"), "{error}");
    assert_eq!(fs::read(folder.path().join("frames/000001.ply")).expect("a frame"), before);
}

#[test]
fn a_resumed_run_is_the_run_that_was_never_stopped() {
    let folder = tempfile::tempdir().expect("a folder");
    let (whole, parts) = (folder.path().join("whole"), folder.path().join("parts"));
    let formats = "output.formats=[\"ply\", \"npz\", \"obj\", \"vtu\", \"pc2\", \"usd\"]";
    go(&falling(10, &[formats]), &options(&whole)).expect("a run");
    // Killed after time step 7, when the last checkpoint was that of 4, with half a line written.
    let scene = falling(10, &[formats, "output.checkpoint_every=4"]);
    let mut kept = Vec::new();
    run(&scene, &options(&parts), &mut |progress: &Progress<'_>| {
        if progress.step == 4 {
            return ControlFlow::Continue(());
        }
        if progress.step == 5 {
            kept = fs::read(parts.join("checkpoint/state.npz")).expect("a checkpoint");
        }
        if progress.step == 7 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })
    .expect("the first part");
    fs::write(parts.join("checkpoint/state.npz"), kept).expect("the earlier checkpoint");
    let mut text = fs::read_to_string(parts.join("stats.jsonl")).expect("statistics");
    text.push_str("{\"step\":8,\"ti");
    fs::write(parts.join("stats.jsonl"), text).expect("statistics");

    let outcome = go(&scene, &RunOptions { resume: true, ..options(&parts) }).expect("the rest");
    assert_eq!(outcome.summary.frames, 10);
    assert_eq!(names(&parts.join("frames")), names(&whole.join("frames")));
    for name in names(&whole.join("frames")) {
        let of = |folder: &Path| fs::read(folder.join("frames").join(&name)).expect("a frame");
        assert!(of(&whole) == of(&parts), "{name} differs");
    }
    assert_eq!(
        names(&parts.join("pc2")),
        ["ball.obj", "ball.pc2", "ground.obj", "ground.pc2", "sheet.obj", "sheet.pc2"]
    );
    for name in [
        "pc2/sheet.pc2",
        "pc2/sheet.obj",
        "pc2/ball.pc2",
        "pc2/ground.pc2",
        "frames.pvd",
        "frames.npz",
        "scene.usda",
    ] {
        let of = |folder: &Path| fs::read(folder.join(name)).expect("a file of all frames");
        assert!(of(&whole) == of(&parts), "{name} differs");
    }
    let stack = |folder: &Path| FrameStack::read(&folder.join("frames.npz")).expect("a stack");
    assert_eq!(stack(&whole).len(), 11);
    assert_eq!(stack(&whole), stack(&parts));
    let strip = |mut line: Value| {
        let fields = line.as_object_mut().expect("an object");
        // Times, and the effort of searches: a resumed run begins with an empty list of candidate pairs.
        for effort in ["seconds", "cpu_seconds", "pairs", "searches", "skipped"] {
            fields.remove(effort);
        }
        line
    };
    let stripped = |folder: &Path| lines(folder).into_iter().map(strip).collect::<Vec<_>>();
    assert_eq!(stripped(&whole), stripped(&parts));
}

#[test]
fn runs_keep_velocities_and_contact_forces() {
    let folder = tempfile::tempdir().expect("a folder");
    let [whole, parts, plain, there] =
        ["whole", "parts", "plain", "there"].map(|name| folder.path().join(name));
    let formats = "output.formats=[\"ply\", \"vtu\", \"npz\", \"usd\", \"gltf\"]";
    let on = ["output.velocities=true", "output.contact_forces=true", "output.checkpoint_every=2", formats];
    go(&falling(9, &on), &options(&whole)).expect("a run");
    run(&falling(9, &on), &options(&parts), &mut |progress: &Progress<'_>| match progress.step {
        5 => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    })
    .expect("the first part");
    // As if it had been killed later.
    fs::copy(whole.join("fields/velocities.f64"), parts.join("fields/velocities.f64")).expect("a file");
    go(&falling(9, &on), &RunOptions { resume: true, ..options(&parts) }).expect("the rest");
    let exported = ExportOptions {
        formats: vec![Format::Vtu, Format::Npz, Format::Usd, Format::Gltf],
        out: there.clone(),
        ..ExportOptions::default()
    };
    export(&whole, &exported, &mut |_, _| {}).expect("exported");
    let fields = ["fields/velocities.f64", "fields/contact_forces.f64"];
    let of = |folder: &Path, name: &str| fs::read(folder.join(name)).expect("a file");
    for name in ["frames/000009.vtu", "frames.npz", "scene.usda", "scene.glb"].iter().chain(&fields) {
        assert!(of(&whole, name) == of(&parts, name), "{name} differs after a resumption");
    }
    for name in ["frames.npz", "scene.glb"] {
        assert!(of(&whole, name) == of(&there, name), "{name} differs after an export");
    }
    // Exports have triangles for the square of the ground, but the same vectors at the end of the file.
    let tail = |folder: &Path| {
        of(folder, "frames/000009.vtu").split_off(of(folder, "frames/000009.vtu").len() - 1000)
    };
    assert!(tail(&whole) == tail(&there), "the forces differ");
    let text = fs::read_to_string(there.join("scene.usda")).expect("a stage");
    assert!(
        text.contains("vector3f[] velocities.timeSamples")
            && text.contains("primvars:contactForce.timeSamples")
    );
    assert_eq!(names(&there), ["frames", "frames.npz", "frames.pvd", "scene.glb", "scene.usda"]);

    // They are those of the simulator; the corners of the ground have none.
    let mut simulator = Simulator::new(&falling(9, &[])).expect("a simulator");
    (0..9).for_each(|_| drop(simulator.step().expect("a step")));
    let count = simulator.world().collision_vertices();
    let expected = [simulator.velocities()[..count].to_vec(), simulator.contact_forces()];
    assert!(expected[1].iter().any(|force| force.z > 0.0), "the sheet lies on the ball");
    for (name, expected) in fields.iter().zip(&expected) {
        let bytes = of(&whole, name);
        let frame = 24 * (count + 4);
        assert_eq!(bytes.len(), 10 * frame);
        let numbers = bytes[9 * frame..].as_chunks::<8>().0.iter().map(|&b| f64::from_le_bytes(b));
        let expected: Vec<f64> = expected.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
        assert_eq!(numbers.collect::<Vec<_>>(), [expected, vec![0.0; 12]].concat(), "{name}");
    }
    // What acts on the vertices of a body adds up to what acts on the body.
    for name in ["sheet", "ball"] {
        let world = simulator.world();
        let vertices = world.bodies[world.index_of(name).expect("a body")].vertices.clone();
        let sum: Vector = expected[1][vertices.start as usize..vertices.end as usize].iter().sum();
        let wrench = simulator.contact_wrench(name, &Point::origin()).expect("a body");
        assert!((sum - wrench.force).norm() < 1e-9 * (1.0 + sum.norm()), "{name}: {sum} {}", wrench.force);
    }

    // Nothing is kept of what nobody asks for, and a run cannot begin with it in its middle.
    go(&falling(2, &[]), &options(&plain)).expect("a run");
    assert!(!plain.join("fields").exists());
    let error = go(&falling(4, &on), &RunOptions { resume: true, ..options(&plain) }).expect_err("too late");
    assert!(error.to_string().contains("it has 0 frames, 3 are needed"), "{error}");
}

#[test]
fn a_run_is_lengthened_but_not_changed_by_resuming() {
    let folder = tempfile::tempdir().expect("a folder");
    go(&falling(2, &[]), &options(folder.path())).expect("a run");
    let resume = RunOptions { resume: true, ..options(folder.path()) };
    let error = go(&falling(4, &["body.0.material=silk"]), &resume).expect_err("another scene");
    assert!(error.to_string().contains("its scene differs in body[0].material."), "{error}");
    let outcome = go(&falling(4, &[]), &resume).expect("longer");
    assert_eq!(outcome.summary.frames, 4);
    assert_eq!(lines(folder.path()).len(), 4);
    let empty = folder.path().join("empty");
    let error = go(&falling(4, &[]), &RunOptions { resume: true, ..options(&empty) }).expect_err("no run");
    assert!(error.to_string().contains("it holds no run"), "{error}");
}

#[test]
fn only_the_archive_can_be_resumed_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let sets = ["output.formats=[\"npz\"]", "output.checkpoint_every=2"];
    let scene = falling(5, &sets);
    let stop = AtomicBool::new(false);
    run(&scene, &options(folder.path()), &mut |progress: &Progress<'_>| {
        stop.store(progress.step == 3, Ordering::Relaxed);
        if progress.step == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })
    .expect("the first part");
    go(&scene, &RunOptions { resume: true, ..options(folder.path()) }).expect("the rest");
    assert_eq!(FrameStack::read(&folder.path().join("frames.npz")).expect("a stack").len(), 6);
    assert!(names(&folder.path().join("frames")).is_empty());
}

#[test]
fn traces_and_records_hold_the_collision_problems() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = falling(5, &["output.trace=true", "output.record=true"]);
    go(&scene, &options(folder.path())).expect("a run");
    let lines = lines(folder.path());
    let traces = names(&folder.path().join("trace"));
    let steps: u64 = lines.iter().filter_map(|line| line["two_way_steps"].as_u64()).sum();
    let problems: u64 = lines.iter().filter_map(|line| line["newton_iterations"].as_u64()).sum();
    assert_eq!(traces.len() as u64, steps + problems);
    assert_eq!(traces[0], "000001_00_00000.ply");

    // Consecutive states are joined by straight paths without intersections.
    let read = |name: &String| {
        read_mesh(&folder.path().join("trace").join(name), &Import::default()).expect("a state").positions
    };
    let world = World::new(&scene).expect("a world");
    let judge = Judge::from_model(&world.collision);
    let vertices = world.positions.len();
    for pair in traces.windows(2) {
        let [a, b] = [read(&pair[0]), read(&pair[1])];
        let path = judge.check_path(&a[..vertices], &b[..vertices], &PathOptions::default()).expect("judged");
        assert!(path.is_clear(), "{pair:?}");
        let options = StateOptions { distance: false, ..StateOptions::default() };
        assert!(judge.check_state(&b[..vertices], &options).expect("judged").is_clear());
    }

    let records = names(&folder.path().join("states"));
    let of_step = |line: &Value| {
        let (step, iterations) = (line["step"].as_u64(), line["newton_iterations"].as_u64());
        let name = move |k| format!("{:06}_{k:02}.npz", step.expect("a number"));
        (0..iterations.expect("a number")).map(name).collect::<Vec<_>>()
    };
    let expected: Vec<String> = lines.iter().flat_map(of_step).collect();
    assert_eq!(records, expected);
    let problem = States::read(&folder.path().join("states/000003_00.npz")).expect("a problem");
    assert_eq!(problem.x, read(&"000003_00_00000.ply".to_owned())[..vertices]);
    assert_eq!((problem.y.len(), problem.masses.len(), problem.fixed.len()), (vertices, vertices, vertices));
    assert_eq!(problem.half_spaces.len(), 1);
    assert_eq!(problem.time_step, Some(0.01));
    assert_eq!(problem.rest, world.positions);
}

#[test]
fn an_unwritable_folder_is_an_error() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    fs::write(&file, "x").expect("a file");
    let error = go(&falling(1, &[]), &options(&file.join("out"))).expect_err("not a folder");
    assert!(error.to_string().starts_with("cannot create "), "{error}");
}

#[test]
fn a_failing_write_leaves_the_frames_so_far_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let error = run(&falling(6, &[]), &options(&out), &mut |progress: &Progress<'_>| {
        if progress.step == 3 {
            // Stands in the way of frame 4, as a full disk would.
            fs::create_dir(out.join("frames/000004.ply")).expect("a folder");
        }
        ControlFlow::Continue(())
    })
    .expect_err("frame 4 cannot be written");
    assert!(matches!(error, SimulationError::Io(_)), "{error}");
    assert_eq!(
        names(&out.join("frames")),
        ["000000.ply", "000001.ply", "000002.ply", "000003.ply", "000004.ply"]
    );
    for frame in 0..4 {
        read_mesh(&out.join(format!("frames/{frame:06}.ply")), &Import::default()).expect("a whole frame");
    }
    assert_eq!(lines(&out).len(), 3);
}

#[test]
fn an_interrupt_stops_within_a_step_and_the_run_can_go_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let flag = Arc::new(AtomicBool::new(false));
    let scene = falling(4, &[]);
    let interruptible = RunOptions { interrupt: Some(Arc::clone(&flag)), ..options(folder.path()) };
    let outcome = run(&scene, &interruptible, &mut |progress: &Progress<'_>| {
        // The loop asks again only within the next time step.
        flag.store(progress.step == 2, Ordering::Relaxed);
        ControlFlow::Continue(())
    })
    .expect("a run");
    assert!(outcome.interrupted);
    assert_eq!(outcome.summary.frames, 2);
    assert_eq!(names(&folder.path().join("frames")).len(), 3);
    let resumed = go(&scene, &RunOptions { resume: true, ..options(folder.path()) }).expect("the rest");
    assert!(!resumed.interrupted);
    assert_eq!(names(&folder.path().join("frames")).len(), 5);
}

/// Point caches end at the last frame also where a longer run had written more, and are filled up where it
/// had none.
#[test]
fn formats_may_change_when_a_run_is_resumed() {
    let folder = tempfile::tempdir().expect("a folder");
    let (whole, parts) = (folder.path().join("whole"), folder.path().join("parts"));
    let formats = |list: &str| format!("output.formats={list}");
    go(&falling(6, &[&formats("[\"pc2\", \"usd\"]")]), &options(&whole)).expect("a run");
    go(&falling(4, &[&formats("[\"ply\"]")]), &options(&parts)).expect("the first part");
    let resume = RunOptions { resume: true, ..options(&parts) };
    go(&falling(6, &[&formats("[\"pc2\", \"usd\", \"vtu\"]")]), &resume).expect("the rest");
    for name in ["pc2/sheet.pc2", "scene.usda"] {
        let of = |folder: &Path| fs::read(folder.join(name)).expect("a file of all frames");
        assert!(of(&whole) == of(&parts), "{name} differs");
    }
    let grids = fs::read_to_string(parts.join("frames.pvd")).expect("a collection");
    assert_eq!(grids.matches("<DataSet").count(), 2, "only frames 5 and 6 are there as VTU: {grids}");
}

#[test]
fn exports_take_every_so_many_frames_or_so_many_per_second() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("run");
    let text =
        format!("simulation = {{ dt = {}, frames = 10 }}\nbody = [{{ shape = \"sheet\" }}]\n", 1.0 / 96.0);
    go(&Scene::from_toml(&text, "").expect("a scene"), &options(&out)).expect("a run");
    let exported = |rate: Rate, name: &str| {
        let options = ExportOptions {
            formats: vec![Format::Ply, Format::Vtu],
            out: folder.path().join(name),
            time_step: None,
            rate,
        };
        export(&out, &options, &mut |_, _| {}).map(|exported| exported.frames).map_err(|e| e.to_string())
    };
    for (rate, name) in [(Rate::Every(4), "every"), (Rate::PerSecond(24.0), "rate")] {
        assert_eq!(exported(rate, name), Ok(3));
        let frames = folder.path().join(name).join("frames");
        assert_eq!(names(&frames).len(), 6);
        for (place, frame) in [(0, 0), (1, 4), (2, 8)] {
            let [taken, given] =
                [frames.join(format!("{place:06}.ply")), out.join(format!("frames/{frame:06}.ply"))]
                    .map(|path| fs::read(path).expect("a frame"));
            assert_eq!(taken, given, "frame {place}");
        }
        let times = fs::read_to_string(folder.path().join(name).join("frames.pvd")).expect("times");
        assert!(times.contains(&format!("timestep=\"{}\"", 2.0 * (4.0 / 96.0))), "{times}");
    }
    let message = exported(Rate::PerSecond(25.0), "no").expect_err("none of its time steps");
    assert!(message.contains("32.000000 in every 3 and 24.000000 in every 4"), "{message}");
    let message = exported(Rate::Every(2), "run").expect_err("among its own frames");
    assert!(message.contains("name another output folder"), "{message}");
    assert!(exported(Rate::Every(0), "no").is_err() && !folder.path().join("no").exists());
}

#[test]
fn frames_picked_by_hand_keep_the_names_of_their_bodies() {
    let folder = tempfile::tempdir().expect("a folder");
    let (out, picked) = (folder.path().join("run"), folder.path().join("picked"));
    let text = "simulation = { frames = 3 }\n\
                body = [{ name = \"left sleeve\", shape = \"sheet\" }, \
                { name = \"cap\", shape = \"sheet\", translate = [0, 0, 1] }]\n";
    go(&Scene::from_toml(text, "").expect("a scene"), &options(&out)).expect("a run");
    fs::create_dir(&picked).expect("a folder");
    for frame in ["000001.ply", "000003.ply"] {
        fs::copy(out.join("frames").join(frame), picked.join(frame)).expect("a frame");
    }
    let options = ExportOptions {
        formats: vec![Format::Pc2],
        out: folder.path().join("there"),
        time_step: Some(0.02),
        ..ExportOptions::default()
    };
    export(&picked, &options, &mut |_, _| {}).expect("exported");
    assert_eq!(
        names(&folder.path().join("there/pc2")),
        ["cap.obj", "cap.pc2", "left_sleeve.obj", "left_sleeve.pc2"]
    );
}
