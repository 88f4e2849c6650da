use crate::{Ended, Place, SMALL, tetrahedron};

#[test]
fn a_run_writes_its_folder() {
    let place = Place::new();
    let ended = place.run(&format!("{SMALL} --check")).ok();
    assert!(ended.stdout.contains("drape: done after 3 of 3 frames"), "{ended:#?}");
    assert!(ended.stdout.contains("checked every accepted state and path: no intersection"), "{ended:#?}");
    assert!(ended.stdout.contains("wrote out/drape"), "{ended:#?}");
    assert_eq!(place.files("out/drape/frames"), ["000000.ply", "000001.ply", "000002.ply", "000003.ply"]);
    for name in ["scene.toml", "summary.json", "checkpoint/state.npz"] {
        assert!(place.path(&format!("out/drape/{name}")).exists(), "{name}");
    }
    for line in place.read("out/drape/stats.jsonl").lines() {
        let step: serde_json::Value = serde_json::from_str(line).unwrap();
        for key in "step time newton_iterations cg_iterations two_way_steps searches pairs contact_rows \
                    edge_rows active_rows frozen_pairs remaining_r remaining_m stationarity_m converged \
                    min_gap_m max_stretch max_step_stretch max_speed energy momentum center_of_mass seconds \
                    cpu_seconds skipped residual_n residual_m tolerance_m solved"
            .split_whitespace()
        {
            assert!(step.get(key).is_some(), "{key} is missing: {line}");
        }
    }
    // The scene file of the run makes the same frames.
    place.run("run out/drape/scene.toml --out again").ok();
    let frame = |run: &str| std::fs::read(place.path(&format!("{run}/frames/000003.ply"))).unwrap();
    assert!(frame("again") == frame("out/drape"), "scene.toml makes other frames");
}

/// Its contact distance, a tenth of its mean edge length, is larger than a twentieth of its size.
#[test]
fn a_coarse_mesh_falls_freely_on_its_ball() {
    let place = Place::new();
    place.write("quad.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4\n");
    place.run("run quad.obj --frames 5 --out run").ok();
    for (index, line) in place.read("run/stats.jsonl").lines().enumerate() {
        let step: serde_json::Value = serde_json::from_str(line).unwrap();
        let (found, expected) = (step["max_speed"].as_f64().unwrap(), 0.0981 * (index + 1) as f64);
        assert!((found - expected).abs() < 1e-6, "time step {}: {found} m/s, not {expected}", index + 1);
    }
}

#[test]
fn a_run_begins_with_the_sizes_of_its_bodies_and_what_is_odd_about_the_scene() {
    let place = Place::new();
    let scene = "[simulation]\nframes = 1\nwind = [3, 0, 0]\n[[body]]\nname = \"sheet\"\n\
                 shape = { type = \"sheet\", size = [50.0, 40.0], edge = 10 }\n\
                 [[obstacle]]\nname = \"ball\"\nshape = { type = \"ball\", radius = 0.1, edge = 0.05 }\n\
                 translate = [0, 0, -1]\n";
    place.write("scene.toml", scene);
    let ended = place.run("run scene.toml").ok();
    for words in [
        "cloth sheet: 30 vertices, 50 x 40 x 0 m\nobstacle ball: ",
        "cloth sheet: 30 vertices, 50 x 40 x 0 m: more than 20 m in size; lengths are in m",
        "is 250 times as large as obstacle ball",
        "simulation.wind has no effect: it needs simulation.air_density",
    ] {
        assert!(ended.stderr.contains(words), "{words:?}: {ended:#?}");
    }
    // Units and axes of a mesh without a scene.
    place.write("mesh.obj", "v 0 0 0\nv 100 0 0\nv 0 50 0\nf 1 2 3\n");
    let ended = place.run("run mesh.obj --frames 1 --scale 0.01 --up y").ok();
    assert!(ended.stderr.contains("cloth body: 3 vertices, 1 x 0 x 0.5 m\n"), "{ended:#?}");
    assert!(!ended.stderr.contains("more than 20 m"), "{ended:#?}");
    place.run("run scene.toml --up y").refused(2, &["--up applies to meshes"]);
}

#[test]
fn an_overlap_at_the_start_says_what_to_move() {
    let place = Place::new();
    place.write(
        "scene.toml",
        "[[body]]\nname = \"sheet\"\nshape = { type = \"sheet\", edge = 0.1 }\ntranslate = [0.01, 0.02, \
         0.2]\n\
         [[obstacle]]\nname = \"ball\"\nshape = { type = \"ball\", radius = 0.25, edge = 0.05 }\n",
    );
    let ended = place.run("run scene.toml").refused(2, &["sheet and ball overlap: move sheet by 0.05"]);
    assert!(ended.stderr.contains(" m along +z, or ball as far along -z, by `translate`"), "{ended:#?}");
    // What it says helps.
    place.run("run scene.toml --frames 1 --out moved --set body.sheet.translate=[0.01,0.02,0.26]").ok();
}

#[test]
fn json_is_the_only_output() {
    let place = Place::new();
    let ended = place.run(&format!("{SMALL} --json --check --threads 1")).ok();
    let summary = ended.json();
    assert_eq!((&summary["scene"], &summary["frames"]), (&"drape".into(), &3.into()));
    assert_eq!((&summary["threads"], &summary["backend"]), (&1.into(), &"cpu".into()));
    assert_eq!(summary["intersections"], 0);
    assert_eq!(
        summary["vertices"],
        place.run("info out/drape/frames/000000.ply --json").ok().json()["vertices"]
    );
    assert!(summary["peak_memory_bytes"].as_u64().is_none_or(|bytes| bytes > 100_000), "{summary}");
    let file: serde_json::Value = serde_json::from_str(&place.read("out/drape/summary.json")).unwrap();
    assert_eq!(file, summary);
    let quiet = place.run(&format!("{SMALL} --quiet --out quiet")).ok();
    assert_eq!((quiet.stdout.as_str(), quiet.stderr.as_str()), ("", ""));
}

#[test]
fn a_run_on_a_gpu_goes_on_from_its_checkpoint_there_and_on_the_cpu() {
    let place = Place::new();
    let run = |frames: u32, options: &str| {
        let start = "--set body.0.velocity=[0,0,-4] --check --json --threads 1";
        place.run(&format!("run drape --scale 0.2 --frames {frames} {start} {options}")).ok().json()
    };
    let summary = run(12, "--backend gpu --out whole");
    let backend = summary["backend"].as_str().unwrap();
    assert!(backend.starts_with("gpu: "), "{backend}");
    assert!(summary["max"]["pressing_contacts"].as_f64().unwrap() > 0.0, "{summary}");
    for line in place.read("whole/stats.jsonl").lines() {
        let line: serde_json::Value = serde_json::from_str(line).unwrap();
        let seconds = |stage: &str| line["seconds"][stage].as_f64();
        // Mesa's driver has time stamps.
        let stages = ["search", "evaluate", "backward", "forward"].map(|stage| seconds(stage).unwrap());
        assert!(stages.iter().all(|stage| *stage > 0.0), "{line}");
        let device = seconds("device").unwrap();
        assert!((stages.iter().sum::<f64>() - device).abs() < 1e-9 * device, "{line}");
        assert!(device < seconds("total").unwrap() - seconds("dynamics").unwrap(), "{line}");
    }
    run(7, "--backend gpu --out parts");
    let summary = run(12, "--backend gpu --out parts --resume");
    assert_eq!(summary["intersections"], 0);
    let last = "frames/000012.ply";
    let bytes = |run: &str| std::fs::read(place.path(&format!("{run}/{last}"))).unwrap();
    assert_eq!(bytes("whole"), bytes("parts"));
    let summary = run(14, "--backend cpu --out parts --resume");
    let stats = place.read("parts/stats.jsonl");
    let times: Vec<bool> = stats.lines().map(|line| line.contains("\"device\":")).collect();
    assert_eq!(times, [[true; 12].as_slice(), &[false; 2]].concat());
    assert_eq!((&summary["backend"], &summary["intersections"]), (&"cpu".into(), &0.into()));
}

#[test]
fn the_dynamics_run_on_a_gpu_if_asked_and_say_so() {
    let place = Place::new();
    let run = |frames: u32, options: &str| {
        let start = "--set body.0.velocity=[0,0,-4] --check --threads 1";
        place.run(&format!("run drape --scale 0.2 --frames {frames} {start} {options}")).ok()
    };
    let on_gpu = |name: &serde_json::Value| name.as_str().unwrap().starts_with("gpu: ");
    let summary = run(8, "--backend gpu --json --out whole").json();
    assert!(on_gpu(&summary["backend"]) && on_gpu(&summary["dynamics_backend"]), "{summary}");
    assert!(summary["mean"]["cg_iterations"].as_f64().unwrap() > 0.0, "{summary}");
    assert_eq!((&summary["mean"]["converged"], &summary["intersections"]), (&1.0.into(), &0.into()));
    let ended = run(5, "--backend gpu --out parts");
    assert!(ended.stderr.contains("collisions on gpu: ") && ended.stderr.contains(", dynamics on gpu: "));
    run(8, "--backend gpu --resume --out parts");
    let bytes = |run: &str| std::fs::read(place.path(&format!("{run}/frames/000008.ply"))).unwrap();
    assert_eq!(bytes("whole"), bytes("parts"));
    let summary = run(3, "--dynamics-backend gpu --device 0 --json --out dynamics").json();
    assert!(summary["backend"] == "cpu" && on_gpu(&summary["dynamics_backend"]), "{summary}");
    let summary = run(3, "--backend gpu --dynamics-backend cpu --json --out collisions").json();
    assert!(on_gpu(&summary["backend"]) && summary["dynamics_backend"] == "cpu", "{summary}");
}

/// The device has no kernels for them; it resolves the collisions all the same.
#[test]
fn the_cpu_computes_quadratic_elements_and_a_device_that_is_asked_for_them_is_refused() {
    let place = Place::new();
    place.write(
        "beam.toml",
        "[[body]]\nname = \"beam\"\nkind = \"solid\"\nelements = \"quadratic\"\n\
         shape = { type = \"block\", size = [0.2, 0.05, 0.05], edge = 0.05 }\ntranslate = [0, 0, 0.03]\n\
         [[obstacle]]\nname = \"ground\"\nshape = { type = \"half-space\" }\n",
    );
    let run = |options: &str| place.run(&format!("run beam.toml --threads 1 {options}"));
    let summary = |run: &str| -> serde_json::Value {
        serde_json::from_str(&place.read(&format!("{run}/summary.json"))).unwrap()
    };
    let note = "the CPU computes the dynamics: 1 body has quadratic elements, which only the CPU computes (the \
                first is \"beam\"); a device computes linear ones (`elements = \"linear\"` in a scene)";
    for options in ["--backend gpu --frames 2", "--resume --frames 3"] {
        let ended = run(&format!("{options} --out run")).ok();
        assert_eq!(ended.stderr.matches(note).count(), 1, "{ended:#?}");
        let summary = summary("run");
        assert!(summary["backend"].as_str().unwrap().starts_with("gpu: "), "{summary}");
        assert_eq!(summary["dynamics_backend"], "cpu", "{summary}");
        assert!(place.read("run/backends.json").contains("dynamics_why"));
    }
    let words = ["body \"beam\" has quadratic elements", "`elements = \"linear\"`"];
    for backend in ["cpu", "gpu"] {
        run(&format!("--backend {backend} --dynamics-backend gpu --frames 2 --out refused"))
            .refused(3, &words);
    }
    let ended = run("--backend gpu --set body.0.elements=linear --frames 2 --out linear").ok();
    assert!(!ended.stderr.contains("the CPU computes"), "{ended:#?}");
    assert!(summary("linear")["dynamics_backend"].as_str().unwrap().starts_with("gpu: "));
}

/// Mesa's software driver is the only device where the tests run.
#[test]
fn the_backend_is_chosen_once_and_a_resumption_keeps_it() {
    let place = Place::new();
    let run = |frames: u32, options: &str| {
        let start = "--set body.0.velocity=[0,0,-4] --threads 1";
        place.run(&format!("run drape --scale 0.2 --frames {frames} {start} {options}"))
    };
    let record = |run: &str| -> serde_json::Value {
        serde_json::from_str(&place.read(&format!("{run}/backends.json"))).unwrap()
    };
    let last =
        |run: &str, frame: u32| std::fs::read(place.path(&format!("{run}/frames/{frame:06}.ply"))).unwrap();
    let ended = run(9, "--backend auto --out auto").ok();
    assert!(ended.stderr.contains("--backend auto: the CPU: "), "{ended:#?}");
    assert_eq!(ended.stderr.lines().filter(|line| line.contains("--backend auto")).count(), 1, "{ended:#?}");
    assert_eq!((&record("auto")["collisions"], &record("auto")["dynamics"]), (&"cpu".into(), &"cpu".into()));
    assert!(record("auto")["why"].as_str().unwrap().starts_with("the CPU: "));
    run(9, "--out plain").ok();
    assert!(last("auto", 9) == last("plain", 9) && record("plain").get("why").is_none());
    run(3, "--backend auto --out auto").refused(2, &["already holds a run"]);
    run(3, "--backend auto --device 99 --out none").refused(3, &["no device 99"]);
    let mut command = place.command("run drape --scale 0.2 --frames 1 --backend auto --out bare");
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        command.env(variable, "/nonexistent/driver.json");
    }
    let ended = Ended::new("without a driver", command.output().unwrap()).ok();
    assert!(ended.stderr.contains("--backend auto: the CPU: no usable GPU was found"), "{ended:#?}");

    // A resumption takes what computed the run before, whether `auto` is said again or not.
    run(9, "--backend gpu --out whole").ok();
    run(6, "--backend gpu --out parts").ok();
    let device = record("parts");
    assert!(device["collisions"].as_str().unwrap().starts_with("gpu: "), "{device}");
    run(8, "--resume --out parts").ok();
    run(9, "--resume --backend auto --out parts").ok();
    assert_eq!(record("parts"), device);
    assert!(last("whole", 9) == last("parts", 9));
    let gone = device.to_string().replace("gpu: ", "gpu: Older ");
    place.write("parts/backends.json", gone);
    run(10, "--resume --out parts").refused(3, &["Older", "not here", "--backend cpu", "--device"]);
    run(10, "--resume --backend cpu --out parts").ok();
    assert_eq!(record("parts")["collisions"], "cpu");
    place.write("parts/backends.json", "{}");
    run(11, "--resume --out parts").refused(2, &["backends.json", "collisions"]);
}

#[test]
fn formats_of_frames() {
    let place = Place::new();
    place.run(&format!("{SMALL} --format obj,npz --out run")).ok();
    assert_eq!(place.files("run/frames").len(), 4);
    assert!(place.files("run/frames").iter().all(|name| name.ends_with(".obj")));
    let report = place.run("check run/frames.npz --json").ok().json();
    assert_eq!(report["states"], 4);
    let distance = |path: &str| {
        place.run(&format!("check {path} --json")).ok().json()["files"][3]["min_distance_m"].clone()
    };
    assert!(
        (distance("run/frames").as_f64().unwrap() - distance("run/frames.npz").as_f64().unwrap()).abs()
            < 1e-15
    );
}

#[test]
fn threads_do_not_change_the_bits() {
    let place = Place::new();
    for threads in [1, 2] {
        place.run(&format!("run drape --scale 0.3 --frames 40 --threads {threads} --out t{threads}")).ok();
    }
    for frame in 0..=40 {
        let read = |t: u32| std::fs::read(place.path(&format!("t{t}/frames/{frame:06}.ply"))).unwrap();
        assert!(read(1) == read(2), "frame {frame} differs");
    }
}

#[test]
fn options_reach_the_scene() {
    let place = Place::new();
    place.run(&format!("{SMALL} --dt 0.002 --preset paper --set solver.backward.sweeps=3 --out run")).ok();
    let scene = place.read("run/scene.toml");
    for line in ["dt = 0.002", "frames = 3", "preset = \"paper\"", "sweeps = 3"] {
        assert!(scene.lines().any(|l| l.trim() == line), "{line:?} is not in\n{scene}");
    }
}

/// Any OBJ or PLY runs as cloth, as the README says.
#[test]
fn a_bare_mesh_falls_on_a_ball() {
    let place = Place::new();
    let vertices: String =
        (0..49).map(|i| format!("v {} {} {}\n", 100 * (i % 7), 40, 100 * (i / 7))).collect();
    let faces: String = (0..36)
        .map(|q| q / 6 * 7 + q % 6 + 1)
        .map(|a| format!("f {} {} {} {}\n", a, a + 1, a + 8, a + 7))
        .collect();
    place.write("cloth.obj", vertices + &faces);
    let words = "run cloth.obj --set body.0.up=y --set body.0.scale=0.001 --frames 30 --check --json";
    let summary = place.run(words).ok().json();
    assert_eq!((&summary["scene"], &summary["vertices"]), (&"cloth".into(), &49.into()));
    assert_eq!(summary["intersections"], 0);
    assert!(summary["min_gap_m"].as_f64().is_some_and(|gap| gap < 0.03), "it met the ball: {summary}");
    let again = place.run("run out/cloth/scene.toml --frames 1 --out again --json").ok().json();
    assert_eq!(again["vertices"], 49);
}

/// The scene in the README, with a smaller mesh.
#[test]
fn the_scene_of_the_readme() {
    let readme = include_str!("../../../../README.md");
    let toml = readme.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let place = Place::new();
    place.write("scene.toml", toml);
    tetrahedron(&place.path("skirt.obj"));
    place.run("run scene.toml --frames 1").ok();
}

#[test]
fn a_pin_that_would_go_through_the_ground_waits_and_is_named() {
    let place = Place::new();
    let scene = r#"
        simulation = { dt = 0.01, frames = 30 }
        [[body]]
        name = "flag"
        shape = { type = "sheet", size = [0.4, 0.4], edge = 0.1 }
        translate = [0, 0, 0.1]
        [[pin]]
        side = "x-min"
        motion = { keyframes = [{ time = 0.1, translate = [0, 0, -0.2] }] }
        [[obstacle]]
        name = "ground"
        shape = "half-space"
    "#;
    place.write("scene.toml", scene);
    let ended = place.run("run scene.toml --check").ok();
    assert!(ended.stdout.contains("pin[0] of flag was held up by what was in its way"), "{ended:#?}");
    assert!(ended.stdout.contains("no intersection"), "{ended:#?}");
    let statistics = place.read("out/scene/stats.jsonl");
    let last: serde_json::Value = serde_json::from_str(statistics.lines().last().unwrap()).unwrap();
    let behind = last["waiting"]["pin[0] of flag"].as_f64().unwrap();
    assert!((behind - 0.1).abs() < 0.01, "the way goes on for 10 cm below the ground: {behind}");
    assert_eq!(last["prescribed_lag_m"].as_f64().unwrap(), behind);
    let free = place.run(&format!("{SMALL} --out free")).ok();
    assert!(!free.stdout.contains("held up") && !free.stdout.contains("ended at the limit"), "{free:#?}");
}

/// A single Newton iteration does not balance the forces of an impact.
#[test]
fn a_run_says_which_time_steps_are_unsolved() {
    let place = Place::new();
    let run = |options: &str| {
        let start = "--set body.0.velocity=[0,0,-4] --threads 1 --out run";
        place.run(&format!("run drape --scale 0.2 --frames 8 {start} {options}")).ok()
    };
    let ended = run("--set simulation.newton_iterations=1");
    let lines: Vec<serde_json::Value> =
        place.read("run/stats.jsonl").lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let unsolved: Vec<&serde_json::Value> = lines.iter().filter(|line| line["solved"] == false).collect();
    assert!(!unsolved.is_empty() && unsolved.len() < lines.len(), "{lines:?}");
    for line in &lines {
        let [residual, tolerance] = ["residual_m", "tolerance_m"].map(|key| line[key].as_f64().unwrap());
        assert!(tolerance > 0.0, "{line}");
        let solved = residual <= tolerance && line["converged"] == true;
        assert_eq!((&line["solved"], line.get("unsolved").is_none()), (&solved.into(), solved), "{line}");
    }
    let both = ["sheet", "ball"].map(serde_json::Value::from);
    let at = unsolved.iter().map(|line| &line["unsolved"]);
    let mut of_both = at.filter(|at| at["bodies"].as_array().unwrap()[..] == both);
    let place_of_both = of_both.next().expect("a time step with a contact")["place_m"].as_array().unwrap();
    // At the top of the ball.
    assert!(place_of_both.iter().all(|c| c.as_f64().unwrap().abs() < 0.5), "{place_of_both:?}");

    let summary: serde_json::Value = serde_json::from_str(&place.read("run/summary.json")).unwrap();
    let share = 1.0 - unsolved.len() as f64 / lines.len() as f64;
    assert!((summary["mean"]["solved"].as_f64().unwrap() - share).abs() < 1e-12, "{summary}");
    assert_eq!(
        (&summary["mean"]["converged"], &summary["unsolved_steps"]),
        (&1.0.into(), &unsolved.len().into())
    );
    let first = &summary["first_unsolved"];
    for key in ["step", "residual_m", "tolerance_m"] {
        assert_eq!(first[key], unsolved[0][key], "{key}");
    }
    for key in ["bodies", "place_m"] {
        assert_eq!(first[key], unsolved[0]["unsolved"][key], "{key}");
    }
    let names: Vec<&str> =
        first["bodies"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    let words = format!(
        "warning: {} of 8 time steps ended unsolved: the first is time step {}, at {} at (",
        unsolved.len(),
        first["step"],
        names.join(" and ")
    );
    assert!(ended.stdout.contains(&words), "{words}: {ended:#?}");
    assert!(ended.stdout.contains(" times the tolerance"), "{ended:#?}");
    assert!(ended.stdout.contains("simulation.newton_iterations=30"), "{ended:#?}");
}

#[test]
fn a_run_whose_time_steps_are_solved_says_nothing_of_them() {
    let place = Place::new();
    let ended = place.run(SMALL).ok();
    assert!(!ended.stdout.contains("unsolved") && !ended.stderr.contains("unsolved"), "{ended:#?}");
    assert!(!ended.stdout.contains("tolerance") && !ended.stderr.contains("tolerance"), "{ended:#?}");
    let summary: serde_json::Value = serde_json::from_str(&place.read("out/drape/summary.json")).unwrap();
    assert_eq!((&summary["mean"]["solved"], &summary["unsolved_steps"]), (&1.0.into(), &0.into()));
    assert!(summary.get("first_unsolved").is_none(), "{summary}");
    // Without a tolerance there is nothing to compare with.
    let more = "--set simulation.newton_iterations=1 --set solver.newton.step_tolerance=0 --out without";
    let ended = place.run(&format!("{SMALL} --set body.0.velocity=[0,0,-4] {more}")).ok();
    assert!(!ended.stdout.contains("unsolved"), "{ended:#?}");
}

#[test]
fn a_slow_time_step_names_what_it_waits_for() {
    let place = Place::new();
    let words = "run drape --scale 0.3 --frames 30 --dt 0.03 --set solver.stop.max_steps=1 --out run";
    let ended = place.run(words).ok();
    let lines: Vec<serde_json::Value> =
        place.read("run/stats.jsonl").lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let slow: Vec<&serde_json::Value> = lines.iter().filter(|line| line["converged"] == false).collect();
    assert!(!slow.is_empty());
    assert!(lines.iter().any(|line| line.get("waits").is_none()), "steps that need not wait say nothing");
    for line in &lines {
        // A problem before the last one may have ended short of its target as well.
        assert!(line.get("waits").is_some() || line["converged"] == true, "{line}");
    }
    for wait in slow.iter().flat_map(|line| line["waits"].as_array().unwrap()) {
        let elements = wait["elements"].as_array().unwrap();
        assert!(elements.iter().all(|element| element.as_str().unwrap().contains(" of ")), "{wait}");
        assert_eq!(wait["bodies"].as_array().unwrap().len(), elements.len());
        // The sheet is within a box of 2 m around the ball.
        assert!(
            wait["place_m"].as_array().unwrap().iter().all(|c| c.as_f64().unwrap().abs() < 1.0),
            "{wait}"
        );
        assert!(wait["remaining_m"].as_f64().unwrap() > 0.0, "{wait}");
    }
    let pairs = lines.iter().filter_map(|line| line.get("waits")).flat_map(|waits| waits.as_array().unwrap());
    let both = ["sheet", "ball"].map(serde_json::Value::from);
    let mut of_both =
        pairs.filter(|wait| both.iter().all(|body| wait["bodies"].as_array().unwrap().contains(body)));
    assert!(of_both.next().is_some(), "{lines:?}");
    let summary: serde_json::Value = serde_json::from_str(&place.read("run/summary.json")).unwrap();
    let slowest = &summary["slowest_step"];
    let line = &lines[slowest["step"].as_u64().unwrap() as usize - 1];
    assert_eq!((&slowest["waits"], &slowest["two_way_steps"]), (&line["waits"], &line["two_way_steps"]));
    let words = format!("slowest: time step {} with", slowest["step"]);
    assert!(ended.stdout.contains(&words) && ended.stdout.contains("short of the target: "), "{ended:#?}");
}
