//! Time steps with everything that a device distinguishes, and what is expected of them in double precision.

use crate::engine::{Engine, TwinEngine};
use crate::linear::ConjugateGradients;
use crate::recording::{BufferId, Recording};
use bowknot_dynamics::{
    AssemblySprings, Body, ClothMaterial, Dynamics, DynamicsModel, DynamicsParams, ElementModel,
    HessianFilter, LinearSpring, NewtonBackend, NewtonTarget, ParticleMaterial, PreconditionerKind,
    SolidMaterial, SolveLimits, StepTerms, StrandMaterial, Watched,
};
use bowknot_geometry::{Point, Vector};
use nalgebra::{DMatrix, DVector, Matrix3};
use std::fmt::Debug;

/// The time step [s].
pub const DT: f64 = 0.02;

/// A tight solve.
pub const LIMITS: SolveLimits =
    SolveLimits { tolerance: 1e-5, own_tolerance: 0.0, min_scale: 0.0, max_iterations: 2000, searches: true };

/// A time step, the start of a target in it, and springs.
pub struct Fixture {
    pub name: &'static str,
    pub dynamics: Dynamics,
    pub model: ElementModel,
    pub terms: StepTerms,
    pub masses: Vec<f64>,
    pub iterate: Vec<Vector>,
    pub free: Vec<bool>,
    pub imposed: Vec<Vector>,
    pub springs: Vec<LinearSpring>,
    pub spring_starts: Vec<u32>,
    pub spring_entries: Vec<(u32, f64)>,
}

fn sheet(cells: usize, at: Vector, first: u32) -> (Vec<Point>, Vec<[u32; 3]>) {
    let row = cells + 1;
    let point =
        |k: usize| Point::from(at + Vector::new(0.05 * (k % row) as f64, 0.04 * (k / row) as f64, 0.0));
    let cell = |k: usize| {
        let a = first + (k % cells + k / cells * row) as u32;
        let [b, c, d] = [a + 1, a + 2 + cells as u32, a + 1 + cells as u32];
        [[a, b, c], [a, c, d]]
    };
    ((0..row * row).map(point).collect(), (0..cells * cells).flat_map(cell).collect())
}

fn random_vector(random: &mut fastrand::Rng) -> Vector {
    Vector::from_fn(|_, _| 2.0 * random.f64() - 1.0)
}

/// A row of tetrahedra between four rails.
fn bar(length: u32, at: Vector, first: u32) -> (Vec<Point>, Vec<[u32; 4]>) {
    let corner = |k: u32| {
        let (x, y, z) = (k / 4, k / 2 % 2, k % 2);
        Point::from(at + Vector::new(f64::from(x), f64::from(y), f64::from(z)) * 0.05)
    };
    let points: Vec<Point> = (0..4 * (length + 1)).map(corner).collect();
    let cubes = (0..length).flat_map(|cube| {
        // Six tetrahedra around the diagonal of a cube.
        [[4, 2, 1], [4, 1, 2], [2, 4, 1], [2, 1, 4], [1, 4, 2], [1, 2, 4]].map(|[a, b, c]| {
            let tet = [4 * cube, 4 * cube + a, 4 * cube + a + b, 4 * cube + a + b + c];
            let [o, x, y, z] = tet.map(|v| points[v as usize]);
            let is_turned = (x - o).cross(&(y - o)).dot(&(z - o)) < 0.0;
            let [o, x, y, z] = tet.map(|v| first + v);
            if is_turned { [o, y, x, z] } else { [o, x, y, z] }
        })
    });
    let tets = cubes.collect();
    (points, tets)
}

/// A fixture of bodies: some vertices are held, and moved to elsewhere.
fn of_bodies(
    name: &'static str,
    rest: &[Point],
    bodies: Vec<Body>,
    distortion: f64,
    held: &[usize],
    patches: bool,
) -> Fixture {
    let mut params = DynamicsParams::default();
    params.newton.preconditioner = PreconditionerKind::BlockJacobi;
    params.newton.hessian_filter = HessianFilter::Clamp;
    params.environment.air_density = 1.2;
    params.environment.wind = Vector::new(3.0, -1.0, 2.0);
    let model = DynamicsModel::new(rest.to_vec(), bodies).expect("a model");
    let mut dynamics = Dynamics::new(model, params).expect("parameters");
    let mut model = dynamics.element_model();
    if patches {
        model.patches.clone_from(&model.components);
    }
    let random = &mut fastrand::Rng::with_seed(rest.len() as u64);
    let mut moved = |from: &[Point], amount: f64, way: Vector| -> Vec<Point> {
        from.iter().map(|x| x + random_vector(random) * amount + way).collect()
    };
    let start = moved(rest, distortion, Vector::new(7.0, -3.0, 2.0));
    let x = moved(&start, 0.3 * distortion, Vector::new(0.002, 0.001, -0.004));
    let v: Vec<Vector> = start.iter().map(|x| Vector::new(0.3, x.x - 7.0, -2.0)).collect();
    dynamics.begin_step(&start, &v, DT).expect("a step");
    let terms = dynamics.step_terms().expect("a step");
    let vertex = |node: &Vector| rest.iter().position(|x| x.coords == *node).expect("a vertex");
    let vertices: Vec<usize> = model.rest.iter().map(vertex).collect();
    let free: Vec<bool> = vertices.iter().map(|v| !held.contains(v)).collect();
    let ends = free.iter().map(|free| if *free { Vector::zeros() } else { Vector::new(0.001, 0.0, -0.002) });
    Fixture {
        name,
        masses: vertices.iter().map(|v| dynamics.model().masses()[*v]).collect(),
        iterate: vertices.iter().map(|v| x[*v].coords).collect(),
        imposed: ends.collect(),
        free,
        terms,
        model,
        dynamics,
        springs: Vec::new(),
        spring_starts: Vec::new(),
        spring_entries: Vec::new(),
    }
}

/// Cloth with pins that move; a solid that flies; two sheets, a bar and grains with springs; grains alone.
pub fn fixtures() -> Vec<Fixture> {
    let cotton = ClothMaterial { bend_stiffness: 1e-3, bend_damping: 0.05, ..ClothMaterial::cotton() };
    let rubber = SolidMaterial { poisson_ratio: 0.4, ..SolidMaterial::rubber() };
    let mut all = Vec::new();
    for patches in [false, true] {
        let (rest, triangles) = sheet(9, Vector::zeros(), 0);
        let body = Body::cloth("sheet", triangles, cotton);
        all.push(of_bodies("pinned cloth", &rest, vec![body], 0.004, &[0, 9], patches));
    }
    let (rest, tets) = bar(20, Vector::zeros(), 0);
    all.push(of_bodies("bar", &rest, vec![Body::solid("bar", tets, rubber)], 0.002, &[], true));

    let (mut rest, triangles) = sheet(8, Vector::zeros(), 0);
    let mut bodies = vec![Body::cloth("a", triangles, cotton)];
    let (points, triangles) = sheet(8, Vector::new(0.0, 0.0, 0.1), rest.len() as u32);
    rest.extend(points);
    bodies.push(Body::cloth("b", triangles, cotton));
    let (points, tets) = bar(6, Vector::new(0.01, 0.01, 0.2), rest.len() as u32);
    rest.extend(points);
    bodies.push(Body::solid("bar", tets, rubber));
    let grains = rest.len() as u32..rest.len() as u32 + 40;
    rest.extend(grains.clone().map(|k| Point::new(0.011 * f64::from(k % 7), 0.013 * f64::from(k), 0.4)));
    bodies.push(Body::particles("grains", grains.clone().collect(), ParticleMaterial::sand()));
    let mut fixture =
        of_bodies("bodies with springs", &rest, bodies, 0.003, &[3, grains.start as usize], true);
    let count = fixture.free.len() as u32;
    fixture.set_springs((0..30).map(|k| {
        let normal = Vector::new(0.6, 0.0, 0.8);
        LinearSpring {
            nodes: [
                k,
                (7 * k + 90) % count,
                (11 * k + 200) % count,
                if k % 2 == 0 { u32::MAX } else { 40 + k },
            ],
            weights: [1.0, -0.5, -0.25, if k % 2 == 0 { 0.0 } else { -0.25 }],
            hessian: normal * normal.transpose() * 40.0 + Matrix3::identity() * 3.0,
            force: normal * 0.02 - Vector::new(0.0, 0.004, 0.0),
        }
    }));
    all.push(fixture);

    let rest: Vec<Point> =
        (0..700).map(|k: u32| Point::new(0.01 * f64::from(k % 9), 0.01 * f64::from(k / 9), 0.0)).collect();
    let body = Body::particles("grains", (0..700).collect(), ParticleMaterial::sand());
    let mut fixture = of_bodies("grains", &rest, vec![body], 0.001, &[5, 600], false);
    fixture.set_springs((0..200).map(|k| LinearSpring {
        nodes: [3 * k, 3 * k + 1, u32::MAX, u32::MAX],
        weights: [1.0, -1.0, 0.0, 0.0],
        hessian: Matrix3::identity() * 2e-4,
        force: Vector::new(1e-7, -2e-7, 0.0),
    }));
    all.push(fixture);
    all
}

/// A solver over twins that has taken over the model.
pub fn solver<E: Engine + Debug + Send>(engine: E, fixture: &Fixture) -> ConjugateGradients<E> {
    let mut solver = ConjugateGradients::new("test".to_owned(), engine);
    solver.set_model(&fixture.model).expect("room");
    solver
}

impl Fixture {
    /// Pinned cloth of so many cells along a side, in patches.
    pub fn of_cloth(cells: usize) -> Self {
        let (rest, triangles) = sheet(cells, Vector::zeros(), 0);
        let cotton = ClothMaterial { bend_stiffness: 1e-3, bend_damping: 0.05, ..ClothMaterial::cotton() };
        let body = Body::cloth("sheet", triangles, cotton);
        of_bodies("cloth", &rest, vec![body], 0.004, &[0, cells], true)
    }

    /// A strand of so many nodes that is nearly straight.
    pub fn of_strand(nodes: u32) -> Self {
        let rest: Vec<Point> = (0..nodes).map(|k| Point::new(0.01 * f64::from(k), 0.0, 0.0)).collect();
        let edges = (1..nodes).map(|k| [k - 1, k]).collect();
        let body = Body::strands("strand", edges, StrandMaterial::hair());
        of_bodies("strand", &rest, vec![body], 1e-7, &[0], true)
    }

    fn set_springs(&mut self, springs: impl Iterator<Item = LinearSpring>) {
        self.springs = springs.collect();
        let mut lists: Vec<Vec<(u32, f64)>> = vec![Vec::new(); self.free.len()];
        for (index, spring) in (0..).zip(&self.springs) {
            for (node, weight) in spring.nodes.iter().zip(spring.weights).filter(|(n, _)| **n != u32::MAX) {
                lists[*node as usize].push((index, weight));
            }
        }
        self.spring_starts = vec![0];
        for list in &lists {
            self.spring_entries.extend(list);
            self.spring_starts.push(self.spring_entries.len() as u32);
        }
    }

    pub fn springs(&self) -> AssemblySprings<'_> {
        if self.springs.is_empty() {
            return AssemblySprings::default();
        }
        AssemblySprings { springs: &self.springs, starts: &self.spring_starts, entries: &self.spring_entries }
    }

    /// Begins the step and the target at `iterate`, watching all nodes.
    pub fn begin<E: Engine + Debug + Send>(&self, solver: &mut ConjugateGradients<E>) -> Watched {
        solver.begin_step(&self.terms.as_step()).expect("runs");
        self.begin_target(solver, &self.iterate)
    }

    pub fn begin_target<E: Engine + Debug + Send>(
        &self,
        solver: &mut ConjugateGradients<E>,
        iterate: &[Vector],
    ) -> Watched {
        let watched: Vec<u32> = (0..self.free.len() as u32).collect();
        let target = NewtonTarget { iterate, free: &self.free, imposed: &self.imposed, watched: &watched };
        solver.begin_target(&target).expect("runs")
    }

    /// The gradient at positions, with springs [N].
    pub fn gradient(&self, x: &[Vector]) -> Vec<Vector> {
        let mut gradient = self.dynamics.bodies_potential(x).expect("a step").gradient;
        for spring in &self.springs {
            for (node, weight) in spring.nodes.iter().zip(spring.weights).filter(|(n, _)| **n != u32::MAX) {
                gradient[*node as usize] -= spring.force * weight;
            }
        }
        gradient
    }

    /// Largest of the forces that the gradient by a node sums [N]: rounding is relative to it.
    pub fn force_scale(&self, x: &[Vector]) -> f64 {
        let step = self.terms.as_step();
        let quadratic = x
            .iter()
            .zip(step.start)
            .zip(step.row_sums)
            .map(|((x, start), sum)| (sum * (x - start)).norm())
            .chain(step.gradient.iter().map(|c| c.norm()))
            .fold(0.0, f64::max);
        // Rounding of the deformation, a few units of 1, acts as strain.
        let membranes =
            self.model.membranes.iter().map(|m| m.stiffness[0].max(m.stiffness[2]) * m.area.sqrt());
        let tets = self
            .model
            .tetrahedra
            .iter()
            .map(|t| (2.0 * t.constants[1] + t.constants[0]) * t.volume.cbrt().powi(2));
        membranes.chain(tets).fold(quadratic, f64::max)
    }
}

/// The content of a buffer of vectors.
pub fn read<E: Engine + Debug + Send>(solver: &mut ConjugateGradients<E>, buffer: BufferId) -> Vec<Vector> {
    let newton = solver.newton.as_mut().expect("a model");
    let pending = std::mem::take(&mut newton.pending);
    let read = solver.engine.run(&pending, &[(buffer, 4 * newton.nodes)]).expect("runs");
    let number = |word: u32| f64::from(f32::from_bits(word));
    read[0].chunks_exact(4).map(|w| Vector::new(number(w[0]), number(w[1]), number(w[2]))).collect()
}

/// The matrix of the last solve over all nodes, column by column, symmetric.
pub fn matrix(solver: &mut ConjugateGradients<TwinEngine>) -> DMatrix<f64> {
    let nodes = solver.newton.as_ref().expect("a model").nodes;
    let mut matrix = DMatrix::zeros(3 * nodes, 3 * nodes);
    for k in 0..3 * nodes {
        let (newton, recorder) =
            (solver.newton.as_ref().expect("one"), solver.recorder.clone().expect("one"));
        let mut x = vec![[0f32; 4]; nodes];
        x[k / 3][k % 3] = 1.0;
        let mut recording = Recording::default();
        newton.record_before(&mut recording);
        recording.write(recorder.buffers.direction, &x);
        newton.outside(&recorder).record_image(&mut recording);
        solver.engine.run(&recording, &[]).expect("runs");
        let column = read(solver, recorder.buffers.image);
        column.iter().enumerate().for_each(|(i, y)| (0..3).for_each(|c| matrix[(3 * i + c, k)] = y[c]));
    }
    0.5 * (&matrix + matrix.transpose())
}

pub fn flat(vectors: &[Vector]) -> DVector<f64> {
    DVector::from_iterator(3 * vectors.len(), vectors.iter().flat_map(|v| [v.x, v.y, v.z]))
}

/// Sets entries of nodes that are not free to zero.
pub fn masked(vector: &DVector<f64>, free: &[bool]) -> DVector<f64> {
    DVector::from_fn(vector.len(), |k, _| if free[k / 3] { vector[k] } else { 0.0 })
}

/// Solves over the free nodes.
pub fn dense_solve(matrix: &DMatrix<f64>, b: &DVector<f64>, free: &[bool]) -> DVector<f64> {
    let matrix = DMatrix::from_fn(b.len(), b.len(), |i, j| {
        if free[i / 3] && free[j / 3] { matrix[(i, j)] } else { f64::from(u8::from(i == j)) }
    });
    matrix.cholesky().expect("positive definite").solve(&masked(b, free))
}
