//! What a time step reports: one line of `stats.jsonl`.

use super::blocking::WaitingElements;
use super::unsolved::{Search, Unsolved};
use crate::simulator::stretch_limits::HeldApart;
use bowknot_dynamics::{DeviceWork, Energies, NewtonInfo, Residual};
use bowknot_geometry::{Point, Vector};
use bowknot_twoway::{Skipped, Statistics};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What a time step did and how it ended; it serializes to one line of `stats.jsonl`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepStatistics {
    /// Index of the time step, from 1: the frame that it made.
    pub step: usize,
    /// Time at its end [s].
    pub time: f64,
    /// Newton iterations.
    pub newton_iterations: usize,
    /// Iterations of the linear solves, over all Newton iterations.
    pub cg_iterations: usize,
    /// Two-way steps, over all collision problems.
    pub two_way_steps: usize,
    /// Proximity searches, likewise.
    pub searches: usize,
    /// Candidate pairs after the last search.
    pub pairs: usize,
    /// Contact rows of the last backward step.
    pub contact_rows: usize,
    /// Edge rows of the last backward step.
    pub edge_rows: usize,
    /// Rows swept in the last backward step.
    pub active_rows: usize,
    /// Pairs that no certificate covers, so that their vertices did not move, over all two-way steps.
    pub frozen_pairs: usize,
    /// Largest remaining fraction r at the end of the last collision problem.
    pub remaining_r: f64,
    /// Largest remaining distance at the end of the last collision problem [m].
    pub remaining_m: f64,
    /// Largest stationarity residual, likewise [m].
    pub stationarity_m: f64,
    /// Whether the last collision problem met the stopping rule.
    pub converged: bool,
    /// Smallest distance over the candidate pairs at the end [m]; none if there are none.
    pub min_gap_m: Option<f64>,
    /// Largest ratio of an edge's length to its rest length at the end, over cloth and strands; 0 without any.
    pub max_stretch: f64,
    /// Largest ratio of an edge's length to its length at the start, over the collision problems.
    pub max_step_stretch: f64,
    /// Largest speed of a deformable vertex at the end [m/s].
    pub max_speed: f64,
    /// Energies at the end [J].
    pub energy: Energy,
    /// Momentum at the end [kg m/s].
    pub momentum: [f64; 3],
    /// Center of mass at the end [m].
    pub center_of_mass: [f64; 3],
    /// Wall seconds by stage.
    pub seconds: StepSeconds,
    /// CPU seconds of the process, all threads; 0 where the system does not tell.
    pub cpu_seconds: f64,
    /// Work that was skipped because nothing needed it.
    pub skipped: Skipped,
    /// Name of the body with the largest remaining distance, if the last collision problem did not converge.
    #[serde(default)]
    pub slowest_body: Option<String>,
    /// What held back the vertices that had farthest to go, if a collision problem took 32 two-way steps or
    /// more, or did not converge although nothing cut it short.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub waits: Vec<WaitingElements>,
    /// Largest distance by which an obstacle or pin lags behind its keyframe at the end [m].
    #[serde(default)]
    pub prescribed_lag_m: f64,
    /// The obstacles and pins that wait for what is in their way, by name, and how far they lag behind their
    /// keyframes at the end [m].
    #[serde(default)]
    pub waiting: BTreeMap<String, f64>,
    /// The obstacles that are not there in the next time step, by name, and what is in the place of those
    /// that wait to appear, in words.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub absent: BTreeMap<String, Option<String>>,
    /// Bound on the kinetic energy that separation to the contact distance injected [J], the sum over all
    /// collision problems, see [`Statistics::injected_j`].
    #[serde(default)]
    pub injected_energy_j: f64,
    /// Energy that the collision stage put in, as measured [J]: kinetic, elastic and potential energy after
    /// it, less that of the target of the dynamics, where that is positive; the sum over all collision
    /// problems. Separation shows here, and the work of moving obstacles; what the dynamics itself loses does
    /// not.
    #[serde(default)]
    pub collision_energy_j: f64,
    /// Friction rows of the last backward step.
    #[serde(default)]
    pub friction_rows: usize,
    /// Contacts in the first Newton system.
    #[serde(default)]
    pub repulsion_springs: usize,
    /// Contacts of the dynamics that carry a force at the end.
    #[serde(default)]
    pub pressing_contacts: usize,
    /// Net forces at the end, the root of their sum of squares [N]: inertia, elasticity, bending, damping,
    /// drag, contact and friction.
    #[serde(default)]
    pub residual_n: f64,
    /// What they are worth in distance [m], see [`bowknot_dynamics::Residual::distance`].
    #[serde(default)]
    pub residual_m: f64,
    /// The tolerance of `residual_m` that ends the Newton iterations of a time step [m]; 0 if there is none.
    #[serde(default)]
    pub tolerance_m: f64,
    /// Whether the time step ended as a solution: `residual_m` at most `tolerance_m`, if there is a
    /// tolerance, and the last collision problem converged. True for lines that do not say it.
    #[serde(default = "not_said")]
    pub solved: bool,
    /// Where forces are out of balance in a time step that is not solved.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unsolved: Option<Unsolved>,
    /// The pins that held edges over their stretch limits at the end, if any did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub held_apart: Option<HeldApart>,
    /// Tetrahedra without a positive volume at the end.
    #[serde(default)]
    pub inverted_tets: usize,
    /// Elastic solves by which vertices inside of solids follow their surfaces.
    #[serde(default)]
    pub interior_solves: usize,
    /// What devices were asked for; none on the CPU.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub device: Option<DeviceWork>,
    /// Vertices of bodies that sleep during the next time step, those inside of solids included.
    #[serde(default)]
    pub asleep_vertices: usize,
}

/// [`StepStatistics::solved`] of lines that do not say it.
fn not_said() -> bool {
    true
}

/// Energies [J].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// 1/2 sum m |v|^2.
    pub kinetic: f64,
    /// Stretching and bending.
    pub elastic: f64,
    /// - sum m g . x.
    pub potential: f64,
}

/// Wall seconds by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepSeconds {
    /// The whole time step.
    pub total: f64,
    /// Targets: the dynamics.
    pub dynamics: f64,
    /// Proximity search.
    pub search: f64,
    /// Contact geometry of the candidate pairs.
    pub evaluate: f64,
    /// Backward steps.
    pub backward: f64,
    /// Forward steps.
    pub forward: f64,
    /// Those of `search`, `evaluate`, `backward` and `forward` in which a GPU computed, by its time stamps;
    /// none on the CPU and on a GPU without time stamps, where all four are 0 and `other` has them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub device: Option<f64>,
    /// Everything else: observers such as `--check` and `--trace`, and the loop itself.
    pub other: f64,
}

impl StepStatistics {
    /// Adds a Newton iteration.
    pub(crate) fn add_newton(&mut self, info: &NewtonInfo, seconds: f64) {
        self.newton_iterations += 1;
        self.cg_iterations += info.cg.iterations;
        self.seconds.dynamics += seconds;
    }

    /// Adds a collision problem.
    pub(crate) fn add_collision(&mut self, call: &Statistics, name_of: impl Fn(u32) -> String) {
        self.two_way_steps += call.steps;
        self.searches += call.searches;
        self.pairs = call.pairs;
        self.contact_rows = call.contact_rows;
        self.edge_rows = call.edge_rows;
        self.active_rows = call.active_rows;
        self.friction_rows = call.friction_rows;
        self.injected_energy_j += call.injected_j;
        self.frozen_pairs += call.frozen_pairs;
        self.remaining_r = call.remaining_r;
        self.remaining_m = call.remaining_m;
        self.stationarity_m = call.stationarity_m;
        self.converged = call.converged;
        self.min_gap_m = call.min_gap_m;
        self.max_step_stretch = self.max_step_stretch.max(call.max_step_stretch);
        self.seconds.search += call.seconds.search;
        self.seconds.evaluate += call.seconds.evaluate;
        self.seconds.backward += call.seconds.backward;
        self.seconds.forward += call.seconds.forward;
        self.skipped.searches += call.skipped.searches;
        self.skipped.evaluations += call.skipped.evaluations;
        self.skipped.rows += call.skipped.rows;
        self.slowest_body = call.slowest_body.filter(|_| !call.converged).map(name_of);
    }

    /// Fills in with which `residual` the iterations of a stage ended, and where they are out of balance if it
    /// is not solved.
    pub(crate) fn end_iterations(
        &mut self,
        search: &Search<'_>,
        residual: &Residual,
        is_balanced: bool,
        slowest_body: Option<u32>,
    ) {
        // The larger one of the stages; one that is not a number stays.
        let larger = |new: f64, old: f64| if new.is_nan() || new > old { new } else { old };
        self.residual_n = larger(residual.force, self.residual_n);
        self.residual_m = larger(residual.distance, self.residual_m);
        let is_solved = self.converged && is_balanced;
        self.solved &= is_solved;
        if !is_solved {
            let of_forces = || residual.vertex.map(|vertex| search.of_forces(vertex));
            let of_collisions = || search.of_collisions(&self.waits, slowest_body);
            // Where forces balance, what stopped the collision stage is the cause.
            self.unsolved = match is_balanced {
                true => of_collisions().or_else(of_forces),
                false => of_forces().or_else(of_collisions),
            };
        }
    }

    /// Fills in what is measured at the end.
    pub(crate) fn finish(&mut self, energies: &Energies, momentum: &Vector, center: &Point) {
        let Energies { kinetic, elastic, potential } = *energies;
        self.energy = Energy { kinetic, elastic, potential };
        self.momentum = (*momentum).into();
        self.center_of_mass = center.coords.into();
    }

    /// Fills in the total times, and the wall time that no stage accounts for.
    pub(crate) fn close(&mut self, total: f64, cpu_seconds: f64) {
        let s = &mut self.seconds;
        s.total = total;
        s.other = (total - s.dynamics - s.search - s.evaluate - s.backward - s.forward).max(0.0);
        self.cpu_seconds = cpu_seconds;
    }
}
