//! Bodies of the fuzz targets: properties that hold for any bytes.
//!
//! `tests/fuzz` runs them with libFuzzer, which mutates bytes by code coverage. The test module `fuzz_bodies`
//! runs them with seeded random bytes, so that they are tested without a fuzzer. Each function panics if its
//! property is violated. It returns whether the bytes led to the check of the property: those of a mesh that
//! intersects at the start, or of a broken file, do not.

mod draw;
mod read_mesh;
mod resolve;
mod separate;

pub use draw::Draw;
pub use read_mesh::read_mesh;
pub use resolve::{resolve, resolve_on_twins};
pub use separate::separate;
