//! Meshes that tests share with examples and benches, which take these files one by one.

mod block;
mod cloth;
mod sheet;
mod strands;

pub use block::block;
pub use cloth::cloth_model;
pub use sheet::sheet;
pub use strands::strands;
