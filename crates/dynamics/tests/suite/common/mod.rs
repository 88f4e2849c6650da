//! What tests share. Examples and benches take the meshes file by file.

mod block;
mod cloth;
mod setup;
mod sheet;
mod strands;

pub use block::block;
pub use cloth::cloth_model;
pub use setup::{dynamics, equilibrium, weightless, with_gravity, with_tolerance};
pub use sheet::sheet;
pub use strands::strands;
