//! Pointers from C as what Rust has for them.

use crate::error::{Failure, input};
use bowknot::geometry::{Point, Vector};
use std::ffi::{CStr, c_char};

/// A text.
///
/// # Safety
/// The pointer is null or points to a text that ends with a zero and does not change while the result is used.
pub(crate) unsafe fn text<'a>(what: &str, pointer: *const c_char) -> Result<&'a str, Failure> {
    if pointer.is_null() {
        return Err(input(format!("{what} is NULL")));
    }
    // SAFETY: by the contract.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|error| input(format!("{what} is not UTF-8: {error}")))
}

/// What a handle or an out parameter points to.
///
/// # Safety
/// The pointer is null or points to a `T` that nothing else uses while the result is.
pub(crate) unsafe fn exclusive<'a, T>(what: &str, pointer: *mut T) -> Result<&'a mut T, Failure> {
    // SAFETY: by the contract.
    unsafe { pointer.as_mut() }.ok_or_else(|| input(format!("{what} is NULL")))
}

/// What a pointer to be read points to.
///
/// # Safety
/// The pointer is null or points to a `T` that does not change while the result is used.
pub(crate) unsafe fn shared<'a, T>(what: &str, pointer: *const T) -> Result<&'a T, Failure> {
    // SAFETY: by the contract.
    unsafe { pointer.as_ref() }.ok_or_else(|| input(format!("{what} is NULL")))
}

/// An array of `count` entries; NULL only if there are none.
///
/// # Safety
/// The pointer is null or points to so many entries that do not change while the result is used.
pub(crate) unsafe fn array<'a, T>(what: &str, pointer: *const T, count: usize) -> Result<&'a [T], Failure> {
    if count == 0 {
        return Ok(&[]);
    }
    if pointer.is_null() || !pointer.is_aligned() || count > isize::MAX as usize / size_of::<T>().max(1) {
        return Err(input(format!("{what}: {count} entries at {pointer:?} are no array")));
    }
    // SAFETY: by the contract; not null, aligned, and not too large.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// Writes `entries` to an array of C that has room for `room` of them, and their number to `count` if that is not NULL.
/// NULL in place of the array only counts.
///
/// # Safety
/// The array is null or has that much room, `count` is null or points to a number, and nothing else uses either.
pub(crate) unsafe fn write<T: Copy>(
    what: &str,
    entries: &[T],
    array: *mut T,
    room: usize,
    count: *mut usize,
) -> Result<(), Failure> {
    let len = entries.len();
    // SAFETY: by the contract.
    if let Some(count) = unsafe { count.as_mut() } {
        *count = len;
    }
    if array.is_null() {
        return Ok(());
    }
    if room < len || !array.is_aligned() {
        return Err(input(format!("{what}: {len} entries, but the array has room for {room}")));
    }
    // SAFETY: by the contract there is room for `room` entries, at least `len`, and they are not those of Rust.
    unsafe { std::ptr::copy_nonoverlapping(entries.as_ptr(), array, len) };
    Ok(())
}

/// Points of x y z each.
pub(crate) fn points(what: &str, xyz: &[f64]) -> Result<Vec<Point>, Failure> {
    let (rows, rest) = xyz.as_chunks::<3>();
    match rest {
        [] => Ok(rows.iter().map(|row| Point::from(*row)).collect()),
        _ => Err(input(format!("{what}: {} numbers are no rows of x, y and z", xyz.len()))),
    }
}

/// The numbers of points or vectors, by their coordinates.
pub(crate) fn numbers<'a>(rows: impl Iterator<Item = &'a Vector>) -> Vec<f64> {
    rows.flat_map(|row| [row.x, row.y, row.z]).collect()
}

/// Elements of N vertices each.
pub(crate) fn elements<const N: usize>(what: &str, indices: &[u32]) -> Result<Vec<[u32; N]>, Failure> {
    let (rows, rest) = indices.as_chunks::<N>();
    match rest {
        [] => Ok(rows.to_vec()),
        _ => Err(input(format!("{what}: {} numbers are no rows of {N}", indices.len()))),
    }
}
