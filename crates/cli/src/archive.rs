//! Archives of frames, and collision problems as archives of one frame.

use bowknot::io::{FrameStack, IoError, MeshView};
use bowknot::recording::States;
use std::path::Path;

/// The frames `X` of an archive, or the start `x` of a collision problem.
pub fn read(file: &Path) -> Result<FrameStack, IoError> {
    if !States::are_in(file)? {
        return FrameStack::read(file);
    }
    let states = States::read(file)?;
    let view = MeshView {
        positions: &states.x,
        triangles: &states.triangles,
        strands: &states.strands,
        particles: &states.particles,
        obstacle: &states.obstacle,
        ..MeshView::default()
    };
    let mut stack = FrameStack::new(&view, &[]);
    // This cannot fail: the stack is for meshes of this number of vertices.
    let _ = stack.push(&states.x);
    Ok(stack)
}
