//! Random systems like those of bodies, and dense algebra.

use bowknot_dynamics::{LinearSpring, LinearSystem, SparseRows};
use bowknot_geometry::Vector;
use nalgebra::{DMatrix, DVector, Matrix3, Rotation3};
use std::collections::BTreeMap;
use std::ops::Range;

/// What a system is made of: a grid of nodes in patches of so many (0 for no patches), springs between random nodes, and
/// nodes that nothing else joins.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    pub columns: usize,
    pub rows: usize,
    pub patch: usize,
    pub springs: usize,
    pub grains: usize,
    /// How far nodes are from their places in the grid.
    pub jitter: f64,
    /// Inertia of a node.
    pub inertia: f64,
    /// One of so many nodes is not free; 0 for none.
    pub held: usize,
}

/// The arrays of a system.
pub struct Owned {
    free: Vec<bool>,
    positions: Vec<Vector>,
    diagonal: Vec<Matrix3<f64>>,
    starts: Vec<u32>,
    columns: Vec<u32>,
    blocks: Vec<Matrix3<f64>>,
    scalar_starts: Vec<u32>,
    scalar_columns: Vec<u32>,
    scalars: Vec<f64>,
    springs: Vec<LinearSpring>,
    spring_starts: Vec<u32>,
    spring_entries: Vec<(u32, f64)>,
    patches: Vec<Range<u32>>,
}

/// A vector with entries in [-1, 1).
fn random_vector(random: &mut fastrand::Rng) -> Vector {
    Vector::from_fn(|_, _| 2.0 * random.f64() - 1.0)
}

impl Owned {
    /// Stiff edges of the grid, and the diagonals of its cells as scalar entries.
    pub fn random(shape: &Shape, seed: u64) -> Self {
        let random = &mut fastrand::Rng::with_seed(seed);
        let grid = shape.columns * shape.rows;
        let count = grid + shape.grains;
        let turn = Rotation3::from_euler_angles(0.3, 0.5, 0.7);
        let at = |k: usize| Vector::new((k % shape.columns) as f64, (k / shape.columns) as f64, 0.0);
        let positions: Vec<Vector> =
            (0..count).map(|k| turn * (at(k) + shape.jitter * random_vector(random))).collect();
        let mut diagonal: Vec<Matrix3<f64>> = (0..count)
            .map(|_| Matrix3::from_diagonal_element(shape.inertia * (1.0 + random.f64())))
            .collect();
        let mut blocks: Vec<BTreeMap<u32, Matrix3<f64>>> = vec![BTreeMap::new(); count];
        let mut scalars: Vec<BTreeMap<u32, f64>> = vec![BTreeMap::new(); count];
        for k in 0..grid {
            let (column, row) = (k % shape.columns, k / shape.columns);
            let has = [column + 1 < shape.columns, row + 1 < shape.rows];
            for (other, exists) in [(k + 1, has[0]), (k + shape.columns, has[1])] {
                if exists {
                    let way = (positions[other] - positions[k]).normalize();
                    let stiffness = 50.0 * (way * way.transpose()) + Matrix3::from_diagonal_element(2.0);
                    for (i, j) in [(k, other), (other, k)] {
                        diagonal[i] += stiffness;
                        blocks[i].insert(j as u32, -stiffness);
                    }
                }
            }
            if has[0] && has[1] {
                let other = k + shape.columns + 1;
                let stiffness = 3.0 * random.f64();
                for (i, j) in [(k, other), (other, k)] {
                    diagonal[i] += Matrix3::from_diagonal_element(stiffness);
                    scalars[i].insert(j as u32, -stiffness);
                }
            }
        }
        let springs: Vec<LinearSpring> =
            (0..shape.springs).map(|_| random_spring(count as u32, random)).collect();
        let mut entries: Vec<Vec<(u32, f64)>> = vec![Vec::new(); count];
        for (index, spring) in springs.iter().enumerate() {
            for (&node, weight) in spring.nodes.iter().zip(spring.weights) {
                if node != u32::MAX {
                    entries[node as usize].push((index as u32, weight));
                }
            }
        }
        let mut patches: Vec<Range<u32>> = Vec::new();
        if shape.patch > 0 {
            let ends = (0..grid as u32).step_by(shape.patch);
            patches.extend(ends.map(|start| start..(start + shape.patch as u32).min(grid as u32)));
            patches.extend((grid as u32..count as u32).map(|k| k..k + 1));
        }
        let (starts, columns, block_values) = rows(blocks);
        let (scalar_starts, scalar_columns, scalar_values) = rows(scalars);
        let (spring_starts, _, _) = rows(entries.iter().map(|e| (0u32..).zip(e.clone()).collect()).collect());
        Self {
            free: (0..count).map(|k| shape.held == 0 || k % shape.held != 3).collect(),
            positions,
            diagonal,
            starts,
            columns,
            blocks: block_values,
            scalar_starts,
            scalar_columns,
            scalars: scalar_values,
            spring_starts: if springs.is_empty() { Vec::new() } else { spring_starts },
            springs,
            spring_entries: entries.concat(),
            patches,
        }
    }

    pub fn system(&self) -> LinearSystem<'_> {
        LinearSystem {
            free: &self.free,
            positions: &self.positions,
            diagonal: &self.diagonal,
            blocks: SparseRows { starts: &self.starts, columns: &self.columns, values: &self.blocks },
            scalars: SparseRows {
                starts: &self.scalar_starts,
                columns: &self.scalar_columns,
                values: &self.scalars,
            },
            springs: &self.springs,
            spring_starts: &self.spring_starts,
            spring_entries: &self.spring_entries,
            patches: &self.patches,
        }
    }

    /// The same system in other units.
    pub fn scaled(mut self, factor: f64) -> Self {
        self.diagonal.iter_mut().chain(&mut self.blocks).for_each(|block| *block *= factor);
        self.scalars.iter_mut().for_each(|value| *value *= factor);
        self.springs.iter_mut().for_each(|spring| spring.hessian *= factor);
        self
    }

    /// The same system without a free node.
    pub fn held(mut self) -> Self {
        self.free.fill(false);
        self
    }

    /// The same system with an entry that is not finite.
    pub fn spoiled(mut self, value: f64) -> Self {
        self.blocks[7][(1, 2)] = value;
        self.diagonal[5][(0, 0)] = value;
        self
    }

    /// Zero at nodes that are not free.
    pub fn right_side(&self, seed: u64) -> Vec<Vector> {
        let random = &mut fastrand::Rng::with_seed(seed);
        let entry = |free: &bool| if *free { random_vector(random) } else { Vector::zeros() };
        self.free.iter().map(entry).collect()
    }
}

/// A stiff spring over up to four nodes.
fn random_spring(count: u32, random: &mut fastrand::Rng) -> LinearSpring {
    let mut nodes = [u32::MAX; 4];
    let used = 1 + random.usize(..4);
    for k in 0..used {
        let node = random.u32(..count);
        if !nodes.contains(&node) {
            nodes[k] = node;
        }
    }
    let normal = random_vector(random).normalize();
    let weights = std::array::from_fn(|k| if k == 0 { 1.0 } else { -random.f64() });
    let hessian = 80.0 * (normal * normal.transpose());
    LinearSpring { nodes, weights, hessian, force: Vector::zeros() }
}

/// Starts, columns and values of compressed rows.
fn rows<T>(rows: Vec<BTreeMap<u32, T>>) -> (Vec<u32>, Vec<u32>, Vec<T>) {
    let (mut starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    for row in rows {
        for (column, value) in row {
            columns.push(column);
            values.push(value);
        }
        starts.push(columns.len() as u32);
    }
    (starts, columns, values)
}

/// H over the free nodes, zero elsewhere.
pub fn dense(system: &LinearSystem<'_>) -> DMatrix<f64> {
    let count = system.free.len();
    let mut matrix = DMatrix::zeros(3 * count, 3 * count);
    let mut add = |i: usize, j: usize, block: &Matrix3<f64>| {
        if system.free[i] && system.free[j] {
            let mut view = matrix.view_mut((3 * i, 3 * j), (3, 3));
            view += block;
        }
    };
    for i in 0..count {
        add(i, i, &system.diagonal[i]);
        system.blocks.row(i).for_each(|(j, block)| add(i, j, block));
        system.scalars.row(i).for_each(|(j, q)| add(i, j, &Matrix3::from_diagonal_element(*q)));
    }
    for spring in system.springs {
        let places = || spring.nodes.iter().zip(spring.weights).filter(|(node, _)| **node != u32::MAX);
        for (&i, a) in places() {
            places().for_each(|(&j, b)| add(i as usize, j as usize, &(spring.hessian * (a * b))));
        }
    }
    matrix
}

fn flat(vectors: &[Vector]) -> DVector<f64> {
    DVector::from_iterator(3 * vectors.len(), vectors.iter().flat_map(|v| [v.x, v.y, v.z]))
}

fn vectors(flat: &DVector<f64>) -> Vec<Vector> {
    flat.as_slice().chunks_exact(3).map(Vector::from_column_slice).collect()
}

/// b - H x.
pub fn residual(matrix: &DMatrix<f64>, x: &[Vector], b: &[Vector]) -> Vec<Vector> {
    vectors(&(flat(b) - matrix * flat(x)))
}

/// The solution by Cholesky.
pub fn solve(system: &LinearSystem<'_>, b: &[Vector]) -> Vec<Vector> {
    let mut matrix = dense(system);
    for node in (0..system.free.len()).filter(|n| !system.free[*n]) {
        (0..3).for_each(|k| matrix[(3 * node + k, 3 * node + k)] = 1.0);
    }
    vectors(&matrix.cholesky().expect("definite").solve(&flat(b)))
}
