//! The native part of the Python package `bowknot`: arrays in, arrays and JSON out.
//!
//! The Python files beside it (`crates/python/python/bowknot`) check what users give, name it in messages and
//! document it. This part calls the library; it assumes nothing about its arguments that would make it panic.
//!
//! | file | does |
//! |---|---|
//! | `compute.rs` | runs work on the thread pool without the interpreter's lock, and watches for Ctrl-C |
//! | `arrays.rs` | NumPy arrays as points and elements, and back |
//! | `error.rs`, `messages.rs` | exceptions; warnings of the libraries for Python's `logging` |
//! | `resolver.rs` | the collision stage |
//! | `scene.rs`, `simulator.rs`, `drive.rs` | scenes; simulations; what is changed between time steps |
//! | `meshes.rs` | files, the judge, the search, repair |
//! | `runs.rs`, `pictures.rs`, `device.rs` | runs and their pages; pictures; the GPU |

mod arrays;
mod compute;
mod contacts;
mod device;
mod drive;
mod error;
mod judging;
mod meshes;
mod messages;
mod pictures;
mod resolver;
mod runs;
mod scene;
mod simulator;

use pyo3::prelude::*;

/// The module `bowknot._native`.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    bowknot::messages::listen();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<resolver::Resolver>()?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<simulator::Simulator>()?;
    module.add_class::<simulator::Checkpoint>()?;
    module.add_function(wrap_pyfunction!(messages::take, module)?)?;
    module.add_function(wrap_pyfunction!(compute::set_threads, module)?)?;
    module.add_function(wrap_pyfunction!(compute::threads, module)?)?;
    module.add_function(wrap_pyfunction!(scene::builtin_scenes, module)?)?;
    module.add_function(wrap_pyfunction!(meshes::read_mesh, module)?)?;
    module.add_function(wrap_pyfunction!(meshes::check_state, module)?)?;
    module.add_function(wrap_pyfunction!(meshes::check_path, module)?)?;
    module.add_function(wrap_pyfunction!(judging::check_files, module)?)?;
    module.add_function(wrap_pyfunction!(meshes::search, module)?)?;
    module.add_function(wrap_pyfunction!(meshes::repair, module)?)?;
    module.add_function(wrap_pyfunction!(runs::run, module)?)?;
    module.add_function(wrap_pyfunction!(runs::report, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::render, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::body_color, module)?)?;
    module.add_function(wrap_pyfunction!(device::gpus, module)?)?;
    Ok(())
}
