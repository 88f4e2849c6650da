//! `bowknot render`: draws pictures of a run.

mod colors;
mod edges;
mod folder;
mod framing;
mod gaps;

use crate::args::{Direction, FrameRange, RenderOptions};
use crate::exit::{Exit, Failure};
use crate::hints::Hint;
use crate::output;
use crate::progress::Bar;
use bowknot::io::{create_folder, write_atomic};
use bowknot_errors::counted;
use bowknot_render::{
    Camera, Elements, Fit, Frame, Legend, Model, Picture, Quality, RenderError, Renderer, Shot, Style, View,
    write_gif, write_png, write_small_png,
};
use colors::Coloring;
use folder::RunFolder;
use framing::Framing;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Largest number of frames per second of an animation, unless --fps asks for more.
const MAX_FPS: f64 = 30.0;
/// Approximate number of frames of a run that the camera is fitted to, in addition to those that are drawn.
const FITTED_FRAMES: usize = 24;

impl Hint for RenderError {
    fn hint(&self) -> Option<&'static str> {
        let is_too_large = matches!(self, Self::TooManyPixels { .. } | Self::OutOfMemory { .. });
        is_too_large.then_some("--size WIDTHxHEIGHT")
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        let message = error.with_hint();
        match error {
            RenderError::NoDriver { .. } | RenderError::Device { .. } | RenderError::OutOfMemory { .. } => {
                Self::backend(message)
            }
            _ => Self::input(message),
        }
    }
}

/// The kind of output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Output {
    Png,
    Gif,
    Folder,
}

impl Output {
    fn of(path: &Path) -> Result<Self, Failure> {
        match path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).as_deref() {
            Some("png") => Ok(Self::Png),
            Some("gif") => Ok(Self::Gif),
            None => Ok(Self::Folder),
            // The name of a folder may contain a dot, as in run.2.
            Some(_) if path.is_dir() => Ok(Self::Folder),
            Some(other) => Err(Failure::input(format!(
                "{}: no format is called .{other}: pictures end in .png, animations in .gif, and a name \
                 without an extension is a folder of pictures",
                path.display()
            ))),
        }
    }
}

pub fn render(options: &RenderOptions) -> Result<Exit, Failure> {
    let output = Output::of(&options.out)?;
    let run = RunFolder::open(&options.run)?;
    let (frames, fps) = select(options, output, &run)?;
    let started = Instant::now();

    // The device comes first: if there is none, the command fails before the other work.
    let mut renderer = Renderer::new(if frames.len() > 1 { Quality::FAST } else { Quality::FINE })?;
    let mut bar = Bar::new(2 * frames.len(), "passes over frames", options.quiet);
    let coloring = Coloring::new(options, &run, &frames, &mut bar)?;
    let size = options.size.unwrap_or(if output == Output::Gif { [640, 480] } else { [960, 720] });
    let shot = shot(options, &run, &frames, size, coloring.legend())?;
    let model = model(&run)?;

    let mut pictures = Vec::new();
    if output == Output::Folder {
        create_folder(&options.out)?;
    }
    for (index, &frame) in frames.iter().enumerate() {
        let (positions, ground) = run.frame(frame)?;
        let shot = Shot { ground, ..shot.clone() };
        let values = coloring.shares(index);
        let mut picture = renderer.render(&model, &Frame { positions: &positions, values }, &shot)?;
        if let Some(legend) = coloring.legend() {
            legend.draw(&mut picture);
        }
        match output {
            Output::Png => write(&options.out, options.indexed, &picture)?,
            Output::Folder => {
                write(&options.out.join(format!("{frame:06}.png")), options.indexed, &picture)?;
            }
            Output::Gif => pictures.push(picture),
        }
        bar.advance(1);
    }
    if output == Output::Gif {
        encode(&options.out, |out| write_gif(out, &pictures, fps))?;
    }
    bar.finish();
    if !options.quiet {
        let [width, height] = size;
        let what = match frames[..] {
            [frame] => format!("frame {frame}"),
            _ => counted(frames.len(), "frame", "frames"),
        };
        let (name, seconds) = (renderer.device_name(), started.elapsed().as_secs_f64());
        let out = options.out.display();
        output::print(&format!("{out}: {what}, {width} x {height} pixels, {seconds:.1} s on {name}"))?;
    }
    Ok(Exit::Success)
}

/// The frames that are drawn, and the number of frames per second of an animation.
fn select(options: &RenderOptions, output: Output, run: &RunFolder) -> Result<(Vec<usize>, f64), Failure> {
    let last = run.last_frame();
    if let Some(frame) = options.frame {
        run.check_frame(frame)?;
        return Ok((vec![frame], options.fps.unwrap_or(1.0)));
    }
    if output == Output::Png && options.frames.is_some() {
        return Err(Failure::input("a picture shows one frame: use --frame, or --out FILE.gif or a folder"));
    }
    let dt = run.time_step();
    // The step between frames with which an animation plays at the speed of the simulation.
    let fitting = (1.0 / (options.fps.unwrap_or(MAX_FPS) * dt)).ceil().max(1.0) as usize;
    let default = match output {
        Output::Png => FrameRange { first: last, last: None, step: 1 },
        Output::Gif => FrameRange { first: 0, last: None, step: fitting },
        Output::Folder => FrameRange { first: 0, last: None, step: 1 },
    };
    let range = options.frames.unwrap_or(default);
    if let Some(end) = range.last {
        run.check_frame(end)?;
    }
    run.check_frame(range.first)?;
    // The first that is missing ends it: a stray file of a large number would ask for as many frames.
    let mut frames = Vec::new();
    for frame in (range.first..=range.last.unwrap_or(last)).step_by(range.step) {
        run.check_frame(frame)?;
        frames.push(frame);
    }
    Ok((frames, options.fps.unwrap_or(1.0 / (dt * range.step as f64))))
}

/// The camera, which is fitted to the whole run, without bodies that have left the scene, unless the options
/// give one.
fn shot(
    options: &RenderOptions,
    run: &RunFolder,
    frames: &[usize],
    size: [u32; 2],
    legend: Option<&Legend>,
) -> Result<Shot, Failure> {
    let legend_width = legend.map_or(0, |legend| legend.width(size[1])).min(size[0] / 2);
    let view = match options.view {
        Direction::Front => View::Front,
        Direction::Side => View::Side,
        Direction::Top => View::Top,
        Direction::ThreeQuarter => View::ThreeQuarter,
    };
    let camera = match (options.camera, options.target) {
        (Some(eye), Some(target)) => Camera { eye: eye.into(), target: target.into(), fov: options.fov },
        (eye, _) => {
            let mut fit = Fit::new(view, options.fov, f64::from(size[0] - legend_width) / f64::from(size[1]));
            let every = (run.last_frame() / FITTED_FRAMES).max(1);
            let spread = run.frames().filter(|frame| frame % every == 0 || *frame == run.last_frame());
            let radius = run.radius();
            let framing = Framing::new(run.elements());
            for frame in spread.chain(frames.iter().copied()) {
                let positions = run.positions(frame)?;
                framing.staying(&positions).for_each(|p| fit.add(p, radius));
            }
            let camera = fit.camera();
            match eye {
                Some(eye) => Camera { eye: eye.into(), ..camera },
                None => camera,
            }
        }
    };
    Ok(Shot { legend_width, ..Shot::new(camera, size) })
}

fn model(run: &RunFolder) -> Result<Model, Failure> {
    let mesh = run.elements();
    let elements = Elements {
        triangles: &mesh.triangles,
        strands: &mesh.strands,
        particles: &mesh.particles,
        obstacle: mesh.obstacle.as_deref().unwrap_or(&[]),
        body: mesh.body.as_deref().unwrap_or(&[]),
    };
    // With this radius, strands and grains touch in the picture when they are in contact.
    let style = Style { strand_radius: run.radius(), particle_radius: run.radius() };
    Ok(Model::new(&elements, &mesh.positions, &style)?)
}

fn write(path: &Path, indexed: bool, picture: &Picture) -> Result<(), Failure> {
    encode(path, |out| if indexed { write_small_png(out, picture) } else { write_png(out, picture) })
}

/// Writes a file atomically, and its folder if there is none. An error of the encoder is reported as one of
/// the file.
pub fn encode(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> Result<(), RenderError>,
) -> Result<(), Failure> {
    let folder: PathBuf = path.parent().unwrap_or(Path::new("")).to_owned();
    if !folder.as_os_str().is_empty() {
        create_folder(&folder)?;
    }
    Ok(write_atomic(path, |out| {
        fill(out).map_err(|error| match error {
            RenderError::Encode(error) => error,
            other => std::io::Error::other(other),
        })
    })?)
}
