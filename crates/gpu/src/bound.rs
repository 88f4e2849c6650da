//! What a twin sees of a dispatch.

use bytemuck::Pod;
use std::cell::{Ref, RefCell, RefMut};

/// The buffers of a dispatch, in the order of the stage's bindings, its parameters, and how many workgroups
/// it has.
#[derive(Clone, Copy)]
pub(crate) struct Bound<'a> {
    buffers: &'a [&'a RefCell<Vec<u32>>],
    params: &'a [u32],
    workgroups: usize,
}

impl<'a> Bound<'a> {
    pub fn new(buffers: &'a [&'a RefCell<Vec<u32>>], params: &'a [u32], workgroups: usize) -> Self {
        Self { buffers, params, workgroups }
    }

    pub fn params<P: Pod>(&self) -> P {
        bytemuck::cast_slice(self.params)[0]
    }

    pub fn workgroups(&self) -> usize {
        self.workgroups
    }

    /// The words of a buffer.
    pub fn read(&self, binding: usize) -> Ref<'a, Vec<u32>> {
        self.buffers[binding].borrow()
    }

    /// The words of a buffer, to be written.
    pub fn write(&self, binding: usize) -> RefMut<'a, Vec<u32>> {
        self.buffers[binding].borrow_mut()
    }
}
