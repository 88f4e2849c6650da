//! What is reported about a state: energies, momenta, stretch.
//!
//! Sums run serially in vertex order: the same bits for any number of threads.

use crate::elements::{CHUNK, Motion};
use crate::{Dynamics, DynamicsModel};
use bowknot_geometry::{Point, Vector};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Energies of all deformable bodies [J].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energies {
    /// 1/2 sum m |v|^2.
    pub kinetic: f64,
    /// Stretching and bending.
    pub elastic: f64,
    /// Gravity's, - sum m g.x: zero at the origin.
    pub potential: f64,
}

impl Energies {
    /// Their sum.
    pub fn total(&self) -> f64 {
        self.kinetic + self.elastic + self.potential
    }
}

impl DynamicsModel {
    /// Linear momentum [kg m/s] at velocities `v` [m/s].
    pub fn momentum(&self, v: &[Vector]) -> Vector {
        self.masses().iter().zip(v).map(|(&m, v)| v * m).sum()
    }

    /// Angular momentum [kg m^2/s] about the origin.
    pub fn angular_momentum(&self, x: &[Point], v: &[Vector]) -> Vector {
        self.masses().iter().zip(x.iter().zip(v)).map(|(&m, (x, v))| x.coords.cross(v) * m).sum()
    }

    /// Centre of mass [m]; the origin if nothing has mass.
    pub fn center_of_mass(&self, x: &[Point]) -> Point {
        let total = self.total_mass();
        let moment: Vector = self.masses().iter().zip(x).map(|(&m, x)| x.coords * m).sum();
        if total > 0.0 { Point::from(moment / total) } else { Point::origin() }
    }

    /// Largest length / rest length over all cloth edges; 0 if there is none.
    pub fn max_stretch(&self, x: &[Point]) -> f64 {
        let position = |node: u32| x[self.node_vertex[node as usize] as usize];
        // A maximum is the same in any order.
        self.edges
            .par_iter()
            .with_min_len(CHUNK)
            .map(|&([a, b], rest)| (position(a) - position(b)).norm() / rest)
            .reduce(|| 0.0, f64::max)
    }

    /// Elastic energy [J] at `x`: membrane and bending.
    pub fn elastic_energy(&self, x: &[Point]) -> f64 {
        let x: Vec<Vector> = self.node_vertex.iter().map(|&v| x[v as usize].coords).collect();
        self.membrane_energy(Motion { x: &x, start: &x, rate: 0.0 }) + self.bending.energy(&x)
    }

    /// Energy of all element families, with dissipation if `motion` has a rate.
    pub(crate) fn membrane_energy(&self, motion: Motion<'_>) -> f64 {
        let chunks = motion.x.len().div_ceil(CHUNK);
        let partial: Vec<f64> = (0..chunks)
            .into_par_iter()
            .map(|chunk| self.families.iter().map(|family| family.energy(chunk, motion)).sum())
            .collect();
        partial.iter().sum()
    }
}

impl Dynamics {
    /// Energies at positions `x` [m] and velocities `v` [m/s], one entry a vertex.
    pub fn energies(&self, x: &[Point], v: &[Vector]) -> Energies {
        let model = self.model();
        let gravity = self.params().gravity;
        Energies {
            kinetic: model.masses().iter().zip(v).map(|(&m, v)| 0.5 * m * v.norm_squared()).sum(),
            elastic: model.elastic_energy(x),
            potential: -(model.masses().iter().zip(x).enumerate())
                .map(|(vertex, (&m, x))| m * model.gravity(vertex, gravity).dot(&x.coords))
                .sum::<f64>(),
        }
    }

    /// [`DynamicsModel::momentum`].
    pub fn momentum(&self, v: &[Vector]) -> Vector {
        self.model().momentum(v)
    }

    /// [`DynamicsModel::angular_momentum`].
    pub fn angular_momentum(&self, x: &[Point], v: &[Vector]) -> Vector {
        self.model().angular_momentum(x, v)
    }

    /// [`DynamicsModel::center_of_mass`].
    pub fn center_of_mass(&self, x: &[Point]) -> Point {
        self.model().center_of_mass(x)
    }

    /// [`DynamicsModel::max_stretch`].
    pub fn max_stretch(&self, x: &[Point]) -> f64 {
        self.model().max_stretch(x)
    }
}
