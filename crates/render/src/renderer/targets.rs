//! Textures that are drawn into: shadow maps, and the picture with its way back to memory.

use crate::device::{COLOR, DEPTH, Device, SAMPLES, SHADOW};
use crate::{Picture, RenderError};
use wgpu::BufferUsages;

/// The shadow maps of all lights: layers of one texture.
#[derive(Debug)]
pub struct ShadowMaps {
    /// One view per light.
    pub layers: Vec<wgpu::TextureView>,
    /// All layers, as the shader reads them.
    pub all: wgpu::TextureView,
}

/// The textures that a picture is drawn into, and the buffer that brings it back.
#[derive(Debug)]
pub struct Targets {
    /// Width and height [pixels].
    pub size: [u32; 2],
    /// Color of the samples.
    pub color: wgpu::TextureView,
    /// Depth of the samples.
    pub depth: wgpu::TextureView,
    /// Color of the pixels: the mean of their samples.
    pub resolved: wgpu::Texture,
    download: wgpu::Buffer,
}

impl ShadowMaps {
    /// Maps of `side` x `side` texels for `count` lights.
    pub fn new(device: &Device, count: usize, side: u32) -> Self {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let texture = texture(device, "shadows", [side, side], count as u32, 1, SHADOW, usage);
        let layer = |index| wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: index,
            array_layer_count: Some(1),
            ..wgpu::TextureViewDescriptor::default()
        };
        let all = wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..wgpu::TextureViewDescriptor::default()
        };
        Self {
            layers: (0..count as u32).map(|index| texture.create_view(&layer(index))).collect(),
            all: texture.create_view(&all),
        }
    }
}

impl Targets {
    /// Targets for a picture of this size [pixels].
    pub fn new(device: &Device, size: [u32; 2]) -> Self {
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let view = |texture: wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let copied = attachment | wgpu::TextureUsages::COPY_SRC;
        Self {
            size,
            color: view(texture(device, "samples", size, 1, SAMPLES, COLOR, attachment)),
            depth: view(texture(device, "depth", size, 1, SAMPLES, DEPTH, attachment)),
            resolved: texture(device, "picture", size, 1, 1, COLOR, copied),
            download: device.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("download"),
                size: download_bytes(size),
                usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
        }
    }

    /// Records the copy of the picture into the download buffer.
    pub fn copy(&self, encoder: &mut wgpu::CommandEncoder) {
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(row_bytes(self.size[0])),
            rows_per_image: None,
        };
        encoder.copy_texture_to_buffer(
            self.resolved.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &self.download, layout },
            self.resolved.size(),
        );
    }

    /// Waits for the device and reads the picture.
    ///
    /// # Errors
    /// [`RenderError::Device`] if the driver fails.
    pub fn read(&self, device: &Device) -> Result<Picture, RenderError> {
        let (sender, receiver) = std::sync::mpsc::channel();
        self.download.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver waits below; if it is gone, nobody needs the result.
            let _ = sender.send(result);
        });
        device.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| device.error(e))?;
        receiver.recv().map_err(|e| device.error(e))?.map_err(|e| device.error(e))?;
        let [width, height] = self.size;
        let mut picture = Picture { width, height, pixels: Vec::with_capacity((width * height) as usize) };
        let mapped = self.download.get_mapped_range(..).map_err(|e| device.error(e))?;
        for row in mapped.chunks_exact(row_bytes(width) as usize) {
            let pixels = row[..4 * width as usize].as_chunks::<4>().0;
            picture.pixels.extend(pixels.iter().map(|&[r, g, b, _]| [r, g, b]));
        }
        drop(mapped);
        self.download.unmap();
        Ok(picture)
    }
}

/// Size of the buffer that brings a picture back [bytes].
pub fn download_bytes([width, height]: [u32; 2]) -> u64 {
    u64::from(row_bytes(width)) * u64::from(height)
}

/// Length of a row of pixels, rounded up to the alignment that copies demand [bytes].
fn row_bytes(width: u32) -> u32 {
    (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

fn texture(
    device: &Device,
    label: &str,
    [width, height]: [u32; 2],
    layers: u32,
    samples: u32,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// A depth attachment that is cleared to the far plane.
pub fn depth_attachment(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    }
}
