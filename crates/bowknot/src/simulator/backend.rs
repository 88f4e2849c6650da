//! What resolves the collisions of a simulation.

use bowknot_dynamics::DeviceWork;
use bowknot_geometry::Point;
use bowknot_twoway::{CollisionScene, Observer, ResolveError, ResolveInput, Resolver, Statistics};
use std::error::Error;
use std::fmt::Debug;

/// Resolves the collision problems of a simulation, in place of the stages of its [`Resolver`].
pub trait CollisionBackend: Debug + Send {
    /// What `summary.json` calls it.
    fn name(&self) -> String;

    /// Prepares for a scene. `home` are the positions that the scene begins with [m]; results depend on them,
    /// but not on the positions that a run is resumed from.
    ///
    /// # Errors
    /// Settings of the scene that the backend does not have.
    fn prepare(&mut self, scene: &CollisionScene, home: &[Point]) -> Result<(), BackendError>;

    /// Whether results depend on the positions that were given to [`Self::order`].
    fn is_ordered(&self) -> bool {
        false
    }

    /// Orders what it searches in by these positions [m], until it is told others: before that by those that the scene begins
    /// with. Time steps decide when, and checkpoints hold the positions, so that a run that is resumed has the same bits.
    ///
    /// # Errors
    /// The backend has failed.
    fn order(&mut self, _positions: &[Point]) -> Result<(), BackendError> {
        Ok(())
    }

    /// How far positions may be off because the backend rounds them [m].
    fn resolution(&self) -> f64;

    /// Seconds of the last call in which a device computed, by time stamps of its own:
    /// [`Statistics::seconds`] then has them by stage. None for the CPU and where they are not measured.
    fn device_seconds(&self) -> Option<f64> {
        None
    }

    /// What its device was asked for since it was opened; nothing for the CPU.
    fn work(&self) -> DeviceWork {
        DeviceWork::default()
    }

    /// As [`Resolver::resolve_with`]. It leaves the state of the resolver as such a call does. Nobody may rely on the state
    /// before it has been [judged](Self::judge).
    ///
    /// # Errors
    /// As [`Resolver::resolve_with`], or what the backend fails of; `positions` are then unchanged.
    fn resolve(
        &mut self,
        resolver: &mut Resolver,
        positions: &mut [Point],
        target: &[Point],
        input: &ResolveInput<'_>,
        observer: &mut dyn Observer,
    ) -> Result<Statistics, BackendError>;

    /// Judges the positions [m] that calls of [`Self::resolve`] have led to, before they are accepted: at the
    /// end of each time step. A backend whose arithmetic is not that of this program, such as a device with
    /// its driver, looks for intersections then. Others have nothing to do.
    ///
    /// # Errors
    /// The positions intersect, or cannot be judged. The time step is then taken back.
    fn judge(&mut self, scene: &CollisionScene, positions: &[Point]) -> Result<(), BackendError>;
}

/// Why a backend did not resolve a collision problem.
#[derive(Debug)]
pub enum BackendError {
    /// The problem is refused.
    Refused(ResolveError),
    /// The backend has failed, or does not have what the scene needs.
    Failed(Box<dyn Error + Send + Sync>),
}

/// The resolver itself, on the CPU.
#[derive(Debug, Default)]
pub struct Cpu;

impl CollisionBackend for Cpu {
    fn name(&self) -> String {
        "cpu".to_owned()
    }

    fn prepare(&mut self, _: &CollisionScene, _: &[Point]) -> Result<(), BackendError> {
        Ok(())
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
        resolver.resolve_with(positions, target, input, observer).map_err(BackendError::Refused)
    }

    fn judge(&mut self, _: &CollisionScene, _: &[Point]) -> Result<(), BackendError> {
        Ok(())
    }
}
