//! The bind groups of dispatches.

use super::compiled::Compiled;
use super::opened::Opened;
use crate::recording::{BufferId, Dispatch};
use std::collections::HashMap;
use std::num::NonZeroU64;
use std::sync::Arc;

/// Bytes between the parameters of two dispatches in a buffer: what every device can offset by.
pub const PARAMS_STRIDE: u64 = 256;

/// The stages that an engine has run, with bind groups of its buffers. Bind groups are kept, since iterations
/// bind the same buffers again and again, and to make one takes the host longer than to record a dispatch.
#[derive(Debug, Default)]
pub struct Bindings {
    /// Places by the name of the stage.
    places: HashMap<&'static str, usize>,
    stages: Vec<Bound>,
}

#[derive(Debug)]
struct Bound {
    compiled: Arc<Compiled>,
    places: HashMap<Vec<BufferId>, usize>,
    /// None: one of its buffers was freed.
    groups: Vec<Option<wgpu::BindGroup>>,
    /// Places in `groups` that are free.
    free: Vec<usize>,
}

/// Where the stage of a dispatch and its bind group are.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    stage: usize,
    group: usize,
}

impl Bindings {
    /// Compiles the stage of a dispatch and binds its buffers, unless that was done before.
    pub fn place<'a>(
        &mut self,
        opened: &Opened,
        dispatch: &Dispatch,
        params: &wgpu::Buffer,
        buffer_of: impl Fn(BufferId) -> &'a wgpu::Buffer,
    ) -> Place {
        let stage = *self.places.entry(dispatch.stage.name).or_insert_with(|| {
            let compiled = opened.stage(dispatch.stage);
            self.stages.push(Bound {
                compiled,
                places: HashMap::new(),
                groups: Vec::new(),
                free: Vec::new(),
            });
            self.stages.len() - 1
        });
        let bound = &mut self.stages[stage];
        if let Some(&group) = bound.places.get(&dispatch.buffers) {
            return Place { stage, group };
        }
        let params = wgpu::BufferBinding { buffer: params, offset: 0, size: NonZeroU64::new(PARAMS_STRIDE) };
        let params = wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::Buffer(params) };
        let buffers = dispatch.buffers.iter().zip(1..).map(|(&buffer, binding)| wgpu::BindGroupEntry {
            binding,
            resource: buffer_of(buffer).as_entire_binding(),
        });
        let entries: Vec<wgpu::BindGroupEntry<'_>> =
            (!opened.has_immediates).then_some(params).into_iter().chain(buffers).collect();
        let made = Some(opened.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(dispatch.stage.name),
            layout: &bound.compiled.layout,
            entries: &entries,
        }));
        let group = bound.free.pop().unwrap_or_else(|| {
            bound.groups.push(None);
            bound.groups.len() - 1
        });
        bound.groups[group] = made;
        bound.places.insert(dispatch.buffers.clone(), group);
        Place { stage, group }
    }

    /// What runs at a place.
    pub fn at(&self, place: Place) -> (&wgpu::ComputePipeline, Option<&wgpu::BindGroup>) {
        let bound = &self.stages[place.stage];
        (&bound.compiled.pipeline, bound.groups[place.group].as_ref())
    }

    /// Forgets bind groups with a buffer, so that its memory is free.
    pub fn forget(&mut self, buffer: BufferId) {
        for Bound { places, groups, free, .. } in &mut self.stages {
            places.retain(|buffers, place| {
                let is_kept = !buffers.contains(&buffer);
                if !is_kept {
                    groups[*place] = None;
                    free.push(*place);
                }
                is_kept
            });
        }
    }

    /// Forgets all bind groups: places are no longer valid.
    pub fn forget_all(&mut self) {
        for bound in &mut self.stages {
            bound.places.clear();
            bound.groups.clear();
            bound.free.clear();
        }
    }
}
