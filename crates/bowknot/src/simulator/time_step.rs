//! One time step.

use super::error::SimulationError;
use super::report::{SimulationObserver, StepStatistics, cpu_seconds};
use super::sleep::SleepingBodies;
use super::tolerance::Tolerance;
use super::{Scratch, Simulator, interior, time_of};
use bowknot_geometry::{Point, Vector};
use web_time::Instant;

impl Simulator {
    /// Makes one time step, on a thread of the pool.
    ///
    /// # Errors
    /// A target that is not finite, with its body; coordinates too large for the minimum separation. The
    /// simulator is then as it was before the step, unless a device fails while bodies fall asleep or obstacles come
    /// and go at the end of it: then the step is done, and [`Self::time`] tells it.
    pub fn step(&mut self) -> Result<StepStatistics, SimulationError> {
        // From outside of the thread pool each of the parallel loops would put this thread to sleep and wake
        // it again.
        rayon::scope(|_| self.step_observed(&mut ()))
    }

    /// Makes one time step with an observer, on this thread. Scenes of a few thousand vertices take less time
    /// from inside of the thread pool, as by `rayon::scope(|_| ...)`.
    ///
    /// # Errors
    /// As [`Self::step`]; [`SimulationError::Interrupted`] if the observer stopped it. The simulator is
    /// then as it was before the step, as said there.
    pub fn step_observed(
        &mut self,
        observer: &mut dyn SimulationObserver,
    ) -> Result<StepStatistics, SimulationError> {
        let (timer, cpu_start) = (Instant::now(), cpu_seconds());
        let work_start = self.device_work();
        let step = self.step + 1;
        let time = time_of(step, self.dt);
        let at_reference = self.step_tolerance * self.resolver.scene().lengths().edge;
        let tolerance = Tolerance::new(at_reference, self.dt, self.dynamics.params().integrator);
        let tolerance_m = tolerance.meters();
        let mut statistics = StepStatistics {
            step,
            time,
            tolerance_m,
            converged: true,
            solved: true,
            ..StepStatistics::default()
        };

        self.order_search()?;
        self.place_absent(time);
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.start.clone_from(&self.positions);
        let anchors = self.anchors.clone();
        self.prescribe(time, &mut scratch);
        // Bodies that wake here stay awake if the time step is abandoned: it would wake them again.
        if let Err(error) = self.wake_for_step(time, &mut scratch) {
            (self.anchors, self.scratch) = (anchors, scratch);
            self.place_absent(self.time());
            return Err(error);
        }
        if self.has_nothing_to_do() {
            self.scratch = scratch;
            self.step = step;
            self.velocities.fill(Vector::zeros());
            self.update_presence(&mut statistics)?;
            self.close(timer, cpu_start, &mut statistics);
            return Ok(statistics);
        }
        if let Err(error) = self.iterate(tolerance, &mut scratch, observer, &mut statistics) {
            self.take_back(anchors, scratch)?;
            return Err(error);
        }
        let Self { dynamics, positions, contacts, velocities, sleeping, .. } = self;
        let dynamics = sleeping.as_mut().and_then(SleepingBodies::dynamics).unwrap_or(dynamics);
        dynamics.end_velocities(positions, &scratch.prescribed, contacts.touching(), velocities);
        statistics.waiting = self.waiting(time, &scratch);
        self.record_pin_forces(time);
        statistics.prescribed_lag_m = statistics.waiting.values().copied().fold(0.0, f64::max);
        self.scratch = scratch;
        self.step = step;
        self.fall_asleep()?;
        self.update_presence(&mut statistics)?;
        self.close(timer, cpu_start, &mut statistics);
        let work = self.device_work() - work_start;
        statistics.device = (work.dispatches > 0).then_some(work);
        if let Some(body) = &statistics.slowest_body {
            tracing::debug!(step, %body, remaining_m = statistics.remaining_m, "collisions did not converge");
        }
        Ok(statistics)
    }

    /// Tells the backend of collisions how to order what it searches in.
    fn order_search(&mut self) -> Result<(), SimulationError> {
        let Self { world, backend, search_order, positions, step, .. } = self;
        let count = world.collision_vertices();
        let places = [&world.positions[..count], &positions[..count]];
        let told = search_order.tell(&mut **backend, *step, places);
        told.map_err(|source| SimulationError::backend(world, *step, source))
    }

    /// Takes an abandoned time step back, in which positions have not changed; `anchors` were those at its start.
    fn take_back(&mut self, anchors: Vec<Vec<Point>>, scratch: Scratch) -> Result<(), SimulationError> {
        self.place_absent(self.time());
        self.anchors = anchors;
        self.attachments.iter_mut().for_each(Vec::clear);
        self.scratch = scratch;
        // The resolver still has the pairs of the abandoned step. What contacts remember changes at its end
        // alone.
        let carried = self.contacts.carried().clone();
        self.find_contacts(carried)
    }

    /// Closes the statistics of a time step that began at `timer` and `cpu_start` [s].
    fn close(&self, timer: Instant, cpu_start: f64, statistics: &mut StepStatistics) {
        statistics.asleep_vertices = self.asleep_vertices();
        if self.measured {
            self.measure_state(statistics);
        }
        statistics.close(timer.elapsed().as_secs_f64(), cpu_seconds() - cpu_start);
    }

    fn measure_state(&self, statistics: &mut StepStatistics) {
        let model = self.dynamics.model();
        statistics.inverted_tets = interior::inverted(&self.world, &self.positions);
        let (energies, max_stretch) = self.measures();
        statistics.max_stretch = max_stretch;
        let (collide, inside) = self.velocities.split_at(self.world.collision_vertices());
        let deformable = collide[..self.world.deformable_vertices].iter().chain(inside);
        statistics.max_speed = deformable.map(Vector::norm).fold(0.0, f64::max);
        let (momentum, center) = (model.momentum(&self.velocities), model.center_of_mass(&self.positions));
        statistics.finish(&energies, &momentum, &center);
    }
}
