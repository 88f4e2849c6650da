use super::scene;
use bowknot::check::StateOptions;
use bowknot::geometry::{Point, Vector};
use bowknot::{Scene, Simulator, StepStatistics};

/// Bodies fall asleep soon, so that tests take few time steps.
const SLEEP: &str = "[solver.sleep]\nenabled = true\ntime = 0.1\n";

const GROUND: &str = "[[obstacle]]\nname = \"ground\"\nshape = { type = \"half-space\" }\nfriction = 0.5\n";

/// Two blocks of jelly and a sheet on each other, at a place along x.
fn pile(name: &str, x: f64) -> String {
    let block = |part: &str, z: f64| {
        format!(
            "[[body]]\nname = \"{name}-{part}\"\nkind = \"solid\"\nfriction = 0.5\n\
             shape = {{ type = \"block\", size = [0.1, 0.1, 0.1], edge = 0.05 }}\ntranslate = [{x}, 0, {z}]\n"
        )
    };
    format!(
        "{}{}[[body]]\nname = \"{name}-sheet\"\nfriction = 0.5\n\
         shape = {{ type = \"sheet\", size = [0.08, 0.08], edge = 0.02 }}\ntranslate = [{x}, 0, 0.215]\n",
        block("low", 0.055),
        block("high", 0.16)
    )
}

/// Two piles and a block above the first, which a pin holds for a second.
fn piles() -> Scene {
    scene(&format!(
        "{SLEEP}{}{}[[body]]\nname = \"falling\"\nkind = \"solid\"\nfriction = 0.5\n\
         shape = {{ type = \"block\", size = [0.06, 0.06, 0.06], edge = 0.03 }}\ntranslate = [0, 0, 0.4]\n\
         [[pin]]\nbody = \"falling\"\nside = \"z-max\"\nend = 1.0\n{GROUND}",
        pile("first", 0.0),
        pile("second", 0.3)
    ))
}

fn bits(points: &[Point]) -> Vec<[u64; 3]> {
    points.iter().map(|p| [p.x, p.y, p.z].map(f64::to_bits)).collect()
}

fn step(simulator: &mut Simulator) -> StepStatistics {
    let statistics = simulator.step().unwrap_or_else(|error| panic!("{error}"));
    let world = simulator.world();
    let options = StateOptions { limit: 3, distance: false };
    let positions = &simulator.positions()[..world.collision_vertices()];
    let report = simulator.judge().check_state(positions, &options).expect("finite positions");
    assert!(report.is_clear(), "time step {}: {:?}", statistics.step, report.intersections);
    assert_eq!(statistics.asleep_vertices > 0, simulator.asleep().contains(&true));
    statistics
}

/// Steps until all `bodies` sleep; returns the last statistics.
fn rest(simulator: &mut Simulator, bodies: &[usize]) -> StepStatistics {
    for _ in 0..300 {
        let statistics = step(simulator);
        if bodies.iter().all(|&body| simulator.asleep()[body]) {
            return statistics;
        }
    }
    panic!("still awake after 300 time steps: {:?}, max speed", simulator.asleep());
}

/// Steps until a body is awake; returns the number of steps.
fn wakes(simulator: &mut Simulator, body: usize) -> usize {
    let steps = (1..200).find(|_| {
        step(simulator);
        !simulator.asleep()[body]
    });
    steps.unwrap_or_else(|| panic!("body {body} still sleeps"))
}

const FIRST: [usize; 3] = [0, 1, 2];
const SECOND: [usize; 3] = [3, 4, 5];
const FALLING: usize = 6;

#[test]
fn a_pile_at_rest_sleeps_and_takes_no_work() {
    let mut simulator = Simulator::new(&piles()).expect("a simulator");
    rest(&mut simulator, &[0, 1, 2, 3, 4, 5, 6]);
    let (start, anchors) = (simulator.positions().to_vec(), simulator.checkpoint());
    assert_eq!(simulator.velocities(), vec![Vector::zeros(); start.len()]);
    assert!(anchors.contacts.forces.iter().any(|c| c.force.norm() > 0.01), "forces of the pile are kept");
    let first = step(&mut simulator);
    for _ in 0..20 {
        let now = step(&mut simulator);
        assert_eq!(now.asleep_vertices, start.len());
        // No dynamics, no search, no pair, no row.
        let counts = [now.newton_iterations, now.cg_iterations, now.two_way_steps, now.searches];
        assert_eq!(counts, [0; 4]);
        assert_eq!([now.pairs, now.contact_rows, now.active_rows, now.interior_solves], [0; 4]);
        let measures = |s: &StepStatistics| (s.energy, s.momentum, s.center_of_mass, s.max_stretch);
        assert_eq!(measures(&now), measures(&first));
    }
    assert_eq!(bits(simulator.positions()), bits(&start));
}

#[test]
fn measures_count_bodies_asleep() {
    let mut simulator = Simulator::new(&piles()).expect("a simulator");
    let asleep = rest(&mut simulator, &[0, 1, 2, 3, 4, 5, 6]);
    let awake = Simulator::new(&piles().with_sets(&["solver.sleep.enabled=false"]).expect("a key"));
    let mut awake = awake.expect("a simulator");
    awake.restore(&simulator.checkpoint()).expect("the same scene");
    assert!(awake.asleep().is_empty());
    let model = awake.dynamics_model();
    let elastic = model.elastic_energy(simulator.positions());
    assert!((asleep.energy.elastic / elastic - 1.0).abs() < 1e-9, "{} {elastic}", asleep.energy.elastic);
    assert!((asleep.max_stretch - model.max_stretch(simulator.positions())).abs() < 1e-12);
    let weight = 9.81 * model.total_mass() * asleep.center_of_mass[2];
    assert!((asleep.energy.potential / weight - 1.0).abs() < 1e-9, "{} {weight}", asleep.energy.potential);
    assert_eq!(asleep.energy.kinetic, 0.0);
}

#[test]
fn a_pin_that_lets_go_and_a_body_that_comes_near_wake_islands() {
    let mut simulator = Simulator::new(&piles()).expect("a simulator");
    rest(&mut simulator, &[0, 1, 2, 3, 4, 5, 6]);
    wakes(&mut simulator, FALLING);
    assert_eq!(simulator.step_index(), 101, "the pin holds until 1 s");
    assert!(simulator.asleep()[..FALLING].iter().all(|asleep| *asleep));
    // In flight only the block is at work: the piles are no part of pairs or rows.
    let flight = step(&mut simulator);
    assert_eq!((flight.contact_rows, flight.pairs), (0, 0));
    assert!(flight.newton_iterations > 0);
    wakes(&mut simulator, FIRST[2]);
    let asleep = simulator.asleep().to_vec();
    assert!(FIRST.iter().all(|&body| !asleep[body]), "an island wakes as one: {asleep:?}");
    assert!(SECOND.iter().all(|&body| asleep[body]), "the other pile sleeps on: {asleep:?}");
    let second = simulator.world().bodies[SECOND[0]].vertices.start as usize;
    let before = simulator.positions()[second];
    (0..20).for_each(|_| drop(step(&mut simulator)));
    assert!(SECOND.iter().all(|&body| simulator.asleep()[body]));
    assert_eq!(simulator.positions()[second], before);
}

/// What wakes in time is hit as if it had never slept. The block is so fast that it would first touch the
/// pile in the time step of the impact, which would then be one on an unyielding obstacle.
#[test]
fn a_pile_that_was_asleep_yields_like_one_that_was_awake() {
    const THROWN: usize = 3;
    let thrown = scene(&format!(
        "{SLEEP}{}[[body]]\nname = \"thrown\"\nkind = \"solid\"\nfriction = 0.5\nvelocity = [0, 0, -12]\n\
         shape = {{ type = \"block\", size = [0.06, 0.06, 0.06], edge = 0.03 }}\ntranslate = [0, 0, \
         4]\n{GROUND}",
        pile("first", 0.0),
    ));
    let mut asleep = Simulator::new(&thrown).expect("a simulator");
    rest(&mut asleep, &FIRST);
    let before = loop {
        let before = asleep.checkpoint();
        step(&mut asleep);
        if !asleep.asleep()[0] {
            break before;
        }
    };
    let never = thrown.with_sets(&["solver.sleep.enabled=false"]).expect("a key");
    let mut awake = Simulator::new(&never).expect("a simulator");
    awake.restore(&before).expect("the same scene");
    step(&mut awake);
    (0..3).for_each(|_| [&mut asleep, &mut awake].into_iter().for_each(|s| drop(step(s))));
    let thrown = awake.world().bodies[THROWN].vertices.start as usize;
    assert!(awake.velocities()[thrown].norm() < 3.0, "the pile has stopped it");
    assert_eq!(bits(asleep.positions()), bits(awake.positions()));
    assert_eq!(asleep.velocities(), awake.velocities());
}

/// The state of sleep is part of a checkpoint: asleep, in flight, and after waking.
#[test]
fn a_resumed_run_sleeps_and_wakes_to_the_same_bits() {
    let mut simulator = Simulator::new(&piles()).expect("a simulator");
    let mut checkpoints = Vec::new();
    for index in 1..=125 {
        step(&mut simulator);
        if [4, 14, 60, 103, 116, 119].contains(&index) {
            checkpoints.push(simulator.checkpoint());
        }
    }
    let kinds: Vec<usize> = checkpoints
        .iter()
        .map(|c| {
            c.sleep.islands.iter().filter(|island| **island != bowknot::simulator::SleepState::AWAKE).count()
        })
        .collect();
    assert!(
        kinds.contains(&0) && kinds.contains(&7) && kinds.contains(&6) && kinds.contains(&3),
        "{kinds:?}"
    );
    for checkpoint in &checkpoints {
        let mut resumed = Simulator::new(&piles()).expect("a simulator");
        resumed.restore(checkpoint).expect("a checkpoint");
        assert_eq!(resumed.checkpoint(), *checkpoint);
        while resumed.step_index() < 125 {
            step(&mut resumed);
        }
        assert_eq!(bits(resumed.positions()), bits(simulator.positions()), "from {}", checkpoint.step);
        assert_eq!(resumed.checkpoint(), simulator.checkpoint());
    }
    // A checkpoint of other bodies is refused, and the simulator stays as it was.
    let before = simulator.checkpoint();
    let mut wrong = before.clone();
    wrong.sleep.islands[0] = 99;
    assert!(simulator.restore(&wrong).is_err());
    assert_eq!(simulator.checkpoint(), before);
}

#[test]
fn sleep_does_not_depend_on_the_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut simulator = Simulator::new(&piles()).expect("a simulator");
            (0..122).for_each(|_| drop(step(&mut simulator)));
            simulator.checkpoint()
        })
    };
    assert_eq!(run(1), run(3));
}

/// A sheet that hangs from two corners, at rest in still air.
fn hanging() -> Scene {
    scene(&format!(
        "{SLEEP}[simulation]\nair_density = 1.2\n\
         [[body]]\nname = \"sheet\"\nshape = {{ type = \"sheet\", size = [0.2, 0.2], edge = 0.05 }}\n\
         rotate = [90, 0, 0]\n[[pin]]\nside = \"z-max\"\n"
    ))
}

#[test]
fn wind_and_forces_wake() {
    let mut simulator = Simulator::new(&hanging()).expect("a simulator");
    rest(&mut simulator, &[0]);
    let still = simulator.positions().to_vec();
    simulator.set_wind(Vector::zeros()).expect("finite");
    assert_eq!(step(&mut simulator).asleep_vertices, still.len(), "no change, no waking");
    simulator.set_wind(Vector::new(0.0, 6.0, 0.0)).expect("finite");
    (0..10).for_each(|_| drop(step(&mut simulator)));
    let moved = |simulator: &Simulator| {
        simulator.positions().iter().zip(&still).map(|(x, x0)| x.y - x0.y).fold(0.0, f64::max)
    };
    assert!(!simulator.asleep()[0] && moved(&simulator) > 0.01, "{}", moved(&simulator));

    // A weak force for many time steps moves it too: at first by less than what counts as rest.
    let mut simulator = Simulator::new(&hanging()).expect("a simulator");
    rest(&mut simulator, &[0]);
    let forces = vec![Vector::new(0.0, 1e-3, 0.0); still.len()];
    simulator.set_external_forces(&forces).expect("one per vertex");
    (0..20).for_each(|_| drop(step(&mut simulator)));
    assert!(moved(&simulator) > 0.01, "{}", moved(&simulator));
    assert!(simulator.set_external_forces(&forces[1..]).is_err());
}

#[test]
fn forces_wake_only_the_bodies_on_which_they_change() {
    let mut simulator = Simulator::new(&piles()).expect("a simulator");
    rest(&mut simulator, &[0, 1, 2, 3, 4, 5, 6]);
    let range = simulator.world().bodies[SECOND[2]].vertices.clone();
    let mut forces = vec![Vector::zeros(); simulator.positions().len()];
    forces[range.start as usize] = Vector::new(0.0, 0.0, 0.2);
    simulator.set_external_forces(&forces).expect("one per vertex");
    step(&mut simulator);
    assert_eq!(simulator.asleep(), [true, true, true, false, false, false, true]);
}

/// Two obstacles never form a pair, and a body asleep is one: an obstacle that moves must wake it before it
/// gets there, at any speed. Each state is judged by exact predicates.
#[test]
fn an_obstacle_that_moves_wakes_what_is_in_its_way() {
    for (speed, height) in [(0.2, 0.1), (3.0, 0.1), (60.0, 0.1), (60.0, 0.6)] {
        let arrival = 1.0 + 0.4 / speed;
        let plough = format!(
            "{SLEEP}{}[[obstacle]]\nname = \"plough\"\nshape = {{ type = \"box\", size = [0.02, 0.3, 0.1] \
             }}\n\
             translate = [-0.5, 0, {height}]\nmotion = {{ keyframes = [{{ time = 1.0, translate = [0, 0, 0] \
             }}, {{ time = {}, translate = [{}, 0, 0] }}] }}\n{GROUND}",
            pile("first", 0.0),
            1.0 + 1.0 / speed,
            1.0,
        );
        let mut simulator = Simulator::new(&scene(&plough)).expect("a simulator");
        rest(&mut simulator, &FIRST);
        let steps = (1.3 / 0.01_f64).max((arrival + 0.3) / 0.01) as usize;
        let mut woken = false;
        while simulator.step_index() < steps {
            step(&mut simulator);
            woken |= !simulator.asleep()[0];
        }
        assert_eq!(woken, height < 0.5, "at {speed} m/s and a height of {height} m");
    }
}

/// With two stages in a time step an obstacle is led to two places, so it may come by and be back at its end.
#[test]
fn an_obstacle_that_is_back_at_the_end_of_a_time_step_wakes_what_it_meets() {
    let plough = format!(
        "{SLEEP}{}[[obstacle]]\nname = \"plough\"\nshape = {{ type = \"box\", size = [0.02, 0.3, 0.1] }}\n\
         translate = [-0.5, 0, 0.1]\nmotion = {{ keyframes = [{{ time = 2.0, translate = [0, 0, 0] }}, \
         {{ time = 2.003, translate = [1, 0, 0] }}, {{ time = 2.01, translate = [0, 0, 0] }}] }}\n{GROUND}",
        pile("first", 0.0),
    );
    for (integrator, meets) in [("implicit-euler", false), ("sdirk2", true)] {
        let sets = [format!("simulation.integrator={integrator}")];
        let scene = scene(&plough).with_sets(&sets).expect("sound keys");
        let mut simulator = Simulator::new(&scene).expect("a simulator");
        rest(&mut simulator, &FIRST);
        assert!(simulator.step_index() < 200, "asleep before the plough comes");
        while simulator.step_index() < 201 {
            step(&mut simulator);
        }
        assert_eq!(!simulator.asleep()[0], meets, "{integrator}");
    }
}

#[test]
fn what_nothing_holds_does_not_sleep() {
    let text = format!(
        "{SLEEP}[simulation]\ngravity = [0, 0, 0]\n[[body]]\nname = \"drifting\"\nvelocity = [1e-4, 0, 0]\n\
         shape = {{ type = \"sheet\", size = [0.2, 0.2], edge = 0.05 }}\n"
    );
    let mut simulator = Simulator::new(&scene(&text)).expect("a simulator");
    let start = simulator.positions()[0].x;
    (0..100).for_each(|_| drop(step(&mut simulator)));
    assert_eq!(simulator.asleep(), [false]);
    assert!((simulator.positions()[0].x - start - 1e-4).abs() < 1e-9);
}

#[test]
fn without_the_key_nothing_sleeps() {
    let scene = piles().with_sets(&["solver.sleep.enabled=false"]).expect("a key");
    let mut simulator = Simulator::new(&scene).expect("a simulator");
    (0..40).for_each(|_| drop(step(&mut simulator)));
    assert!(simulator.asleep().is_empty());
    assert_eq!(simulator.checkpoint().sleep, bowknot::simulator::SleepState::default());
}
