//! The options of the command that do what an error of a library advises: libraries know no options.

use bowknot::SceneError;
use bowknot::report::ReportError;
use bowknot::run::ExportError;
use bowknot::simulator::SimulationError;
use std::error::Error;
use std::fmt::Display;

/// Options for the remedies in the message of an error.
pub trait Hint: Display {
    /// The options, in words; none if the message advises nothing that an option does.
    fn hint(&self) -> Option<&'static str>;

    /// The message, and the options on a line of their own.
    fn with_hint(&self) -> String {
        self.hint().map_or_else(|| self.to_string(), |hint| format!("{self}\noptions: {hint}"))
    }
}

impl Hint for SimulationError {
    fn hint(&self) -> Option<&'static str> {
        match self {
            Self::Scene(error) => error.hint(),
            Self::StartIntersects { .. } => Some("--dump FILE.ply writes the offending triangles as a mesh"),
            Self::RunExists { .. } => Some("--resume, or --out DIR for another folder"),
            Self::RunInUse { .. } => Some("--out DIR for another folder"),
            Self::Resume { .. } => {
                Some("--out DIR names the folder of the run, by default out/ and the name of its scene")
            }
            Self::Internal { .. } => Some("--resume"),
            Self::Backend { step: 0, source } => Some(of_backend(source.as_ref())),
            Self::Backend { source, .. } if is_unsupported(source.as_ref()) => {
                Some(of_backend(source.as_ref()))
            }
            Self::Backend { .. } => {
                Some("--resume, with --backend cpu, or --dynamics-backend cpu for the dynamics alone")
            }
            _ => None,
        }
    }
}

impl Hint for SceneError {
    fn hint(&self) -> Option<&'static str> {
        matches!(self, Self::ScaleOfFile { .. }).then_some("without --scale")
    }
}

impl Hint for ExportError {
    fn hint(&self) -> Option<&'static str> {
        match self {
            Self::NoTimeStep { .. } => Some("--dt SECONDS"),
            Self::Mixes { .. } | Self::Overwrites { .. } => Some("--out DIR"),
            _ => None,
        }
    }
}

impl Hint for ReportError {
    fn hint(&self) -> Option<&'static str> {
        matches!(self, Self::TooLarge { .. }).then_some("--max-megabytes, --stride")
    }
}

/// Options for what a backend does not have or do.
pub fn of_backend(error: &(dyn Error + 'static)) -> &'static str {
    if is_unsupported(error) { "--backend cpu, or --preset fast" } else { "--backend cpu" }
}

/// Whether the fast preset has what the device does not.
#[cfg(feature = "gpu")]
fn is_unsupported(error: &(dyn Error + 'static)) -> bool {
    use bowknot::gpu::GpuResolveError;
    matches!(error.downcast_ref(), Some(GpuResolveError::Unsupported { instead: Some(_), .. }))
}

#[cfg(not(feature = "gpu"))]
fn is_unsupported(_: &(dyn Error + 'static)) -> bool {
    false
}
