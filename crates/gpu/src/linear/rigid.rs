//! Rigid motions of groups of nodes: six numbers, three of a shift and three of a spin. A node at the arm o from its group's
//! center, over the group's size, moves by shift + spin x o.

use bowknot_geometry::Vector;
use nalgebra::{Matrix3, Matrix6};

/// A row of H times the motions of a group: 3 x 3 for shifts and for spins.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rigid {
    shift: Matrix3<f64>,
    spin: Matrix3<f64>,
}

impl Rigid {
    /// Adds a block times the motion of a node at `arm`.
    pub fn add(&mut self, block: &Matrix3<f64>, arm: &Vector) {
        self.shift += block;
        // The block times the spin matrix, without its zeros.
        let [a, b, c] = [block.column(0), block.column(1), block.column(2)];
        for (k, column) in
            [c * arm.y - b * arm.z, a * arm.z - c * arm.x, b * arm.x - a * arm.y].iter().enumerate()
        {
            let mut sum = self.spin.column_mut(k);
            sum += column;
        }
    }

    /// The motion of a node at `arm`, transposed, times the sum.
    pub fn restricted(&self, arm: &Vector) -> Matrix6<f64> {
        let turn = spin_matrix(arm).transpose();
        let mut block = Matrix6::zeros();
        block.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.shift);
        block.fixed_view_mut::<3, 3>(0, 3).copy_from(&self.spin);
        block.fixed_view_mut::<3, 3>(3, 0).copy_from(&(turn * self.shift));
        block.fixed_view_mut::<3, 3>(3, 3).copy_from(&(turn * self.spin));
        block
    }
}

/// From the center of a parent to that of a child, over the parent's size, and the ratio of their sizes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Link {
    pub way: Vector,
    pub ratio: f64,
}

/// The motion of a child by that of its parent.
#[derive(Clone, Copy, Debug)]
pub struct Mode(Matrix6<f64>);

impl Mode {
    pub fn new(link: &Link) -> Self {
        let mut matrix = Matrix6::zeros();
        matrix.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&spin_matrix(&link.way));
        matrix.fixed_view_mut::<3, 3>(3, 3).fill_diagonal(link.ratio);
        Self(matrix)
    }

    pub fn matrix(&self) -> &Matrix6<f64> {
        &self.0
    }
}

/// The matrix of the map spin -> spin x arm.
fn spin_matrix(o: &Vector) -> Matrix3<f64> {
    Matrix3::new(0.0, o.z, -o.y, -o.z, 0.0, o.x, o.y, -o.x, 0.0)
}
