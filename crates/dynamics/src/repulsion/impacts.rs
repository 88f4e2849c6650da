//! What contacts do to velocities at the end of a stage of a time step, see [`crate::dynamics::stages`].

use super::spring::SpringKind;
use super::springs::Repulsion;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;

/// Sweeps of Gauss-Seidel over all contacts. More: less of the velocity at which contacts close or open remains. Fewer:
/// less time.
const SWEEPS: usize = 4;

/// The contacts that press, and the taut edges.
pub(crate) struct Impacts(Vec<Impact>);

struct Impact {
    vertices: [u32; 4],
    weights: [f64; 4],
    /// Of the vertices that are free.
    nodes: [Option<u32>; 4],
    /// The direction in which it opens.
    normal: Vector,
    /// Normal force and friction on the side that the normal points to [N].
    force: [Vector; 2],
    /// Whether it sticks.
    sticks: bool,
    /// Length of the stage [s].
    length: f64,
}

impl Repulsion {
    /// The contacts that press with watched nodes at `x` [m], at the end of a stage of `length` [s]. `free_node` is the
    /// node of a vertex that is free.
    pub fn impacts(&self, x: &[Vector], length: f64, free_node: impl Fn(u32) -> Option<u32>) -> Impacts {
        let impact = |spring: usize| {
            let (state, s) = (&self.states[spring], &self.springs[spring]);
            let (gap, slip) = self.gap_and_slip(spring, x);
            let push = if state.acts { state.push(gap).force } else { 0.0 };
            (push > 0.0).then(|| {
                let normal = self.normal(spring, x);
                let rub = state.rub(&slip, s.friction * push);
                Impact {
                    vertices: s.vertices,
                    weights: s.weights,
                    nodes: std::array::from_fn(|k| {
                        (s.weights[k] != 0.0).then(|| free_node(s.vertices[k])).flatten()
                    }),
                    normal,
                    force: [normal * push, rub.force],
                    sticks: s.kind == SpringKind::Contact && s.friction > 0.0 && rub.sliding.is_none(),
                    length,
                }
            })
        };
        Impacts((0..self.springs.len()).filter_map(impact).collect())
    }
}

impl Impacts {
    /// Sums of the normal forces on nodes, whatever their directions [N].
    pub fn pressures(&self, nodes: usize) -> Vec<f64> {
        let mut pressures = vec![0.0; nodes];
        for impact in &self.0 {
            for (node, weight) in impact.free() {
                pressures[node as usize] += weight.abs() * impact.force[0].norm();
            }
        }
        pressures
    }

    /// Takes from the accelerations of nodes [m/s^2] the share of each contact's force by which `now` more presses on
    /// its nodes than `before` [N].
    pub fn take_sudden_forces(
        &self,
        before: &[f64],
        now: &[f64],
        masses: &[f64],
        accelerations: &mut [Vector],
    ) {
        for impact in &self.0 {
            let lasting = |node: u32| {
                let node = node as usize;
                if now[node] > before[node] { before[node] / now[node] } else { 1.0 }
            };
            let sudden = 1.0 - impact.free().map(|(node, _)| lasting(node)).fold(1.0, f64::min);
            for (node, weight) in impact.free() {
                let force = (impact.force[0] + impact.force[1]) * (weight * sudden);
                accelerations[node as usize] -= force / masses[node as usize];
            }
        }
    }

    /// Takes away the velocities [m/s], by vertex, at which contacts close or open, and at which those that stick slip,
    /// by impulses of at most `bound` times those of the contact in the stage. Each impulse is the exact minimum of the
    /// kinetic energy along its direction, or a part of the way there.
    pub fn stop(&self, masses: &[f64], bound: f64, v: &mut [Vector]) {
        let mut impulses = vec![[Vector::zeros(); 2]; self.0.len()];
        for _ in 0..SWEEPS {
            for (impact, impulses) in self.0.iter().zip(&mut impulses) {
                let inverse: f64 = impact.free().map(|(node, w)| w * w / masses[node as usize]).sum();
                if inverse == 0.0 {
                    continue;
                }
                let along = impact.normal * impact.normal.transpose();
                let parts = [(along, true), (Matrix3::identity() - along, impact.sticks)];
                for (part, (projection, acts)) in parts.into_iter().enumerate() {
                    if !acts {
                        continue;
                    }
                    let used = (0..4).filter(|&k| impact.weights[k] != 0.0);
                    let relative: Vector =
                        used.map(|k| v[impact.vertices[k] as usize] * impact.weights[k]).sum();
                    let wanted = impulses[part] - projection * relative / inverse;
                    let most = bound * impact.length * impact.force[part].norm();
                    let size = wanted.norm();
                    let next = if size > most { wanted * (most / size) } else { wanted };
                    let change = next - impulses[part];
                    impulses[part] = next;
                    for k in 0..4 {
                        if let Some(node) = impact.nodes[k] {
                            v[impact.vertices[k] as usize] +=
                                change * (impact.weights[k] / masses[node as usize]);
                        }
                    }
                }
            }
        }
    }
}

impl Impact {
    /// The free nodes with their weights.
    fn free(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        self.nodes.iter().zip(self.weights).filter_map(|(node, weight)| Some(((*node)?, weight)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two contacts that share vertices of different masses, the first of which sticks.
    fn impacts(size: f64) -> Impacts {
        let impact = |vertices, weights, normal: Vector, sticks| Impact {
            vertices,
            weights,
            nodes: std::array::from_fn(|k| (weights[k] != 0.0).then_some(vertices[k])),
            normal,
            force: [normal * size, normal.cross(&Vector::x()) * size],
            sticks,
            length: 1.0,
        };
        Impacts(vec![
            impact([0, 1, 2, 3], [0.5, 0.5, -0.25, -0.75], Vector::z(), true),
            impact([1, 3, 0, 0], [1.0, -1.0, 0.0, 0.0], Vector::new(0.0, 0.6, 0.8), false),
        ])
    }

    #[test]
    fn impulses_take_kinetic_energy_and_conserve_momentum() {
        let masses = [1.0, 2.0, 0.5, 4.0];
        for size in [1e-3, 0.1, 10.0] {
            let velocity =
                |k: usize| Vector::new((3.0 * k as f64).sin(), (5.0 * k as f64).cos(), k as f64 - 1.5);
            let mut v: Vec<Vector> = (0..4).map(velocity).collect();
            let energy = |v: &[Vector]| (0..4).map(|k| masses[k] * v[k].norm_squared()).sum::<f64>();
            let momentum = |v: &[Vector]| (0..4).map(|k| v[k] * masses[k]).sum::<Vector>();
            let before = (energy(&v), momentum(&v));
            impacts(size).stop(&masses, 2.0, &mut v);
            assert!(energy(&v) < before.0, "{size}: {} {}", energy(&v), before.0);
            assert!((momentum(&v) - before.1).norm() < 1e-12, "{size}");
        }
    }

    #[test]
    fn strong_contacts_stop_what_closes_and_slips_and_weak_ones_a_part_of_it() {
        let masses = [1.0, 2.0, 0.5, 4.0];
        let start = || vec![Vector::new(1.0, -2.0, 3.0), Vector::zeros(), Vector::x(), Vector::y()];
        let mut all = impacts(10.0);
        all.0.truncate(1);
        let relative = |v: &[Vector]| v[0] * 0.5 + v[1] * 0.5 - v[2] * 0.25 - v[3] * 0.75;
        let mut v = start();
        all.stop(&masses, 2.0, &mut v);
        assert!(relative(&v).norm() < 1e-12, "{}", relative(&v));
        let mut weak = impacts(0.1);
        weak.0.truncate(1);
        let mut v = start();
        weak.stop(&masses, 2.0, &mut v);
        let inverse: f64 = [0.25, 0.125, 0.125, 0.140_625].iter().sum();
        let taken = (relative(&start()) - relative(&v)).z;
        assert!((taken - 0.2 * inverse).abs() < 1e-12, "{taken}");
    }

    #[test]
    fn forces_count_as_lasting_where_nodes_were_pressed_as_much_before() {
        let masses = [1.0, 2.0, 0.5, 4.0];
        let all = impacts(10.0);
        let now = all.pressures(4);
        assert_eq!(now, [5.0, 15.0, 2.5, 17.5]);
        let taken = |before: &[f64]| {
            let mut accelerations = vec![Vector::zeros(); 4];
            all.take_sudden_forces(before, &now, &masses, &mut accelerations);
            accelerations
        };
        assert_eq!(taken(&now), [Vector::zeros(); 4]);
        let (all, half) = (taken(&[0.0; 4]), taken(&now.iter().map(|p| 0.5 * p).collect::<Vec<_>>()));
        for k in 0..4 {
            assert!((all[k] * 0.5 - half[k]).norm() < 1e-12 && all[k] != Vector::zeros());
        }
    }
}
