//! The device and the pipelines, which do not depend on the picture.

use crate::RenderError;
use crate::model::{Ball, SurfaceVertex};
use std::pin::pin;
use std::task::{Context, Poll, Waker};
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// Format of the picture on the device.
pub const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Format of the picture's depth.
pub const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Format of the shadow maps. Its step of depth is far below the width of a texel.
pub const SHADOW: wgpu::TextureFormat = wgpu::TextureFormat::Depth16Unorm;
/// Samples per pixel: every device supports 4.
pub const SAMPLES: u32 = 4;

/// An opened device with all pipelines.
#[derive(Debug)]
pub struct Device {
    pub adapter_name: String,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub view_layout: wgpu::BindGroupLayout,
    pub scene_layout: wgpu::BindGroupLayout,
    pub sampler: wgpu::Sampler,
    pub backdrop: wgpu::RenderPipeline,
    pub ground: wgpu::RenderPipeline,
    pub surface: wgpu::RenderPipeline,
    pub balls: wgpu::RenderPipeline,
    pub surface_shadow: wgpu::RenderPipeline,
    pub ball_shadow: wgpu::RenderPipeline,
}

impl Device {
    /// Opens the fastest device there is.
    pub fn open() -> Result<Self, RenderError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..wgpu::RequestAdapterOptions::default()
        };
        let adapter = wait(instance.request_adapter(&options)).map_err(|error| {
            tracing::debug!("no adapter: {error}");
            RenderError::NoDriver { reason: None }
        })?;
        let info = adapter.get_info();
        tracing::debug!("drawing on {} ({:?}, {})", info.name, info.backend, info.driver_info);
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("bowknot-render"),
            required_limits: wgpu::Limits::downlevel_defaults().using_resolution(adapter.limits()),
            ..wgpu::DeviceDescriptor::default()
        };
        let opened = wait(adapter.request_device(&descriptor));
        let (device, queue) = opened.map_err(|error| RenderError::Device {
            adapter: info.name.clone(),
            message: error.to_string(),
        })?;
        Ok(Self::with_pipelines(info.name, device, queue))
    }

    fn with_pipelines(adapter_name: String, device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("pictures"),
            source: wgpu::ShaderSource::Wgsl(include_str!("shader.wgsl").into()),
        });
        let view_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("view"),
            entries: &[uniform(0, true)],
        });
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let shadows = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Depth,
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        };
        let comparison = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison);
        let scene_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("scene"),
            entries: &[uniform(0, false), entry(1, shadows), entry(2, comparison)],
        });
        let layout = |label, groups: &[Option<&wgpu::BindGroupLayout>]| {
            device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: groups,
                immediate_size: 0,
            })
        };
        let picture = layout("picture", &[Some(&view_layout), Some(&scene_layout)]);
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("shadows"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            compare: Some(wgpu::CompareFunction::LessEqual),
            ..wgpu::SamplerDescriptor::default()
        });
        let shadow = layout("shadow", &[Some(&view_layout)]);
        let make = |recipe: Recipe<'_>| recipe.pipeline(&device, &shader);
        let surface_buffer = || wgpu::VertexBufferLayout {
            array_stride: size_of::<SurfaceVertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &SURFACE_ATTRIBUTES,
        };
        let ball_buffer = || wgpu::VertexBufferLayout {
            array_stride: size_of::<Ball>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &BALL_ATTRIBUTES,
        };
        let strip = wgpu::PrimitiveTopology::TriangleStrip;
        let plain = Recipe { layout: &picture, ..Recipe::new("", &shadow) };
        let backdrop = make(Recipe {
            label: "backdrop",
            vertex: "backdrop_vertex",
            fragment: Some("backdrop_fragment"),
            depth: false,
            ..plain.clone()
        });
        let surface = Recipe { buffer: Some(surface_buffer()), vertex: "surface_vertex", ..plain.clone() };
        let ball =
            Recipe { buffer: Some(ball_buffer()), vertex: "ball_vertex", topology: strip, ..plain.clone() };
        let ground = make(Recipe { label: "ground", fragment: Some("ground_fragment"), ..surface.clone() });
        let balls =
            make(Recipe { label: "balls", fragment: Some("ball_fragment"), coverage: true, ..ball.clone() });
        let surface_shadow =
            make(Recipe { label: "surface shadows", layout: &shadow, shadow: true, ..surface.clone() });
        let ball_shadow = make(Recipe {
            label: "ball shadows",
            vertex: "ball_outline_vertex",
            fragment: Some("ball_shadow"),
            layout: &shadow,
            shadow: true,
            ..ball
        });
        let surface = make(Recipe { label: "surface", fragment: Some("surface_fragment"), ..surface });
        Self {
            adapter_name,
            device,
            queue,
            view_layout,
            scene_layout,
            sampler,
            backdrop,
            ground,
            surface,
            balls,
            surface_shadow,
            ball_shadow,
        }
    }

    /// A buffer with this content. No buffer may be empty, so an empty one holds a few zeros.
    pub fn buffer<T: bytemuck::NoUninit>(
        &self,
        label: &str,
        content: &[T],
        usage: wgpu::BufferUsages,
    ) -> wgpu::Buffer {
        let bytes: &[u8] = bytemuck::cast_slice(content);
        let contents = if bytes.is_empty() { &[0; 16] } else { bytes };
        self.device.create_buffer_init(&BufferInitDescriptor { label: Some(label), contents, usage })
    }

    /// An error of the driver, with its message.
    pub fn error(&self, message: impl std::fmt::Display) -> RenderError {
        RenderError::Device { adapter: self.adapter_name.clone(), message: message.to_string() }
    }
}

const SURFACE_ATTRIBUTES: [wgpu::VertexAttribute; 4] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32, 2 => Float32x3, 3 => Unorm8x4];
const BALL_ATTRIBUTES: [wgpu::VertexAttribute; 4] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32, 2 => Float32, 3 => Unorm8x4];

fn uniform(binding: u32, has_dynamic_offset: bool) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset,
            min_binding_size: None,
        },
        count: None,
    }
}

/// The settings in which the pipelines differ.
#[derive(Clone)]
struct Recipe<'a> {
    label: &'a str,
    layout: &'a wgpu::PipelineLayout,
    vertex: &'a str,
    fragment: Option<&'a str>,
    buffer: Option<wgpu::VertexBufferLayout<'a>>,
    topology: wgpu::PrimitiveTopology,
    /// Whether it draws into a shadow map: depth only, one sample.
    shadow: bool,
    /// Whether it tests and writes depth.
    depth: bool,
    /// Whether alpha masks the samples of a pixel.
    coverage: bool,
}

impl<'a> Recipe<'a> {
    fn new(label: &'a str, layout: &'a wgpu::PipelineLayout) -> Self {
        Self {
            label,
            layout,
            vertex: "",
            fragment: None,
            buffer: None,
            topology: wgpu::PrimitiveTopology::TriangleList,
            shadow: false,
            depth: true,
            coverage: false,
        }
    }

    fn pipeline(&self, device: &wgpu::Device, shader: &wgpu::ShaderModule) -> wgpu::RenderPipeline {
        let targets = [Some(wgpu::ColorTargetState::from(COLOR))];
        let targets = if self.shadow { &[][..] } else { &targets[..] };
        let compare = if self.depth { wgpu::CompareFunction::Less } else { wgpu::CompareFunction::Always };
        let buffers = [self.buffer.clone()];
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.label),
            layout: Some(self.layout),
            vertex: wgpu::VertexState {
                module: shader,
                entry_point: Some(self.vertex),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: if self.buffer.is_some() { &buffers } else { &[] },
            },
            fragment: self.fragment.map(|entry| wgpu::FragmentState {
                module: shader,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets,
            }),
            primitive: wgpu::PrimitiveState { topology: self.topology, ..wgpu::PrimitiveState::default() },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: if self.shadow { SHADOW } else { DEPTH },
                depth_write_enabled: Some(self.depth),
                depth_compare: Some(compare),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState {
                count: if self.shadow { 1 } else { SAMPLES },
                mask: !0,
                alpha_to_coverage_enabled: self.coverage,
            },
            multiview_mask: None,
            cache: None,
        })
    }
}

/// Waits for a future of wgpu. With the native backends these are ready at once, so the loop does not spin.
pub fn wait<T>(future: impl Future<Output = T>) -> T {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        match future.as_mut().poll(&mut context) {
            Poll::Ready(value) => return value,
            Poll::Pending => std::thread::yield_now(),
        }
    }
}
