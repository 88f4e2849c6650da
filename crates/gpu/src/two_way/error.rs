//! Why a device does not solve a collision problem.

use crate::CollisionError;
use bowknot_errors::counted;
use bowknot_twoway::ResolveError;
use bowknot_twoway::check::{CheckError, Intersection};

/// Why a collision problem was not solved on a device.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuResolveError {
    /// A setting that the device does not have.
    #[error("{what} is not available on a GPU: use the CPU{}", remedy(.instead))]
    Unsupported {
        /// The key and its value.
        what: String,
        /// What the device has in its place, if anything.
        instead: Option<&'static str>,
    },
    /// The input is refused, as on the CPU.
    #[error(transparent)]
    Input(#[from] ResolveError),
    /// The device failed, or has no room for the scene.
    #[error(transparent)]
    Collision(#[from] CollisionError),
    /// A device that has failed before.
    #[error("the device has failed before: use the CPU")]
    NoEngine,
    /// The start cannot be judged.
    #[error(transparent)]
    Check(#[from] CheckError),
    /// Gaps at the start are too small for the grid of the device.
    #[error(
        "at the start a gap is smaller than two steps of the grid of the device, of {quantum:e} m: use the CPU"
    )]
    TooTight {
        /// The distance of neighboring points of the grid [m].
        quantum: f64,
    },
    /// The device computed a state that intersects: its driver does not compute what it should.
    #[error(
        "{} in the state that the device computed, which was thrown away: {first}. Its driver does not compute what it \
         should. Use the CPU, and report this with the names of the device and its driver",
        counted(*count, "pair intersects", "pairs intersect")
    )]
    Intersects {
        /// Pairs that intersect.
        count: usize,
        /// The first of them.
        first: Box<Intersection>,
    },
}

fn remedy(instead: &Option<&'static str>) -> String {
    instead.map_or_else(String::new, |instead| format!(" or {instead}"))
}
