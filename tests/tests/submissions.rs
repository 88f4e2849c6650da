//! How often a simulation on a device waits for it: steps that are submitted together have the same bits as
//! one by one.

use bowknot::gpu::{Device, Engine, GpuError, TwinEngine};
use bowknot::{Scene, Simulator};
use bowknot_geometry::Point;
use bowknot_gpu::{BufferId, Recording};
use std::sync::{Arc, Mutex, PoisonError};

/// What an engine was asked for.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    /// Recordings with dispatches, and the dispatches of all of them.
    submissions: usize,
    dispatches: usize,
    /// Recordings that end with reading, for which the host waits.
    readbacks: usize,
}

/// The twins, counted.
#[derive(Debug)]
struct Counted {
    engine: TwinEngine,
    counts: Arc<Mutex<Counts>>,
}

impl Engine for Counted {
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
        let mut counts = self.counts.lock().unwrap_or_else(PoisonError::into_inner);
        counts.submissions += usize::from(recording.dispatch_count() > 0);
        counts.dispatches += recording.dispatch_count();
        counts.readbacks += usize::from(!read.is_empty());
        drop(counts);
        self.engine.run(recording, read)
    }
}

/// A run with so many steps per submission at most.
struct Course {
    counts: Counts,
    two_way_steps: usize,
    /// Calls of the backend.
    calls: usize,
    end: Vec<Point>,
}

fn course(scene: &Scene, time_steps: usize, most: usize) -> Course {
    let counts = Arc::default();
    let engine = Counted { engine: TwinEngine::new(), counts: Arc::clone(&counts) };
    let mut device = Device::new("counted".to_owned(), engine);
    device.set_steps_per_submission(most);
    let mut simulator = Simulator::new(scene).expect("a simulator");
    simulator.set_backend(Box::new(device)).expect("settings that the kernels have");
    let (mut two_way_steps, mut calls) = (0, 0);
    for _ in 0..time_steps {
        let statistics = simulator.step().expect("a step");
        two_way_steps += statistics.two_way_steps;
        calls += statistics.newton_iterations;
    }
    let counts = *counts.lock().unwrap_or_else(PoisonError::into_inner);
    Course { counts, two_way_steps, calls, end: simulator.positions().to_vec() }
}

#[test]
fn steps_that_are_submitted_together_have_the_same_bits_and_fewer_waits() {
    for (name, scale, time_steps) in [("drape", 0.2, 24), ("needle", 0.12, 8)] {
        let scene = Scene::builtin(name, scale)
            .and_then(|scene| scene.with_sets(&["body.0.velocity=[0,0,-4]".to_owned()]))
            .expect("a scene");
        let [one, eight] = [1, 8].map(|most| course(&scene, time_steps, most));
        assert!(one.end == eight.end, "{name}");
        assert_eq!(one.two_way_steps, eight.two_way_steps, "{name}");
        assert!(one.counts.submissions >= one.two_way_steps, "{name}");
        assert!(eight.counts.submissions < one.counts.submissions, "{name}");
        assert!(eight.counts.readbacks < one.counts.readbacks, "{name}");
    }
}

/// The table of `docs/gpu/collisions.md`.
#[test]
#[ignore = "it takes minutes"]
fn submissions_and_readbacks_by_scene() {
    println!(
        "| scene | calls | two-way steps | most | submissions per call | readbacks per call | dispatches per \
         step |"
    );
    for (name, scale, time_steps) in
        [("drape", 0.5, 60), ("needle", 0.2, 40), ("stack", 0.2, 80), ("dress", 0.1, 40), ("sand", 0.08, 80)]
    {
        let scene = Scene::builtin(name, scale).expect("a scene");
        for most in [1, 2, 4, 8] {
            let course = course(&scene, time_steps, most);
            let per_call = |count: usize| count as f64 / course.calls as f64;
            println!(
                "| {name} | {} | {} | {most} | {:.2} | {:.2} | {:.0} |",
                course.calls,
                course.two_way_steps,
                per_call(course.counts.submissions),
                per_call(course.counts.readbacks),
                course.counts.dispatches as f64 / course.two_way_steps as f64,
            );
        }
    }
}
