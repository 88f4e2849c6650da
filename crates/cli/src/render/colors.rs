//! The numbers that colors show at vertices, and the scale that all frames share.

use super::edges::edges_with_lengths;
use super::folder::RunFolder;
use super::gaps::Gaps;
use crate::args::{Color, RenderOptions};
use crate::exit::Failure;
use crate::progress::Bar;
use bowknot::StepStatistics;
use bowknot::geometry::Point;
use bowknot::io::{IoError, files_in};
use bowknot::recording::States;
use bowknot_errors::counted;
use bowknot_render::{Legend, Scale, body_color};
use std::fs;
use std::path::{Path, PathBuf};

/// Share of the values at either end that may lie beyond the scale, so that a few extreme edges do not take
/// the range of colors from all others.
const OUTLIERS: f64 = 0.002;

/// Colors of all frames that are drawn.
pub struct Coloring {
    legend: Option<Legend>,
    /// For each frame the position of each vertex on the scale, in [0, 1], or NaN for none; empty without a
    /// scale.
    shares: Vec<Vec<f32>>,
}

impl Coloring {
    /// Computes the numbers of all frames and a scale for them.
    pub fn new(
        options: &RenderOptions,
        run: &RunFolder,
        frames: &[usize],
        bar: &mut Bar,
    ) -> Result<Self, Failure> {
        let Some(color) = options.color.filter(|color| color.is_number()) else {
            bar.advance(frames.len());
            let legend = options.color.map(|_| Legend::Names(names(run)));
            return Ok(Self { legend, shares: Vec::new() });
        };
        let source = Source::new(color, run, options.range)?;
        let mut values: Vec<Vec<f64>> = Vec::with_capacity(frames.len());
        for &frame in frames {
            values.push(source.values(run, frame)?);
            bar.advance(1);
        }
        let (title, unit) = source.heading();
        let scale = match options.range {
            Some([low, high]) => Scale { title, unit, low, high, beyond: [false; 2] },
            None => {
                let [low, high] = ends(&values);
                Scale { title, unit, low, high, beyond: [false; 2] }.rounded()
            }
        };
        let any = |test: &dyn Fn(f64) -> bool| values.iter().flatten().any(|v| test(*v));
        let (low, high) = (scale.low, scale.high);
        let beyond = [any(&|v| v < low), any(&|v| v > high) || source.is_capped(high)];
        let scale = Scale { beyond, ..scale };
        let share = |v: &f64| if v.is_nan() { f32::NAN } else { scale.share(*v) as f32 };
        let shares = values.iter().map(|frame| frame.iter().map(share).collect()).collect();
        Ok(Self { legend: Some(Legend::Scale(scale)), shares })
    }

    /// The legend, if colors show something.
    pub fn legend(&self) -> Option<&Legend> {
        self.legend.as_ref()
    }

    /// Positions on the scale in frame `index` of those that are drawn.
    pub fn shares(&self, index: usize) -> &[f32] {
        self.shares.get(index).map_or(&[], Vec::as_slice)
    }
}

/// Names and colors of the deformable bodies, and of the obstacles together.
fn names(run: &RunFolder) -> Vec<(String, [u8; 3])> {
    let bodies = run.scene().bodies.iter().enumerate();
    let mut names: Vec<_> = bodies.map(|(k, body)| (body.name.clone(), body_color(k as u32))).collect();
    if (0..run.elements().positions.len()).any(|v| run.is_obstacle(v)) {
        names.push(("obstacles".to_owned(), bowknot_render::OBSTACLE_COLOR));
    }
    names
}

/// The smallest and the largest value, except for the outliers at either end.
fn ends(values: &[Vec<f64>]) -> [f64; 2] {
    let mut all: Vec<f64> = values.iter().flatten().copied().filter(|v| !v.is_nan()).collect();
    if all.is_empty() {
        return [0.0, 1.0];
    }
    all.sort_by(f64::total_cmp);
    let few = (OUTLIERS * all.len() as f64) as usize;
    [all[few], all[all.len() - 1 - few]]
}

/// The source of the numbers.
enum Source {
    Stretch {
        edges: Vec<([u32; 2], f64)>,
    },
    Gap(Box<Gaps>),
    Speed,
    /// Distances to recorded targets: a file for each time step and Newton iteration.
    RemainingOfVertices {
        files: Vec<(usize, PathBuf)>,
    },
    /// The largest distance to the target in each time step, from step 1 on [m].
    RemainingOfSteps(Vec<f64>),
}

impl Source {
    fn new(color: Color, run: &RunFolder, range: Option<[f64; 2]>) -> Result<Self, Failure> {
        Ok(match color {
            Color::Stretch => Self::Stretch { edges: edges_with_lengths(run.elements()) },
            Color::Gap => Self::Gap(Box::new(Gaps::new(run, range.map(|[_, high]| high * 1e-3))?)),
            Color::Speed | Color::Body => Self::Speed,
            Color::Remaining => {
                let files = recorded(run)?;
                if files.is_empty() {
                    Self::RemainingOfSteps(remaining_of_steps(run)?)
                } else {
                    Self::RemainingOfVertices { files }
                }
            }
        })
    }

    /// The quantity and the unit for the legend.
    fn heading(&self) -> (String, String) {
        let (title, unit) = match self {
            Self::Stretch { .. } => ("stretch", ""),
            Self::Gap(_) => ("gap", "mm"),
            Self::Speed => ("speed", "m/s"),
            Self::RemainingOfVertices { .. } => ("remaining", "mm"),
            Self::RemainingOfSteps(_) => ("largest remaining", "mm"),
        };
        (title.to_owned(), unit.to_owned())
    }

    /// Whether values above this are all shown as the same, because the source measures no larger ones.
    fn is_capped(&self, high: f64) -> bool {
        matches!(self, Self::Gap(gaps) if high * 1e-3 >= gaps.cap() * (1.0 - 1e-9))
    }

    /// A number per vertex, in the unit of the legend; NaN for obstacles.
    fn values(&self, run: &RunFolder, frame: usize) -> Result<Vec<f64>, Failure> {
        let (positions, ground) = run.frame(frame)?;
        let n = positions.len();
        let mut values = match self {
            Self::Stretch { edges } => {
                let mut largest = vec![0.0_f64; n];
                for &([i, j], rest) in edges {
                    let ratio = (positions[i as usize] - positions[j as usize]).norm() / rest;
                    for v in [i, j] {
                        largest[v as usize] = largest[v as usize].max(ratio);
                    }
                }
                // Grains have no edges.
                largest.iter().map(|&ratio| if ratio > 0.0 { ratio } else { f64::NAN }).collect()
            }
            Self::Gap(gaps) => {
                let absent = run.elements().absent(&positions);
                gaps.measure(&positions, &ground, &absent).into_iter().map(|gap| 1e3 * gap).collect()
            }
            Self::Speed => {
                // The first frame has no frame before it: it shows the speed to the next one.
                let (before, after) =
                    if frame == 0 { (0, run.last_frame().min(1)) } else { (frame - 1, frame) };
                let (a, b) = (run.positions(before)?, run.positions(after)?);
                a.iter().zip(&b).map(|(p, q)| (q - p).norm() / run.time_step()).collect()
            }
            Self::RemainingOfVertices { files } => match files.iter().rfind(|(step, _)| *step == frame) {
                Some((_, file)) => remaining_of_vertices(&States::read(file)?, &positions, file)?,
                // The first frame has no target.
                None => vec![0.0; n],
            },
            Self::RemainingOfSteps(steps) => {
                let of_step = frame.checked_sub(1).and_then(|step| steps.get(step));
                vec![of_step.map_or(0.0, |meters| 1e3 * meters); n]
            }
        };
        for (v, value) in values.iter_mut().enumerate() {
            if run.is_obstacle(v) {
                *value = f64::NAN;
            }
        }
        Ok(values)
    }
}

/// The files in `states/` with the numbers of their time steps, in order.
fn recorded(run: &RunFolder) -> Result<Vec<(usize, PathBuf)>, Failure> {
    let folder = run.file("states");
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let step = |file: &PathBuf| file.file_stem()?.to_str()?.split('_').next()?.parse().ok();
    let files = files_in(&folder, &["npz"])?;
    Ok(files.into_iter().filter_map(|file| Some((step(&file)?, file))).collect())
}

/// Distance from each vertex to its target in the last collision problem of the time step [mm].
fn remaining_of_vertices(states: &States, x: &[Point], file: &Path) -> Result<Vec<f64>, Failure> {
    if states.y.len() != x.len() {
        let (file, expected) = (file.display(), x.len());
        let given = counted(states.y.len(), "vertex", "vertices");
        return Err(Failure::input(format!("{file} has {given}, but the frames have {expected}")));
    }
    Ok(x.iter().zip(&states.y).map(|(p, y)| 1e3 * (y - p).norm()).collect())
}

/// `remaining_m` of each time step.
fn remaining_of_steps(run: &RunFolder) -> Result<Vec<f64>, Failure> {
    let path = run.file("stats.jsonl");
    let text = fs::read_to_string(&path).map_err(|source| IoError::system("read", &path, source))?;
    let mut steps = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let statistics: StepStatistics = serde_json::from_str(line)
            .map_err(|error| Failure::input(format!("{}: line {}: {error}", path.display(), index + 1)))?;
        steps.push(statistics.remaining_m);
    }
    Ok(steps)
}
