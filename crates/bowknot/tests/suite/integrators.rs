//! Time steps of second order: theory, impacts, rest, and what a simulator promises for any integrator.

use super::scene;
use bowknot::check::{PathOptions, StateOptions};
use bowknot::geometry::{Point, Vector};
use bowknot::simulator::{AcceptedStep, SimulationError};
use bowknot::{Scene, SimulationObserver, Simulator, StepStatistics};
use std::ops::ControlFlow;

const INTEGRATORS: [&str; 2] = ["implicit-euler", "sdirk2"];

fn with(text: &str, integrator: &str) -> Scene {
    scene(text).with_sets(&[format!("simulation.integrator={integrator}")]).expect("sound keys")
}

fn simulator(text: &str, integrator: &str) -> Simulator {
    Simulator::new(&with(text, integrator)).unwrap_or_else(|error| panic!("{error}"))
}

fn run(simulator: &mut Simulator, steps: usize) -> Vec<StepStatistics> {
    (0..steps).map(|_| simulator.step().unwrap_or_else(|error| panic!("{error}"))).collect()
}

fn bits(simulator: &Simulator) -> Vec<[u64; 6]> {
    let state = simulator.positions().iter().zip(simulator.velocities());
    state.map(|(x, v)| [x.x, x.y, x.z, v.x, v.y, v.z].map(f64::to_bits)).collect()
}

fn energy(statistics: &StepStatistics) -> f64 {
    let energy = &statistics.energy;
    energy.kinetic + energy.elastic + energy.potential
}

#[test]
fn a_sheet_falls_by_galileos_law() {
    let text = "[[body]]\nname = \"sheet\"\nshape = { type = \"sheet\", size = [0.4, 0.4], edge = 0.1 }\n\
                translate = [0, 0, 1]\n";
    let mut simulator = simulator(text, "sdirk2");
    let start = simulator.positions().to_vec();
    run(&mut simulator, 20);
    let (t, g) = (0.2, Vector::new(0.0, 0.0, -9.81));
    for ((x, v), start) in simulator.positions().iter().zip(simulator.velocities()).zip(&start) {
        assert!((x - (start + g * (0.5 * t * t))).norm() < 1e-9, "{x}");
        assert!((v - g * t).norm() < 1e-9, "{v}");
    }
}

/// Kinetic energies before and after two cubes of jelly meet at 1 m/s; their energy never grows.
fn met(integrator: &str) -> [f64; 2] {
    let cube = |name: &str, place: &str, speed: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\nkind = \"solid\"\nmaterial = {{ density = 400.0, young_modulus = 60000.0 }}\n\
             shape = {{ type = \"block\", size = [0.16, 0.16, 0.16], edge = 0.04 }}\ntranslate = {place}\n\
             velocity = [{speed:?}, 0, 0]\n"
        )
    };
    let text = format!(
        "[simulation]\ndt = 0.005\ngravity = [0, 0, 0]\n{}{}",
        cube("left", "[-0.09, 0, 0]", 0.5),
        cube("right", "[0.09, 0.001, 0.002]", -0.5)
    );
    let mut simulator = simulator(&text, integrator);
    let mut last = f64::INFINITY;
    let statistics = run(&mut simulator, 30);
    for statistics in &statistics {
        let now = energy(statistics);
        // Contacts store energy that is not counted.
        assert!(now <= last * 1.001, "{integrator}, time step {}: {last} J became {now} J", statistics.step);
        last = now;
    }
    [&statistics[0], &statistics[29]].map(|statistics| statistics.energy.kinetic)
}

#[test]
fn cubes_that_meet_keep_several_times_the_kinetic_energy_that_implicit_euler_leaves() {
    let [before, after] = met("sdirk2");
    assert!(after > 0.45 * before, "{after} J of {before} J");
    let [before, after] = met("implicit-euler");
    assert!(after < 0.15 * before, "{after} J of {before} J");
}

#[test]
fn a_block_slides_down_a_slope_by_coulombs_law() {
    let on_slope = |friction: f64| {
        let text = format!(
            "[[body]]\nname = \"block\"\nkind = \"solid\"\nmaterial = \"rubber\"\nfriction = {friction}\n\
             shape = {{ type = \"block\", size = [0.2, 0.2, 0.05], edge = 0.025 }}\n\
             rotate = [0, 21.801, 0]\ntranslate = [0.011, 0, 0.0275]\n\
             [[obstacle]]\nname = \"slope\"\nshape = \"half-space\"\nrotate = [0, 21.801, 0]\nfriction = \
             {friction}\n"
        );
        let mut simulator = simulator(&text, "sdirk2");
        let mass = simulator.dynamics_model().total_mass();
        let statistics = run(&mut simulator, 100);
        [49, 99].map(|step: usize| Vector::from(statistics[step].momentum).norm() / mass)
    };
    let [_, stuck] = on_slope(0.5);
    assert!(stuck < 1e-6, "{stuck} m/s");
    let [before, after] = on_slope(0.3);
    // tan 21.801 = 0.4.
    let expected = 9.81 * (0.4 - 0.3) / f64::hypot(1.0, 0.4);
    let acceleration = (after - before) / 0.5;
    assert!((acceleration - expected).abs() < 0.01 * expected, "{acceleration} instead of {expected} m/s2");
}

const RUBBER: &str = "[[obstacle]]\nname = \"ground\"\nshape = \"half-space\"\nfriction = 0.5\n";

#[test]
fn a_stack_at_rest_stays_at_rest() {
    let block = |name: &str, place: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nkind = \"solid\"\nmaterial = \"rubber\"\nfriction = 0.5\n\
             shape = {{ type = \"block\", size = [0.1, 0.1, 0.05], edge = 0.025 }}\ntranslate = {place}\n"
        )
    };
    let text = format!(
        "[solver.sleep]\nenabled = false\n{}{}{}{RUBBER}",
        block("low", "[0, 0, 0.0285]"),
        block("middle", "[0.01, 0.005, 0.082]"),
        block("high", "[0, -0.01, 0.1355]")
    );
    let mut simulator = simulator(&text, "sdirk2");
    let statistics = run(&mut simulator, 300);
    let (settled, last) = (&statistics[199], &statistics[299]);
    assert!(statistics[200..].iter().all(|s| s.max_speed < 1e-3), "{}", last.max_speed);
    assert!((energy(last) - energy(settled)).abs() < 1e-6, "{} {}", energy(last), energy(settled));
    assert!(statistics[100..].iter().all(|s| s.solved));
}

/// Cloth, a solid, strands and grains in contact, with a pin that moves.
const MIXED: &str = r#"
[[body]]
name = "sheet"
shape = { type = "sheet", size = [0.3, 0.3], edge = 0.05 }
translate = [0, 0, 0.13]
friction = 0.3

[[body]]
name = "cube"
kind = "solid"
material = "jelly"
shape = { type = "block", size = [0.1, 0.1, 0.1], edge = 0.05 }
translate = [0, 0, 0.06]
friction = 0.3

[[body]]
name = "grains"
kind = "particles"
shape = { type = "grains", count = [3, 3, 1], spacing = 0.03 }
material = { base = "gravel", radius = 0.01 }
translate = [0.0, 0.0, 0.17]
friction = 0.3

[[pin]]
body = "sheet"
side = "x-min"
motion = { keyframes = [{ time = 0, translate = [0, 0, 0] }, { time = 1, translate = [0.1, 0, 0.3] }] }

[[obstacle]]
name = "ground"
shape = "half-space"
friction = 0.3
"#;

#[test]
fn a_resumed_run_and_any_number_of_threads_give_the_same_bits() {
    let mut whole = simulator(MIXED, "sdirk2");
    run(&mut whole, 12);
    let checkpoint = whole.checkpoint();
    run(&mut whole, 6);
    let mut resumed = simulator(MIXED, "sdirk2");
    resumed.restore(&checkpoint).expect("a checkpoint");
    run(&mut resumed, 6);
    assert_eq!(bits(&resumed), bits(&whole));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("a pool");
    let parallel = pool.install(|| {
        let mut simulator = simulator(MIXED, "sdirk2");
        run(&mut simulator, 18);
        bits(&simulator)
    });
    assert_eq!(parallel, bits(&whole));
}

/// Judges every state and path, and stops before the collision problem of this number.
struct Judged {
    judge: bowknot::check::Judge,
    problems_left: usize,
}

impl SimulationObserver for Judged {
    fn problem(&mut self, _problem: &bowknot::simulator::CollisionProblem<'_>) -> ControlFlow<()> {
        match self.problems_left.checked_sub(1) {
            Some(left) => {
                self.problems_left = left;
                ControlFlow::Continue(())
            }
            None => ControlFlow::Break(()),
        }
    }

    fn accepted(&mut self, accepted: &AcceptedStep<'_>) -> ControlFlow<()> {
        let x = accepted.state.positions;
        let state = self.judge.check_state(x, &StateOptions { distance: false, ..Default::default() });
        assert!(state.expect("judged").is_clear(), "time step {}", accepted.step);
        let path = self.judge.check_path(accepted.state.previous, x, &PathOptions::default());
        assert!(path.expect("judged").is_clear(), "on the way in time step {}", accepted.step);
        ControlFlow::Continue(())
    }
}

#[test]
fn a_time_step_that_is_stopped_in_any_stage_leaves_no_trace() {
    let (mut whole, mut stopped) = (simulator(MIXED, "sdirk2"), simulator(MIXED, "sdirk2"));
    let mut observer = Judged { judge: whole.judge(), problems_left: usize::MAX };
    for step in 0..15 {
        let statistics = whole.step_observed(&mut observer).unwrap_or_else(|error| panic!("{error}"));
        // The last problem belongs to the last stage.
        let last = statistics.newton_iterations - 1;
        for problems_left in [0, last] {
            let before = bits(&stopped);
            let mut observer = Judged { judge: stopped.judge(), problems_left };
            let result = stopped.step_observed(&mut observer);
            assert!(matches!(result, Err(SimulationError::Interrupted)), "time step {step}: {result:?}");
            assert_eq!(bits(&stopped), before);
        }
        stopped.step().unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(bits(&stopped), bits(&whole), "time step {step}");
    }
}

#[test]
fn pins_end_at_their_keyframes() {
    for integrator in INTEGRATORS {
        let mut simulator = simulator(MIXED, integrator);
        let pinned: Vec<usize> = simulator.world().pins[0].vertices.iter().map(|&v| v as usize).collect();
        let start: Vec<Point> = pinned.iter().map(|&v| simulator.positions()[v]).collect();
        run(&mut simulator, 10);
        for (&v, start) in pinned.iter().zip(&start) {
            let expected = start + Vector::new(0.1, 0.0, 0.3) * 0.1;
            assert!((simulator.positions()[v] - expected).norm() < 1e-12, "{integrator}");
            let error = simulator.velocities()[v] - Vector::new(0.1, 0.0, 0.3);
            assert!(error.norm() < 1e-9, "{integrator}: {error}");
        }
    }
}

#[test]
fn a_grain_that_rows_hold_presses_with_its_weight() {
    let text = "[[body]]\nname = \"grains\"\nkind = \"particles\"\ntranslate = [0, 0, 0.0105]\n\
                shape = { type = \"grains\", count = [1, 1, 1], spacing = 0.03 }\n\
                material = { base = \"gravel\", radius = 0.01, density = 2000 }\n\
                [[obstacle]]\nname = \"ground\"\nshape = \"half-space\"\n[solver.sleep]\nenabled = false\n";
    for integrator in INTEGRATORS {
        let mut simulator = simulator(text, integrator);
        run(&mut simulator, 50);
        let weight = 9.81 * 2000.0 * std::f64::consts::PI * 4.0 / 3.0 * 0.01_f64.powi(3);
        let share = simulator.contact_forces()[0].z / weight;
        assert!((share - 1.0).abs() < 0.01, "{integrator}: {share}");
    }
}

#[test]
fn what_a_program_leads_goes_at_a_constant_speed() {
    let text = "[[body]]\nname = \"sheet\"\nshape = { type = \"sheet\", size = [0.3, 0.3], edge = 0.1 }\n\
                [[pin]]\nbody = \"sheet\"\nside = \"x-min\"\n";
    let velocity = Vector::new(0.1, 0.0, 0.3);
    for integrator in INTEGRATORS {
        let mut simulator = simulator(text, integrator);
        let pinned: Vec<usize> = simulator.world().pins[0].vertices.iter().map(|&v| v as usize).collect();
        let start: Vec<Point> = pinned.iter().map(|&v| simulator.positions()[v]).collect();
        for step in 1..=10 {
            let targets: Vec<Point> = start.iter().map(|x| x + velocity * 0.01 * f64::from(step)).collect();
            simulator.set_pin_targets("pin[0] of sheet", &targets).expect("a pin");
            run(&mut simulator, 1);
            for &v in &pinned {
                let error = simulator.velocities()[v] - velocity;
                assert!(error.norm() < 1e-9, "{integrator}: {error}");
            }
        }
    }
}

#[test]
fn second_order_without_contact_forces_is_refused() {
    for set in
        ["contact.friction_model=filter", "solver.repulsion.law=quadratic", "solver.repulsion.stiffness=0"]
    {
        let refused = scene(MIXED).with_sets(&[set, "simulation.integrator=sdirk2"]);
        let error = refused.err().map(|error| error.to_string()).unwrap_or_default();
        assert!(
            error.contains("simulation.integrator") && error.contains("implicit-euler"),
            "{set}: {error}"
        );
    }
}
