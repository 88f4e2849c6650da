//! Conjugate gradients on an engine, as a backend of the dynamics.

use super::assembly::Assembly;
use super::buffers::{Pool, Sizes};
use super::galerkin::Multilevel;
use super::matrix::PackedMatrix;
use super::patches::Patches;
use super::record::Recorder;
use crate::engine::Engine;
use crate::error::GpuError;
use crate::newton::Newton;
use crate::recording::Recording;
use bowknot_dynamics::{DeviceWork, LinearBackend, LinearBackendError, LinearSystem, NewtonBackend};
use bowknot_geometry::Vector;
use std::fmt::Debug;

/// Iterations that are submitted at once; then the host looks whether the residual is small enough. Those that are too many
/// change nothing and take little time.
const BATCH: usize = 16;

/// Largest reduction of a squared residual by one solve: rounding errors of single precision come near then.
const MAX_REDUCTION: f64 = 1e-10;

/// Solves linear systems of the dynamics on an engine, with block-Jacobi, or with rigid motions on several levels of groups
/// of nodes (`docs/gpu/dynamics.md`).
#[derive(Debug)]
pub struct ConjugateGradients<E> {
    name: String,
    pub(crate) engine: E,
    pub(crate) pool: Pool,
    pub(crate) recorder: Option<Recorder>,
    /// Squared norm at the start of the solve.
    norm: f64,
    /// The elements of a model whose matrices are assembled here.
    pub(crate) assembly: Option<Assembly>,
    /// The vectors of Newton's method over that model.
    pub(crate) newton: Option<Newton>,
}

impl<E: Engine> ConjugateGradients<E> {
    /// Solves on that engine, which nothing else may use.
    pub fn new(name: String, engine: E) -> Self {
        Self { name, engine, pool: Pool::default(), recorder: None, norm: 0.0, assembly: None, newton: None }
    }

    /// What runs the stages.
    pub fn engine(&self) -> &E {
        &self.engine
    }

    /// Forgets what lies in the buffers of the system: something else is written there.
    fn forget(&mut self) {
        if let Some(assembly) = &mut self.assembly {
            assembly.forget();
        }
        if let Some(newton) = &mut self.newton {
            newton.forget_matrix();
        }
    }

    fn upload(&mut self, system: &LinearSystem<'_>) -> Result<(), GpuError> {
        let matrix = PackedMatrix::new(system);
        let patches = Patches::new(system.free, system.positions, system.patches);
        self.forget();
        let preconditioner = Multilevel::new(system, &patches);
        let sizes = Sizes::new(system.free.len(), &matrix, &patches);
        self.recorder = None;
        let buffers = self.pool.upload(&mut self.engine, &sizes, &matrix, &preconditioner)?;
        self.recorder = Some(Recorder { buffers, sizes, strands: None });
        Ok(())
    }

    fn start(&mut self, r: &[[f32; 4]]) -> Result<f64, GpuError> {
        let Some(recorder) = &self.recorder else { return Ok(0.0) };
        let mut recording = Recording::default();
        recorder.record_start(r, &mut recording);
        let norms = recorder.norms(0);
        let read = self.engine.run(&recording, &[(recorder.buffers.sums, norms.end)])?;
        Ok(read[0][norms].iter().map(|bits| f64::from(f32::from_bits(*bits))).sum())
    }

    /// Makes up to `max_iterations` and returns their number and the solution.
    fn solve(&mut self, goal: f64, max_iterations: usize) -> Result<(usize, Vec<f32>), GpuError> {
        let Some(recorder) = &self.recorder else { return Ok((0, Vec::new())) };
        let goal = goal.max(MAX_REDUCTION * self.norm) as f32;
        let mut made = 0;
        // Without a free node no stage runs that could end the iterations.
        let mut is_moving = self.norm > 0.0 && recorder.sizes.patches > 0;
        while is_moving && made < max_iterations {
            let mut recording = Recording::default();
            let end = max_iterations.min(made + BATCH);
            if made == 0 {
                recorder.record_goal(goal, &mut recording);
            }
            (made..end).for_each(|k| recorder.record_iteration(k, &mut recording));
            let read = self.engine.run(&recording, &[(recorder.buffers.progress, 2)])?;
            is_moving = read[0][0] == 1;
            made = read[0][1] as usize;
        }
        let words = 4 * recorder.sizes.nodes;
        let read = self.engine.run(&Recording::default(), &[(recorder.buffers.solution, words)])?;
        Ok((made, read[0].iter().map(|bits| f32::from_bits(*bits)).collect()))
    }
}

impl<E: Engine + Debug + Send> LinearBackend for ConjugateGradients<E> {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn work(&self) -> DeviceWork {
        self.engine.work()
    }

    fn prepare(&mut self, system: &LinearSystem<'_>) -> Result<(), LinearBackendError> {
        Ok(self.upload(system)?)
    }

    fn newton(&mut self) -> Option<&mut dyn NewtonBackend> {
        Some(self)
    }

    fn begin(&mut self, r: &[Vector], factor: f64) -> Result<f64, LinearBackendError> {
        let r: Vec<[f32; 4]> = r
            .iter()
            .map(|r| [(r.x * factor) as f32, (r.y * factor) as f32, (r.z * factor) as f32, 0.0])
            .collect();
        self.norm = self.start(&r)?;
        Ok(self.norm)
    }

    fn iterate(
        &mut self,
        goal: f64,
        max_iterations: usize,
        factor: f64,
        x: &mut [Vector],
    ) -> Result<usize, LinearBackendError> {
        let (iterations, solution) = self.solve(goal, max_iterations)?;
        for (x, s) in x.iter_mut().zip(solution.chunks_exact(4)) {
            *x += Vector::new(f64::from(s[0]), f64::from(s[1]), f64::from(s[2])) * factor;
        }
        Ok(iterations)
    }
}
