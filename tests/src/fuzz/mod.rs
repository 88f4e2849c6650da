//! Bodies of the fuzz targets: what must hold for any bytes at all.
//!
//! `tests/fuzz` hands them to libFuzzer, which mutates bytes by what they cover; the test module `fuzz_bodies`
//! drives them with seeded random bytes, so that they are known to work without a fuzzer. Each panics where a
//! promise is broken and returns whether the bytes led as far as the promise: those of a mesh that intersects
//! from the start, or of a broken file, do not.

mod draw;
mod read_mesh;
mod resolve;
mod separate;

pub use draw::Draw;
pub use read_mesh::read_mesh;
pub use resolve::resolve;
pub use separate::separate;
