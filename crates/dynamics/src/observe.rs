//! What is reported about a state: energies, momenta, stretch.
//!
//! Sums run serially in vertex order: the same bits for any number of threads.

use crate::elements::{CHUNK, Kind, Motion};
use crate::{Dynamics, DynamicsModel};
use bowknot_geometry::{Point, Vector};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Elastic energy of all deformable bodies [J] by what stores it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ElasticEnergies {
    /// Stretching and shearing of cloth.
    pub membrane: f64,
    /// Bending of cloth.
    pub bending: f64,
    /// Strain of solids.
    pub solid: f64,
    /// Stretching of strands.
    pub strand_stretching: f64,
    /// Bending of strands.
    pub strand_bending: f64,
}

impl ElasticEnergies {
    /// Their sum.
    pub fn total(&self) -> f64 {
        self.membrane + self.bending + self.solid + self.strand_stretching + self.strand_bending
    }
}

/// Energies of all deformable bodies [J].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energies {
    /// 1/2 sum m |v|^2.
    pub kinetic: f64,
    /// That of strain and bending, see [`DynamicsModel::elastic_energies`].
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

    /// Largest length / rest length over all edges of cloth and strands; 0 if there is none.
    pub fn max_stretch(&self, x: &[Point]) -> f64 {
        let position = |node: u32| x[self.node_vertex[node as usize] as usize];
        // A maximum is the same in any order.
        self.edges
            .par_iter()
            .with_min_len(CHUNK)
            .map(|&([a, b], rest)| (position(a) - position(b)).norm() / rest)
            .reduce(|| 0.0, f64::max)
    }

    /// Elastic energy [J] at `x`, of strain and bending.
    pub fn elastic_energy(&self, x: &[Point]) -> f64 {
        self.elastic_energies(x).total()
    }

    /// Elastic energy [J] at `x` by kind.
    pub fn elastic_energies(&self, x: &[Point]) -> ElasticEnergies {
        let x: Vec<Vector> = self.node_vertex.iter().map(|&v| x[v as usize].coords).collect();
        let motion = Motion { x: &x, start: &x, rate: 0.0 };
        let mut energies = ElasticEnergies { bending: self.bending.energy(&x), ..Default::default() };
        for family in &self.families {
            let sum = match family.kind() {
                Kind::Membrane => &mut energies.membrane,
                Kind::Bending => &mut energies.bending,
                Kind::Solid => &mut energies.solid,
                Kind::StrandStretching => &mut energies.strand_stretching,
                Kind::StrandBending => &mut energies.strand_bending,
            };
            let chunks = x.len().div_ceil(CHUNK);
            let partial: Vec<f64> =
                (0..chunks).into_par_iter().map(|chunk| family.energy(chunk, motion)).collect();
            *sum += partial.iter().sum::<f64>();
        }
        energies
    }

    /// Elastic energy [J] of each component at positions `x` of nodes.
    pub(crate) fn elastic_by_component(&self, x: &[Vector]) -> Vec<f64> {
        let mut energies: Vec<f64> = self
            .components
            .iter()
            .map(|c| self.bending.rows_energy(c.start as usize..c.end as usize, x))
            .collect();
        for family in &self.families {
            family.for_each_energy(x, &mut |node, energy| {
                energies[self.component(node)] += energy;
            });
        }
        energies
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
