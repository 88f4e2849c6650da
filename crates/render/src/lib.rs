//! Offscreen pictures of triangles, strands and particles through wgpu. No window is needed, and any driver
//! will do, a software driver included.
//!
//! ```no_run
//! use bowknot_render::geometry::{HalfSpace, Point, Vector};
//! use bowknot_render::{Elements, Fit, Frame, Model, Quality, Renderer, Shot, Style, View, write_png};
//!
//! let points: Vec<Point> = vec![Point::origin(), Point::new(1.0, 0.0, 0.2), Point::new(0.0, 1.0, 0.4)];
//! let elements = Elements { triangles: &[[0, 1, 2]], ..Elements::default() };
//! let model = Model::new(&elements, &points, &Style { strand_radius: 0.01, particle_radius: 0.01 })?;
//!
//! let mut fit = Fit::new(View::ThreeQuarter, 26.0, 4.0 / 3.0);
//! points.iter().for_each(|p| fit.add(p, 0.0));
//! let ground = HalfSpace { normal: Vector::z(), offset: -0.1 };
//! let shot = Shot { ground: vec![ground], ..Shot::new(fit.camera(), [640, 480]) };
//!
//! let mut renderer = Renderer::new(Quality::FINE)?; // without a driver, an error that names the package to install
//! let picture = renderer.render(&model, &Frame { positions: &points, values: &[] }, &shot)?;
//! write_png(std::fs::File::create("triangle.png")?, &picture)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | module | holds |
//! |---|---|
//! | `model` | elements and frames in the layout of the device |
//! | `surface`, `tubes` | normals with creases; strands as closed tubes |
//! | `camera`, `lights` | the camera and its fit; key light and sky as many small lights |
//! | `device`, `renderer`, `shader.wgsl` | the device and its pipelines; the passes of a picture; the shaders |
//! | `colormap`, `palette`, `legend`, `text` | colors of numbers and bodies, and their legend |
//! | `picture`, `encode` | pixels in memory; PNG and GIF |
//!
//! The crate knows no solvers, no scenes, and no file formats other than PNG and GIF.

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

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

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
