//! PLY: read in all three encodings, written as binary little-endian doubles.

mod header;
mod payload;
mod read;
mod write;

pub(crate) use read::parse_ply;
pub use read::read_ply;
pub use write::write_ply;
