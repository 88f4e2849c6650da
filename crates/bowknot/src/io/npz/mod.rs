//! NPZ archives: collision problems ([`States`]) and stacks of frames ([`FrameStack`]).

mod archive;
mod frames;
mod stack;
mod states;

pub use frames::FrameStack;
pub use stack::write_frame_stack;
pub use states::{States, write_result};
