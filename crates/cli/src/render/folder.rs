//! What pictures need from the folder of a run.

use super::edges::mean_edge;
use crate::exit::Failure;
use bowknot::geometry::{HalfSpace, Point};
use bowknot::io::{Import, Mesh, read_mesh};
use bowknot::scene::{Material, Scene};
use bowknot::shapes::Shape;
use bowknot_errors::counted;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Contact distance where a scene gives none, relative to the mean edge length, as in the simulation.
const DELTA: f64 = 0.1;
/// Smallest radius of strands and grains, relative to the size of the scene: thinner ones could not be seen.
const MIN_RADIUS: f64 = 5e-4;
/// Number of grains whose nearest neighbors are measured to estimate their size, if the scene does not give
/// it.
const SAMPLED_GRAINS: usize = 500;

/// The folder of a run.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    scene: Scene,
    /// Files of the frames by number.
    frames: BTreeMap<usize, PathBuf>,
    /// Elements and positions of the first frame, without the squares that represent half-spaces.
    elements: Mesh,
    /// Half-spaces, for each of which a frame has a square.
    squares: usize,
    radius: f64,
}

impl RunFolder {
    /// Opens a folder and reads what is the same for all frames.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        let bad_input = |message: String| Failure::input(format!("{}: {message}", path.display()));
        let scene_file = path.join("scene.toml");
        if !path.is_dir() || !scene_file.is_file() {
            let what = if path.exists() { "it holds no scene.toml" } else { "there is no such folder" };
            return Err(bad_input(format!("not the folder of a run: {what}; `bowknot run SCENE` makes one")));
        }
        let scene = Scene::load(&scene_file, &[] as &[&str]).map_err(Failure::input)?;
        let frames = frames(&path.join("frames"))?;
        let Some((_, first)) = frames.first_key_value() else {
            return Err(bad_input("it has no frames/*.ply: run with --format ply".to_owned()));
        };
        let mut elements = read_mesh(first, &Import::default())?;

        let squares = scene.obstacles.iter().filter(|o| matches!(o.shape, Some(Shape::HalfSpace(_)))).count();
        let vertices = elements.positions.len();
        let Some(kept) = vertices.checked_sub(4 * squares) else {
            return Err(bad_input(format!(
                "{} has {}, too few for its scene",
                first.display(),
                counted(vertices, "vertex", "vertices")
            )));
        };
        elements.positions.truncate(kept);
        elements.surface = None;
        elements.triangles.retain(|t| t.iter().all(|&v| (v as usize) < kept));
        elements.particles.retain(|&v| (v as usize) < kept);
        elements.strands.retain(|e| e.iter().all(|&v| (v as usize) < kept));
        if let Some(obstacle) = &mut elements.obstacle {
            obstacle.truncate(kept);
        }
        if let Some(body) = &mut elements.body {
            body.truncate(kept);
        }
        let radius = radius(&scene, &elements);
        Ok(Self { path: path.to_owned(), scene, frames, elements, squares, radius })
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// A file of the run.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Elements and positions of the first frame, without the squares that represent half-spaces.
    pub fn elements(&self) -> &Mesh {
        &self.elements
    }

    /// Whether a vertex belongs to an obstacle.
    pub fn is_obstacle(&self, vertex: usize) -> bool {
        self.elements.obstacle.as_ref().is_some_and(|o| o[vertex])
    }

    /// Radius of strands and grains [m]; 0 if there are none.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Time between frames [s].
    pub fn time_step(&self) -> f64 {
        self.scene.simulation.dt
    }

    /// Numbers of the frames, ascending.
    pub fn frames(&self) -> impl Iterator<Item = usize> {
        self.frames.keys().copied()
    }

    /// Number of the last frame.
    pub fn last_frame(&self) -> usize {
        self.frames.last_key_value().map_or(0, |(number, _)| *number)
    }

    /// Refuses a frame that does not exist.
    pub fn check_frame(&self, frame: usize) -> Result<(), Failure> {
        if self.frames.contains_key(&frame) {
            return Ok(());
        }
        let (path, last) = (self.path.display(), self.last_frame());
        Err(Failure::input(format!("{path} has no frame {frame}: its frames are numbered from 0 to {last}")))
    }

    /// Positions of a frame [m], without the squares that represent half-spaces.
    pub fn positions(&self, frame: usize) -> Result<Vec<Point>, Failure> {
        Ok(self.frame(frame)?.0)
    }

    /// Positions of a frame [m], and the half-spaces that are there.
    pub fn frame(&self, frame: usize) -> Result<(Vec<Point>, Vec<HalfSpace>), Failure> {
        self.check_frame(frame)?;
        let file = &self.frames[&frame];
        let mut positions = read_mesh(file, &Import::default())?.positions;
        let kept = self.elements.positions.len();
        if positions.len() != kept + 4 * self.squares {
            let (file, expected) = (file.display(), kept + 4 * self.squares);
            let given = counted(positions.len(), "vertex", "vertices");
            return Err(Failure::input(format!(
                "{file} has {given}, but other frames of the run have {expected}"
            )));
        }
        let ground = positions[kept..].as_chunks::<4>().0.iter().filter_map(plane).collect();
        positions.truncate(kept);
        Ok((positions, ground))
    }
}

/// The frames of a folder by their numbers.
fn frames(folder: &Path) -> Result<BTreeMap<usize, PathBuf>, Failure> {
    let unreadable = |error| Failure::input(format!("cannot read {}: {error}", folder.display()));
    let mut frames = BTreeMap::new();
    if !folder.is_dir() {
        return Ok(frames);
    }
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        let number = path.file_stem().and_then(|stem| stem.to_str()).and_then(|stem| stem.parse().ok());
        if let (Some(number), Some("ply")) = (number, path.extension().and_then(|e| e.to_str())) {
            frames.insert(number, path);
        }
    }
    Ok(frames)
}

/// The half-space of a square with counter-clockwise corners, seen from outside; none if it has no area,
/// since the half-space is not there.
fn plane(corners: &[Point; 4]) -> Option<HalfSpace> {
    HalfSpace::new(corners[0], (corners[1] - corners[0]).cross(&(corners[3] - corners[0])))
}

/// Radius for strands and grains [m]: the smallest in the materials, or half the contact distance. With it
/// they touch in the picture when they are in contact.
fn radius(scene: &Scene, mesh: &Mesh) -> f64 {
    if mesh.strands.is_empty() && mesh.particles.is_empty() {
        return 0.0;
    }
    let positions = &mesh.positions;
    let own = scene.bodies.iter().filter_map(|body| match body.material {
        Material::Particles(grain) => Some(body.delta.unwrap_or(2.0 * grain.radius)),
        Material::Strands(strand) => Some(2.0 * strand.radius),
        _ => None,
    });
    let given = own.min_by(f64::total_cmp).or(scene.contact.delta);
    let of_edges = || mean_edge(mesh).map(|length| DELTA * length);
    let delta = given.or_else(of_edges).unwrap_or_else(|| spacing(mesh));
    let (low, high) = positions.iter().fold((positions[0], positions[0]), |(l, h), p| (l.inf(p), h.sup(p)));
    (delta / 2.0).max(MIN_RADIUS * (high - low).norm())
}

/// Median distance from grains to their nearest neighbors [m].
fn spacing(mesh: &Mesh) -> f64 {
    let grains: Vec<Point> = mesh.particles.iter().map(|&v| mesh.positions[v as usize]).collect();
    let step = (grains.len() / SAMPLED_GRAINS).max(1);
    let mut nearest: Vec<f64> = (0..grains.len())
        .step_by(step)
        .map(|k| {
            let others = grains.iter().enumerate().filter(|(other, _)| *other != k);
            others.map(|(_, p)| (p - grains[k]).norm()).fold(f64::INFINITY, f64::min)
        })
        .filter(|distance| distance.is_finite())
        .collect();
    nearest.sort_by(f64::total_cmp);
    nearest.get(nearest.len() / 2).copied().unwrap_or(0.0)
}
