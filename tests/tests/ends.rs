//! The end of a call on a device: its contacts are those that a search on the CPU finds, and a state that
//! intersects is never accepted.

use bowknot::check::StateOptions;
use bowknot::gpu::{Device, Engine, GpuError, GpuResolveError, TwinEngine, resolve_on};
use bowknot::run::{self, Backends, Progress, RunOptions};
use bowknot::simulator::{BackendError, CollisionBackend};
use bowknot::{Scene, SimulationError, Simulator};
use bowknot_geometry::{PairKind, Point};
use bowknot_gpu::{BufferId, Recording};
use bowknot_twoway::{
    CallEnd, CollisionScene, ContactSet, Observer, PairMultipliers, ResolveInput, Resolver, Statistics,
};
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, PoisonError};

/// What a broken driver does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// The list of pairs in range is empty.
    NoPairs,
    /// It has pairs that the scene does not have.
    WrongPairs,
    /// After so many calls two vertices are exchanged where a call ends.
    Exchanged(usize, [usize; 2]),
}

/// The twins with a fault.
#[derive(Debug)]
struct Faulty {
    engine: TwinEngine,
    fault: Fault,
    control: Option<BufferId>,
    near: Option<BufferId>,
    positions: Option<BufferId>,
    ends: usize,
}

impl Faulty {
    /// Word of the number of pairs in `Control`.
    const COUNT: usize = 14;

    fn new(fault: Fault) -> Self {
        Self { engine: TwinEngine::new(), fault, control: None, near: None, positions: None, ends: 0 }
    }
}

impl Engine for Faulty {
    fn buffer(&mut self, label: &'static str, words: usize) -> Result<BufferId, GpuError> {
        let buffer = self.engine.buffer(label, words)?;
        match label {
            "control at the end" => self.control = Some(buffer),
            "pairs in range" => self.near = Some(buffer),
            "positions" => self.positions = Some(buffer),
            _ => {}
        }
        Ok(buffer)
    }

    fn free(&mut self, buffer: BufferId) {
        self.engine.free(buffer);
    }

    fn clear(&mut self) {
        self.engine.clear();
    }

    fn words(&self, buffer: BufferId) -> usize {
        self.engine.words(buffer)
    }

    fn run(&mut self, recording: &Recording, read: &[(BufferId, usize)]) -> Result<Vec<Vec<u32>>, GpuError> {
        let mut all = self.engine.run(recording, read)?;
        let place = |wanted: Option<BufferId>| read.iter().position(|(buffer, _)| Some(*buffer) == wanted);
        let Some(near) = place(self.near) else { return Ok(all) };
        self.ends += 1;
        match self.fault {
            Fault::None => {}
            Fault::NoPairs => {
                if let Some(control) = place(self.control) {
                    all[control][Self::COUNT] = 0;
                }
            }
            Fault::WrongPairs => all[near].fill(u32::MAX),
            Fault::Exchanged(calls, vertices) if self.ends > calls => {
                if let Some(positions) = place(self.positions) {
                    (0..4).for_each(|k| all[positions].swap(4 * vertices[0] + k, 4 * vertices[1] + k));
                }
            }
            Fault::Exchanged(..) => {}
        }
        Ok(all)
    }
}

/// What was compared.
#[derive(Clone, Copy, Debug, Default)]
struct Compared {
    calls: usize,
    pairs: [usize; 5],
    /// Pairs whose rows press.
    pressing: usize,
    /// Calls with bodies asleep.
    asleep: usize,
    /// Calls after which a search finds other contacts.
    differing: usize,
}

/// A device whose contacts are compared with those of a search after each call.
#[derive(Debug)]
struct Comparing {
    device: Device<Faulty>,
    compared: Arc<Mutex<Compared>>,
    bodies: Option<usize>,
}

/// All of it, with the bits of the numbers.
fn described(contacts: &ContactSet) -> String {
    let ContactSet {
        pairs,
        separations,
        deltas,
        min_separations,
        multipliers,
        frictions,
        friction_multipliers,
    } = contacts;
    let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let separations: Vec<Vec<u64>> = separations
        .iter()
        .map(|s| bits(&[s.normal.as_slice(), &s.weights, &[s.distance, s.width]].concat()))
        .collect();
    let vectors: Vec<u64> = friction_multipliers.iter().flat_map(|f| bits(f.as_slice())).collect();
    let numbers = [deltas, min_separations, multipliers, frictions].map(|list| bits(list));
    format!("{pairs:?} {separations:?} {numbers:?} {vectors:?}")
}

/// What the contacts carry, in another order.
fn carried(contacts: &ContactSet) -> Vec<PairMultipliers> {
    let all = (0..contacts.pairs.len()).rev().map(|p| PairMultipliers {
        kind: contacts.pairs.kind(p),
        elements: contacts.pairs.pairs()[p].elements,
        normal: contacts.multipliers[p],
        friction: contacts.friction_multipliers.get(p).copied().unwrap_or_default(),
    });
    all.filter(|pair| pair.normal > 0.0).collect()
}

impl CollisionBackend for Comparing {
    fn name(&self) -> String {
        CollisionBackend::name(&self.device)
    }

    fn prepare(&mut self, scene: &CollisionScene, home: &[Point]) -> Result<(), BackendError> {
        CollisionBackend::prepare(&mut self.device, scene, home)
    }

    fn is_ordered(&self) -> bool {
        self.device.is_ordered()
    }

    fn order(&mut self, positions: &[Point]) -> Result<(), BackendError> {
        CollisionBackend::order(&mut self.device, positions)
    }

    fn resolution(&self) -> f64 {
        self.device.resolution()
    }

    fn resolve(
        &mut self,
        resolver: &mut Resolver,
        positions: &mut [Point],
        target: &[Point],
        input: &ResolveInput<'_>,
        observer: &mut dyn Observer,
    ) -> Result<Statistics, BackendError> {
        let statistics = self.device.resolve(resolver, positions, target, input, observer)?;
        let state = resolver.state().clone();
        let contacts = carried(&state.contacts);
        let end = CallEnd {
            start: &state.start,
            positions: &state.x,
            target: &state.target,
            aims: &state.y,
            contacts: &contacts,
            near: None,
        };
        let mut searched = Statistics { steps: state.step, ..Statistics::default() };
        resolver.adopt(&end, state.call.clone(), &mut searched).map_err(BackendError::Refused)?;
        let mut compared = self.compared.lock().unwrap_or_else(PoisonError::into_inner);
        compared.calls += 1;
        for kind in PairKind::ALL {
            compared.pairs[kind as usize] += state.contacts.pairs.range(kind).len();
        }
        compared.pressing += contacts.len();
        let obstacles = resolver.scene().model().bodies().iter().filter(|body| body.obstacle).count();
        compared.asleep += usize::from(obstacles > *self.bodies.get_or_insert(obstacles));
        let numbers = |s: &Statistics| [s.remaining_m, s.injected_j, s.distance_to_target_m];
        compared.differing += usize::from(
            described(&state.contacts) != described(&resolver.state().contacts)
                || statistics.min_gap_m != searched.min_gap_m
                || numbers(&statistics) != numbers(&searched),
        );
        Ok(statistics)
    }

    fn judge(&mut self, scene: &CollisionScene, positions: &[Point]) -> Result<(), BackendError> {
        CollisionBackend::judge(&mut self.device, scene, positions)
    }
}

fn compared(scene: &Scene, time_steps: usize, fault: Fault) -> Compared {
    let compared = Arc::default();
    let device = Device::new("faulty twins".to_owned(), Faulty::new(fault));
    let backend = Comparing { device, compared: Arc::clone(&compared), bodies: None };
    let mut simulator = Simulator::new(scene).expect("a simulator");
    simulator.set_backend(Box::new(backend)).expect("settings that the kernels have");
    for _ in 0..time_steps {
        simulator.step().expect("a step");
    }
    *compared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Everything that collides, on a ground and around a ball: sheets of which two do not meet, with and without
/// a thickness, strands, and grains on them. One sheet falls asleep before another falls on it.
const EVERYTHING: &str = r#"
[simulation]
dt = 0.01
[solver.sleep]
enabled = true
distance = 0.5
time = 0.05
[contact]
delta = 0.004
[[obstacle]]
name = "ground"
shape = { type = "half-space" }
friction = 0.5
thickness = 0.001
[[obstacle]]
name = "ball"
shape = { type = "ball", radius = 0.05, edge = 0.03 }
translate = [0, 0, 0.03]
friction = 0.3
[[body]]
name = "asleep"
shape = { type = "sheet", edge = 0.05, size = [0.2, 0.2] }
translate = [-0.4, 0, 0.0042]
friction = 0.5
[[body]]
name = "late"
shape = { type = "sheet", edge = 0.04, size = [0.1, 0.1] }
translate = [-0.38, 0.01, 0.4]
[[body]]
name = "mat"
shape = { type = "sheet", edge = 0.05, size = [0.2, 0.2] }
translate = [0.3, 0, 0.0045]
friction = 0.5
[[body]]
name = "low"
shape = { type = "sheet", edge = 0.03, size = [0.15, 0.15] }
translate = [0, 0, 0.09]
thickness = 0.002
groups = [1]
collides_with = [0, 1]
friction = 0.4
[[body]]
name = "high"
shape = { type = "sheet", edge = 0.04, size = [0.16, 0.16] }
translate = [0.01, 0.01, 0.1]
groups = [2]
collides_with = [0, 2]
friction = 0.4
[[body]]
name = "hair"
kind = "strands"
shape = { type = "strands", count = 6, length = 0.12 }
translate = [0.3, 0, 0.14]
[[body]]
name = "grains"
kind = "particles"
material = { base = "sand", radius = 0.004 }
shape = { type = "grains", count = [4, 4, 2], spacing = 0.009 }
translate = [0.29, -0.01, 0.15]
friction = 0.5
"#;

#[test]
fn contacts_at_the_end_of_a_call_are_those_that_a_search_finds() {
    let everything = Scene::from_toml(EVERYTHING, std::path::Path::new(".")).expect("a scene");
    let builtin = |name: &str, scale: f64| Scene::builtin(name, scale).expect("a scene");
    let (mut pairs, mut pressing, mut asleep) = ([0; 5], 0, 0);
    for (name, scene, time_steps) in [
        ("everything", everything, 44),
        ("stack", builtin("stack", 0.12), 30),
        ("sand", builtin("sand", 0.05), 30),
        ("hair", builtin("hair", 0.05), 8),
        ("needle", builtin("needle", 0.12), 10),
    ] {
        let compared = compared(&scene, time_steps, Fault::None);
        println!("{name}: {compared:?}");
        assert!(compared.calls >= time_steps && compared.differing == 0, "{name}: {compared:?}");
        (0..5).for_each(|k| pairs[k] += compared.pairs[k]);
        pressing += compared.pressing;
        asleep += compared.asleep;
    }
    assert!(pairs.iter().all(|count| *count > 1000) && pressing > 1000 && asleep > 0, "{pairs:?}, {asleep}");
}

/// The list of the device is what counts, and a search takes its place if it makes no sense.
#[test]
fn a_device_that_lists_wrong_pairs_is_found_out() {
    let scene = Scene::builtin("sand", 0.05).expect("a scene");
    let missing = compared(&scene, 12, Fault::NoPairs);
    assert!(missing.pairs == [0; 5] && missing.differing > 0, "{missing:?}");
    let wrong = compared(&scene, 12, Fault::WrongPairs);
    assert!(wrong.pairs != [0; 5] && wrong.differing == 0, "{wrong:?}");
}

/// A sheet falls on a ball; after a while the device exchanges a corner and the middle of it.
#[test]
fn a_state_of_a_device_that_intersects_is_never_accepted() {
    let folder = tempfile::tempdir().expect("a folder");
    let sets = ["simulation.frames=16".to_owned(), "body.0.velocity=[0,0,-4]".to_owned()];
    let scene = Scene::builtin("drape", 0.25).and_then(|scene| scene.with_sets(&sets)).expect("a scene");
    let sheet = Simulator::new(&scene).expect("a simulator").world().bodies[0].vertices.clone();
    let exchanged = [sheet.start, (sheet.start + sheet.end) / 2].map(|v| v as usize);
    let options =
        |resume: bool| RunOptions { out: folder.path().join("run"), resume, ..RunOptions::default() };
    let mut go_on = |_: &Progress<'_>| ControlFlow::Continue(());
    let device = Device::new("faulty twins".to_owned(), Faulty::new(Fault::Exchanged(20, exchanged)));
    let backends = Backends { collisions: Box::new(device), ..Backends::default() };
    let error = run::run_on(&scene, &options(false), backends, &mut go_on).expect_err("it intersects");
    let SimulationError::Backend { step, source } = &error else { panic!("{error}") };
    assert!((4..16).contains(step), "{step}");
    let cause = source.downcast_ref::<GpuResolveError>();
    assert!(matches!(cause, Some(GpuResolveError::Intersects { count: 1.., .. })), "{error}");
    let frame = |k: usize| folder.path().join(format!("run/frames/{k:06}.ply"));
    assert!(frame(step - 1).exists() && !frame(*step).exists(), "{step}");
    // The CPU goes on from the last sound state.
    run::run(&scene, &options(true), &mut go_on).expect("it goes on");
    assert!(frame(16).exists());
}

#[test]
fn a_problem_whose_solution_intersects_is_refused() {
    let scene = Scene::builtin("drape", 0.25).expect("a scene");
    let simulator = Simulator::new(&scene).expect("a simulator");
    let world = simulator.world();
    let start = &simulator.positions()[..world.collision_vertices()];
    let vertices = &world.bodies[0].vertices;
    let sheet = vertices.start as usize..vertices.end as usize;
    let mut target = start.to_vec();
    target[sheet.clone()].iter_mut().for_each(|y| y.z -= 0.1);
    let model = simulator.dynamics_model();
    let (rest, masses) = (&model.rest_positions()[..start.len()], &model.masses()[..start.len()]);
    for (fault, is_sound) in [(Fault::None, true), (Fault::Exchanged(0, [sheet.start, sheet.end - 1]), false)]
    {
        let mut resolver =
            Resolver::new(world.collision.clone(), rest, masses, scene.twoway()).expect("a resolver");
        let mut x = start.to_vec();
        let input = ResolveInput { max_steps: Some(6), ..ResolveInput::default() };
        let result = resolve_on(Faulty::new(fault), &mut resolver, &mut x, &target, &input, &mut ());
        if is_sound {
            result.expect("a solution");
            let options = StateOptions { limit: 1, distance: false };
            assert!(x != start && simulator.judge().check_state(&x, &options).expect("a report").is_clear());
        } else {
            assert!(matches!(result, Err(GpuResolveError::Intersects { .. })), "{result:?}");
            assert!(x == start);
        }
    }
}
