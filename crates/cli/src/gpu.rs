//! What the command does on a GPU: the devices, and the backends of `run` and `resolve`.

use crate::args::{Backend, DynamicsBackend, Machine, RunOptions};
use crate::exit::Failure;
use bowknot::run::{BackendRecord, Backends};
use bowknot::simulator::{CollisionBackend, Cpu};
use bowknot::{Scene, World};
use bowknot_errors::counted;
use std::path::Path;

/// The devices, one per line, with what those that cannot be used lack.
#[cfg(feature = "gpu")]
pub fn list() -> Result<String, Failure> {
    use bowknot::gpu::Adapter;
    let adapters = Adapter::all();
    if adapters.is_empty() {
        // The error tells what was looked for.
        Adapter::choose(None).map_err(Failure::backend)?;
    }
    let line = |(number, adapter): (usize, &Adapter)| match adapter.lacks() {
        None => {
            let most = adapter.largest_buffer() / (1 << 20);
            format!("{number}: {adapter}, buffers of {most} MiB at most\n")
        }
        Some(what) => format!("{number}: {adapter}: cannot be used, it has no {what}\n"),
    };
    Ok(adapters.iter().enumerate().map(line).collect())
}

/// What resolves a single collision problem. To open a device takes longer than most problems, so the CPU is
/// taken unless a GPU is asked for.
pub fn of_problem(machine: &Machine) -> Result<Box<dyn CollisionBackend>, Failure> {
    match machine.backend {
        Some(Backend::Gpu) => device::collisions(&Place::Number(machine.device)),
        Some(Backend::Cpu | Backend::Auto) | None => Ok(Box::new(Cpu)),
    }
}

/// What computes a run of the scene in that folder. A resumption goes on with what computed it before, unless
/// the options say otherwise.
pub fn of_run(options: &RunOptions, scene: &Scene, folder: &Path) -> Result<Backends, Failure> {
    let machine = &options.machine;
    let before = if options.resume { BackendRecord::read(folder).map_err(Failure::input)? } else { None };
    let as_before = |name: &str| Place::of_name(name, machine.device, folder);
    let mut why = None;
    let collisions = match (machine.backend, &before) {
        (Some(Backend::Cpu), _) | (None, None) => Place::Cpu,
        (Some(Backend::Gpu), _) => Place::Number(machine.device),
        (Some(Backend::Auto) | None, Some(before)) => {
            why.clone_from(&before.why);
            as_before(&before.collisions)?
        }
        (Some(Backend::Auto), None) => {
            if !options.resume {
                // Before anything is measured for it.
                bowknot::run::refuse_run(folder).map_err(|error| Failure::simulation(&error))?;
            }
            let (place, reason) = device::choose(
                scene,
                machine.device,
                options.dynamics_backend != Some(DynamicsBackend::Cpu),
            )?;
            why = Some(reason);
            place
        }
    };
    let mut dynamics_why = None;
    let mut dynamics = match (options.dynamics_backend, machine.backend, &before) {
        (Some(DynamicsBackend::Cpu), ..) => Place::Cpu,
        (Some(DynamicsBackend::Gpu), ..) => Place::Number(machine.device),
        (None, Some(Backend::Auto) | None, Some(before)) => {
            dynamics_why.clone_from(&before.dynamics_why);
            as_before(&before.dynamics)?
        }
        (None, ..) => collisions.clone(),
    };
    if options.dynamics_backend.is_none() && dynamics != Place::Cpu {
        dynamics_why = why_on_cpu(&World::new(scene).map_err(Failure::input)?);
        if dynamics_why.is_some() {
            dynamics = Place::Cpu;
        }
    }
    let (collisions, dynamics) = match (&collisions, &dynamics) {
        (Place::Cpu, Place::Cpu) => (Box::new(Cpu) as Box<dyn CollisionBackend>, None),
        (Place::Cpu, dynamics) => (Box::new(Cpu) as _, Some(device::dynamics(dynamics)?)),
        (collisions, Place::Cpu) => (device::collisions(collisions)?, None),
        (collisions, dynamics) if collisions == dynamics => {
            let (collisions, dynamics) = device::both(collisions)?;
            (collisions, Some(dynamics))
        }
        (collisions, dynamics) => (device::collisions(collisions)?, Some(device::dynamics(dynamics)?)),
    };
    Ok(Backends { collisions, dynamics, why, dynamics_why })
}

/// Why the dynamics of a scene stay on the CPU where a device resolves its collisions; None if they need not.
fn why_on_cpu(world: &World) -> Option<String> {
    let (first, [what, instead]) = world.bodies_only_on_cpu().next()?;
    let count = world.bodies_only_on_cpu().filter(|(_, [other, _])| *other == what).count();
    Some(format!(
        "{} {what}, which only the CPU computes (the first is \"{first}\"); a device computes {instead}",
        counted(count, "body has", "bodies have")
    ))
}

/// Where something is computed.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Place {
    Cpu,
    /// The device of that number, or the first that is usable.
    Number(Option<usize>),
}

impl Place {
    /// The backend of that name, which computed the run of a folder before, or the device of that number in
    /// its place.
    fn of_name(name: &str, number: Option<usize>, folder: &Path) -> Result<Self, Failure> {
        match name.strip_prefix(GPU) {
            _ if name == "cpu" => Ok(Self::Cpu),
            Some(_) if number.is_some() => Ok(Self::Number(number)),
            Some(device) => device::number_of(device, folder).map(|number| Self::Number(Some(number))),
            None => Err(not_here(name, folder)),
        }
    }
}

/// What resolves the collisions, and what computes the dynamics.
type Both = (Box<dyn CollisionBackend>, Box<dyn bowknot::dynamics::NewtonBackend>);

/// What the names of devices begin with.
const GPU: &str = "gpu: ";

/// The device of a run is not on this machine.
fn not_here(name: &str, folder: &Path) -> Failure {
    Failure::backend(format!(
        "{}: {name} computed this run, and is not here. --backend cpu, or --device N, goes on from its \
         checkpoint; results then differ from what they would have been, within the tolerances",
        folder.display()
    ))
}

/// The backends on a device.
#[cfg(feature = "gpu")]
mod device {
    use super::{Both, CollisionBackend, Failure, GPU, Path, Place, Scene, not_here};
    use bowknot::dynamics::NewtonBackend;
    use bowknot::gpu::{Adapter, Choice, ConjugateGradients, Device, DeviceEngine};

    pub fn collisions(place: &Place) -> Result<Box<dyn CollisionBackend>, Failure> {
        let (name, engine) = open(place, "--backend cpu")?;
        Ok(Box::new(Device::new(name, engine)))
    }

    /// Both on one device.
    pub fn both(place: &Place) -> Result<Both, Failure> {
        let (name, engine) = open(place, "--backend cpu")?;
        let dynamics = ConjugateGradients::new(name.clone(), engine.beside());
        Ok((Box::new(Device::new(name, engine)), Box::new(dynamics)))
    }

    pub fn dynamics(place: &Place) -> Result<Box<dyn NewtonBackend>, Failure> {
        let (name, engine) = open(place, "--dynamics-backend cpu")?;
        Ok(Box::new(ConjugateGradients::new(name, engine)))
    }

    /// The faster one of the CPU and the device of that number in a scene, with or without its dynamics, and
    /// why it was chosen.
    pub fn choose(
        scene: &Scene,
        number: Option<usize>,
        with_dynamics: bool,
    ) -> Result<(Place, String), Failure> {
        if number.is_some() {
            // A device that is asked for and is not there is a mistake, none at all is not.
            Adapter::choose(number).map_err(Failure::backend)?;
        }
        let Choice { device, why } = Choice::new(scene, number, with_dynamics).map_err(Failure::input)?;
        Ok(match device {
            Some(adapter) => (Place::Number(number), format!("{}: {why}", adapter.name())),
            None => (Place::Cpu, format!("the CPU: {why}")),
        })
    }

    /// The number of the device that computed a run: of that description, or of that name with another
    /// driver.
    pub fn number_of(description: &str, folder: &Path) -> Result<usize, Failure> {
        let all = Adapter::all();
        let same = all.iter().position(|adapter| adapter.to_string() == description);
        let alike =
            || all.iter().position(|adapter| description.starts_with(&format!("{} (", adapter.name())));
        same.or_else(alike).ok_or_else(|| not_here(&format!("{GPU}{description}"), folder))
    }

    /// Opens a device.
    fn open(place: &Place, without: &str) -> Result<(String, DeviceEngine), Failure> {
        let number = if let Place::Number(number) = place { *number } else { None };
        let adapter = Adapter::choose(number).map_err(Failure::backend)?;
        if adapter.is_software() {
            eprintln!("warning: {adapter} computes on the CPU: slower than {without}");
        }
        let engine = DeviceEngine::open(&adapter).map_err(Failure::backend)?;
        Ok((format!("{GPU}{adapter}"), engine))
    }
}

/// What takes the place of the devices in a build without them.
#[cfg(not(feature = "gpu"))]
mod device {
    use super::{Both, CollisionBackend, Failure, GPU, Path, Place, Scene, not_built_in, not_here};
    use bowknot::dynamics::NewtonBackend;

    pub fn collisions(_place: &Place) -> Result<Box<dyn CollisionBackend>, Failure> {
        Err(not_built_in())
    }

    pub fn both(_place: &Place) -> Result<Both, Failure> {
        Err(not_built_in())
    }

    pub fn dynamics(_place: &Place) -> Result<Box<dyn NewtonBackend>, Failure> {
        Err(not_built_in())
    }

    pub fn choose(
        _scene: &Scene,
        _number: Option<usize>,
        _with_dynamics: bool,
    ) -> Result<(Place, String), Failure> {
        Ok((Place::Cpu, "the CPU: this bowknot was built without the feature `gpu`".to_owned()))
    }

    pub fn number_of(description: &str, folder: &Path) -> Result<usize, Failure> {
        Err(not_here(&format!("{GPU}{description}"), folder))
    }
}

#[cfg(not(feature = "gpu"))]
pub fn list() -> Result<String, Failure> {
    Err(not_built_in())
}

#[cfg(not(feature = "gpu"))]
fn not_built_in() -> Failure {
    Failure::backend(
        "this bowknot was built without the feature `gpu`: build it with it, or use --backend cpu",
    )
}
