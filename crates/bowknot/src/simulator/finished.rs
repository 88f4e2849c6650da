//! Bodies whose time step is solved while that of others goes on.
//!
//! Connected bodies that touch neither directly nor through others do not depend on each other. Each such
//! group ends its iterations by its own residual: from then on the dynamics has its vertices as prescribed,
//! where they are. A contact that is found later joins two groups, and what had ended goes on. Otherwise the
//! iterations of one body would go on as long as those of any other, however far away. The collision stage
//! moves all bodies as ever; those that are finished are at their targets.

use super::tolerance::Tolerance;
use bowknot_dynamics::{DynamicsModel, RepulsionSpring};
use bowknot_geometry::{Point, UnionFind};

/// Which vertices of a world are prescribed in an iteration, and where they end, with bodies that are
/// finished among them.
#[derive(Debug, Default)]
pub(super) struct Finished {
    /// Connected component of each vertex; `u32::MAX` for those of obstacles. Empty before it is needed.
    components: Vec<u32>,
    /// Vertices that are prescribed, whatever is finished.
    prescribed: Vec<bool>,
    /// Vertices that are prescribed, those of finished bodies included.
    held: Vec<bool>,
    /// Where they end [m]; only entries of vertices that are held count.
    places: Vec<Point>,
}

impl Finished {
    /// Begins a time step in which vertices are `prescribed`, and nothing is finished.
    pub fn begin(&mut self, prescribed: &[bool]) {
        self.components.clear();
        self.prescribed.clear();
        self.prescribed.extend_from_slice(prescribed);
        self.held.clear();
        self.held.extend_from_slice(prescribed);
    }

    /// Lets all groups go on.
    pub fn release(&mut self) {
        self.held.clone_from(&self.prescribed);
    }

    /// Updates which groups are finished, by the `residuals` of connected components [m], where `springs` may
    /// act. A component goes on if not all of its vertices are `counted`: what rows alone hold has no
    /// residual.
    pub fn update(
        &mut self,
        model: &DynamicsModel,
        residuals: &[f64],
        counted: &[bool],
        springs: &[RepulsionSpring],
        tolerance: Tolerance,
    ) {
        self.release();
        let Self { components, held, .. } = self;
        if residuals.len() < 2 {
            return;
        }
        if components.is_empty() {
            *components = model.components_of_vertices();
        }
        let mut groups = UnionFind::new(residuals.len());
        for spring in springs {
            let sides = spring.vertices.iter().zip(spring.weights).filter(|(_, weight)| *weight != 0.0);
            let mut sides = sides.map(|(&v, _)| components[v as usize]).filter(|c| *c != u32::MAX);
            if let Some(first) = sides.next() {
                sides.for_each(|other| groups.join(first, other));
            }
        }
        let mut goes_on = vec![false; residuals.len()];
        for (component, residual) in (0..).zip(residuals) {
            if !tolerance.ends(*residual) {
                goes_on[groups.find(component) as usize] = true;
            }
        }
        for (&component, _) in
            components.iter().zip(counted).filter(|(c, counted)| **c != u32::MAX && !**counted)
        {
            goes_on[groups.find(component) as usize] = true;
        }
        for (held, &component) in held.iter_mut().zip(&*components).filter(|(_, c)| **c != u32::MAX) {
            *held |= !goes_on[groups.find(component) as usize];
        }
    }

    /// Begins an iteration from `x`, in which obstacles and pins are led to their `ends` [m].
    pub fn lead(&mut self, x: &[Point], ends: &[Point]) {
        let Self { prescribed, places, .. } = self;
        places.clear();
        let place = |(led, (x, end)): (&bool, (&Point, &Point))| if *led { *end } else { *x };
        places.extend(prescribed.iter().zip(x.iter().zip(ends)).map(place));
    }

    /// Which vertices are prescribed in the iteration.
    pub fn held(&self) -> &[bool] {
        &self.held
    }

    /// Where they end: those of finished bodies where they are, the others at their ends [m].
    pub fn places(&self) -> &[Point] {
        &self.places
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bowknot_dynamics::{Body, ClothMaterial, Integrator, SpringKind};
    use bowknot_geometry::Vector;

    /// Three triangles, and a spring between the vertices `a` and `b`.
    fn finished(residuals: [f64; 3], [a, b]: [u32; 2], uncounted: Option<usize>) -> Vec<bool> {
        let counted: Vec<bool> = (0..9).map(|v| Some(v) != uncounted).collect();
        let rest = (0..9).map(|k| Point::new(f64::from(k % 3), f64::from(k * k % 3), f64::from(k / 3)));
        let triangles = vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]];
        let body = Body::cloth("sheets", triangles, ClothMaterial::cotton());
        let model = DynamicsModel::new(rest.collect(), vec![body]).expect("a model");
        // Components have another order than vertices.
        let components = model.components_of_vertices();
        let mut by_component = [0.0; 3];
        (0..3).for_each(|k| by_component[components[3 * k] as usize] = residuals[k]);
        let spring = RepulsionSpring {
            kind: SpringKind::Contact,
            vertices: [a, b, 0, 0],
            weights: [1.0, -1.0, 0.0, 0.0],
            normal: Vector::z(),
            offset: 0.0,
            reach: 1.0,
            floor: 0.0,
            start_gap: 1.0,
            stiffness: 1.0,
            friction: 0.0,
            friction_ratio: Vector::zeros(),
        };
        let mut finished = Finished::default();
        finished.begin(&[true, false, false, false, false, false, false, false, false]);
        let tolerance = Tolerance::new(1.0, 0.01, Integrator::ImplicitEuler);
        finished.update(&model, &by_component, &counted, &[spring], tolerance);
        finished.held().to_vec()
    }

    #[test]
    fn a_group_is_finished_where_all_of_its_bodies_are() {
        let [t, f] = [true, false];
        assert_eq!(finished([2.0, 0.5, 2.0], [3, 3], None), [t, f, f, t, t, t, f, f, f]);
        assert_eq!(finished([0.5, 0.5, 2.0], [4, 8], None), [t, t, t, f, f, f, f, f, f]);
        assert_eq!(finished([0.5, 2.0, 0.5], [0, 8], None), [t, t, t, f, f, f, t, t, t]);
        assert_eq!(finished([0.5, 0.5, 2.0], [3, 3], Some(4)), [t, t, t, f, f, f, f, f, f]);
    }

    #[test]
    fn what_is_finished_stays_where_it_is() {
        let mut finished = Finished::default();
        finished.begin(&[true, false]);
        let (x, ends) = ([Point::origin(); 2], [Point::new(1.0, 0.0, 0.0); 2]);
        finished.lead(&x, &ends);
        assert_eq!(finished.places(), [ends[0], x[1]]);
    }
}
