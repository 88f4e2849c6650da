//! How long the host takes for the calls of a device, in seconds of the CPU: those of all threads, whatever else runs.

use bowknot::gpu::{Device, Engine, GpuError, TwinEngine};
use bowknot::simulator::{BackendError, CollisionBackend, cpu_seconds};
use bowknot::{Scene, Simulator};
use bowknot_geometry::Point;
use bowknot_gpu::{BufferId, Recording};
use bowknot_twoway::{CollisionScene, Observer, ResolveInput, Resolver, Statistics};
use std::sync::{Arc, Mutex, PoisonError};

/// Seconds of the CPU in the calls of a backend, and those of the engine in them.
#[derive(Clone, Copy, Debug, Default)]
struct Seconds {
    calls: usize,
    all: f64,
    engine: f64,
    /// Of judging.
    judge: f64,
}

/// Time steps that are measured.
const STEPS: usize = 2;

type Shared = Arc<Mutex<Seconds>>;

fn add(seconds: &Shared, to: impl FnOnce(&mut Seconds)) {
    to(&mut seconds.lock().unwrap_or_else(PoisonError::into_inner));
}

/// The twins with the seconds of their runs.
#[derive(Debug)]
struct TimedEngine {
    engine: TwinEngine,
    seconds: Shared,
}

impl Engine for TimedEngine {
    fn buffer(&mut self, label: &'static str, words: usize) -> Result<BufferId, GpuError> {
        self.engine.buffer(label, words)
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
        let start = cpu_seconds();
        let result = self.engine.run(recording, read);
        add(&self.seconds, |seconds| seconds.engine += cpu_seconds() - start);
        result
    }
}

/// A backend with the seconds of its calls.
#[derive(Debug)]
struct Timed {
    backend: Device<TimedEngine>,
    seconds: Shared,
}

impl CollisionBackend for Timed {
    fn name(&self) -> String {
        self.backend.name()
    }

    fn prepare(&mut self, scene: &CollisionScene, home: &[Point]) -> Result<(), BackendError> {
        self.backend.prepare(scene, home)
    }

    fn resolution(&self) -> f64 {
        self.backend.resolution()
    }

    fn resolve(
        &mut self,
        resolver: &mut Resolver,
        positions: &mut [Point],
        target: &[Point],
        input: &ResolveInput<'_>,
        observer: &mut dyn Observer,
    ) -> Result<Statistics, BackendError> {
        let start = cpu_seconds();
        let result = self.backend.resolve(resolver, positions, target, input, observer);
        add(&self.seconds, |seconds| {
            seconds.calls += 1;
            seconds.all += cpu_seconds() - start;
        });
        result
    }

    fn judge(&mut self, scene: &CollisionScene, positions: &[Point]) -> Result<(), BackendError> {
        let start = cpu_seconds();
        let result = self.backend.judge(scene, positions);
        add(&self.seconds, |seconds| seconds.judge += cpu_seconds() - start);
        result
    }
}

/// Seconds of the host per call, without those of the engine, which a GPU would take over, and of judging.
#[test]
#[ignore = "it prints a table"]
fn seconds_of_the_host_per_call() {
    println!(
        "| scene | vertices | calls | twins, s per call | host, ms per call | judge, ms per time step |"
    );
    for scale in [0.5, 3.0] {
        let scene = Scene::builtin("drape", scale)
            .and_then(|scene| scene.with_sets(&["body.0.velocity=[0,0,-4]".to_owned()]))
            .expect("a scene");
        let mut simulator = Simulator::new(&scene).expect("a simulator");
        // Into contact, on the CPU.
        let mut rows = 0;
        while rows < simulator.positions().len() / 60 {
            rows = simulator.step().expect("a step").contact_rows;
        }
        let seconds = Shared::default();
        let engine = TimedEngine { engine: TwinEngine::new(), seconds: Arc::clone(&seconds) };
        let backend = Device::new("twins".to_owned(), engine);
        let timed = Timed { backend, seconds: Arc::clone(&seconds) };
        simulator.set_backend(Box::new(timed)).expect("a backend");
        // The first one prepares the scene.
        simulator.step().expect("a step");
        *seconds.lock().unwrap_or_else(PoisonError::into_inner) = Seconds::default();
        for _ in 0..STEPS {
            simulator.step().expect("a step");
        }
        let Seconds { calls, all, engine, judge } = *seconds.lock().unwrap_or_else(PoisonError::into_inner);
        let per_call = |seconds: f64| seconds / calls as f64;
        println!(
            "| drape | {} | {calls} | {:.3} | {:.2} | {:.2} |",
            simulator.positions().len(),
            per_call(engine),
            1e3 * per_call(all - engine),
            1e3 * judge / STEPS as f64,
        );
    }
}
