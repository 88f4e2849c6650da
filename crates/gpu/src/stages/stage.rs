//! What a stage is.

use crate::bound::Bound;

const DISPATCH: &str = include_str!("../../shader/shared/dispatch.wgsl");

/// What a stage does with a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Access {
    Read,
    /// It reads or writes it.
    Write,
}

/// A stage.
pub(crate) struct Stage {
    pub name: &'static str,
    /// Shared parts of the shader and its own, after those that all have.
    pub parts: &'static [&'static str],
    /// Threads of a workgroup.
    pub workgroup: usize,
    /// The storage buffers, from binding 1 on.
    pub bindings: &'static [Access],
    pub twin: fn(Bound<'_>),
}

impl Stage {
    /// The whole shader.
    pub fn source(&self) -> String {
        DISPATCH.to_owned() + &self.parts.concat()
    }
}

impl std::fmt::Debug for Stage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}
