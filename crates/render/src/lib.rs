#![doc = include_str!("../README.md")]
//!
//! ## Modules
//!
//! | module | holds |
//! |---|---|
//! | `model` | elements and frames in the layout of the device |
//! | `surface`, `tubes` | normals with creases; strands as closed tubes |
//! | `camera`, `lights` | the camera and its fit; key light and sky as many small lights |
//! | `device`, `renderer`, `shader.wgsl` | the device and its pipelines; the passes of a picture; the shaders |
//! | `colormap`, `palette`, `legend`, `text` | colors of numbers and bodies, and their legend |
//! | `picture`, `encode` | pixels in memory; PNG and GIF |

mod camera;
mod colormap;
mod device;
mod encode;
mod error;
mod legend;
mod lights;
mod model;
mod palette;
mod picture;
mod renderer;
mod surface;
mod text;
mod tubes;

pub use bowknot_geometry as geometry;
pub use camera::{Camera, DEFAULT_FOV, Fit, View};
pub use colormap::viridis;
pub use encode::{write_gif, write_png, write_small_png};
pub use error::RenderError;
pub use legend::{Legend, Scale};
pub use model::{Elements, Frame, Model, Style};
pub use palette::{OBSTACLE as OBSTACLE_COLOR, body as body_color};
pub use picture::Picture;
pub use renderer::{Quality, Renderer, Shot};
