//! Compiled stages.

use crate::adapter::MOST_IMMEDIATES;
use crate::stages::{Access, Stage};

/// What the shaders declare, and what takes its place where parameters are immediates.
const IN_A_BUFFER: &str = "@group(0) @binding(0) var<uniform> params";
const IMMEDIATE: &str = "var<immediate> params";

/// A compiled stage.
#[derive(Debug)]
pub struct Compiled {
    pub pipeline: wgpu::ComputePipeline,
    pub layout: wgpu::BindGroupLayout,
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
