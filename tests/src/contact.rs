//! Scenes with a known motion: bodies that slide on grounds of different tessellations. Gravity is tilted
//! instead of the ground.
//!
//! The surface of a ground is the plane z = 0, wide enough for a second of sliding. A body starts at the
//! origin, at the contact distance above the ground, so that it neither falls nor is lifted.

use crate::Random;
use bowknot::dynamics::NewtonBackend;
use bowknot::geometry::{Point, Vector};
use bowknot::io::{MeshView, write_obj};
use bowknot::simulator::{CollisionBackend, Cpu};
use bowknot::{Scene, Simulator};
use std::ops::Range;
use std::path::Path;

/// Acceleration of gravity [m/s^2].
pub const GRAVITY: f64 = 9.81;

/// Contact distance of all these scenes [m].
pub const DELTA: f64 = 1e-3;

/// The ground below a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ground {
    /// An analytic half-space.
    HalfSpace,
    /// The mesh of a box with edges of 3 cm.
    Box,
    /// The mesh of a box with edges of 25 cm.
    CoarseBox,
    /// A mesh of triangles of 6 to 12 mm, irregular.
    Irregular,
    /// A mesh of triangles of 3 by 60 mm.
    Slivers,
    /// Two boxes side by side, flush, with the seam across the way, 5 cm ahead.
    Flush,
    /// One plane whose mesh has edges of 3 cm before a seam, 5 cm ahead, and of 7 mm behind it.
    Seam,
    /// A block of jelly, held at its lower side.
    Slab,
}

/// The body that slides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slider {
    /// A cube of 8 cm, E = 100 kPa.
    JellyCube,
    /// A cube of 8 cm, E = 10 MPa.
    StiffCube,
    /// A patch of cotton of 10 cm with edges of 1 cm.
    Patch,
    /// Three such patches on each other.
    Layers,
    /// Nine straws of 10 cm, side by side.
    Strands,
    /// Sixteen separate grains of gravel.
    Grains,
}

impl Slider {
    /// All bodies.
    pub const ALL: [Self; 6] =
        [Self::JellyCube, Self::StiffCube, Self::Patch, Self::Layers, Self::Strands, Self::Grains];

    fn bodies(self, velocity: Vector) -> String {
        let common =
            format!("friction = 1\nvelocity = [{:?}, {:?}, {:?}]\n", velocity.x, velocity.y, velocity.z);
        let cube = |modulus: f64| {
            format!(
                "[[body]]\nname = \"cube\"\nkind = \"solid\"\n{common}\
                 material = {{ base = \"jelly\", young_modulus = {modulus:?}, density = 1000 }}\n\
                 shape = {{ type = \"block\", size = [0.08, 0.08, 0.08], edge = 0.02 }}\n\
                 translate = [0, 0, {}]\n",
                0.04 + DELTA
            )
        };
        let patch = |index: usize| {
            format!(
                "[[body]]\nname = \"patch-{index}\"\n{common}\
                 shape = {{ type = \"sheet\", size = [0.1, 0.1], edge = 0.01 }}\n\
                 translate = [0, 0, {}]\n",
                (index + 1) as f64 * DELTA
            )
        };
        match self {
            Self::JellyCube => cube(1e5),
            Self::StiffCube => cube(1e7),
            Self::Patch => patch(0),
            Self::Layers => (0..3).map(patch).collect(),
            Self::Strands => format!(
                "[[body]]\nname = \"straws\"\nkind = \"strands\"\nmaterial = \"straw\"\n{common}\
                 shape = {{ type = \"strands\", count = 9, length = 0.1, segments = 10, spacing = 0.012 }}\n\
                 rotate = [0, 90, 0]\ntranslate = [0, 0, {}]\n",
                0.012 + DELTA
            ),
            Self::Grains => format!(
                "[[body]]\nname = \"grains\"\nkind = \"particles\"\nmaterial = \"gravel\"\n{common}\
                 delta = {DELTA}\n\
                 shape = {{ type = \"grains\", count = [4, 4, 1], spacing = 0.0203, jitter = 0.0 }}\n\
                 translate = [0, 0, {DELTA}]\n",
            ),
        }
    }
}

impl Ground {
    /// All grounds on which a body slides as on one plane.
    pub const ALL: [Self; 8] = [
        Self::HalfSpace,
        Self::Box,
        Self::CoarseBox,
        Self::Irregular,
        Self::Slivers,
        Self::Flush,
        Self::Seam,
        Self::Slab,
    ];

    fn obstacles(self, folder: &Path) -> String {
        let of_box = |name: &str, x: [f64; 2], edge: f64| {
            format!(
                "[[obstacle]]\nname = \"{name}\"\nfriction = 1\n\
                 shape = {{ type = \"box\", size = [{:?}, 0.6, 0.05], edge = {edge:?} }}\n\
                 translate = [{:?}, 0, -0.025]\n",
                x[1] - x[0],
                0.5 * (x[0] + x[1])
            )
        };
        let of_mesh = |positions: &[Point], triangles: &[[u32; 3]]| {
            let view = MeshView { positions, triangles, ..MeshView::default() };
            write_obj(&folder.join("ground.obj"), &view).expect("a mesh of the ground");
            "[[obstacle]]\nname = \"ground\"\nfriction = 1\nmesh = \"ground.obj\"\n".to_owned()
        };
        match self {
            Self::HalfSpace => {
                "[[obstacle]]\nname = \"ground\"\nshape = \"half-space\"\nfriction = 1\n".to_owned()
            }
            Self::Box => of_box("ground", [-0.2, 1.3], 0.03),
            Self::CoarseBox => of_box("ground", [-0.2, 1.3], 0.25),
            Self::Flush => of_box("near", [-0.2, 0.09], 0.03) + &of_box("far", [0.09, 1.3], 0.05),
            Self::Irregular => {
                let (positions, triangles) = grid([-0.2, 0.8], [-0.2, 0.2], [0.009, 0.009], 0.3);
                of_mesh(&positions, &triangles)
            }
            Self::Slivers => {
                let (positions, triangles) = grid([-0.2, 1.0], [-0.2, 0.2], [0.06, 0.003], 0.0);
                of_mesh(&positions, &triangles)
            }
            Self::Seam => {
                let (mut positions, mut triangles) = grid([-0.2, 0.1], [-0.2, 0.2], [0.03, 0.03], 0.0);
                let (behind, more) = grid([0.1, 0.5], [-0.2, 0.2], [0.007, 0.007], 0.0);
                let first = positions.len() as u32;
                positions.extend(behind);
                triangles.extend(more.iter().map(|t| t.map(|v| v + first)));
                of_mesh(&positions, &triangles)
            }
            Self::Slab => "[[body]]\nname = \"slab\"\nkind = \"solid\"\nfriction = 1\n\
                 gravity = [0, 0, 0]\n\
                 material = { base = \"jelly\", young_modulus = 3e5, density = 1000 }\n\
                 shape = { type = \"block\", size = [0.6, 0.2, 0.04], edge = 0.02 }\n\
                 translate = [0.2, 0, -0.02]\n[[pin]]\nbody = \"slab\"\nside = \"z-min\"\n"
                .to_owned(),
        }
    }
}

/// A grid of triangles in the plane z = 0 over `x` by `y`, with cells of about `size`. Inner vertices are
/// moved by up to `jitter` of a cell. With jitter, diagonals have random directions.
fn grid(x: [f64; 2], y: [f64; 2], size: [f64; 2], jitter: f64) -> (Vec<Point>, Vec<[u32; 3]>) {
    let mut random = Random::new(1);
    let count = |range: [f64; 2], size: f64| ((range[1] - range[0]) / size).round() as usize;
    let (nx, ny) = (count(x, size[0]), count(y, size[1]));
    let mut positions = Vec::new();
    for i in 0..=nx {
        for j in 0..=ny {
            let inside = i > 0 && i < nx && j > 0 && j < ny;
            let mut place = |k: usize, n: usize, range: [f64; 2]| {
                let shift = if inside && jitter > 0.0 { random.between(-jitter, jitter) } else { 0.0 };
                range[0] + (range[1] - range[0]) * (k as f64 + shift) / n as f64
            };
            positions.push(Point::new(place(i, nx, x), place(j, ny, y), 0.0));
        }
    }
    let mut triangles = Vec::new();
    for i in 0..nx {
        for j in 0..ny {
            let corner = |di: usize, dj: usize| ((i + di) * (ny + 1) + j + dj) as u32;
            let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            if jitter > 0.0 && random.below(2) == 0 {
                triangles.extend([[a, b, d], [b, c, d]]);
            } else {
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    (positions, triangles)
}

/// A body on a ground.
#[derive(Clone, Debug)]
pub struct Slope {
    /// The body that slides.
    pub slider: Slider,
    /// The ground.
    pub ground: Ground,
    /// Angle of the slope [deg].
    pub degrees: f64,
    /// Downhill direction in the plane, from the x axis [deg].
    pub heading: f64,
    /// Coefficient of friction [1].
    pub friction: f64,
    /// Time step [s].
    pub dt: f64,
    /// Speed at the start, along the heading [m/s].
    pub speed: f64,
    /// More settings, as for `--set`.
    pub settings: Vec<String>,
}

impl Slope {
    /// A slope of 20 degrees along the x axis, from rest, in steps of 1/100 s.
    pub fn new(slider: Slider, ground: Ground, friction: f64) -> Self {
        Self {
            slider,
            ground,
            degrees: 20.0,
            heading: 0.0,
            friction,
            dt: 0.01,
            speed: 0.0,
            settings: Vec::new(),
        }
    }

    /// Acceleration down the slope by Coulomb's law, for a body that starts from rest or slides down [m/s^2].
    pub fn acceleration(&self) -> f64 {
        let (sine, cosine) = self.degrees.to_radians().sin_cos();
        GRAVITY * (sine - self.friction * cosine).max(0.0)
    }

    /// The scene. Meshes of the ground are written to `folder`.
    pub fn scene(&self, folder: &Path) -> Scene {
        let (sine, cosine) = self.degrees.to_radians().sin_cos();
        let heading = self.heading.to_radians();
        let along = Vector::new(heading.cos(), heading.sin(), 0.0);
        let gravity = GRAVITY * (sine * along - cosine * Vector::z());
        let text = format!(
            "[simulation]\ndt = {:?}\ngravity = [{:?}, {:?}, {:?}]\n[solver.sleep]\nenabled = \
             false\n[contact]\ndelta = {DELTA}\n{}{}",
            self.dt,
            gravity.x,
            gravity.y,
            gravity.z,
            self.slider.bodies(along * self.speed),
            self.ground.obstacles(folder),
        );
        let friction = format!("friction = {:?}\n", self.friction);
        let scene = Scene::from_toml(&text.replace("friction = 1\n", &friction), folder)
            .unwrap_or_else(|error| panic!("{error}"));
        scene.with_sets(&self.settings).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Follows the slider for `steps` time steps.
    pub fn run(&self, steps: usize) -> Track {
        self.run_on(Box::new(Cpu), None, steps)
    }

    /// The same with a backend for the collisions, and one for the dynamics or none.
    pub fn run_on(
        &self,
        collisions: Box<dyn CollisionBackend>,
        dynamics: Option<Box<dyn NewtonBackend>>,
        steps: usize,
    ) -> Track {
        let folder = tempfile::tempdir().expect("a folder");
        let mut simulator =
            Simulator::new(&self.scene(folder.path())).unwrap_or_else(|error| panic!("{error}"));
        simulator.set_backend(collisions).unwrap_or_else(|error| panic!("{error}"));
        simulator.set_dynamics_backend(dynamics).unwrap_or_else(|error| panic!("{error}"));
        let heading = self.heading.to_radians();
        let along = Vector::new(heading.cos(), heading.sin(), 0.0);
        let mut track = Track {
            along,
            dt: self.dt,
            places: vec![center(&simulator)],
            velocities: vec![along * self.speed],
            cpu_seconds: 0.0,
            two_way_steps: 0,
        };
        for _ in 0..steps {
            let statistics = simulator.step().unwrap_or_else(|error| panic!("{error}"));
            track.places.push(center(&simulator));
            track.velocities.push(velocity(&simulator));
            track.cpu_seconds += statistics.cpu_seconds;
            track.two_way_steps += statistics.two_way_steps;
        }
        track
    }
}

/// Center of mass of a slider at the start and after each time step.
#[derive(Clone, Debug)]
pub struct Track {
    /// Unit vector down the slope.
    pub along: Vector,
    /// Time step [s].
    pub dt: f64,
    /// Center of mass [m].
    pub places: Vec<Point>,
    /// Its velocity [m/s].
    pub velocities: Vec<Vector>,
    /// CPU seconds of all steps.
    pub cpu_seconds: f64,
    /// Two-way steps of all steps.
    pub two_way_steps: usize,
}

impl Track {
    /// Mean speed along the slope over the time steps of `range` [m/s].
    pub fn speed(&self, range: Range<usize>) -> f64 {
        let count = range.len() as f64;
        self.velocities[range].iter().map(|v| v.dot(&self.along)).sum::<f64>() / count
    }

    /// Mean acceleration along the slope between the speeds at two time steps [m/s^2].
    pub fn acceleration(&self, from: usize, to: usize) -> f64 {
        (self.velocities[to] - self.velocities[from]).dot(&self.along) / ((to - from) as f64 * self.dt)
    }

    /// Displacement along the slope and across it, in its plane [m].
    pub fn way(&self) -> [f64; 2] {
        let way = self.places[self.places.len() - 1] - self.places[0];
        let across = Vector::z().cross(&self.along);
        [way.dot(&self.along), way.dot(&across)]
    }
}

/// Vertices of all bodies but the slab.
fn sliding(simulator: &Simulator) -> impl Iterator<Item = usize> + '_ {
    let bodies = simulator.world().bodies.iter();
    bodies.filter(|body| body.kind.is_some() && body.name != "slab").flat_map(|body| {
        let vertices = body.vertices.clone().chain(body.interior.clone());
        vertices.map(|v| v as usize)
    })
}

/// Center of mass of the slider [m].
pub fn center(simulator: &Simulator) -> Point {
    let masses = simulator.dynamics_model().masses();
    let (mut sum, mut total) = (Vector::zeros(), 0.0);
    for v in sliding(simulator) {
        sum += simulator.positions()[v].coords * masses[v];
        total += masses[v];
    }
    Point::from(sum / total)
}

/// Velocity of the slider's center of mass [m/s].
pub fn velocity(simulator: &Simulator) -> Vector {
    let masses = simulator.dynamics_model().masses();
    let (mut sum, mut total) = (Vector::zeros(), 0.0);
    for v in sliding(simulator) {
        sum += simulator.velocities()[v] * masses[v];
        total += masses[v];
    }
    sum / total
}
