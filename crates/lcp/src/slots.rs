//! Arrays that several rows write through shared references, one element at a time.
//!
//! Rows of a color write disjoint nodes, which the compiler cannot prove. Two views of a `&mut [T]` give
//! kernels shared access: `Cell`s on one thread, relaxed atomics on several. One kernel serves both. A wrong
//! coloring can then spoil a result but never memory safety: soundness needs no check of the colors, and
//! the only unsafe line is a change of type.
//!
//! The cost, on 30k distance limits and 20k rows over 10k nodes (8 sweeps, one thread of a 2-core
//! x86-64): 3.7 ms with cells, 4.7 ms with atomics, whose loads the compiler does not combine, and 2.6 ms
//! with atomics on two threads. Raw pointers with checked colors would save that quarter. But the proof that
//! no two threads access the same node would then involve the check, the kernels and the schedules, and the
//! check costs 0.1 ms per problem. Computing changes in parallel and scattering them serially needs safe code
//! only, took 2.7 ms on two threads, and does not scale beyond two: the serial half is a third of the work.
#![allow(unsafe_code)]
#![deny(clippy::undocumented_unsafe_blocks)]

use nalgebra::SVector;
use std::cell::Cell;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// An array with element-wise access through a shared reference.
pub(crate) trait Slots<T> {
    fn get(&self, index: usize) -> T;
    fn set(&self, index: usize, value: T);
}

/// The view for one thread.
pub(crate) fn cells<T>(values: &mut [T]) -> &[Cell<T>] {
    Cell::from_mut(values).as_slice_of_cells()
}

impl<T: Copy> Slots<T> for &[Cell<T>] {
    #[inline(always)]
    fn get(&self, index: usize) -> T {
        self[index].get()
    }
    #[inline(always)]
    fn set(&self, index: usize, value: T) {
        self[index].set(value);
    }
}

/// A type that consists of N consecutive `f64`s.
///
/// # Safety
/// `Self` must have the layout of `[f64; N]`.
pub(crate) unsafe trait Reals<const N: usize>: Copy {
    fn to_array(self) -> [f64; N];
    fn from_array(array: [f64; N]) -> Self;
}

// SAFETY: f64 and [f64; 1] have the same layout.
unsafe impl Reals<1> for f64 {
    #[inline(always)]
    fn to_array(self) -> [f64; 1] {
        [self]
    }
    #[inline(always)]
    fn from_array(array: [f64; 1]) -> Self {
        array[0]
    }
}

// SAFETY: nalgebra's matrix is repr(C) over its storage and a zero-sized marker, and array storage is
// repr(transparent) over [[f64; N]; 1].
unsafe impl<const N: usize> Reals<N> for SVector<f64, N> {
    #[inline(always)]
    fn to_array(self) -> [f64; N] {
        self.data.0[0]
    }
    #[inline(always)]
    fn from_array(array: [f64; N]) -> Self {
        array.into()
    }
}

/// The view for several threads. It is `None` on a target whose atomics are aligned more strictly than `f64`
/// (32-bit x86); callers then use one thread.
pub(crate) fn atomics<const N: usize, T: Reals<N>>(values: &mut [T]) -> Option<&[[AtomicU64; N]]> {
    const { assert!(size_of::<T>() == size_of::<[AtomicU64; N]>()) };
    if align_of::<T>() < align_of::<AtomicU64>() {
        return None;
    }
    // SAFETY: T has the layout of [f64; N], the sizes agree (asserted), and T is aligned enough, so the
    // memory holds as many [AtomicU64; N]; every bit pattern is valid for both types. The exclusive borrow of
    // `values` lasts as long as the result: all access goes through the atomics.
    Some(unsafe { std::slice::from_raw_parts(values.as_mut_ptr().cast(), values.len()) })
}

impl<const N: usize, T: Reals<N>> Slots<T> for &[[AtomicU64; N]] {
    #[inline(always)]
    fn get(&self, index: usize) -> T {
        let slot = &self[index];
        T::from_array(std::array::from_fn(|k| f64::from_bits(slot[k].load(Relaxed))))
    }
    #[inline(always)]
    fn set(&self, index: usize, value: T) {
        let slot = &self[index];
        let array = value.to_array();
        for k in 0..N {
            slot[k].store(array[k].to_bits(), Relaxed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Vector2, Vector3};

    #[test]
    fn both_views_read_and_write_the_elements_of_the_slice() {
        let mut values: Vec<Vector3<f64>> = (0..5).map(|i| Vector3::new(f64::from(i), 0.5, -0.0)).collect();
        let expected = Vector3::new(7.0, f64::NEG_INFINITY, 1e-320);
        let view = atomics(&mut values).expect("64-bit alignment");
        assert_eq!(Slots::<Vector3<f64>>::get(&view, 3), Vector3::new(3.0, 0.5, -0.0));
        view.set(3, expected);
        let view = cells(&mut values);
        assert_eq!(Slots::<Vector3<f64>>::get(&view, 3), expected);
        view.set(4, expected);
        assert_eq!(values[3..], [expected, expected]);
        assert_eq!(values[2], Vector3::new(2.0, 0.5, 0.0));

        let mut pairs = [Vector2::new(1.0, 2.0), Vector2::new(3.0, 4.0)];
        atomics(&mut pairs).expect("64-bit alignment").set(0, Vector2::new(5.0, 6.0));
        assert_eq!(pairs, [Vector2::new(5.0, 6.0), Vector2::new(3.0, 4.0)]);
        let mut scalars = [1.0, 2.0];
        atomics(&mut scalars).expect("64-bit alignment").set(1, 9.0);
        assert_eq!(scalars, [1.0, 9.0]);
    }
}
