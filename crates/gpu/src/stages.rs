//! What a stage is: a kernel with its place in the table of all [kernels](crate::kernels).
//!
//! Binding 0 of a kernel holds the parameters of a dispatch. Threads go on with strides, so that any number
//! of workgroups up to [`recording::MAX_WORKGROUPS`](crate::recording::MAX_WORKGROUPS) does all of the work;
//! only those that scan depend on the size of a workgroup.

#[cfg(feature = "twins")]
use crate::bound::Bound;

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
    /// Shared parts of the shader and its own.
    pub parts: &'static [&'static str],
    /// Threads of a workgroup.
    pub workgroup: usize,
    /// The storage buffers, from binding 1 on.
    pub bindings: &'static [Access],
    #[cfg(feature = "twins")]
    pub twin: fn(Bound<'_>),
}

impl Stage {
    /// The whole shader.
    pub fn source(&self) -> String {
        self.parts.concat()
    }
}

impl std::fmt::Debug for Stage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

#[cfg(test)]
mod function_tests;
#[cfg(test)]
mod tests;
