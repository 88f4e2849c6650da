//! Vectors of nodes as four numbers, in single or double precision: the form in which linear solves run.
//!
//! The fourth number is zero. It makes a vector one SIMD register in single precision, and products with
//! blocks three multiplications of registers.

use bowknot_geometry::Vector;
use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};
use wide::{f32x4, f64x4};

/// The numbers that a linear solve computes with: `f32` or `f64`.
pub(crate) trait Real: Copy + Default + Send + Sync + 'static {
    /// Four numbers.
    type Four: Copy
        + Default
        + Send
        + Sync
        + std::fmt::Debug
        + Add<Output = Self::Four>
        + Sub<Output = Self::Four>
        + Mul<Output = Self::Four>;

    /// Largest reduction of a residual by one solve; rounding errors come near then.
    const MAX_REDUCTION: f64;

    fn from_f64(value: f64) -> Self;
    fn to_f64(self) -> f64;
    fn pack(numbers: [Self; 4]) -> Self::Four;
    fn unpack(four: Self::Four) -> [Self; 4];

    /// The first three numbers and a zero.
    fn first_three(four: Self::Four) -> Self::Four;
}

impl Real for f32 {
    type Four = f32x4;
    const MAX_REDUCTION: f64 = 1e-5;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value as f32
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    #[inline(always)]
    fn pack(numbers: [Self; 4]) -> f32x4 {
        f32x4::new(numbers)
    }

    #[inline(always)]
    fn unpack(four: f32x4) -> [Self; 4] {
        four.to_array()
    }

    #[inline(always)]
    fn first_three(four: f32x4) -> f32x4 {
        const KEEP: f32 = f32::from_bits(u32::MAX);
        four & f32x4::new([KEEP, KEEP, KEEP, 0.0])
    }
}

impl Real for f64 {
    type Four = f64x4;
    const MAX_REDUCTION: f64 = 0.0;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }

    #[inline(always)]
    fn pack(numbers: [Self; 4]) -> f64x4 {
        f64x4::new(numbers)
    }

    #[inline(always)]
    fn unpack(four: f64x4) -> [Self; 4] {
        four.to_array()
    }

    #[inline(always)]
    fn first_three(four: f64x4) -> f64x4 {
        const KEEP: f64 = f64::from_bits(u64::MAX);
        four & f64x4::new([KEEP, KEEP, KEEP, 0.0])
    }
}

/// A vector in space and a fourth number.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Lane<T: Real>(T::Four);

impl<T: Real> Lane<T> {
    /// From a vector times a factor.
    #[inline(always)]
    pub fn new(vector: &Vector, factor: f64) -> Self {
        Self::from_parts(&(vector * factor), 0.0)
    }

    /// From a vector and the fourth number.
    #[inline(always)]
    pub fn from_parts(v: &Vector, fourth: f64) -> Self {
        Self(T::pack([T::from_f64(v.x), T::from_f64(v.y), T::from_f64(v.z), T::from_f64(fourth)]))
    }

    /// The four numbers.
    #[inline(always)]
    pub fn numbers(&self) -> [T; 4] {
        T::unpack(self.0)
    }

    /// The first three numbers.
    #[inline(always)]
    pub fn vector(&self) -> Vector {
        let [x, y, z, _] = self.numbers();
        Vector::new(x.to_f64(), y.to_f64(), z.to_f64())
    }

    /// This lane with a fourth number of zero.
    #[inline(always)]
    pub fn without_fourth(self) -> Self {
        Self(T::first_three(self.0))
    }

    /// Dot product; the fourth numbers count.
    #[inline(always)]
    pub fn dot(&self, other: &Self) -> f64 {
        let [a, b, c, d] = T::unpack(self.0 * other.0).map(T::to_f64);
        (a + b) + (c + d)
    }
}

impl<T: Real> Add for Lane<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl<T: Real> Sub for Lane<T> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl<T: Real> Mul<T> for Lane<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        Self(self.0 * T::pack([factor; 4]))
    }
}

impl<T: Real> AddAssign for Lane<T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Real> SubAssign for Lane<T> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

/// A list of 3 x 3 blocks without gaps, by columns.
///
/// A column is read as a [`Lane`] whose fourth number is that of whatever follows, so products have an
/// arbitrary fourth number. Three numbers at the end let the last column be read like this as well.
#[derive(Clone, Debug, Default)]
pub(crate) struct PackedBlocks<T>(Vec<T>);

/// Numbers of a block, and those that are read with it.
const BLOCK: usize = 9;
const READ: usize = 12;

impl<T: Real> PackedBlocks<T> {
    /// Makes room for `count` blocks, which are zero where they are new.
    pub fn resize(&mut self, count: usize) {
        self.0.resize(BLOCK * count + READ - BLOCK, T::default());
    }

    /// The numbers of all blocks, nine by nine.
    pub fn as_mut_slice(&mut self) -> &mut [T] {
        let end = self.0.len() - (READ - BLOCK);
        &mut self.0[..end]
    }

    /// Block k times a vector.
    #[inline(always)]
    pub fn product(&self, k: usize, x: Lane<T>) -> Lane<T> {
        let at = BLOCK * k;
        let numbers = &self.0[at..at + READ];
        let column = |c: usize| Lane(T::pack([numbers[c], numbers[c + 1], numbers[c + 2], numbers[c + 3]]));
        let [a, b, c, _] = x.numbers();
        column(0) * a + column(3) * b + column(6) * c
    }
}

/// Writes a 3 x 3 block into nine numbers.
#[inline(always)]
pub(crate) fn pack<T: Real>(numbers: &mut [T], block: &nalgebra::Matrix3<f64>) {
    numbers.iter_mut().zip(block.iter()).for_each(|(number, value)| *number = T::from_f64(*value));
}
