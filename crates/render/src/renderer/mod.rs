//! Draws a frame: a shadow map for each light, then the picture as the camera sees it.
//!
//! All passes of a picture are one submission. A depth-only pass for each light writes a layer of the shadow
//! maps. Then one pass with four samples per pixel shades each visible point with the lights that its shadow
//! maps let through. Vertices and uniforms are uploaded for each frame; the textures are kept.

mod buffers;
mod ground;
mod shot;
mod targets;
mod uniforms;

pub use shot::{Quality, Shot};

use crate::device::{Device, wait};
use crate::model::Drawing;
use crate::{Frame, Model, Picture, RenderError};
use buffers::FrameBuffers;
use targets::{ShadowMaps, Targets, depth_attachment, download_bytes};
use uniforms::{Uniforms, VIEW_STRIDE, light_counts};

/// Smallest side of a picture [pixels].
const MIN_SIZE: u32 = 16;

/// Draws frames. It keeps the device and its largest buffers: use one for all frames of a run.
#[derive(Debug)]
pub struct Renderer {
    device: Device,
    quality: Quality,
    shadows: Option<ShadowMaps>,
    targets: Option<Targets>,
}

impl Renderer {
    /// Opens the fastest device there is.
    ///
    /// # Errors
    /// [`RenderError::NoDriver`], which names the package to install, or the driver's refusal.
    pub fn new(quality: Quality) -> Result<Self, RenderError> {
        Ok(Self { device: Device::open()?, quality, shadows: None, targets: None })
    }

    /// Name of the device that draws.
    pub fn device_name(&self) -> &str {
        &self.device.adapter_name
    }

    /// Draws a frame.
    ///
    /// # Errors
    /// A frame that does not fit the model, a size that the device cannot draw, a camera at its target, a
    /// driver that fails.
    pub fn render(&mut self, model: &Model, frame: &Frame<'_>, shot: &Shot) -> Result<Picture, RenderError> {
        let drawing = model.drawing(frame)?;
        let largest = self.device.device.limits().max_texture_dimension_2d;
        let [width, height] = shot.size;
        if shot.size.iter().any(|side| !(MIN_SIZE..=largest).contains(side)) {
            return Err(RenderError::Size { width, height, largest });
        }
        let most = self.device.device.limits().max_buffer_size;
        let fits = |factor: u32| download_bytes([width, height].map(|side| side * factor)) <= most;
        if !fits(1) {
            let adapter = self.device.adapter_name.clone();
            return Err(RenderError::TooManyPixels {
                width,
                height,
                adapter,
                most: most / 4,
                fits: fitting(shot.size, most),
            });
        }
        let finest = self.quality.supersampling.max(1).min(largest / width.max(height));
        let factor = (1..=finest).rev().find(|&factor| fits(factor)).unwrap_or(1);

        // Without these scopes an error on the device would end the program.
        let device = self.device.device.clone();
        let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let drawn = self.draw(&drawing, shot, factor);
        let (invalid, no_memory) = (wait(validation.pop()), wait(memory.pop()));
        if no_memory.is_some() {
            // What has no memory behind it must not be used again.
            (self.targets, self.shadows) = (None, None);
            let adapter = self.device.adapter_name.clone();
            return Err(RenderError::OutOfMemory { width, height, adapter });
        }
        if let Some(error) = invalid {
            return Err(self.device.error(error));
        }
        Ok(drawn?.shrink(factor))
    }

    /// Draws the picture, larger by a factor.
    fn draw(&mut self, drawing: &Drawing, shot: &Shot, factor: u32) -> Result<Picture, RenderError> {
        let size = shot.size.map(|side| side * factor);
        let device = &self.device;
        let targets = match self.targets.take() {
            Some(targets) if targets.size == size => targets,
            _ => Targets::new(device, size),
        };
        let targets = self.targets.insert(targets);
        let light_count = light_counts(&self.quality).iter().sum();
        let shadows =
            self.shadows.get_or_insert_with(|| ShadowMaps::new(device, light_count, self.quality.shadow_map));

        let uniforms = Uniforms::new(drawing, shot, &self.quality, size, factor)?;
        let buffers = FrameBuffers::new(device, drawing, shot, &uniforms, shadows);
        let mut encoder = device.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for (index, layer) in shadows.layers.iter().enumerate().take(uniforms.light_count) {
            shadow_pass(device, &mut encoder, &buffers, layer, ((index + 1) * VIEW_STRIDE) as u32);
        }
        picture_pass(device, &mut encoder, &buffers, targets);
        targets.copy(&mut encoder);
        device.queue.submit([encoder.finish()]);
        targets.read(device)
    }
}

/// Sides of the shape of `size`, in whole 16 pixels, of which the device can hand over all pixels in `most`
/// bytes.
fn fitting(size: [u32; 2], most: u64) -> [u32; 2] {
    let scale = (most as f64 / download_bytes(size) as f64).sqrt();
    size.map(|side| ((f64::from(side) * scale) as u32 / 16 * 16).max(MIN_SIZE))
}

/// Records the pass that draws the shadow map of a light. `view` is the offset of its view in their buffer
/// [bytes].
fn shadow_pass(
    device: &Device,
    encoder: &mut wgpu::CommandEncoder,
    buffers: &FrameBuffers,
    layer: &wgpu::TextureView,
    view: u32,
) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("shadow"),
        depth_stencil_attachment: Some(depth_attachment(layer)),
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_bind_group(0, &buffers.view, &[view]);
    buffers.draw_elements(&mut pass, &device.surface_shadow, &device.ball_shadow);
}

/// Records the pass that draws what the camera sees.
fn picture_pass(
    device: &Device,
    encoder: &mut wgpu::CommandEncoder,
    buffers: &FrameBuffers,
    targets: &Targets,
) {
    let resolved = targets.resolved.create_view(&wgpu::TextureViewDescriptor::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("picture"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &targets.color,
            depth_slice: None,
            resolve_target: Some(&resolved),
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                store: wgpu::StoreOp::Discard,
            },
        })],
        depth_stencil_attachment: Some(depth_attachment(&targets.depth)),
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_bind_group(0, &buffers.view, &[0]);
    pass.set_bind_group(1, &buffers.scene, &[]);
    pass.set_pipeline(&device.backdrop);
    pass.draw(0..3, 0..1);
    // The ground comes last, so that the parts of it that elements hide are not shaded.
    buffers.draw_elements(&mut pass, &device.surface, &device.balls);
    buffers.draw_ground(&mut pass, &device.ground);
}
