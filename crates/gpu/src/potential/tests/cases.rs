//! Bodies in states that a device distinguishes, with all positions on a grid: those in double precision are
//! the same.

use crate::assembly::StateGrid;
use crate::potential::Places;
use bodies::{Case, block, locks, of_every_kind, sheet};
use bowknot_dynamics::{
    Body, Dynamics, DynamicsModel, DynamicsParams, ElementModel, SolidMaterial, StepTerms,
};
use bowknot_geometry::{Point, Vector};
use std::collections::BTreeMap;

#[path = "../../../tests/bodies/mod.rs"]
mod bodies;

/// The time step [s].
pub const DT: f64 = 0.02;

/// Bodies of every kind.
pub fn cases() -> Vec<Case> {
    of_every_kind(&|curvature| sheet(9, curvature), &|| block(12), &|radius| locks(30, radius), 0.1)
}

/// Bodies of every kind, each of one element; bending around a triangle needs a neighbor.
pub fn single_elements() -> Vec<Case> {
    let triangle = |curvature: f64| {
        let (points, triangles) = sheet(1, curvature);
        if curvature == 0.0 { (points[..3].to_vec(), vec![[0, 1, 2]]) } else { (points, triangles) }
    };
    let tetrahedron = || {
        let corners = [[0.0, 0.0, 0.0], [0.05, 0.01, 0.0], [0.01, 0.04, 0.02], [0.0, -0.01, 0.05]];
        (corners.map(Point::from).to_vec(), vec![[0, 1, 2, 3]])
    };
    let turn = |_: f64| {
        let points = [[0.0, 0.0, 0.0], [0.05, 0.0, 0.01], [0.08, 0.03, 0.0]];
        (points.map(Point::from).to_vec(), vec![[0, 1], [1, 2]])
    };
    of_every_kind(&triangle, &tetrahedron, &turn, 0.1)
}

/// A solid of many cubes in a row.
pub fn long_block(cubes: usize) -> Case {
    let (rest, tets) = block(cubes);
    Case { name: "long block", rest, bodies: vec![Body::solid("block", tets, SolidMaterial::rubber())] }
}

/// Positions of nodes on a grid.
#[derive(Clone, Debug)]
pub struct State {
    /// In quanta.
    pub integers: Vec<[i32; 4]>,
    /// In m.
    pub positions: Vec<Vector>,
}

/// How far states are from the rest shape.
#[derive(Clone, Copy)]
pub struct Amounts {
    /// Size of random displacements at the start, relative to the size of elements.
    pub start: f64,
    /// From there to the reference.
    pub reference: f64,
    /// From there to the trial.
    pub trial: f64,
    /// Displacement of everything from the start to the reference, and as much to the trial [m].
    pub fall: f64,
}

/// A time step that was begun, and states in it.
pub struct Problem {
    pub name: &'static str,
    pub dynamics: Dynamics,
    pub model: ElementModel,
    pub terms: StepTerms,
    pub quantum: f64,
    pub start: State,
    pub reference: State,
    pub trial: State,
}

impl Problem {
    pub fn new(case: &Case, amounts: Amounts, seed: u64) -> Self {
        let mut params = DynamicsParams::default();
        params.environment.air_density = 1.2;
        params.environment.wind = Vector::new(3.0, -1.0, 2.0);
        let model = DynamicsModel::new(case.rest.clone(), case.bodies.clone()).expect("a model");
        let mut dynamics = Dynamics::new(model, params).expect("parameters");
        let model = dynamics.element_model();

        let random = &mut fastrand::Rng::with_seed(seed);
        let mut displaced = |from: &[Vector], amount: f64, fall: f64| -> Vec<Vector> {
            let mut random_vector = || Vector::from_fn(|_, _| 2.0 * random.f64() - 1.0);
            let fall = Vector::new(0.2, 0.1, -1.0) * fall;
            from.iter().map(|x| x + random_vector() * (0.05 * amount) + fall).collect()
        };
        let turn = nalgebra::Rotation3::from_euler_angles(0.3, -0.8, 1.1);
        let turned: Vec<Vector> = model.rest.iter().map(|x| turn * x).collect();
        let start = displaced(&turned, amounts.start, 0.0);
        let reference = displaced(&start, amounts.reference, amounts.fall);
        let trial = displaced(&reference, amounts.trial, amounts.fall);
        let grid = StateGrid::around(start.iter().chain(&reference).chain(&trial));
        let [start, reference, trial] = [start, reference, trial].map(|x| {
            let integers: Vec<[i32; 4]> = x.iter().map(|x| grid.place(x)).collect();
            let position = |x: &[i32; 4]| Vector::new(x[0].into(), x[1].into(), x[2].into()) * grid.quantum;
            State { positions: integers.iter().map(position).collect(), integers }
        });
        let key = |x: &Vector| [x.x, x.y, x.z].map(f64::to_bits);
        let nodes: BTreeMap<[u64; 3], usize> = model.rest.iter().map(key).zip(0..).collect();
        let place = |vertex: &Point| Point::from(start.positions[nodes[&key(&vertex.coords)]]);
        let by_vertex: Vec<Point> = case.rest.iter().map(place).collect();
        let velocities: Vec<Vector> = by_vertex.iter().map(|x| Vector::new(0.3, x.x, -2.0)).collect();
        dynamics.begin_step(&by_vertex, &velocities, DT).expect("a step");
        let terms = dynamics.step_terms().expect("a step");
        let (name, quantum) = (case.name, grid.quantum);
        Self { name, dynamics, model, terms, quantum, start, reference, trial }
    }

    /// Tetrahedra that are inside out.
    pub fn inverted(&self, at: &State) -> usize {
        let edge = |a: u32, b: u32| at.positions[b as usize] - at.positions[a as usize];
        let is_inverted = |[a, b, c, d]: [u32; 4]| edge(a, b).cross(&edge(a, c)).dot(&edge(a, d)) < 0.0;
        self.model.tetrahedra.iter().filter(|tet| is_inverted(tet.nodes)).count()
    }

    pub fn places(&self, [positions, start]: [crate::recording::BufferId; 2]) -> Places {
        Places { positions, start, quantum: self.quantum as f32 }
    }

    /// The sum over its elements of stiffness times length by each node [N], as a body has it whose lengths
    /// are up to `stretch` times those at rest: the forces to which rounding of the elements' gradients is
    /// relative.
    pub fn force_scales(&self, stretch: f64) -> Vec<f64> {
        let mut scales = vec![0.0; self.model.rest.len()];
        let steepest = |gradients: &[f64]| gradients.iter().fold(0.0f64, |most, g| most.max(g.abs()));
        // Damping adds a multiple of the stiffness, and of the square of the stretch.
        for m in &self.model.membranes {
            let stiffness = steepest(&m.stiffness) * (1.0 + m.damping / DT * stretch * stretch);
            let scale = stiffness * m.area * steepest(m.gradients.as_flattened()) * stretch;
            m.nodes.iter().for_each(|node| scales[*node as usize] += scale);
        }
        for bend in &self.model.bends {
            let weight = steepest(bend.jumps.as_flattened());
            let gram: f64 = bend.gram.as_flattened().iter().map(|g| g.abs()).sum();
            let scale = gram * weight * weight * 0.05 * stretch;
            let nodes = bend.nodes.iter().filter(|node| **node != u32::MAX);
            nodes.for_each(|node| scales[*node as usize] += scale);
        }
        for tet in &self.model.tetrahedra {
            let [lambda, mu] = tet.constants;
            let viscosity = tet.viscosity / DT * (1.0 + lambda / mu);
            let stiffness = (2.0 * mu + lambda + 2.0 * viscosity) * stretch * stretch;
            let scale = stiffness * tet.volume * steepest(tet.gradients.as_flattened()) * stretch;
            tet.nodes.iter().for_each(|node| scales[*node as usize] += scale);
        }
        for strand in &self.model.strands {
            let damping = 1.0 + strand.damping / DT * stretch * stretch;
            // Of a turn, w is a difference of two tangents.
            let weight = 2.0 * steepest(&strand.inverse_lengths);
            let scale = strand.stiffness * damping * weight * 2.0 * stretch;
            let nodes = strand.nodes.iter().filter(|node| **node != u32::MAX);
            nodes.for_each(|node| scales[*node as usize] += scale);
        }
        scales
    }
}
