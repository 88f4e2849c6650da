//! Damping of oscillations of the target, by a factor on the proximal weight of each vertex.

use crate::scene::CollisionScene;
use crate::state::ResolveState;
use bowknot_geometry::Vector;

/// Change of the factor of a vertex each time that its wanted displacement reverses, and each time that it
/// does not. In hard contact, values of 1.5 to 3 and 0.7 to 0.9 differ by less than the scenes do.
const GROWTH: f64 = 2.0;
const DECAY: f64 = 0.8;

/// The factors. If the wanted displacement of a vertex reverses from one step to the next, y oscillates about
/// x: the proximal weight is too small there.
#[derive(Debug, Default)]
pub(crate) struct OscillationDamping {
    factors: Vec<f64>,
    wanted: Vec<Vector>,
}

impl OscillationDamping {
    /// Starts a call.
    pub fn begin(&mut self, scene: &CollisionScene) {
        let is_on = scene.params().solver.backward.proximal_growth > 1.0;
        let vertices = if is_on { scene.vertex_count() } else { 0 };
        self.factors.clear();
        self.factors.resize(vertices, 1.0);
        self.wanted.clear();
        self.wanted.resize(vertices, Vector::zeros());
    }

    /// Multiplies the proximal weights by the factors.
    pub fn apply(&self, proximal: &mut [f64]) {
        proximal.iter_mut().zip(&self.factors).for_each(|(mu, factor)| *mu *= factor);
    }

    /// Updates the factors after a backward step.
    pub fn update(&mut self, scene: &CollisionScene, state: &ResolveState) {
        let largest = scene.params().solver.backward.proximal_growth;
        for v in 0..self.factors.len() {
            let wanted = state.y[v] - state.x[v];
            let last = std::mem::replace(&mut self.wanted[v], wanted);
            let factor = &mut self.factors[v];
            let turn = wanted.dot(&last);
            if turn < 0.0 {
                *factor = (*factor * GROWTH).min(largest);
            } else if turn > 0.0 {
                *factor = (*factor * DECAY).max(1.0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Params, Resolver};
    use bowknot_geometry::{Point, Topology};
    use bowknot_proximity::CollisionModel;

    #[test]
    fn the_factor_grows_where_the_target_oscillates_and_falls_elsewhere() {
        let x = vec![Point::origin(), Point::new(1.0, 0.0, 0.0)];
        let topology = Topology::builder(2).particles([0, 1]).build().unwrap();
        let model = CollisionModel::single_body(topology);
        let resolver = Resolver::new(model, &x, &[1.0; 2], Params::fast()).unwrap();
        let scene = resolver.scene();
        let mut state = ResolveState { x: x.clone(), y: x.clone(), ..ResolveState::default() };
        let mut damping = OscillationDamping::default();
        damping.begin(scene);
        let mut weights = |wanted: f64| {
            state.y = vec![x[0] + wanted * Vector::x(), x[1] + Vector::x()];
            damping.update(scene, &state);
            let mut proximal = [1.0; 2];
            damping.apply(&mut proximal);
            proximal
        };
        assert_eq!(weights(1.0), [1.0, 1.0]);
        assert_eq!(weights(-1.0), [2.0, 1.0]);
        assert_eq!(weights(1.0), [4.0, 1.0]);
        assert_eq!(weights(1.0), [3.2, 1.0]);
        for k in 0..20 {
            weights(if k % 2 == 0 { -1.0 } else { 1.0 });
        }
        assert_eq!(weights(-1.0), [32.0, 1.0], "bounded");
    }
}
