//! Compiled stages, and the bind groups of their dispatches.

use super::opened::Opened;
use crate::recording::{BufferId, Dispatch};
use crate::stages::{Access, Stage};
use std::collections::HashMap;
use std::num::NonZeroU64;
use std::sync::Arc;

/// Bytes between the parameters of two dispatches in a buffer: what every device can offset by.
pub const PARAMS_STRIDE: u64 = 256;

/// Bytes of parameters that fit into immediates; no stage has more.
pub const MOST_IMMEDIATES: u32 = 96;

/// What the shaders declare, and what takes its place where parameters are immediates.
const IN_A_BUFFER: &str = "@group(0) @binding(0) var<uniform> params";
const IMMEDIATE: &str = "var<immediate> params";

/// A compiled stage.
#[derive(Debug)]
pub struct Compiled {
    pub pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
}

/// The stages that an engine has run, with bind groups of its buffers. Bind groups are kept, since iterations bind the
/// same buffers again and again, and to make one takes the host longer than to record a dispatch.
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
            self.stages.push(Bound { compiled, places: HashMap::new(), groups: Vec::new() });
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
        bound.groups.push(Some(opened.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(dispatch.stage.name),
            layout: &bound.compiled.layout,
            entries: &entries,
        })));
        let group = bound.groups.len() - 1;
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
        for Bound { places, groups, .. } in &mut self.stages {
            places.retain(|buffers, place| {
                let is_kept = !buffers.contains(&buffer);
                if !is_kept {
                    groups[*place] = None;
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
        }
    }
}

pub fn compile(device: &wgpu::Device, stage: &'static Stage, has_immediates: bool) -> Compiled {
    let entry =
        |binding: u32, ty: wgpu::BufferBindingType, has_dynamic_offset: bool| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset, min_binding_size: None },
            count: None,
        };
    let params = (!has_immediates).then(|| entry(0, wgpu::BufferBindingType::Uniform, true));
    let buffers = stage.bindings.iter().zip(1..).map(|(access, binding)| {
        let read_only = *access == Access::Read;
        entry(binding, wgpu::BufferBindingType::Storage { read_only }, false)
    });
    let entries: Vec<wgpu::BindGroupLayoutEntry> = params.into_iter().chain(buffers).collect();
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(stage.name),
        entries: &entries,
    });
    let source = stage.source();
    let source = if has_immediates { source.replace(IN_A_BUFFER, IMMEDIATE) } else { source };
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(stage.name),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(stage.name),
        bind_group_layouts: &[Some(&layout)],
        immediate_size: if has_immediates { MOST_IMMEDIATES } else { 0 },
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(stage.name),
        layout: Some(&pipeline_layout),
        module: &module,
        entry_point: Some("main"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    Compiled { pipeline, layout }
}
