//! NPZ archives: collision problems ([`States`]) and stacks of frames ([`FrameStack`]).

mod archive;
mod frames;
mod states;

pub use frames::FrameStack;
pub use states::{States, write_result};
