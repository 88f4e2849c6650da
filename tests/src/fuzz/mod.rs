//! Bodies of the fuzz targets: properties that hold for any bytes.
//!
//! `tests/fuzz` runs them with libFuzzer, which mutates bytes by code coverage. The tests `fuzz_bodies` and
//! `fuzz_files` run them with seeded random bytes and with damaged files ([`mutate`]), so that they are
//! tested without a fuzzer; `fuzz_files` measures memory as well. Each function panics if its property is
//! violated. It returns whether the bytes led to the check of the property: those of a mesh that intersects
//! at the start, or of a broken file, do not.

mod archive;
mod draw;
mod msh;
mod mutate;
mod parts;
mod read_mesh;
mod resolve;
mod run_folder;
mod scene;
mod separate;

pub use archive::{arrays, arrays_of, checkpoint, restore, sound_checkpoint, write_run};
pub use draw::Draw;
pub use msh::binary_msh_4;
pub use mutate::mutate;
pub use read_mesh::read_mesh;
pub use resolve::{resolve, resolve_on_twins};
pub use run_folder::{files_of, run_folder};
pub use scene::scene;
pub use separate::separate;
