//! Wavefront OBJ: `v`, `f`, `l`, `p` and what modeling tools say about faces (`vt`, `vn`, `o`, `g`, `usemtl`,
//! `mtllib`, `s`); every other statement is skipped. And `.seg`, of the same manner, with strand segments as
//! `s`.
//!
//! The format has no word for obstacles, without which nobody could tell a ball that rests on the ground from
//! one that intersects it; a comment says from which vertex on there are obstacles only.

mod faces;
mod library;
mod read;
mod write;

pub(crate) use read::{parse_obj, read_segments};
pub use read::{read_obj, read_obj_surface};
pub use write::write_obj;
