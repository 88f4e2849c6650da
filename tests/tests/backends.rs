//! Whole simulations, collisions and dynamics, on the twins of the kernels: nothing intersects, the first
//! contacts are those of the CPU, and so are the statistics of the runs.
//!
//! Where bodies crumple, differences of the size of a tolerance grow. The yardstick for them are runs on the
//! CPU with one sweep more per backward step, more accurate linear solves, and time steps solved to a tenth
//! of the tolerance, which should make no difference either.
//!
//! `--ignored` runs every scene of the paper and prints a table; without it there are some small ones.

use bowknot::check::StateOptions;
use bowknot::gpu::{ConjugateGradients, Device, TwinEngine};
use bowknot::run::{self, Backends, Progress, RunOptions};
use bowknot::simulator::{BackendError, Checkpoint, CollisionBackend, Cpu};
use bowknot::{Scene, SimulationError, Simulator, StepStatistics};
use bowknot_geometry::{Point, Vector};
use bowknot_tests::contact::{Ground, Slider, Slope};
use bowknot_twoway::{CollisionScene, Observer, ResolveInput, Resolver, Statistics};
use std::ops::ControlFlow;
use std::time::Instant;

/// A scene, its scale, assignments to its keys, and the number of time steps.
type Case<'a> = (&'static str, f64, &'a [&'a str], usize);

const SMALL: [Case<'_>; 5] = [
    ("drape", 0.25, &["body.0.velocity=[0,0,-4]"], 16),
    ("needle", 0.12, &[], 12),
    ("trampoline", 0.2, &[], 40),
    ("hair", 0.05, &[], 10),
    ("sand", 0.05, &[], 40),
];

const ALL: [Case<'_>; 15] = [
    ("drape", 0.5, &[], 60),
    ("needle", 0.2, &[], 40),
    ("stack", 0.2, &[], 80),
    ("sphere", 0.1, &[], 80),
    ("tube", 0.15, &[], 50),
    ("dress", 0.1, &[], 40),
    ("gown", 0.1, &[], 40),
    ("blade", 0.1, &[], 40),
    ("funnel", 0.1, &[], 30),
    ("bow-knot", 0.08, &[], 60),
    ("reef-knot", 0.15, &[], 60),
    ("mat", 0.12, &[], 60),
    ("hair", 0.05, &[], 60),
    ("sand", 0.08, &[], 80),
    ("trampoline", 0.4, &[], 80),
];

/// What a run did.
struct Course {
    /// Mean edge length [m].
    edge: f64,
    /// Wall time, that of the judge included [s].
    seconds: f64,
    two_way_steps: usize,
    newton_iterations: usize,
    largest_stretch: f64,
    /// Mean contact rows and pressing contacts per time step.
    contacts: f64,
    /// First time step with contacts.
    first_contact: usize,
    converged: usize,
    /// Center of mass after each time step.
    centers: Vec<Point>,
    end: Vec<Point>,
}

/// What computes a run.
#[derive(Clone, Copy, Debug, PartialEq)]
enum On {
    Cpu,
    /// With one sweep more.
    CpuOnceMore,
    /// With linear solves a hundred times as accurate.
    CpuAccurate,
    /// With a tenth of the tolerance of time steps.
    CpuSolved,
    /// With trust regions of one size: iterations come to contacts another way, which decides where these
    /// begin.
    CpuUniform,
    /// With vertices that start 1e-6 m beside where they are.
    CpuMoved(u32),
    Twins,
    /// With the dynamics of the CPU.
    TwinCollisions,
}

fn dynamics() -> Box<ConjugateGradients<TwinEngine>> {
    Box::new(ConjugateGradients::new("twins".to_owned(), TwinEngine::new()))
}

fn twins() -> Device<TwinEngine> {
    Device::new("twins".to_owned(), TwinEngine::new())
}

fn course((name, scale, sets, steps): Case<'_>, on: On) -> Course {
    let mut sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    sets.extend(std::env::var("BOWKNOT_SETS").iter().flat_map(|sets| sets.split(' ').map(str::to_owned)));
    match on {
        On::Cpu | On::CpuMoved(_) | On::Twins | On::TwinCollisions => (),
        On::CpuOnceMore => sets.push("solver.backward.sweeps=9".to_owned()),
        On::CpuAccurate => sets.push("solver.newton.cg_tolerance=1e-6".to_owned()),
        On::CpuSolved => sets.push("solver.newton.step_tolerance=0.0003".to_owned()),
        On::CpuUniform => sets.push("solver.forward.trust_region=uniform".to_owned()),
    }
    let scene = Scene::builtin(name, scale).and_then(|scene| scene.with_sets(&sets)).expect("a scene");
    let mut simulator = Simulator::new(&scene).expect("a simulator");
    if matches!(on, On::Twins | On::TwinCollisions) {
        simulator.set_backend(Box::new(twins())).expect("settings that the kernels have");
    }
    if let On::CpuMoved(which) = on {
        let mut start = simulator.checkpoint();
        let count = start.positions.len();
        for (v, x) in start.positions.iter_mut().enumerate() {
            let (sine, cosine) = (f64::from(which) + 2.4 * v as f64).sin_cos();
            *x += 1e-6 * Vector::new(cosine, sine, 1.0 - 2.0 * (v as f64 + 0.5) / count as f64).normalize();
        }
        simulator.restore(&start).expect("the same scene");
    }
    if on == On::Twins {
        simulator.set_dynamics_backend(Some(dynamics())).expect("linear elements");
    }
    let timer = Instant::now();
    let judge = simulator.judge();
    let count = simulator.world().collision_vertices();
    let options = StateOptions { limit: 1, distance: false };
    let mut all: Vec<StepStatistics> = Vec::new();
    for step in 0..steps {
        all.push(simulator.step().unwrap_or_else(|error| panic!("{name}: {error}")));
        let state = judge.check_state(&simulator.positions()[..count], &options).expect("a report");
        assert!(state.is_clear(), "{name}, step {step}, {on:?}: {state:?}");
    }
    let contacts: usize = all.iter().map(|s| s.contact_rows + s.pressing_contacts).sum();
    Course {
        edge: simulator.resolver().scene().lengths().edge,
        seconds: timer.elapsed().as_secs_f64(),
        two_way_steps: all.iter().map(|s| s.two_way_steps).sum(),
        newton_iterations: all.iter().map(|s| s.newton_iterations).sum(),
        largest_stretch: all.iter().map(|s| s.max_stretch).fold(0.0, f64::max),
        contacts: contacts as f64 / steps as f64,
        first_contact: all.iter().position(|s| s.contact_rows + s.pressing_contacts > 0).unwrap_or(steps),
        converged: all.iter().filter(|s| s.converged).count(),
        centers: all.iter().map(|s| Point::from(s.center_of_mass)).collect(),
        end: simulator.positions().to_vec(),
    }
}

/// Largest distance of the centers of mass in the first `steps` time steps [m].
fn centers_apart(a: &Course, b: &Course, steps: usize) -> f64 {
    a.centers.iter().zip(&b.centers).take(steps).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

#[test]
fn runs_on_the_kernels_go_as_on_the_cpu() {
    for case in SMALL {
        let [cpu, twins] = [On::Cpu, On::Twins].map(|on| course(case, on));
        let others =
            [On::CpuOnceMore, On::CpuAccurate, On::CpuSolved, On::CpuUniform].map(|on| course(case, on));
        let (name, steps) = (case.0, case.3);
        assert!(cpu.first_contact < steps, "{name}: the scene has not come to its contacts");
        assert_eq!(cpu.first_contact, twins.first_contact, "{name}");
        // Two vertices may stop short of their targets by the tolerance of the stopping rule each.
        let tolerance = 0.02 * cpu.edge;
        for steps in [cpu.first_contact + 2, steps] {
            let apart = centers_apart(&cpu, &twins, steps);
            let own = others.iter().map(|other| centers_apart(&cpu, other, steps)).fold(0.0, f64::max);
            assert!(
                apart < 2.0 * own + tolerance,
                "{name}, step {steps}: {apart} m, the yardstick is {own} m"
            );
        }
        let ratio = |of: fn(&Course) -> f64| of(&twins) / of(&cpu);
        let steps = |course: &Course| course.two_way_steps as f64 / cpu.two_way_steps as f64;
        let own = others.iter().map(steps);
        let (fewest, most) = own.fold((1.0f64, 1.0f64), |(low, high), own| (low.min(own), high.max(own)));
        let steps = steps(&twins);
        assert!((0.8 * fewest..1.25 * most).contains(&steps), "{name}: {steps} times the two-way steps");
        let contacts = ratio(|course| course.contacts);
        assert!((0.6..1.7).contains(&contacts), "{name}: {contacts} times the contacts");
        // Grains have no edges.
        let stretch = ratio(|course| 1.0 + course.largest_stretch);
        assert!((0.99..1.01).contains(&stretch), "{name}: {stretch} times the stretch");
    }
}

#[test]
fn bodies_slide_and_stick_on_the_kernels_as_theory_has_it() {
    // An error of 1 % of friction gives one of 4.7 % of the acceleration at mu = 0.3.
    for (slider, share) in [
        (Slider::JellyCube, 0.1),
        (Slider::StiffCube, 0.03),
        (Slider::Patch, 0.03),
        (Slider::Strands, 0.03),
        (Slider::Grains, 0.03),
    ] {
        let speed = |friction: f64| {
            let slope = Slope::new(slider, Ground::Irregular, friction);
            let track = slope.run_on(Box::new(twins()), Some(dynamics()), 25);
            (track.speed(23..26), slope.acceleration() * 0.24)
        };
        let (found, expected) = speed(0.3);
        assert!((found - expected).abs() < share * expected, "{slider:?}: {found} m/s, not {expected}");
        let (creep, _) = speed(0.5);
        assert!(creep.abs() < 1e-3, "{slider:?} creeps at {creep} m/s");
    }
}

/// Both processors beside the CPU from a start moved by 1e-6 m: two-way steps, and how far centers of mass come apart.
/// `BOWKNOT_SCENES=needle,hair` chooses scenes, `BOWKNOT_SETS="solver.backward.sweeps=16 ..."` sets keys for all runs.
#[test]
#[ignore = "it takes minutes"]
fn nothing_intersects_in_any_scene_of_the_paper() {
    const STEPS: usize = 40;
    const RUNS: [On; 5] = [On::Cpu, On::CpuMoved(1), On::CpuMoved(2), On::TwinCollisions, On::Twins];
    let only = std::env::var("BOWKNOT_SCENES").unwrap_or_default();
    println!(
        "{RUNS:?} | vertices | seconds | two-way steps | iterations | contact rows | converged | stretch | apart mm"
    );
    for (name, scale, sets, _) in ALL {
        if !only.is_empty() && !only.split(',').any(|chosen| chosen == name) {
            continue;
        }
        let courses = RUNS.map(|on| course((name, scale, sets, STEPS), on));
        let all = |of: &dyn Fn(&Course) -> String| courses.each_ref().map(of).join(", ");
        println!(
            "| {name} | {} | {} | {} | {} | {} | {} | {} | {} |",
            courses[0].end.len(),
            all(&|c| format!("{:.1}", c.seconds)),
            all(&|c| c.two_way_steps.to_string()),
            all(&|c| c.newton_iterations.to_string()),
            all(&|c| format!("{:.0}", c.contacts)),
            all(&|c| c.converged.to_string()),
            all(&|c| format!("{:.3}", c.largest_stretch)),
            all(&|c| format!("{:.3}", 1e3 * centers_apart(&courses[0], c, STEPS))),
        );
    }
}

/// Two patches of cloth that fly together, far out of where they began, and meet there.
const FLIGHT: &str = r#"
[simulation]
dt = 0.01
gravity = [0, 0, 0]
[solver.sleep]
enabled = false
[contact]
delta = 0.001
[[body]]
name = "upper"
shape = { type = "sheet", edge = 0.05, size = [0.3, 0.3] }
translate = [0, 0, 0.06]
velocity = [60, 0, -1]
[[body]]
name = "lower"
shape = { type = "sheet", edge = 0.05, size = [0.3, 0.3] }
translate = [0.013, 0.007, 0]
velocity = [60, 0, 1]
"#;

fn flight() -> Simulator {
    let scene = Scene::from_toml(FLIGHT, std::path::Path::new(".")).expect("a scene");
    Simulator::new(&scene).expect("a simulator")
}

#[test]
fn the_grid_follows_bodies_and_a_resumed_run_has_the_same_bits() {
    let [mut cpu, mut whole, mut resumed] = [(); 3].map(|()| flight());
    whole.set_backend(Box::new(twins())).expect("a backend");
    resumed.set_backend(Box::new(twins())).expect("a backend");
    let mut contacts = [0, 0];
    for step in 0..10 {
        // A two-way step that is the last of its call may need no rows where contacts press.
        for (contacts, simulator) in contacts.iter_mut().zip([&mut cpu, &mut whole]) {
            *contacts += simulator.step().expect("a step").pressing_contacts;
        }
        if step == 4 {
            resumed.restore(&whole.checkpoint()).expect("the same scene");
        } else if step > 4 {
            resumed.step().expect("a step");
        }
    }
    assert!(whole.positions()[0].x > 5.5, "{}", whole.positions()[0]);
    assert!(contacts[0] > 0 && contacts[1] > 0, "{contacts:?}");
    assert!(whole.positions() == resumed.positions());
    let center = |simulator: &Simulator| simulator.dynamics_model().center_of_mass(simulator.positions());
    let apart = (center(&whole) - center(&cpu)).norm();
    assert!(apart < 1e-3, "{apart}");
}

/// Trees are ordered by positions of every 64th time step, which checkpoints hold.
#[test]
fn trees_follow_grains_that_mix_and_a_resumed_run_has_the_same_bits() {
    let scene = Scene::from_toml(SIDE_BY_SIDE, std::path::Path::new(".")).expect("a scene");
    let [mut whole, mut resumed, mut from_old] =
        [(); 3].map(|()| Simulator::new(&scene).expect("a simulator"));
    for simulator in [&mut whole, &mut resumed, &mut from_old] {
        simulator.set_backend(Box::new(twins())).expect("a backend");
    }
    let mut kept = whole.checkpoint();
    let mut order = Vec::new();
    for step in 0..70 {
        if step == 64 {
            order = whole.positions().to_vec();
        }
        whole.step().expect("a step");
        if step + 1 == 66 {
            kept = whole.checkpoint();
            resumed.restore(&kept).expect("the same scene");
        } else if step + 1 > 66 {
            resumed.step().expect("a step");
        }
    }
    assert!(whole.positions() == resumed.positions() && whole.velocities() == resumed.velocities());
    assert!(!order.is_empty() && kept.order == order && whole.checkpoint().order == order);
    // A state from before the order was made takes it back.
    let start = from_old.checkpoint();
    from_old.restore(&kept).expect("the same scene");
    from_old.step().expect("a step");
    from_old.restore(&start).expect("the same scene");
    assert!(from_old.checkpoint() == start && start.order.is_empty());
    let wrong = Checkpoint { order: vec![Point::origin()], ..start };
    assert!(from_old.restore(&wrong).expect_err("another scene").to_string().contains("order"));
}

/// Grains and two patches of cloth fall side by side; friction stops all but the second patch.
const SIDE_BY_SIDE: &str = r#"
[simulation]
dt = 0.01
gravity = [3, 0, -9]
[solver.sleep]
enabled = false
[contact]
delta = 0.002
[[contact.friction_pairs]]
bodies = ["ground", "smooth"]
friction = 0
[[obstacle]]
name = "ground"
shape = "half-space"
friction = 1
[[body]]
name = "grains"
kind = "particles"
material = { base = "sand", radius = 0.006 }
shape = { type = "grains", count = [3, 3, 1], spacing = 0.04 }
translate = [0, 0, 0.01]
friction = 1
[[body]]
name = "rough"
shape = { type = "sheet", edge = 0.05, size = [0.2, 0.2] }
translate = [0, 0.5, 0.02]
friction = 1
[[body]]
name = "smooth"
shape = { type = "sheet", edge = 0.05, size = [0.2, 0.2] }
translate = [0, 1, 0.02]
friction = 1
thickness = 0.003
"#;

#[test]
fn bodies_rest_as_high_above_a_half_space_and_rub_as_on_the_cpu() {
    for ground in ["friction = 1", "friction = 1\nthickness = 0.01"] {
        let text = SIDE_BY_SIDE.replacen("friction = 1", ground, 1);
        let [mut cpu, mut device] = [(); 2].map(|()| {
            let scene = Scene::from_toml(&text, std::path::Path::new(".")).expect("a scene");
            Simulator::new(&scene).expect("a simulator")
        });
        device.set_backend(Box::new(twins())).expect("settings that the kernels have");
        let start = cpu.positions().to_vec();
        for _ in 0..40 {
            cpu.step().expect("a step");
            device.step().expect("a step");
        }
        for (body, slides) in [false, false, true].into_iter().enumerate() {
            let mean = |x: &[Point]| mean(&cpu, body, x);
            let [start, end, other] = [mean(&start), mean(cpu.positions()), mean(device.positions())];
            assert!((end - other).norm() < 1e-6, "{ground}, body {body}: {other}, not {end}");
            assert_eq!(end.x - start.x > 0.2, slides, "{ground}, body {body}: {start} to {end}");
        }
    }
}

/// Mean position of the vertices of a body [m].
fn mean(simulator: &Simulator, body: usize, x: &[Point]) -> Point {
    let of_body = simulator.resolver().scene().model().vertex_body();
    let all: Vec<&Point> =
        x.iter().zip(of_body).filter(|(_, b)| **b as usize == body).map(|(x, _)| x).collect();
    Point::from(all.iter().map(|x| x.coords).sum::<Vector>() / all.len() as f64)
}

/// The CPU, which fails in one of its calls.
#[derive(Debug)]
struct Failing {
    cpu: Cpu,
    calls_left: usize,
}

impl CollisionBackend for Failing {
    fn name(&self) -> String {
        "failing".to_owned()
    }

    fn prepare(&mut self, scene: &CollisionScene, home: &[Point]) -> Result<(), BackendError> {
        self.cpu.prepare(scene, home)
    }

    fn resolution(&self) -> f64 {
        self.cpu.resolution()
    }

    fn resolve(
        &mut self,
        resolver: &mut Resolver,
        positions: &mut [Point],
        target: &[Point],
        input: &ResolveInput<'_>,
        observer: &mut dyn Observer,
    ) -> Result<Statistics, BackendError> {
        if self.calls_left == 0 {
            return Err(BackendError::Failed("the device was lost".into()));
        }
        self.calls_left -= 1;
        self.cpu.resolve(resolver, positions, target, input, observer)
    }

    fn judge(&mut self, scene: &CollisionScene, positions: &[Point]) -> Result<(), BackendError> {
        self.cpu.judge(scene, positions)
    }
}

#[test]
fn a_run_whose_device_is_lost_goes_on_from_the_last_time_step() {
    let folder = tempfile::tempdir().expect("a folder");
    let sets = ["simulation.frames=12".to_owned(), "body.0.velocity=[0,0,-4]".to_owned()];
    let scene = Scene::builtin("drape", 0.2).and_then(|scene| scene.with_sets(&sets)).expect("a scene");
    let options = |name: &str, resume: bool| RunOptions {
        out: folder.path().join(name),
        resume,
        ..RunOptions::default()
    };
    let mut go_on = |_: &Progress<'_>| ControlFlow::Continue(());
    run::run(&scene, &options("whole", false), &mut go_on).expect("a run");
    let failing =
        Backends { collisions: Box::new(Failing { cpu: Cpu, calls_left: 9 }), ..Backends::default() };
    let error =
        run::run_on(&scene, &options("parts", false), failing, &mut go_on).expect_err("the device is lost");
    assert!(matches!(error, SimulationError::Backend { step: 2.., .. }), "{error}");
    assert!(error.to_string().contains("the device was lost"), "{error}");
    run::run(&scene, &options("parts", true), &mut go_on).expect("it goes on");
    for frame in 0..=12 {
        let bytes = |run: &str| {
            std::fs::read(folder.path().join(format!("{run}/frames/{frame:06}.ply"))).expect("a frame")
        };
        assert!(bytes("whole") == bytes("parts"), "frame {frame}");
    }
}
