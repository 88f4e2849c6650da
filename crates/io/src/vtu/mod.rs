//! VTK XML for ParaView: unstructured grids, read in all their encodings and written in one.
//!
//! Source: VTK's pages "VTK XML file formats" and "VTK file formats"; numbers of cell types from `vtkCellType.h`.
//! The content of an array stands in its element, as text or base64, or behind the last element, raw or base64.
//! Binary content begins with its length in bytes; compressed content with the number of blocks, the size of a
//! block, that of the last if it is smaller, and the compressed size of each.

mod cells;
mod data;
mod read;
mod write;

#[cfg(test)]
mod tests;

pub(crate) use read::read_vtu;
pub use write::{write_pvd, write_vtu, write_vtu_with_fields};
