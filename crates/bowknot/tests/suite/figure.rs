use super::scene;
use bowknot::check::StateOptions;
use bowknot::geometry::Point;
use bowknot::{Scene, Simulator};
use std::f64::consts::FRAC_PI_2;

/// A strip over a box that turns by a quarter a second, its end sewn to the box.
fn sewn(pin: &str) -> String {
    format!(
        "[[body]]\nname = \"strip\"\nshape = {{ type = \"sheet\", size = [0.3, 0.1], edge = 0.05 }}\n\
         translate = [0.2, 0, 0.3]\n\
         [[obstacle]]\nname = \"box\"\nshape = {{ type = \"box\", size = [0.5, 0.5, 0.5], edge = 0.1 }}\n\
         motion = {{ spin = 90 }}\n\
         [[obstacle]]\nname = \"ground\"\nshape = \"half-space\"\ntranslate = [0, 0, -2]\n\
         [[pin]]\nside = \"x-min\"\n{pin}\n"
    )
}

fn run(simulator: &mut Simulator, steps: usize) {
    for _ in 0..steps {
        simulator.step().unwrap_or_else(|error| panic!("{error}"));
    }
}

fn turned(x: &Point, angle: f64) -> Point {
    let (sin, cos) = angle.sin_cos();
    Point::new(cos * x.x - sin * x.y, sin * x.x + cos * x.y, x.z)
}

#[test]
fn pins_follow_the_surface_of_an_obstacle() {
    let mut simulator = Simulator::new(&scene(&sewn("follow = \"box\""))).expect("a simulator");
    let start = simulator.positions().to_vec();
    let pinned = simulator.world().pins[0].vertices.clone();
    assert_eq!(pinned.len(), 3);
    run(&mut simulator, 20);
    for &v in &pinned {
        let v = v as usize;
        let expected = turned(&start[v], 0.2 * FRAC_PI_2);
        assert!((simulator.positions()[v] - expected).norm() < 1e-9);
    }
    // What is not pinned hangs down to the box.
    assert!(simulator.positions().iter().take(21).any(|p| p.z < 0.28));
}

#[test]
fn a_late_pin_follows_from_where_it_takes_hold_also_after_a_restart() {
    let text = sewn("follow = \"box\"\nstart = 0.05");
    let mut simulator = Simulator::new(&scene(&text)).expect("a simulator");
    run(&mut simulator, 5);
    let held = simulator.positions().to_vec();
    let pinned = simulator.world().pins[0].vertices.clone();
    assert!(held[pinned[0] as usize].z < 0.295);
    run(&mut simulator, 5);
    let middle = simulator.checkpoint();
    run(&mut simulator, 10);
    for &v in &pinned {
        let v = v as usize;
        let expected = turned(&held[v], 0.15 * FRAC_PI_2);
        assert!((simulator.positions()[v] - expected).norm() < 1e-9);
    }
    let mut resumed = Simulator::new(&scene(&text)).expect("a simulator");
    resumed.restore(&middle).expect("a checkpoint");
    run(&mut resumed, 10);
    assert_eq!(resumed.positions(), simulator.positions());
}

#[test]
fn what_cannot_be_followed_is_refused() {
    let refusal = |pin: &str| Scene::from_toml(&sewn(pin), "").expect_err("refused").to_string();
    let message = refusal("follow = \"bok\"");
    assert!(
        message.contains("no obstacle with a mesh \"bok\"; there are: box; did you mean box?"),
        "{message}"
    );
    let message = refusal("follow = \"ground\"");
    assert!(message.contains("pin[0].follow: no obstacle with a mesh \"ground\""), "{message}");
    let message = refusal("follow = \"box\"\nmotion = { spin = 1 }");
    assert!(message.contains("stands beside motion"), "{message}");
    let body = "[[body]]\nshape = \"figure\"\n";
    let message = Scene::from_toml(body, "").expect_err("refused").to_string();
    assert!(message.contains("a figure can only be an obstacle"), "{message}");
}

#[test]
fn a_figure_moves_and_is_placed_as_its_obstacle_says() {
    let text = "[[body]]\nshape = \"sheet\"\ntranslate = [0, 0, 9]\n\
                [[obstacle]]\nname = \"figure\"\nrotate = [0, 0, 90]\ntranslate = [0, 0, 0.5]\n\
                shape = { type = \"figure\", edge = 0.03, start = 0, ease = 0, walk_speed = 2 }\n";
    let mut simulator = Simulator::new(&scene(text)).expect("a simulator");
    let first = simulator.world().deformable_vertices;
    let start = simulator.positions().to_vec();
    let head = (first..start.len()).max_by(|a, b| start[*a].z.total_cmp(&start[*b].z)).expect("a vertex");
    assert!((start[head].z - 2.2).abs() < 5e-3);
    run(&mut simulator, 20);
    let way = simulator.positions()[head] - start[head];
    // It looks along y and has gone 40 cm; the hips sway by 2 cm and sink while the legs are apart.
    assert!((way.y - 0.4).abs() < 0.02 && way.x.abs() < 0.03 && (-0.08..0.0).contains(&way.z), "{way}");
}

/// The counts of the paper's Table 2, within 5 %.
#[test]
fn dresses_have_the_size_of_the_papers() {
    for (name, vertices, triangles) in [("dress", 30_000.0, 60_000.0), ("gown", 27_000.0, 51_000.0)] {
        let info = Scene::builtin(name, 1.0).and_then(|scene| scene.info()).expect("a scene");
        assert!((info.vertices as f64 / vertices - 1.0).abs() < 0.05, "{name}: {} vertices", info.vertices);
        assert!(
            (info.triangles as f64 / triangles - 1.0).abs() < 0.05,
            "{name}: {} triangles",
            info.triangles
        );
        assert_eq!(info.time_step, 0.01);
    }
}

#[test]
fn dresses_start_clear_at_every_scale() {
    for name in ["dress", "gown"] {
        for scale in [0.05, 0.2, 0.47, 1.0] {
            let scene = Scene::builtin(name, scale).expect("a scene");
            let (_, report) = Simulator::start_intersections(&scene).expect("a report");
            assert_eq!(report.intersection_count, 0, "{name} at {scale}");
        }
    }
}

#[test]
fn a_dressed_figure_walks_without_intersections() {
    let sets = ["obstacle.figure.shape.start=0", "obstacle.figure.shape.ease=0.1"];
    for name in ["dress", "gown"] {
        let scene = Scene::builtin(name, 0.15).and_then(|s| s.with_sets(&sets)).expect("a scene");
        let mut simulator = Simulator::new(&scene).expect("a simulator");
        let start = simulator.positions().to_vec();
        for _ in 0..20 {
            let statistics = simulator.step().unwrap_or_else(|error| panic!("{error}"));
            assert!(statistics.max_stretch < 1.15, "{name}: {}", statistics.max_stretch);
            let options = StateOptions { limit: 5, distance: false };
            let report = simulator.judge().check_state(simulator.positions(), &options).expect("a report");
            assert!(report.is_clear(), "{name}: {}", report.intersections[0]);
        }
        let gone = |v: usize| (simulator.positions()[v] - start[v]).x;
        let last = simulator.world().pins[0].vertices[0] as usize;
        assert!((0.05..0.2).contains(&gone(last)), "{name}: {}", gone(last));
    }
}
