//! A device as the collision backend of a simulation.

use crate::simulator::{BackendError, CollisionBackend};
use bowknot_dynamics::DeviceWork;
use bowknot_geometry::Point;
use bowknot_gpu::{Device, Engine, GpuResolveError};
use bowknot_twoway::{CollisionScene, Observer, ResolveInput, Resolver, Statistics};
use std::fmt::Debug;

impl<E: Engine + Debug + Send> CollisionBackend for Device<E> {
    fn name(&self) -> String {
        Self::name(self).to_owned()
    }

    fn prepare(&mut self, scene: &CollisionScene, home: &[Point]) -> Result<(), BackendError> {
        Ok(Self::prepare(self, scene, home)?)
    }

    fn is_ordered(&self) -> bool {
        true
    }

    fn order(&mut self, positions: &[Point]) -> Result<(), BackendError> {
        Ok(Self::order(self, positions)?)
    }

    fn work(&self) -> DeviceWork {
        Self::work(self)
    }

    fn device_seconds(&self) -> Option<f64> {
        Self::device_seconds(self)
    }

    fn resolution(&self) -> f64 {
        Self::resolution(self)
    }

    fn resolve(
        &mut self,
        resolver: &mut Resolver,
        positions: &mut [Point],
        target: &[Point],
        input: &ResolveInput<'_>,
        observer: &mut dyn Observer,
    ) -> Result<Statistics, BackendError> {
        Ok(Self::resolve(self, resolver, positions, target, input, observer)?)
    }

    fn judge(&mut self, scene: &CollisionScene, positions: &[Point]) -> Result<(), BackendError> {
        Ok(Self::judge(self, scene, positions)?)
    }
}

impl From<GpuResolveError> for BackendError {
    fn from(error: GpuResolveError) -> Self {
        match error {
            GpuResolveError::Input(error) => Self::Refused(error),
            error => Self::Failed(Box::new(error)),
        }
    }
}
