//! Damping of oscillations of the target, by a factor on the proximal weight of each vertex.

use crate::index_set::IndexSet;
use crate::scene::CollisionScene;
use crate::state::ResolveState;
use bowknot_geometry::Vector;

/// Change of the factor of a vertex each time that its wanted displacement reverses, and each time that it
/// does not. In hard contact, values of 1.5 to 3 and 0.7 to 0.9 differ by less than the scenes do.
const GROWTH: f64 = 2.0;
const DECAY: f64 = 0.8;

/// The factors. If the wanted displacement of a vertex reverses from one step to the next, y oscillates about
/// x: the proximal weight is too small there.
///
/// A vertex that wants to go to its target y0 in both steps gets nearer to it and does not reverse. So only
/// the vertices whose y differs from y0 in one of them need a look, and those with a factor above 1.
#[derive(Debug, Default)]
pub(crate) struct OscillationDamping {
    factors: Vec<f64>,
    /// Vertices with a factor above 1.
    raised: IndexSet,
}

impl OscillationDamping {
    /// Starts a call.
    pub fn begin(&mut self, scene: &CollisionScene) {
        let is_on = scene.params().solver.backward.proximal_growth > 1.0;
        let vertices = if is_on { scene.vertex_count() } else { 0 };
        if self.factors.len() != vertices {
            self.raised.clear();
            self.factors.clear();
            self.factors.resize(vertices, 1.0);
        }
        self.raised.members().iter().for_each(|&v| self.factors[v as usize] = 1.0);
        self.raised.reset(vertices);
    }

    /// The factor on the proximal weight of a vertex.
    #[inline]
    pub fn factor(&self, vertex: usize) -> f64 {
        self.factors.get(vertex).copied().unwrap_or(1.0)
    }

    /// Updates the factors after a backward step. `y` is its result; `state.y` is still that of the last
    /// step, which started at `state.previous`. `changed` are the vertices, each once, with y or `state.y`
    /// other than their target.
    pub fn update(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        y: &[Vector],
        changed: impl Iterator<Item = u32>,
        is_changed: impl Fn(u32) -> bool,
    ) {
        if self.factors.is_empty() || state.step == 0 {
            return;
        }
        let largest = scene.params().solver.backward.proximal_growth;
        let factors = &mut self.factors;
        let mut update = |v: u32| {
            let v = v as usize;
            let turn = (y[v] - state.x[v].coords).dot(&(state.y[v] - state.previous[v]));
            let factor = &mut factors[v];
            if turn < 0.0 {
                *factor = (*factor * GROWTH).min(largest);
            } else if turn > 0.0 {
                *factor = (*factor * DECAY).max(1.0);
            }
            *factor > 1.0
        };
        // Those that change are looked at below.
        self.raised.retain(|v| !is_changed(v) && update(v));
        for v in changed {
            if update(v) {
                self.raised.insert(v);
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
        let mut state =
            ResolveState { x: x.clone(), y: x.clone(), previous: x.clone(), ..Default::default() };
        let mut damping = OscillationDamping::default();
        damping.begin(scene);
        let mut factors = |wanted: f64| {
            let y = vec![x[0] + wanted * Vector::x(), x[1] + Vector::x()];
            let coords: Vec<Vector> = y.iter().map(|y| y.coords).collect();
            damping.update(scene, &state, &coords, [0].into_iter(), |v| v == 0);
            (state.y, state.step) = (y, state.step + 1);
            [0, 1].map(|v| damping.factor(v))
        };
        assert_eq!(factors(1.0), [1.0, 1.0]);
        assert_eq!(factors(-1.0), [2.0, 1.0]);
        assert_eq!(factors(1.0), [4.0, 1.0]);
        assert_eq!(factors(1.0), [3.2, 1.0]);
        for k in 0..20 {
            factors(if k % 2 == 0 { -1.0 } else { 1.0 });
        }
        assert_eq!(factors(-1.0), [32.0, 1.0], "bounded");
        // A vertex that no longer changes decays as well, and a new call starts from 1.
        let y: Vec<Vector> = state.y.iter().map(|y| y.coords).collect();
        damping.update(scene, &state, &y, [].into_iter(), |_| false);
        assert_eq!(damping.factor(0), 0.8 * 32.0);
        damping.begin(scene);
        assert_eq!((damping.factor(0), damping.factor(1)), (1.0, 1.0));
    }
}
