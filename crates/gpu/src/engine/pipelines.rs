//! Compiled stages, and the bind groups of their dispatches.

use crate::recording::{BufferId, Dispatch};
use crate::stages::{Access, Stage};
use std::collections::HashMap;
use std::num::NonZeroU64;

/// Bytes between the parameters of two dispatches: what every device can offset by.
pub const PARAMS_STRIDE: u64 = 256;

/// By the name of the stage. Bind groups are kept, since iterations bind the same buffers again and again, and to make one
/// takes the host longer than to record a dispatch.
#[derive(Debug, Default)]
pub struct Pipelines {
    stages: HashMap<&'static str, Compiled>,
}

#[derive(Debug)]
struct Compiled {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    groups: HashMap<Vec<BufferId>, wgpu::BindGroup>,
}

impl Pipelines {
    /// Compiles the stage of a dispatch and binds its buffers, unless that was done before.
    pub fn prepare<'a>(
        &mut self,
        device: &wgpu::Device,
        dispatch: &Dispatch,
        params: &wgpu::Buffer,
        buffer_of: impl Fn(BufferId) -> &'a wgpu::Buffer,
    ) {
        let stage = dispatch.stage;
        let compiled = self.stages.entry(stage.name).or_insert_with(|| compile(device, stage));
        if compiled.groups.contains_key(&dispatch.buffers) {
            return;
        }
        let size = NonZeroU64::new(PARAMS_STRIDE);
        let params = wgpu::BufferBinding { buffer: params, offset: 0, size };
        let mut entries =
            vec![wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::Buffer(params) }];
        entries.extend(dispatch.buffers.iter().zip(1..).map(|(&buffer, binding)| wgpu::BindGroupEntry {
            binding,
            resource: buffer_of(buffer).as_entire_binding(),
        }));
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(stage.name),
            layout: &compiled.layout,
            entries: &entries,
        });
        compiled.groups.insert(dispatch.buffers.clone(), group);
    }

    /// What a dispatch runs, which was prepared.
    pub fn of(&self, dispatch: &Dispatch) -> (&wgpu::ComputePipeline, &wgpu::BindGroup) {
        let compiled = &self.stages[dispatch.stage.name];
        (&compiled.pipeline, &compiled.groups[dispatch.buffers.as_slice()])
    }

    /// Forgets bind groups with a buffer.
    pub fn forget(&mut self, buffer: BufferId) {
        self.stages.values_mut().for_each(|stage| stage.groups.retain(|bound, _| !bound.contains(&buffer)));
    }

    /// Forgets all bind groups.
    pub fn forget_all(&mut self) {
        self.stages.values_mut().for_each(|stage| stage.groups.clear());
    }
}

fn compile(device: &wgpu::Device, stage: &'static Stage) -> Compiled {
    let entry =
        |binding: u32, ty: wgpu::BufferBindingType, has_dynamic_offset: bool| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset, min_binding_size: None },
            count: None,
        };
    let mut entries = vec![entry(0, wgpu::BufferBindingType::Uniform, true)];
    entries.extend(stage.bindings.iter().zip(1..).map(|(access, binding)| {
        let read_only = *access == Access::Read;
        entry(binding, wgpu::BufferBindingType::Storage { read_only }, false)
    }));
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(stage.name),
        entries: &entries,
    });
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(stage.name),
        source: wgpu::ShaderSource::Wgsl(stage.source().into()),
    });
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(stage.name),
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(stage.name),
        layout: Some(&pipeline_layout),
        module: &module,
        entry_point: Some("main"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    Compiled { pipeline, layout, groups: HashMap::new() }
}
