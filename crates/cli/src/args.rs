//! The command line.

use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Simulates deformable bodies that never intersect.
///
/// Exit codes: 0 done; 1 a check found an intersection or too small a distance; 2 bad input; 3 no such
/// backend or device; 4 a fault of the program itself; 130 interrupted, with a valid checkpoint.
#[derive(Debug, Parser)]
#[command(name = "bowknot", version, arg_required_else_help = true)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// List the built-in scenes with their sizes
    Scenes(ScenesOptions),
    /// Simulate a built-in scene, a scene file or a mesh
    Run(RunOptions),
    /// Resolve a recorded collision problem
    Resolve(ResolveOptions),
    /// Check states, and the paths of a trace, for intersections: exit code 1 if there are any
    Check(CheckOptions),
    /// Weld the seams of a mesh and drop degenerate elements: exit code 1 if intersections remain
    Repair(RepairOptions),
    /// Write the frames of a run in other formats
    Export(ExportOptions),
    /// Write one HTML page that plays a run beside plots of its statistics
    Report(ReportOptions),
    /// Draw the frames of a run: a picture, an animation, or a folder of pictures
    #[cfg(feature = "render")]
    Render(RenderOptions),
    /// Print the counts and the size of a scene or a mesh
    Info(InfoOptions),
    /// Print the completions of a shell
    Completions(CompletionsOptions),
    /// Write the manual pages, one per command, into a folder
    Man(ManOptions),
}

#[derive(Debug, Args)]
pub struct CompletionsOptions {
    /// The shell
    pub shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
pub struct ManOptions {
    /// The folder; it is made if it is not there
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

#[derive(Debug, Args)]
pub struct ScenesOptions {
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct RunOptions {
    /// A built-in scene (see `bowknot scenes`), a scene file (.toml), or a mesh (.obj, .ply, .stl, .msh,
    /// .mesh, .ele, .vtu, .t, .seg), which falls on a ball: tetrahedra as a solid, else triangles as cloth,
    /// else edges as strands, else points as grains
    pub scene: String,
    /// Number of time steps [default: that of the scene]
    #[arg(long, value_name = "N")]
    pub frames: Option<usize>,
    /// Folder of the run [default: out/SCENE]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Time step [s; default: that of the scene]
    #[arg(long, value_name = "S", value_parser = positive)]
    pub dt: Option<f64>,
    /// Of a built-in scene: factor on the resolution, at the same size: 0.5 gives sheets half the edges along
    /// each side, a quarter of the vertices [default: 1]. Of a mesh: length of its unit [m; default: 1], 0.01
    /// for centimeters
    #[arg(long, value_name = "F", value_parser = positive)]
    pub scale: Option<f64>,
    /// Axis of a mesh that points up [default: z]
    #[arg(long, value_enum)]
    pub up: Option<Up>,
    #[command(flatten)]
    pub machine: Machine,
    /// Where the dynamics are computed [default: as --backend says; with --resume: as before]
    #[arg(long, value_enum)]
    pub dynamics_backend: Option<DynamicsBackend>,
    #[command(flatten)]
    pub method: Method,
    /// Formats of the frames, separated by commas [default: that of the scene, else ply]
    #[arg(long, value_name = "FORMATS", value_delimiter = ',')]
    pub format: Vec<Format>,
    /// Write each accepted state of each time step to trace/ in the folder of the run: `bowknot check` judges
    /// the paths between them
    #[arg(long)]
    pub trace: bool,
    /// Write the collision problem of each iteration to states/ in the folder of the run, for `bowknot
    /// resolve`
    #[arg(long)]
    pub record: bool,
    /// Check the path to every accepted state by a certificate, and the state at the end of each time step by
    /// exact tests: exit code 1 if anything intersects
    #[arg(long)]
    pub check: bool,
    /// If the start intersects, write the triangles that do to this file (.ply or .obj)
    #[arg(long, value_name = "FILE")]
    pub dump: Option<PathBuf>,
    /// If the run ends with an error, a panic, an intersection found by --check, or a target that was not
    /// reached, write the smallest state that shows it to this file (.npz), for `bowknot resolve` and
    /// `bowknot check`
    #[arg(long, value_name = "FILE.npz")]
    pub dump_on_failure: Option<PathBuf>,
    /// Continue the run in the folder --out from its checkpoint
    #[arg(long)]
    pub resume: bool,
    /// Print the summary as JSON to stdout and nothing else
    #[arg(long)]
    pub json: bool,
    /// Print errors only
    #[arg(long)]
    pub quiet: bool,
}

#[derive(Debug, Args)]
pub struct ResolveOptions {
    /// The problem: an NPZ archive, as `bowknot run --record` writes it; docs/formats.md lists its arrays
    pub states: PathBuf,
    /// File for the result: the array x of positions, free of intersections
    #[arg(long, value_name = "RESULT.npz")]
    pub out: PathBuf,
    #[command(flatten)]
    pub machine: Machine,
    #[command(flatten)]
    pub method: Method,
    /// Stop after this many seconds, with a valid state
    #[arg(long, value_name = "S", value_parser = positive)]
    pub max_seconds: Option<f64>,
    /// Check the path to every accepted state by a certificate: exit code 1 if anything intersects
    #[arg(long)]
    pub check: bool,
    /// If the start intersects, or the call is refused, panics, does not converge, or is found to intersect
    /// by --check, write the smallest part of the problem that shows it to this file (.npz)
    #[arg(long, value_name = "FILE.npz")]
    pub dump_on_failure: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct CheckOptions {
    /// Meshes, animations (.usda, .glb, .pc2, .pvd, .npz), recorded collision problems, folders of frames, or
    /// folders of runs; in a folder `trace` the path between successive files is checked too
    #[arg(required = true, value_name = "PATH")]
    pub paths: Vec<PathBuf>,
    /// Also check the straight paths between the frames of animations. What meets there is a hint and no
    /// failure, since the motion between frames is not known
    #[arg(long = "paths")]
    pub between_frames: bool,
    /// Take all PATHs as parts of one scene, frame by frame; those of one frame stand still
    #[arg(long)]
    pub together: bool,
    /// A part that is an obstacle: it may intersect itself and other obstacles. `*` in a name stands for
    /// anything; may be repeated
    #[arg(long, value_name = "PART")]
    pub obstacle: Vec<String>,
    /// A part that may intersect itself; may be repeated
    #[arg(long, value_name = "PART")]
    pub may_intersect: Vec<String>,
    /// A part that is not checked; may be repeated
    #[arg(long, value_name = "PART")]
    pub leave_out: Vec<String>,
    /// Also fail if two triangles, strands or grains that share no vertex are nearer than this [m; for other
    /// meshes in the unit of their files]
    #[arg(long, value_name = "D", value_parser = positive)]
    pub min_distance: Option<f64>,
    /// Axis of the files that points up, which matters for --picture only [default: z]
    #[arg(long, value_enum)]
    pub up: Option<Up>,
    /// Length of the unit of the files [m; default: 1], 0.01 for centimeters
    #[arg(long, value_name = "F", value_parser = positive)]
    pub scale: Option<f64>,
    /// Frames per second of files that have motion but no frames, as glTF [default: the times of their keys]
    #[arg(long, value_name = "RATE", value_parser = positive)]
    pub fps: Option<f64>,
    /// Print at most this many intersections of each state and path; all are counted
    #[arg(long, value_name = "N", default_value_t = 5)]
    pub list: usize,
    /// Write a table with a row per state and pair of parts
    #[arg(long, value_name = "FILE.csv")]
    pub table: Option<PathBuf>,
    /// Draw the first state that intersects, beside the elements that do
    #[cfg(feature = "render")]
    #[arg(long, value_name = "FILE.png")]
    pub picture: Option<PathBuf>,
    /// Write the triangles and strands that intersect to this file (.ply or .obj), for the first state where
    /// any do
    #[arg(long, value_name = "FILE")]
    pub dump: Option<PathBuf>,
    /// Write the fewest elements that intersect to this file (.npz), for the first state where any do
    #[arg(long, value_name = "FILE.npz")]
    pub dump_on_failure: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[cfg(feature = "render")]
#[derive(Debug, Args)]
pub struct RenderOptions {
    /// Folder of a run
    pub run: PathBuf,
    /// A picture (.png), an animation (.gif), or a folder for numbered pictures
    #[arg(long, value_name = "FILE.png|FILE.gif|DIR")]
    pub out: PathBuf,
    /// The frame to draw [default for a picture: the last]
    #[arg(long, value_name = "K", conflicts_with = "frames")]
    pub frame: Option<usize>,
    /// Frames to draw, both ends included; an omitted end is the first or last [default: all; for an
    /// animation as many as play at the speed of the simulation with at most 30 frames per second]
    #[arg(long, value_name = "A..B[:STEP]", value_parser = frames)]
    pub frames: Option<FrameRange>,
    /// Frames per second of an animation [default: the speed of the simulation]
    #[arg(long, value_name = "N", value_parser = positive)]
    pub fps: Option<f64>,
    /// Width and height [pixels; default: 960x720, for an animation 640x480]
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size: Option<[u32; 2]>,
    /// What colors show, with a legend [default: each body has a color of its own, without a legend]
    #[arg(long, value_enum)]
    pub color: Option<Color>,
    /// Ends of the color scale, in the unit of the legend [default: from the values in the frames]
    #[arg(long, value_name = "LOW..HIGH", value_parser = range, allow_hyphen_values = true)]
    pub range: Option<[f64; 2]>,
    /// Direction to look from; the camera is placed so that it sees all frames of the run
    #[arg(long, value_enum, default_value_t = Direction::ThreeQuarter, conflicts_with = "camera")]
    pub view: Direction,
    /// Position of the camera [m; default: as --view says]
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub camera: Option<[f64; 3]>,
    /// Point that the camera looks at [m; default: the middle of the run]
    #[arg(long, value_name = "X,Y,Z", value_parser = point, requires = "camera", allow_hyphen_values = true)]
    pub target: Option<[f64; 3]>,
    /// Vertical field of view [deg]
    #[arg(long, value_name = "DEG", value_parser = angle, default_value_t = 26.0)]
    pub fov: f64,
    /// Reduce a picture to 256 colors, which makes the file a third of the size
    #[arg(long)]
    pub indexed: bool,
    /// Print errors only
    #[arg(long)]
    pub quiet: bool,
}

/// The quantity that colors show.
#[cfg(feature = "render")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Color {
    /// Stretch of the most stretched edge at a vertex: its length over that in the first frame
    Stretch,
    /// Gap to the nearest other element: triangles, strands and grains that share no vertex
    Gap,
    /// Speed between frames
    Speed,
    /// Distance between where a vertex is and where elasticity and inertia pull it: of each vertex if the run
    /// was made with --record, else the largest of each time step
    Remaining,
    /// The body, by name
    Body,
}

#[cfg(feature = "render")]
impl Color {
    /// Whether the quantity is a number, so that the legend is a scale.
    pub fn is_number(self) -> bool {
        self != Self::Body
    }
}

/// The direction to look from.
#[cfg(feature = "render")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Direction {
    /// From -y
    Front,
    /// From +x
    Side,
    /// From above
    Top,
    /// From the left in front, and above
    ThreeQuarter,
}

/// Every `step`-th frame from `first` to `last`, both included.
#[cfg(feature = "render")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRange {
    pub first: usize,
    pub last: Option<usize>,
    pub step: usize,
}

#[derive(Debug, Args)]
pub struct RepairOptions {
    /// A mesh of triangles and strands, or of tetrahedra (.obj, .ply, .stl, .msh, .mesh, .ele, .vtu, .t)
    pub mesh: PathBuf,
    /// File for the repaired mesh (.obj, .ply; of tetrahedra .msh, .t)
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// Weld border vertices, or any of tetrahedra, nearer than this [unit of the mesh file; default: a
    /// hundredth of the mean length of border edges, a ten-thousandth of the mean edge of tetrahedra]
    #[arg(long, value_name = "D", value_parser = positive)]
    pub weld_distance: Option<f64>,
    /// Drop all lines, such as leftovers and those along which other programs sew
    #[arg(long)]
    pub drop_lines: bool,
    /// Drop all triangles of a mesh of tetrahedra
    #[arg(long)]
    pub drop_triangles: bool,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct ExportOptions {
    /// The folder of a run, a folder of frames (.ply, .obj), or an archive of frames (.npz)
    #[arg(value_name = "DIR")]
    pub source: PathBuf,
    /// Formats to write, separated by commas
    #[arg(long, value_name = "FORMATS", value_delimiter = ',', required = true)]
    pub format: Vec<Format>,
    /// Folder to write to [default: DIR]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Time between frames of DIR [s; default: that of the run, if DIR is the folder of a run]
    #[arg(long, value_name = "S", value_parser = positive)]
    pub dt: Option<f64>,
    /// Take every N-th frame from the first on, into another folder; they are numbered anew
    #[arg(long, value_name = "N", value_parser = stride, default_value_t = 1)]
    pub every: usize,
    /// Take so many frames per second, such as 24 of a run with time steps of 1/96 s
    #[arg(long, value_name = "F", value_parser = positive, conflicts_with = "every")]
    pub fps: Option<f64>,
}

#[derive(Debug, Args)]
pub struct ReportOptions {
    /// Folder of a run
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// File of the page [default: DIR/report.html]
    #[arg(long, value_name = "FILE.html")]
    pub out: Option<PathBuf>,
    /// Show every N-th frame and the last [default: as many frames as --max-megabytes allows]
    #[arg(long, value_name = "N", value_parser = stride)]
    pub stride: Option<usize>,
    /// Largest size of the page [MB; default: 30]
    #[arg(long, value_name = "MB", value_parser = positive)]
    pub max_megabytes: Option<f64>,
}

#[derive(Debug, Args)]
pub struct InfoOptions {
    /// A built-in scene, a scene file (.toml), or a mesh (.obj, .ply, .stl, .msh, .mesh, .ele, .vtu, .t,
    /// .seg)
    #[arg(required_unless_present = "gpus")]
    pub scene: Option<String>,
    /// Of a mesh: length of its unit [m; default: 1], 0.01 for centimeters
    #[arg(long, value_name = "F", value_parser = positive)]
    pub scale: Option<f64>,
    /// Axis of a mesh that points up [default: z]
    #[arg(long, value_enum)]
    pub up: Option<Up>,
    /// Print at most this many groups, parts, borders, odd edges and problems of a mesh; all are counted
    #[arg(long, value_name = "N", default_value_t = 5)]
    pub list: usize,
    /// List the GPUs of this machine, for --device
    #[arg(long, conflicts_with = "scene")]
    pub gpus: bool,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// Threads and backend.
#[derive(Debug, Args)]
pub struct Machine {
    /// Number of threads [default: all cores]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<usize>,
    /// Where a simulation is computed, and collisions are resolved [default: cpu; with --resume: as before]
    #[arg(long, value_enum)]
    pub backend: Option<Backend>,
    /// Which GPU: its number in `bowknot info --gpus` [default: the first that is usable]
    #[arg(long, value_name = "N")]
    pub device: Option<usize>,
}

/// How collisions are resolved.
#[derive(Debug, Args)]
pub struct Method {
    /// Set of defaults for the tables [contact] and [solver] of a scene [default: that of the scene, else
    /// fast]
    #[arg(long, value_enum)]
    pub preset: Option<Preset>,
    /// Set one key of the scene, as in a scene file: contact.delta=0.001; may be repeated;
    /// docs/scene-reference.md lists the keys
    #[arg(long = "set", value_name = "KEY.PATH=VALUE")]
    pub sets: Vec<String>,
}

impl Method {
    /// The options as assignments to keys of a scene. Those of `--set` come last and override the others.
    pub fn assignments(&self) -> Vec<String> {
        let preset = self.preset.map(|preset| match preset {
            Preset::Fast => "contact.preset=\"fast\"".to_owned(),
            Preset::Quick => "contact.preset=\"quick\"".to_owned(),
            Preset::Paper => "contact.preset=\"paper\"".to_owned(),
        });
        preset.into_iter().chain(self.sets.iter().cloned()).collect()
    }
}

/// The axis of a mesh file that points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Up {
    /// x becomes z, y becomes x, z becomes y
    X,
    /// As most modeling tools have it: y becomes z, z becomes -y
    Y,
    /// Nothing changes
    Z,
}

impl Up {
    /// The name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        }
    }
}

impl From<Up> for bowknot::io::Up {
    fn from(up: Up) -> Self {
        match up {
            Up::X => Self::X,
            Up::Y => Self::Y,
            Up::Z => Self::Z,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// The CPU
    Cpu,
    /// A GPU (docs/GPU.md says what it does not have)
    Gpu,
    /// The faster of both: `run` measures them in the first time steps with contacts, on copies of the scene,
    /// and says which it took and why; with --resume: as before. `resolve` takes the CPU
    Auto,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DynamicsBackend {
    /// The CPU
    Cpu,
    /// A GPU, in single precision
    Gpu,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Preset {
    /// The method with the improvements that measurements support
    Fast,
    /// For previews: `fast` with loose tolerances, and as safe
    Quick,
    /// The method as its paper describes it
    Paper,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Binary PLY, one file per frame
    Ply,
    /// Wavefront OBJ, one file per frame
    Obj,
    /// One NPZ archive of all frames
    Npz,
    /// Point caches, one per body, for Blender's Mesh Cache modifier and others
    Pc2,
    /// One USD stage of all frames, as text
    Usd,
    /// VTK XML, one file per frame, for ParaView
    Vtu,
    /// One binary glTF scene (.glb) of all frames, as morph targets
    Gltf,
}

impl Format {
    /// The name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ply => "ply",
            Self::Obj => "obj",
            Self::Npz => "npz",
            Self::Pc2 => "pc2",
            Self::Usd => "usd",
            Self::Vtu => "vtu",
            Self::Gltf => "gltf",
        }
    }

    /// The same format in the library.
    pub fn of_scene(self) -> bowknot::scene::Format {
        use bowknot::scene::Format;
        match self {
            Self::Ply => Format::Ply,
            Self::Obj => Format::Obj,
            Self::Npz => Format::Npz,
            Self::Pc2 => Format::Pc2,
            Self::Usd => Format::Usd,
            Self::Vtu => Format::Vtu,
            Self::Gltf => Format::Gltf,
        }
    }
}

/// A finite number above 0.
fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        Ok(_) => Err("must be finite and above 0".to_owned()),
        Err(_) => Err("must be a number".to_owned()),
    }
}

/// A whole number, at least 1.
fn stride(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(value) if value >= 1 => Ok(value),
        _ => Err("must be a whole number, at least 1".to_owned()),
    }
}

/// A number of threads.
fn threads(text: &str) -> Result<usize, String> {
    const MAX: usize = 4096;
    match text.parse::<usize>() {
        Ok(value) if (1..=MAX).contains(&value) => Ok(value),
        _ => Err(format!("must be a whole number from 1 to {MAX}")),
    }
}

/// A range of frames: `10..60`, `..60:5`, `10..`.
#[cfg(feature = "render")]
fn frames(text: &str) -> Result<FrameRange, String> {
    let malformed = || "must be A..B or A..B:STEP, whole numbers".to_owned();
    let (ends, step) = text.split_once(':').unwrap_or((text, "1"));
    let (first, last) = ends.split_once("..").ok_or_else(malformed)?;
    let number = |text: &str| text.parse::<usize>().map_err(|_| malformed());
    let first = if first.is_empty() { 0 } else { number(first)? };
    let last = if last.is_empty() { None } else { Some(number(last)?) };
    match number(step)? {
        0 => Err("its step must be at least 1".to_owned()),
        _ if last.is_some_and(|last| last < first) => Err("it ends before it begins".to_owned()),
        step => Ok(FrameRange { first, last, step }),
    }
}

#[cfg(feature = "render")]
fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse::<u32>().ok().filter(|side| (16..=16384).contains(side));
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some([side(w)?, side(h)?]));
    sides.ok_or_else(|| "must be WIDTHxHEIGHT, each from 16 to 16384".to_owned())
}

#[cfg(feature = "render")]
fn point(text: &str) -> Result<[f64; 3], String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|word| word.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y, z] if text.split(',').count() == 3 && [x, y, z].iter().all(|c| c.abs() < 1e9) => Ok([x, y, z]),
        _ => Err("must be three finite numbers separated by commas, X,Y,Z".to_owned()),
    }
}

#[cfg(feature = "render")]
fn range(text: &str) -> Result<[f64; 2], String> {
    let number = |text: &str| text.parse::<f64>().ok().filter(|value| value.is_finite());
    let ends = text.split_once("..").and_then(|(low, high)| Some([number(low)?, number(high)?]));
    match ends {
        Some([low, high]) if low < high => Ok([low, high]),
        Some(_) => Err("its low end must be below its high end".to_owned()),
        None => Err("must be LOW..HIGH, finite numbers".to_owned()),
    }
}

#[cfg(feature = "render")]
fn angle(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (1.0..=150.0).contains(&value) => Ok(value),
        _ => Err("must be a number of degrees from 1 to 150".to_owned()),
    }
}
