//! Archives of frames, and collision problems as archives of one frame.

use bowknot::io::npz::Archive;
use bowknot::io::{FrameStack, IoError, Mesh, MeshView};
use bowknot::recording::States;
use std::path::Path;

/// The frames `X` of an archive, or the start `x` of a collision problem.
pub fn read(file: &Path) -> Result<FrameStack, IoError> {
    if Archive::open(file)?.has("X") {
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

/// A frame of an archive as a mesh.
pub fn mesh(stack: &FrameStack, frame: usize) -> Mesh {
    let view = stack.mesh();
    Mesh {
        positions: stack.frame(frame).unwrap_or_default(),
        triangles: view.triangles.to_vec(),
        strands: view.strands.to_vec(),
        particles: view.particles.to_vec(),
        obstacle: Some(view.obstacle.to_vec()),
        ..Mesh::default()
    }
}
