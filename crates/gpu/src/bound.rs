//! What a twin sees of a dispatch.

use bytemuck::Pod;
use std::cell::{Ref, RefCell, RefMut};

/// The buffers of a dispatch, in the order of the stage's bindings, and its parameters.
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

    pub fn read<T: Pod>(&self, binding: usize) -> Ref<'a, [T]> {
        Ref::map(self.buffers[binding].borrow(), |words| whole(words))
    }

    pub fn write<T: Pod>(&self, binding: usize) -> RefMut<'a, [T]> {
        RefMut::map(self.buffers[binding].borrow_mut(), |words| {
            let count = words.len() * 4 / size_of::<T>();
            bytemuck::cast_slice_mut(&mut words[..count * size_of::<T>() / 4])
        })
    }
}

/// As many entries as the words hold.
fn whole<T: Pod>(words: &[u32]) -> &[T] {
    let count = words.len() * 4 / size_of::<T>();
    bytemuck::cast_slice(&words[..count * size_of::<T>() / 4])
}
