//! Reports about a state: energies, momenta, stretch, volumes.
//!
//! Sums run serially in vertex order: they have the same bits for any number of threads.

use crate::body::BodyShape;
use crate::dynamics::Dynamics;
use crate::elements::set::{Displaced, ElementKind, Motion};
use crate::model::DynamicsModel;
use crate::model::measures::volume;
use crate::nodes::CHUNK;
use bowknot_geometry::{Point, Vector, divide_tetrahedron};
use rayon::prelude::*;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::ops::Range;

/// Elastic energy of all deformable bodies [J] by the kind of element that stores it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
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
    /// That of [custom elements](crate::CustomElement).
    pub custom: f64,
}

impl ElasticEnergies {
    /// The sum [J].
    pub fn total(&self) -> f64 {
        self.membrane + self.bending + self.solid + self.strand_stretching + self.strand_bending + self.custom
    }
}

/// Energies of all deformable bodies [J].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Energies {
    /// Kinetic energy, 1/2 sum m |v|^2.
    pub kinetic: f64,
    /// Energy of strain and bending and of custom elements, see [`DynamicsModel::elastic_energies`].
    pub elastic: f64,
    /// Potential energy of gravity, - sum m g.x: zero at the origin.
    pub potential: f64,
}

impl Energies {
    /// The sum [J].
    pub fn total(&self) -> f64 {
        self.kinetic + self.elastic + self.potential
    }
}

impl DynamicsModel {
    /// Linear momentum [kg m/s] at velocities `v` [m/s].
    pub fn momentum(&self, v: &[Vector]) -> Vector {
        self.masses().iter().zip(v).map(|(&m, v)| v * m).sum()
    }

    /// Angular momentum about the origin [kg m^2/s].
    pub fn angular_momentum(&self, x: &[Point], v: &[Vector]) -> Vector {
        self.masses().iter().zip(x.iter().zip(v)).map(|(&m, (x, v))| x.coords.cross(v) * m).sum()
    }

    /// Center of mass [m]; the origin if nothing has mass.
    pub fn center_of_mass(&self, x: &[Point]) -> Point {
        let total = self.total_mass();
        let moment: Vector = self.masses().iter().zip(x).map(|(&m, x)| x.coords * m).sum();
        if total > 0.0 { Point::from(moment / total) } else { Point::origin() }
    }

    /// Largest ratio of length to rest length over all edges of cloth and strands [1]; 0 if there are none.
    pub fn max_stretch(&self, x: &[Point]) -> f64 {
        let position = |node: u32| x[self.node_vertex[node as usize] as usize];
        // A maximum is the same in any order.
        self.edges
            .par_iter()
            .with_min_len(CHUNK)
            .map(|&([a, b], rest)| (position(a) - position(b)).norm() / rest)
            .reduce(|| 0.0, f64::max)
    }

    /// Elastic energy at `x` [J], of strain and bending and of custom elements.
    pub fn elastic_energy(&self, x: &[Point]) -> f64 {
        self.elastic_energies(x).total()
    }

    /// Elastic energy at `x` [J] by kind of element.
    pub fn elastic_energies(&self, x: &[Point]) -> ElasticEnergies {
        let x: Vec<Vector> = self.node_vertex.iter().map(|&v| x[v as usize].coords).collect();
        let motion = Motion { x: &x, start: &x, rate: 0.0 };
        let mut energies = ElasticEnergies { bending: self.bending.energy(&x), ..Default::default() };
        for set in self.sets() {
            let sum = match set.kind() {
                ElementKind::Membrane => &mut energies.membrane,
                ElementKind::Bending => &mut energies.bending,
                ElementKind::Solid => &mut energies.solid,
                ElementKind::StrandStretching => &mut energies.strand_stretching,
                ElementKind::StrandBending => &mut energies.strand_bending,
                ElementKind::Custom => &mut energies.custom,
            };
            let chunks = x.len().div_ceil(CHUNK);
            let partial: Vec<f64> =
                (0..chunks).into_par_iter().map(|chunk| set.energy(chunk, motion)).collect();
            *sum += partial.iter().sum::<f64>();
        }
        energies
    }

    /// Change of the elastic energy [J] from the positions `from` to `x`, of vertices that have `moved`.
    fn elastic_energy_change(&self, from: &[Point], x: &[Point], moved: impl Fn(usize) -> bool) -> f64 {
        let vertices = || self.node_vertex.iter().map(|&vertex| vertex as usize);
        let moved: Vec<bool> = vertices().map(moved).collect();
        if !moved.contains(&true) {
            return 0.0;
        }
        let from: Vec<Vector> = vertices().map(|vertex| from[vertex].coords).collect();
        let position = |(vertex, (from, moved)): (usize, (&Vector, &bool))| {
            if *moved { x[vertex].coords } else { *from }
        };
        let x: Vec<Vector> = vertices().zip(from.iter().zip(&moved)).map(position).collect();
        let change = Displaced { from: &from, x: &x, moved: &moved };
        let chunks = (0..moved.len().div_ceil(CHUNK)).into_par_iter();
        let of_chunk = |chunk: usize| {
            let of_sets = self.sets().map(|set| set.energy_change(chunk, &change));
            self.bending.energy_change(chunk, &change) + of_sets.sum::<f64>()
        };
        let changes: Vec<f64> = chunks.map(of_chunk).collect();
        changes.iter().sum()
    }

    /// Elastic energy [J] of each component at positions `x` of nodes.
    pub(crate) fn elastic_by_component(&self, x: &[Vector]) -> Vec<f64> {
        let bending = |component: &Range<u32>| {
            let rows = component.start as usize..component.end as usize;
            let starts = rows.clone().into_par_iter().step_by(CHUNK);
            let of_rows = |start: usize| self.bending.rows_energy(start..rows.end.min(start + CHUNK), x);
            // Partial sums in order: the same bits for any number of threads.
            starts.map(of_rows).collect::<Vec<f64>>().iter().sum()
        };
        let mut energies: Vec<f64> = self.components.par_iter().map(bending).collect();
        for set in self.sets() {
            set.for_each_energy(x, &mut |node, energy| {
                energies[self.component(node)] += energy;
            });
        }
        energies
    }

    /// Signed volume [m^3] of all tets at positions `x` [m].
    pub fn volume(&self, x: &[Point]) -> f64 {
        let of_solid = |tets: &[[u32; 4]]| -> f64 {
            tets.iter().map(|tet| volume(&tet.map(|v| x[v as usize].coords))).sum()
        };
        self.solids().map(|(_, tets)| of_solid(&tets)).sum()
    }

    /// Tets without positive volume at positions `x` [m]: body and index of each tet, ascending. Quadratic
    /// ones count as eight, see [`divide_tetrahedron`].
    pub fn inverted_tets(&self, x: &[Point]) -> Vec<[usize; 2]> {
        let mut inverted = Vec::new();
        for (body, tets) in self.solids() {
            let found = tets.par_iter().enumerate().with_min_len(1024).filter_map(|(index, tet)| {
                (volume(&tet.map(|v| x[v as usize].coords)) <= 0.0).then_some([body, index])
            });
            inverted.par_extend(found);
        }
        inverted
    }

    /// Tets of each solid, with the index of its body; the parts of quadratic ones.
    fn solids(&self) -> impl Iterator<Item = (usize, Cow<'_, [[u32; 4]]>)> {
        self.bodies().iter().enumerate().filter_map(|(index, body)| match &body.shape {
            BodyShape::Solid { tets, .. } => Some((index, Cow::from(tets))),
            BodyShape::QuadraticSolid { tets, .. } => {
                Some((index, tets.iter().flat_map(divide_tetrahedron).collect()))
            }
            _ => None,
        })
    }
}

impl Dynamics {
    /// Energies at positions `x` [m] and velocities `v` [m/s], which have one entry per vertex.
    pub fn energies(&self, x: &[Point], v: &[Vector]) -> Energies {
        let model = self.model();
        let gravity = self.params().environment.gravity;
        Energies {
            kinetic: model.masses().iter().zip(v).map(|(&m, v)| 0.5 * m * v.norm_squared()).sum(),
            elastic: model.elastic_energy(x),
            potential: -(model.masses().iter().zip(x).enumerate())
                .map(|(vertex, (&m, x))| m * model.gravity(vertex, gravity).dot(&x.coords))
                .sum::<f64>(),
        }
    }

    /// Change of the sum of the [energies](Self::energies) [J] where a time step of `dt` [s] from `start`
    /// ends at `x` in place of `from` [m], velocities being those of the way from its start. Vertices that
    /// differ by at most `resolution` along each axis [m] count as if they did not: the time that this takes
    /// goes with the number of the others.
    pub fn energy_change(
        &self,
        start: &[Point],
        from: &[Point],
        x: &[Point],
        dt: f64,
        resolution: f64,
    ) -> f64 {
        let model = self.model();
        let gravity = self.params().environment.gravity;
        let moved = |vertex: usize| (x[vertex] - from[vertex]).amax() > resolution;
        let of_vertex = |vertex: usize| {
            let way = x[vertex] - from[vertex];
            // 1/2 m (|v|^2 - |u|^2) with the velocities v and u of both ways.
            let sum = (x[vertex] - start[vertex]) + (from[vertex] - start[vertex]);
            let kinetic = 0.5 * way.dot(&sum) / (dt * dt);
            model.masses()[vertex] * (kinetic - model.gravity(vertex, gravity).dot(&way))
        };
        let of_vertices: f64 = (0..x.len()).filter(|&vertex| moved(vertex)).map(of_vertex).sum();
        of_vertices + model.elastic_energy_change(from, x, moved)
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
