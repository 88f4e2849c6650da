//! Small systems of rows.

use crate::common::Draw;
use bowknot_baselines::twoway::geometry::Vector;
use bowknot_baselines::twoway::lcp::{FrictionBound, LcpProblem, LcpState, Row, prepare_rows, residuals};

/// Rows over nodes, and the positions of the nodes without them.
#[derive(Clone)]
pub struct System {
    pub weights: Vec<f64>,
    pub free: Vec<Vector>,
    pub rows: Vec<Row>,
}

/// The result of a solver.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    pub y: Vec<Vector>,
    pub lambda: Vec<f64>,
}

impl System {
    pub fn new(weights: Vec<f64>, free: Vec<Vector>, mut rows: Vec<Row>) -> Self {
        prepare_rows(&mut rows, &weights).unwrap();
        Self { weights, free, rows }
    }

    /// One node of weight 1 at the origin, free to be at `free`, above the lines x >= 0 and x + y >= 0.
    pub fn corner(free: [f64; 2]) -> Self {
        let zero = Vector::zeros();
        let normals = [Vector::x(), (Vector::x() + Vector::y()).normalize()];
        let rows = normals.map(|n| Row::new([0; 4], [n, zero, zero, zero], 0.0)).to_vec();
        Self::new(vec![1.0], vec![Vector::new(free[0], free[1], 0.0)], rows)
    }

    /// A column of beads under its weight, on a vertical wire: the lowest above the ground, each at least 1
    /// above the previous one. Each has sunk in proportion to its height.
    pub fn column(beads: u32) -> Self {
        let zero = Vector::zeros();
        let above = |i: u32| Row::new([i + 1, i, i, i], [Vector::z(), -Vector::z(), zero, zero], -1.0);
        let mut rows = vec![Row::new([0; 4], [Vector::z(), zero, zero, zero], 0.0)];
        rows.extend((0..beads - 1).map(above));
        let free = (0..beads).map(f64::from).map(|i| Vector::z() * (i - 0.01 * (i + 1.0))).collect();
        Self::new(vec![1.0; beads as usize], free, rows)
    }

    /// Rows of three nodes each over a few, with weights and gradients that look random; fewer rows than
    /// coordinates, hence with one lambda only.
    pub fn random(seed: u64) -> Self {
        let mut draw = Draw::new(seed);
        let nodes = 6;
        let weights = (0..nodes).map(|v| if v == 5 { 0.0 } else { 1.0 + 0.5 * draw.next() }).collect();
        let free: Vec<Vector> = (0..nodes).map(|_| draw.vector()).collect();
        let rows = (0..7)
            .map(|r| {
                let vertices = [r % nodes, (r + 1) % nodes, (r + 3) % nodes, r % nodes].map(|v| v as u32);
                let mut row =
                    Row::new(vertices, [draw.vector(), draw.vector(), draw.vector(), Vector::zeros()], 0.0);
                row.offset = 0.3 * draw.next() - row.value(&free);
                row
            })
            .collect();
        Self::new(weights, free, rows)
    }

    /// Runs a solver from zero multipliers.
    pub fn solve(&self, solver: impl FnOnce(&LcpProblem<'_>, &mut LcpState<'_>)) -> Solution {
        let problem = LcpProblem::of_rows(&self.weights, &self.rows).unwrap();
        let mut solution = Solution { y: self.free.clone(), lambda: vec![0.0; self.rows.len()] };
        let mut state = LcpState { y: &mut solution.y, lambda: &mut solution.lambda, ..LcpState::default() };
        solver(&problem, &mut state);
        solution
    }

    /// Largest |min(lambda, s)|.
    pub fn complementarity(&self, solution: &Solution) -> f64 {
        let problem = LcpProblem::of_rows(&self.weights, &self.rows).unwrap();
        let Solution { mut y, mut lambda } = solution.clone();
        let state = LcpState { y: &mut y, lambda: &mut lambda, ..LcpState::default() };
        residuals(&problem, &state, FrictionBound::Disc).unwrap().complementarity
    }
}

impl Solution {
    #[track_caller]
    pub fn assert_near(&self, other: &Solution, tolerance: f64) {
        let of_y = self.y.iter().zip(&other.y).map(|(a, b)| (a - b).norm());
        let of_lambda = self.lambda.iter().zip(&other.lambda).map(|(a, b)| (a - b).abs());
        let (y, lambda) = (of_y.fold(0.0, f64::max), of_lambda.fold(0.0, f64::max));
        assert!(y < tolerance && lambda < tolerance, "y off by {y:e}, lambda by {lambda:e}");
    }
}
