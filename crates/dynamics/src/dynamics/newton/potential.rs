//! The incremental potential, on the CPU.

use super::bodies::BodyEnergies;
use super::cpu::CpuBodies;
use crate::elements::set::Motion;
use crate::nodes::CHUNK;
use bowknot_geometry::Vector;
use rayon::prelude::*;

impl CpuBodies<'_> {
    /// The incremental potential at `x` without springs [J]: the part of inertia and air, and the part of
    /// elements.
    fn energies(&self, x: &[Vector]) -> [f64; 2] {
        let Self { model, params, step, .. } = self;
        let free = &self.work.free;
        let motion = Motion { x, start: &step.start, rate: 1.0 / step.dt };
        let inertia = 0.5 / (step.dt * step.dt);
        let drag = 0.5 * params.environment.air_drag / step.dt;
        let chunks = x.len().div_ceil(CHUNK);
        let partial: Vec<[f64; 2]> = (0..chunks)
            .into_par_iter()
            .map(|chunk| {
                let mut kinetic = 0.0;
                for node in chunk * CHUNK..((chunk + 1) * CHUNK).min(x.len()) {
                    if free[node] {
                        let share = inertia * (x[node] - step.inertial[node]).norm_squared()
                            + drag * (x[node] - step.start[node]).norm_squared();
                        kinetic += model.node_masses[node] * share;
                        if let Some(drag) = &step.drag {
                            let moved = x[node] - step.start[node];
                            kinetic += moved
                                .dot(&(drag.matrix[node] * moved * (0.5 * motion.rate) - drag.push[node]));
                        }
                    }
                }
                let elements: f64 = model.sets().map(|set| set.energy(chunk, motion)).sum();
                [kinetic, elements + model.bending.chunk_energy(chunk, x)]
            })
            .collect();
        let (mut kinetic, mut internal) = (0.0, 0.0);
        for [k, i] in partial {
            kinetic += k;
            internal += i;
        }
        if let Some(damping) = &model.bending_damping {
            let moved: Vec<Vector> = x.iter().zip(&step.start).map(|(x, x0)| x - x0).collect();
            internal += damping.energy(&moved) / step.dt;
        }
        [kinetic, internal]
    }

    /// The incremental potential of the bodies at the trial, from the cache if it was last computed there.
    pub(super) fn energies_of_trial(&mut self) -> BodyEnergies {
        let trial = std::mem::take(&mut self.work.trial);
        if self.work.cache.energies_at != trial {
            self.work.cache.energies = self.energies(&trial);
            self.work.cache.energies_at.clone_from(&trial);
        }
        self.work.trial = trial;
        let [kinetic, internal] = self.work.cache.energies;
        BodyEnergies { kinetic, internal, rounding: 0.0 }
    }
}
