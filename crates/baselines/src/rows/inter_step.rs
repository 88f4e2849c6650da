//! Chebyshev acceleration from step to step (Wang 2015), around any backward step.

use bowknot_twoway::geometry::Point;
use bowknot_twoway::{BackwardStep, CollisionScene, Residuals, ResolveState, Statistics};

/// Accelerates the targets of another backward step over the two-way steps of a call (Wang 2015, "A Chebyshev
/// semi-iterative approach for accelerating projective and position-based dynamics"; paper, section 4.2.2,
/// which finds it ineffective because contacts come and go): y^(l+1) <- y^(l-1) + omega (y^(l+1) - y^(l-1)),
/// with omega_1 = 2/(2 - rho^2) and omega_(k+1) = 4/(4 - rho^2 omega_k) after `delay` plain steps.
///
/// Multipliers and residuals are those of the inner step. An inner step that starts from multipliers and y', as
/// projected Jacobi here, does not read the accelerated y: it moves x alone.
#[derive(Clone, Debug)]
pub struct InterStepChebyshev<B> {
    inner: B,
    spectral_radius: f64,
    delay: usize,
    omega: f64,
    /// y^(l-1) and y^(l) [m].
    before: Vec<Point>,
    last: Vec<Point>,
}

impl<B> InterStepChebyshev<B> {
    /// Around `inner`, for an estimate of the spectral radius in [0, 1), after `delay` plain steps (Wang
    /// 2015: 10).
    pub fn new(inner: B, spectral_radius: f64, delay: usize) -> Self {
        Self { inner, spectral_radius, delay, omega: 1.0, before: Vec::new(), last: Vec::new() }
    }
}

impl<B: BackwardStep> BackwardStep for InterStepChebyshev<B> {
    fn begin(&mut self, scene: &CollisionScene, state: &ResolveState) {
        self.omega = 1.0;
        self.before.clone_from(&state.y);
        self.last.clone_from(&state.y);
        self.inner.begin(scene, state);
    }

    fn project(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        self.inner.project(scene, state, statistics);
        let square = self.spectral_radius * self.spectral_radius;
        if state.step >= self.delay {
            self.omega = if state.step == self.delay {
                2.0 / (2.0 - square)
            } else {
                4.0 / (4.0 - square * self.omega)
            };
            for v in 0..state.y.len() {
                if state.is_movable(v) {
                    let before = self.before[v];
                    state.y[v] = before + self.omega * (state.y[v] - before);
                }
            }
        }
        std::mem::swap(&mut self.before, &mut self.last);
        self.last.clone_from(&state.y);
    }

    fn residuals(&mut self, scene: &CollisionScene, state: &ResolveState) -> Residuals {
        self.inner.residuals(scene, state)
    }

    fn finish(&mut self, scene: &CollisionScene, state: &ResolveState, statistics: &mut Statistics) {
        self.inner.finish(scene, state, statistics);
    }
}
