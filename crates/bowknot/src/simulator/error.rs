//! Why a simulation cannot begin or go on.

use super::backend::BackendError;
use super::drive::DriveError;
use super::report::element_words;
use super::restore_error::RestoreError;
use bowknot_check::{CheckError, Intersection};
use bowknot_dynamics::{Errors, ModelError, ParamError, StepError};
use bowknot_errors::counted;
use bowknot_io::IoError;
use bowknot_scene::SceneError;
use bowknot_scene::world::World;
use bowknot_twoway::ResolveError;
use std::path::PathBuf;

/// Why a simulation cannot begin or go on. All but [`SimulationError::Interrupted`] and
/// [`SimulationError::Internal`] are the user's input or an unwritable output (exit code 2 of the command);
/// that a check found an intersection is no error but a result, see [`crate::run::Summary::intersections`].
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// The scene is refused.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Parameters of the dynamics are refused.
    #[error(transparent)]
    Dynamics(Errors<ParamError>),
    /// The state cannot be judged.
    #[error(transparent)]
    Check(#[from] CheckError),
    /// A change between time steps is refused.
    #[error(transparent)]
    Drive(#[from] DriveError),
    /// A checkpoint is refused.
    #[error(transparent)]
    Restore(#[from] RestoreError),
    /// Bodies intersect at the start.
    #[error("{}", start_message(.lines, .count, .advice))]
    StartIntersects {
        /// The first intersecting pairs, in words.
        lines: Vec<String>,
        /// How many pairs intersect in all.
        count: usize,
        /// What to move or mend, in words.
        advice: Vec<String>,
    },
    /// The dynamics has no finite target.
    #[error("time step {step}: {source}; a smaller dt, or softer materials, may help")]
    Target {
        /// The time step, from 1.
        step: usize,
        /// What is not finite, of which body.
        source: StepError,
    },
    /// The collision stage refuses the state or the target.
    #[error("time step {step}: {}", resolve_message(.source, .body))]
    Resolve {
        /// The time step, from 1; 0 before the first.
        step: usize,
        /// Name of the body that it is about, if any.
        body: String,
        /// Why.
        source: ResolveError,
    },
    /// What resolves the collisions or computes the dynamics has failed; the simulator is as it was before the time step.
    #[error("time step {step}: {source}")]
    Backend {
        /// The time step, from 1; 0 before the first.
        step: usize,
        /// Why.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A file cannot be read or written.
    #[error(transparent)]
    Io(#[from] IoError),
    /// The output folder holds a run already.
    #[error(
        "{} already holds a run: resume it, choose another folder, or remove it",
        path.display()
    )]
    RunExists {
        /// The folder.
        path: PathBuf,
    },
    /// Another run writes to the output folder.
    #[error(
        "{} is in use by another run{}: wait for it, end it, or choose another folder",
        path.display(), process_words(.process)
    )]
    RunInUse {
        /// The folder.
        path: PathBuf,
        /// The process of the other run, if known.
        process: Option<u32>,
    },
    /// The program itself failed within a run.
    #[error(
        "time step {step}: internal error: {message}\nThis is a fault of the program, please report it. What was \
         written so far is whole; if the run is resumed, it goes on from the last checkpoint."
    )]
    Internal {
        /// The time step, from 1; 0 before the first.
        step: usize,
        /// The message of the panic.
        message: String,
    },
    /// A run cannot be resumed.
    #[error("cannot resume {}: {message}", path.display())]
    Resume {
        /// The output folder.
        path: PathBuf,
        /// Why not.
        message: String,
    },
    /// An observer stopped the time step; the simulator is as it was before the step.
    #[error("interrupted")]
    Interrupted,
}

impl SimulationError {
    /// The dynamics has no target in a time step.
    pub(super) fn target(step: usize, source: StepError) -> Self {
        match source {
            StepError::Backend { .. } | StepError::OnlyOnCpu { .. } | StepError::CustomElements { .. } => {
                Self::Backend { step, source: Box::new(source) }
            }
            source => Self::Target { step, source },
        }
    }

    /// Custom elements that are refused.
    pub(super) fn elements(source: Errors<ModelError>) -> Self {
        DriveError::Elements { source }.into()
    }

    /// A collision problem that is refused, with the name of its body.
    pub(super) fn resolve(world: &World, step: usize, source: ResolveError) -> Self {
        let body = match &source {
            ResolveError::NonFinite { body, .. } | ResolveError::Mass { body, .. } => world.name_of(*body),
            ResolveError::MinSeparationBelowRounding { vertex, .. } => world.body_name(*vertex),
            _ => "",
        };
        Self::Resolve { step, body: body.to_owned(), source }
    }

    /// A collision problem that a backend did not resolve.
    pub(super) fn backend(world: &World, step: usize, source: BackendError) -> Self {
        match source {
            BackendError::Refused(source) => Self::resolve(world, step, source),
            BackendError::Failed(source) => Self::Backend { step, source },
        }
    }
}

fn process_words(process: &Option<u32>) -> String {
    process.map_or_else(String::new, |id| format!(" (process {id})"))
}

/// The first intersections of a state in words: bodies by name, vertices by index in their body's mesh.
pub fn describe_intersections(world: &World, intersections: &[Intersection]) -> Vec<String> {
    let side = |intersection: &Intersection, side: usize| {
        let kind = intersection.class.sides()[side];
        if intersection.bodies[side].is_none() {
            let plane = intersection.elements[side] as usize;
            let name = world.half_space_names.get(plane).map_or("", String::as_str);
            return format!("half-space {name}");
        };
        element_words(world, kind, &intersection.vertices[side])
    };
    intersections
        .iter()
        .map(|i| {
            let p = i.place;
            format!("{} and {} at ({:.6}, {:.6}, {:.6})", side(i, 0), side(i, 1), p.x, p.y, p.z)
        })
        .collect()
}

fn start_message(lines: &[String], count: &usize, advice: &[String]) -> String {
    let more = count - lines.len();
    let more = if more > 0 {
        format!("\n  and {}", counted(more, "more pair", "more pairs"))
    } else {
        String::new()
    };
    let advice: String = advice.iter().map(|line| format!("\n{line}")).collect();
    format!(
        "the start already intersects; a simulation needs a start without intersections:\n  {}{more}{advice}",
        lines.join("\n  ")
    )
}

/// The messages of the collision stage, with the keys of a scene and the names of bodies.
fn resolve_message(error: &ResolveError, body: &str) -> String {
    match error {
        ResolveError::MinSeparationBelowRounding { min_separation, coordinate, needed, .. } => format!(
            "the minimum separation of {min_separation:.3e} m is below 16 ulp of the largest coordinate \
             ({coordinate:.3e} m, body {body}): move the scene closer to the origin, or set \
             contact.min_separation above {needed:.3e} m"
        ),
        ResolveError::NonFinite { what, vertex, .. } => {
            format!("{what} of vertex {vertex} (body {body}) is not finite")
        }
        other => other.to_string(),
    }
}
