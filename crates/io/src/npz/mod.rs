//! NumPy archives (NPZ): arrays by name ([`Archive`]) and stacks of frames ([`FrameStack`]).

mod archive;
mod frames;
mod stack;

pub use archive::{Archive, Shape, write_archive};
pub use frames::FrameStack;
pub use stack::{write_frame_stack, write_frame_stack_with_fields};
