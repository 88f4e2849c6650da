//! What a frame uploads to the device.

use super::ground::ground_vertices;
use super::shot::Shot;
use super::targets::ShadowMaps;
use super::uniforms::{Uniforms, ViewData};
use crate::device::Device;
use crate::model::Drawing;
use wgpu::BufferUsages;

/// Buffers and bind groups of a frame.
pub struct FrameBuffers {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    index_count: u32,
    balls: wgpu::Buffer,
    ball_count: u32,
    ground: wgpu::Buffer,
    ground_vertices: u32,
    /// The views; a dynamic offset selects one.
    pub view: wgpu::BindGroup,
    /// The scene and the shadow maps.
    pub scene: wgpu::BindGroup,
}

impl FrameBuffers {
    /// Uploads a frame.
    pub fn new(
        device: &Device,
        drawing: &Drawing,
        shot: &Shot,
        uniforms: &Uniforms,
        shadows: &ShadowMaps,
    ) -> Self {
        let view_buffer = device.buffer("views", &uniforms.views, BufferUsages::UNIFORM);
        let scene_buffer = device.buffer("scene", &[uniforms.scene], BufferUsages::UNIFORM);
        let view = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("view"),
            layout: &device.view_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer: &view_buffer,
                    offset: 0,
                    size: std::num::NonZeroU64::new(size_of::<ViewData>() as u64),
                }),
            }],
        });
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let scene = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("scene"),
            layout: &device.scene_layout,
            entries: &[
                entry(0, scene_buffer.as_entire_binding()),
                entry(1, wgpu::BindingResource::TextureView(&shadows.all)),
                entry(2, wgpu::BindingResource::Sampler(&device.sampler)),
            ],
        });
        let ground = ground_vertices(shot, drawing);
        Self {
            vertices: device.buffer("vertices", &drawing.vertices, BufferUsages::VERTEX),
            indices: device.buffer("indices", &drawing.indices, BufferUsages::INDEX),
            index_count: drawing.indices.len() as u32,
            balls: device.buffer("balls", &drawing.balls, BufferUsages::VERTEX),
            ball_count: drawing.balls.len() as u32,
            ground_vertices: ground.len() as u32,
            ground: device.buffer("ground", &ground, BufferUsages::VERTEX),
            view,
            scene,
        }
    }

    /// Records the draws of all elements with these pipelines.
    pub fn draw_elements(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        surface: &wgpu::RenderPipeline,
        balls: &wgpu::RenderPipeline,
    ) {
        if self.index_count > 0 {
            pass.set_pipeline(surface);
            pass.set_vertex_buffer(0, self.vertices.slice(..));
            pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..self.index_count, 0, 0..1);
        }
        if self.ball_count > 0 {
            pass.set_pipeline(balls);
            pass.set_vertex_buffer(0, self.balls.slice(..));
            pass.draw(0..4, 0..self.ball_count);
        }
    }

    /// Records the draw of the ground, if there is any.
    pub fn draw_ground(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        if self.ground_vertices > 0 {
            pass.set_pipeline(pipeline);
            pass.set_vertex_buffer(0, self.ground.slice(..));
            pass.draw(0..self.ground_vertices, 0..1);
        }
    }
}
