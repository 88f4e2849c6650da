//! A backend of collisions with the seconds of its calls.

use bowknot::geometry::Point;
use bowknot::simulator::{BackendError, CollisionBackend, cpu_seconds};
use bowknot::twoway::{CollisionScene, Observer, ResolveInput, Resolver, Statistics};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// Seconds by the clock, and of the CPU.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seconds {
    pub wall: f64,
    pub cpu: f64,
}

/// Runs something and adds its seconds.
pub fn timed<R>(seconds: &Mutex<Seconds>, run: impl FnOnce() -> R) -> R {
    let (timer, cpu_start) = (Instant::now(), cpu_seconds());
    let result = run();
    let mut seconds = seconds.lock().unwrap_or_else(PoisonError::into_inner);
    seconds.wall += timer.elapsed().as_secs_f64();
    seconds.cpu += cpu_seconds() - cpu_start;
    result
}

/// The seconds so far, which then begin again.
pub fn taken(seconds: &Mutex<Seconds>) -> Seconds {
    std::mem::take(&mut *seconds.lock().unwrap_or_else(PoisonError::into_inner))
}

/// A backend with the seconds of its calls.
#[derive(Debug)]
pub struct TimedBackend {
    pub backend: Box<dyn CollisionBackend>,
    pub resolve: Arc<Mutex<Seconds>>,
    pub judge: Arc<Mutex<Seconds>>,
}

impl CollisionBackend for TimedBackend {
    fn name(&self) -> String {
        self.backend.name()
    }

    fn prepare(&mut self, scene: &CollisionScene, home: &[Point]) -> Result<(), BackendError> {
        self.backend.prepare(scene, home)
    }

    fn is_ordered(&self) -> bool {
        self.backend.is_ordered()
    }

    fn order(&mut self, scene: &CollisionScene, positions: &[Point]) -> Result<(), BackendError> {
        self.backend.order(scene, positions)
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
        timed(&self.resolve, || self.backend.resolve(resolver, positions, target, input, observer))
    }

    fn judge(&mut self, scene: &CollisionScene, positions: &[Point]) -> Result<(), BackendError> {
        timed(&self.judge, || self.backend.judge(scene, positions))
    }
}
