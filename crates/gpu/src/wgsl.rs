//! What twins are written with: values of the shaders' language in Rust, and how they lie in buffers.
//!
//! Vectors are arrays, matrices are arrays of columns. Integers wrap, as they do there. Nothing is fused or
//! reordered, so twins compute the same bits everywhere.

pub(crate) use crate::bound::Bound;

use std::array::from_fn;
use std::ops::{Add, Mul};

/// A value that lies in a buffer.
pub trait Stored: Sized {
    /// Words that it takes.
    const WORDS: usize;

    fn load(words: &[u32], at: usize) -> Self;

    fn store(self, words: &mut [u32], at: usize);
}

impl Stored for u32 {
    const WORDS: usize = 1;

    fn load(words: &[u32], at: usize) -> Self {
        words[at]
    }

    fn store(self, words: &mut [u32], at: usize) {
        words[at] = self;
    }
}

impl Stored for i32 {
    const WORDS: usize = 1;

    fn load(words: &[u32], at: usize) -> Self {
        words[at].cast_signed()
    }

    fn store(self, words: &mut [u32], at: usize) {
        words[at] = self.cast_unsigned();
    }
}

impl Stored for f32 {
    const WORDS: usize = 1;

    fn load(words: &[u32], at: usize) -> Self {
        Self::from_bits(words[at])
    }

    fn store(self, words: &mut [u32], at: usize) {
        words[at] = self.to_bits();
    }
}

impl<T: Stored, const N: usize> Stored for [T; N] {
    const WORDS: usize = N * T::WORDS;

    fn load(words: &[u32], at: usize) -> Self {
        let words = &words[at..at + Self::WORDS];
        from_fn(|k| T::load(words, k * T::WORDS))
    }

    fn store(self, words: &mut [u32], at: usize) {
        let words = &mut words[at..at + Self::WORDS];
        for (k, value) in self.into_iter().enumerate() {
            value.store(words, k * T::WORDS);
        }
    }
}

/// What an atomic exchange on a condition found.
#[derive(Clone, Copy)]
pub struct Exchanged<T> {
    pub old_value: T,
    pub exchanged: bool,
}

/// What decides for all threads of a workgroup, which must be the same for each.
pub fn uniform<T: Copy + PartialEq, const N: usize>(values: [T; N]) -> T {
    assert!(values.iter().all(|value| *value == values[0]), "threads that wait for each other part");
    values[0]
}

/// An operation on the components of two vectors.
pub fn zip<A: Copy, B: Copy, C, const N: usize>(a: [A; N], b: [B; N], of: impl Fn(A, B) -> C) -> [C; N] {
    from_fn(|k| of(a[k], b[k]))
}

pub fn swizzle<T: Copy, const N: usize, const M: usize>(vector: [T; N], components: [usize; M]) -> [T; M] {
    components.map(|k| vector[k])
}

/// The components of `a` where `condition` is true, those of `b` elsewhere.
pub fn select<T: Copy, const N: usize>(condition: [bool; N], a: [T; N], b: [T; N]) -> [T; N] {
    from_fn(|k| if condition[k] { a[k] } else { b[k] })
}

pub fn all<const N: usize>(are: [bool; N]) -> bool {
    are.iter().all(|is| *is)
}

pub fn any<const N: usize>(are: [bool; N]) -> bool {
    are.iter().any(|is| *is)
}

pub fn dot<T: Copy + Add<Output = T> + Mul<Output = T>, const N: usize>(a: [T; N], b: [T; N]) -> T {
    (1..N).fold(a[0] * b[0], |sum, k| sum + a[k] * b[k])
}

pub fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn normalize<const N: usize>(a: [f32; N]) -> [f32; N] {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

pub fn transpose<const N: usize, const M: usize>(a: [[f32; M]; N]) -> [[f32; N]; M] {
    from_fn(|r| from_fn(|c| a[c][r]))
}

/// A matrix times a vector.
pub fn image<const N: usize, const M: usize>(a: [[f32; M]; N], x: [f32; N]) -> [f32; M] {
    from_fn(|r| (1..N).fold(a[0][r] * x[0], |sum, c| sum + a[c][r] * x[c]))
}

/// A matrix times a matrix.
pub fn product<const N: usize, const M: usize, const L: usize>(
    a: [[f32; M]; N],
    b: [[f32; N]; L],
) -> [[f32; M]; L] {
    b.map(|column| image(a, column))
}
