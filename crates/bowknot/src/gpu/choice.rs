//! Where a scene is simulated faster: on the CPU or on a device.

use crate::simulator::{Checkpoint, CollisionBackend, Cpu, SimulationError, Simulator};
use bowknot_dynamics::NewtonBackend;
use bowknot_errors::counted;
use bowknot_gpu::{Adapter, ConjugateGradients, Device, DeviceEngine};
use bowknot_scene::Scene;
use web_time::Instant;

/// How many times as long the CPU must take for the device to be chosen: where both take as long, chance must not decide.
const MARGIN: f64 = 1.25;

/// Time steps with contacts that are measured on either.
const MEASURED_STEPS: usize = 3;

/// Wall time after which no further time step is made toward the first contact, or measured on one backend [s].
const MOST_SECONDS: f64 = 10.0;

/// Share of the time steps of a run that may be made toward the first contact, and their largest number.
const LEAD_SHARE: usize = 4;
const MOST_LEAD_STEPS: usize = 64;

/// What computes a scene, and why.
#[derive(Debug)]
pub struct Choice {
    /// The device; None for the CPU.
    pub device: Option<Adapter>,
    /// The reason, as a part of a sentence.
    pub why: String,
}

impl Choice {
    /// The device `number`, or the first that is usable, if it simulates the scene faster than the CPU: its collisions and,
    /// if `with_dynamics` is true and no body has quadratic elements, its dynamics. The first time steps with contacts are made on either, on copies of the
    /// scene.
    ///
    /// The clock decides, so the answer may differ from machine to machine and, where both are about as fast, from call to
    /// call.
    ///
    /// # Errors
    /// A scene that cannot be simulated, on the CPU either.
    pub fn new(scene: &Scene, number: Option<usize>, with_dynamics: bool) -> Result<Self, SimulationError> {
        let on_cpu = |why: String| Ok(Self { device: None, why });
        let adapter = match Adapter::choose(number) {
            Ok(adapter) => adapter,
            Err(error) => return on_cpu(error.to_string()),
        };
        if adapter.is_software() {
            return on_cpu(format!("{adapter} computes on the CPU"));
        }
        let device = DeviceEngine::open(&adapter).map(|engine| {
            let dynamics = with_dynamics.then(|| engine.beside());
            let name = adapter.to_string();
            let dynamics = dynamics.map(|engine| ConjugateGradients::new(name.clone(), engine));
            let dynamics = dynamics.map(|dynamics| Box::new(dynamics) as Box<dyn NewtonBackend>);
            (Box::new(Device::new(name, engine)) as Box<dyn CollisionBackend>, dynamics)
        });
        let device = match device {
            Ok(device) => device,
            Err(error) => return on_cpu(error.to_string()),
        };
        let verdict = compare(scene, Box::new(Cpu), device)?;
        Ok(Self { device: verdict.device_is_faster.then_some(adapter), why: verdict.why })
    }
}

/// How a comparison ended.
#[derive(Debug)]
struct Verdict {
    device_is_faster: bool,
    why: String,
}

/// Compares the seconds of two backends in the first time steps with contacts, or in the last ones that are tried.
fn compare(
    scene: &Scene,
    cpu: Box<dyn CollisionBackend>,
    (device, dynamics): (Box<dyn CollisionBackend>, Option<Box<dyn NewtonBackend>>),
) -> Result<Verdict, SimulationError> {
    let to_cpu = |why: String| Ok(Verdict { device_is_faster: false, why });
    let frames = scene.simulation.frames;
    let lead = (frames / LEAD_SHARE).min(MOST_LEAD_STEPS);
    if lead == 0 {
        let frames = counted(frames, "time step is", "time steps are");
        return to_cpu(format!("{frames} too few to measure"));
    }
    let mut on_device = simulator(scene)?;
    if let Err(error) = on_device.set_backend(device) {
        return to_cpu(words(&error));
    }
    if on_device.world().bodies_only_on_cpu().next().is_none() {
        on_device.set_dynamics_backend(dynamics)?;
    }
    let mut on_cpu = simulator(scene)?;
    on_cpu.set_backend(cpu)?;
    // Where a time step fails, the run will say so, after the frames before it.
    let (touches, [seconds_on_cpu, seconds_on_device]) = match seconds(&mut on_cpu, &mut on_device, lead) {
        Ok(measured) => measured,
        Err(error) => return to_cpu(words(&error)),
    };
    let place = if touches { "from the first contact on" } else { "before the first contact" };
    Ok(Verdict {
        device_is_faster: MARGIN * seconds_on_device < seconds_on_cpu,
        why: format!(
            "a time step takes {seconds_on_device:.4} s on the device and {seconds_on_cpu:.4} s on the CPU, {place}"
        ),
    })
}

/// Whether anything touches after at most `lead` time steps, and the seconds per time step from then on, on the CPU and on
/// the device.
fn seconds(
    on_cpu: &mut Simulator,
    on_device: &mut Simulator,
    lead: usize,
) -> Result<(bool, [f64; 2]), SimulationError> {
    let timer = Instant::now();
    let mut touches = false;
    for _ in 0..lead {
        let statistics = on_cpu.step()?;
        touches = statistics.contact_rows + statistics.pressing_contacts > 0;
        if touches || timer.elapsed().as_secs_f64() > MOST_SECONDS {
            break;
        }
    }
    let start = on_cpu.checkpoint();
    let cpu = measure(on_cpu)?;
    restore(on_device, &start)?;
    // The device compiles its kernels in a time step that does not count.
    on_device.step()?;
    restore(on_device, &start)?;
    Ok((touches, [cpu, measure(on_device)?]))
}

/// What a backend failed of, or why a time step cannot be made.
fn words(error: &SimulationError) -> String {
    match error {
        SimulationError::Backend { source, .. } => source.to_string(),
        error => error.to_string(),
    }
}

/// Seconds per time step, over the next ones.
fn measure(simulator: &mut Simulator) -> Result<f64, SimulationError> {
    let timer = Instant::now();
    let mut steps = 0;
    while steps == 0 || steps < MEASURED_STEPS && timer.elapsed().as_secs_f64() < MOST_SECONDS {
        simulator.step()?;
        steps += 1;
    }
    Ok(timer.elapsed().as_secs_f64() / steps as f64)
}

fn simulator(scene: &Scene) -> Result<Simulator, SimulationError> {
    let mut simulator = Simulator::new(scene)?;
    simulator.set_measured(false);
    Ok(simulator)
}

fn restore(simulator: &mut Simulator, start: &Checkpoint) -> Result<(), SimulationError> {
    let restored = simulator.restore(start);
    restored.map_err(|error| SimulationError::Internal { step: start.step, message: error.to_string() })
}

#[cfg(test)]
#[cfg(feature = "twins")]
mod tests {
    use super::*;
    use crate::simulator::BackendError;
    use bowknot_geometry::Point;
    use bowknot_gpu::TwinEngine;
    use bowknot_twoway::{CollisionScene, Observer, ResolveInput, Resolver, Statistics};

    fn scene(sets: &[&str]) -> Scene {
        let sets = [&["body.0.velocity=[0,0,-4]"], sets].concat();
        Scene::builtin("drape", 0.2).and_then(|scene| scene.with_sets(&sets)).expect("a scene")
    }

    fn twins() -> Box<dyn CollisionBackend> {
        Box::new(Device::new("twins".to_owned(), TwinEngine::new()))
    }

    /// The CPU, which takes a tenth of a second more, or fails.
    #[derive(Debug)]
    struct Odd {
        cpu: Cpu,
        fails: bool,
    }

    impl CollisionBackend for Odd {
        fn name(&self) -> String {
            "odd".to_owned()
        }

        fn prepare(&mut self, scene: &CollisionScene, home: &[Point]) -> Result<(), BackendError> {
            self.cpu.prepare(scene, home)
        }

        fn resolution(&self) -> f64 {
            0.0
        }

        fn resolve(
            &mut self,
            resolver: &mut Resolver,
            positions: &mut [Point],
            target: &[Point],
            input: &ResolveInput<'_>,
            observer: &mut dyn Observer,
        ) -> Result<Statistics, BackendError> {
            if self.fails {
                return Err(BackendError::Failed("the device was lost".into()));
            }
            std::thread::sleep(std::time::Duration::from_millis(100));
            self.cpu.resolve(resolver, positions, target, input, observer)
        }

        fn judge(&mut self, scene: &CollisionScene, positions: &[Point]) -> Result<(), BackendError> {
            self.cpu.judge(scene, positions)
        }
    }

    #[test]
    fn the_faster_backend_is_taken_and_both_are_measured_in_contact() {
        let slow = || Box::new(Odd { cpu: Cpu, fails: false });
        let verdict = compare(&scene(&[]), slow(), (Box::new(Cpu), None)).expect("a verdict");
        assert!(verdict.device_is_faster && verdict.why.contains("from the first contact on"), "{verdict:?}");
        let verdict = compare(&scene(&[]), Box::new(Cpu), (slow(), None)).expect("a verdict");
        assert!(!verdict.device_is_faster && verdict.why.contains(" s on the device and "), "{verdict:?}");
    }

    #[test]
    fn the_cpu_is_taken_where_the_device_cannot_or_as_fast() {
        let verdict = |sets: &[&str], device: Box<dyn CollisionBackend>| {
            let verdict = compare(&scene(sets), Box::new(Cpu), (device, None)).expect("a verdict");
            assert!(!verdict.device_is_faster, "{verdict:?}");
            verdict.why
        };
        let why = verdict(&["contact.preset=\"paper\""], twins());
        assert!(why.contains("contact.form"), "{why}");
        let why = verdict(&[], Box::new(Odd { cpu: Cpu, fails: true }));
        assert!(why.contains("the device was lost"), "{why}");
        let why = verdict(&["simulation.frames=3"], twins());
        assert_eq!(why, "3 time steps are too few to measure");
        let why = verdict(
            &["simulation.frames=8", "body.0.velocity=[0,0,4]"],
            Box::new(Odd { cpu: Cpu, fails: false }),
        );
        assert!(why.contains("before the first contact"), "{why}");
    }
}
