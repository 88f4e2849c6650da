//! Every scene as a film, and what it costs: the runs and films of docs/gallery.md.

use crate::bench::{Bench, Size};
use crate::figure::{Figure, Part, Report};
use crate::pages;
use crate::table::Table;
use anyhow::{Context, Result, bail, ensure};
use bowknot::Scene;
use bowknot::run::{self, RunOptions};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

pub struct Gallery;

/// A scene and how its film is drawn.
struct Film {
    /// Of the film's file.
    name: &'static str,
    /// What `bowknot run` is given: the scene and its scale.
    run: &'static str,
    /// Options of `bowknot render`.
    camera: &'static str,
}

/// All built-in scenes and all scene files of their own.
const FILMS: &[Film] = &[
    film("drape", "drape", ""),
    film("needle", "needle --scale 0.5", ""),
    film("stack", "stack --scale 0.5", ""),
    film("sphere", "sphere --scale 0.3", ""),
    film("tube", "tube --scale 0.4", ""),
    film("dress", "dress --scale 0.3", "--camera 5.0,2.9,1.3 --target 0.7,0.03,0.83 --fov 22"),
    film("gown", "gown --scale 0.3", "--camera 4.9,2.7,1.3 --target 0.55,-0.09,0.83 --fov 22"),
    film("blade", "blade --scale 0.2", ""),
    film("funnel", "funnel --scale 0.2", "--camera 1.7,-1.7,1.7 --target 0,0,0.95 --fov 40"),
    film("bow-knot", "bow-knot --scale 0.25", "--camera 0.4,-1.7,0.6 --target 0,0,0 --fov 44"),
    film("reef-knot", "reef-knot --scale 0.25", "--camera 0.15,-0.8,0.45 --target 0,0,0 --fov 35"),
    film("mat", "mat --scale 0.25", ""),
    film("hair", "hair --scale 0.15", ""),
    film("sand", "sand --scale 0.3", ""),
    film("trampoline", "trampoline", ""),
    film("cards", "cards", ""),
    film("woven", "woven", "--camera 0.5,-0.5,0.25 --target 0,0,0"),
    film("seams", "assets/scenes/seams.toml", "--camera 3,1.2,1.1 --target 0,0,0.6"),
    film("fingers", "assets/scenes/fingers.toml", "--camera 0.6,1.25,1.15 --target 0,0.48,0.52 --fov 18"),
    film("soft-solid", "assets/scenes/soft-solid.toml", "--camera 0.5,-1.1,0.5 --target 0,0,0.07"),
    film("wind", "assets/scenes/wind.toml", ""),
    film("pins", "assets/scenes/pins.toml", "--camera=-0.4,-0.9,1.6 --target 0.15,0,0.4"),
    film("curls", "assets/scenes/curls.toml", "--camera=0.0,-0.85,0.38 --target=0.0,0.0,0.36 --fov 27"),
];

const fn film(name: &'static str, run: &'static str, camera: &'static str) -> Film {
    Film { name, run, camera }
}

/// Sizes [pixels] that are tried in turn until a film is small enough, and the largest size of a file [bytes].
const SIZES: [&str; 4] = ["400x300", "320x240", "280x210", "240x180"];
const MAX_BYTES: u64 = 600_000;
/// Largest number of frames of films of runs with more than four times as many time steps, and of films that would be far
/// too large. Others have as many as `bowknot render` chooses, 30 per second at most.
const MAX_FRAMES: usize = 60;

/// What a run reports.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Cost {
    vertices: usize,
    frames: usize,
    cpu_seconds: f64,
    /// Two-way steps per time step: mean and largest.
    two_way_steps: [f64; 2],
    /// Largest over the time steps [1].
    max_stretch: f64,
    /// Smallest over the time steps [m].
    min_gap: f64,
    /// Number of time steps.
    unsolved: usize,
    intersections: usize,
}

impl Figure for Gallery {
    fn name(&self) -> &'static str {
        "gallery"
    }

    fn title(&self) -> &'static str {
        "What each run costs"
    }

    fn question(&self) -> &'static str {
        "Each run as its command makes it, on one thread. The judge looks at every state and at the path to it \
         (`--check`), and takes 15 to 23 % of the CPU time of `needle` besides.\n\n\
         *CPU s*: of all time steps with the judge, without writing frames; *per time step*: mean. *Two-way \
         steps*: per time step, mean and largest, over all Newton iterations. *Stretch*: largest ratio of an edge \
         of cloth or of a strand to its rest length, 0 without. *Gap*: smallest distance of two elements that \
         share no vertex. *Unsolved*: time steps that ended above the tolerance of the residual."
    }

    fn page(&self) -> &'static str {
        pages::GALLERY
    }

    fn on_page(&self) -> bool {
        true
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let mut table = Table::new([
            "command",
            "vertices",
            "time steps",
            "CPU s",
            "per time step",
            "two-way steps",
            "most",
            "stretch",
            "gap, mm",
            "unsolved",
        ]);
        let count = bench.size.pick(FILMS.len(), 3, 1);
        let (mut states, mut seconds, mut intersections) = (0, 0.0, 0);
        let films = FILMS.iter().filter(|film| bench.wants(film.name)).take(count);
        for film in films {
            if !bench.has_time() {
                break;
            }
            let folder = bench.out().join("gallery").join(film.name);
            let cost =
                bench.store.measured(&format!("gallery/{}", film.name), || measure(film, bench, &folder))?;
            if bench.size == Size::Full && folder.exists() {
                draw(film, &folder, cost.frames)?;
            }
            println!("  {:<30} {:.1} CPU s", film.run, cost.cpu_seconds);
            states += cost.frames;
            seconds += cost.cpu_seconds;
            intersections += cost.intersections;
            table.row([
                format!("`bowknot run {} --check`", film.run).into(),
                cost.vertices.into(),
                cost.frames.into(),
                cost.cpu_seconds.into(),
                (cost.cpu_seconds / cost.frames as f64).into(),
                cost.two_way_steps[0].into(),
                (cost.two_way_steps[1] as usize).into(),
                cost.max_stretch.into(),
                (1e3 * cost.min_gap).into(),
                cost.unsolved.into(),
            ]);
        }
        let finding = format!(
            "{states} time steps in {seconds:.0} CPU seconds, {intersections} intersections in their states and paths."
        );
        Ok(Report { finding, parts: vec![Part::table(self.name(), "", table)] })
    }
}

/// Runs the scene into `folder`.
fn measure(film: &Film, bench: &Bench, folder: &Path) -> Result<Cost> {
    if folder.exists() {
        fs::remove_dir_all(folder).with_context(|| format!("cannot remove {}", folder.display()))?;
    }
    let mut words = film.run.split_whitespace();
    let name = words.next().unwrap_or_default();
    let scale = words.next_back().map(str::parse).transpose()?;
    let name =
        if name.ends_with(".toml") { root().join(name).display().to_string() } else { name.to_owned() };
    let frames = bench.size.pick(None, Some(10), Some(2));
    let sets: Vec<String> = frames.iter().map(|frames| format!("simulation.frames={frames}")).collect();
    let scene = Scene::open(&name, scale, &sets)?;
    let options = RunOptions { out: folder.to_owned(), check: true, ..RunOptions::default() };
    let summary = run::run(&scene, &options, &mut |_| ControlFlow::Continue(()))?.summary;
    let (Some(mean), Some(max)) = (&summary.mean, &summary.max) else {
        bail!("{} has no time steps", film.run);
    };
    let number = |value: Option<f64>| value.context("a statistic is missing");
    Ok(Cost {
        vertices: summary.info.vertices,
        frames: summary.frames,
        cpu_seconds: number(mean.cpu_seconds)? * summary.frames as f64,
        two_way_steps: [number(mean.two_way_steps)?, number(max.two_way_steps)?],
        max_stretch: number(max.max_stretch)?,
        min_gap: summary.min_gap_m.unwrap_or(f64::INFINITY),
        unsolved: summary.unsolved_steps,
        intersections: summary.intersections.context("the run was judged")?,
    })
}

/// Draws the run of so many time steps in `folder` into docs/gallery, by the command beside this program, unless the film
/// is newer than the run.
fn draw(film: &Film, folder: &Path, frames: usize) -> Result<()> {
    let out = root().join(pages::FILMS).join(film.name).with_extension("gif");
    let time = |path: &Path| fs::metadata(path).and_then(|file| file.modified()).ok();
    if time(&out) > time(&folder.join("summary.json")) {
        return Ok(());
    }
    let command = env::current_exe()?.with_file_name("bowknot").with_extension(env::consts::EXE_EXTENSION);
    ensure!(
        command.exists(),
        "{} is missing, which draws: cargo build --release -p bowknot-cli",
        command.display()
    );
    let (mut sizes, mut most) = (SIZES.iter(), (frames > 4 * MAX_FRAMES).then_some(MAX_FRAMES));
    let mut size = sizes.next();
    while let Some(pixels) = size {
        let mut render = Command::new(&command);
        render.arg("render").arg(folder).args(["--quiet", "--size", pixels]);
        if let Some(most) = most {
            render.arg("--frames").arg(format!("..:{}", frames.div_ceil(most)));
        }
        let output = render.args(film.camera.split_whitespace()).arg("--out").arg(&out).output()?;
        ensure!(output.status.success(), "{render:?}: {}", String::from_utf8_lossy(&output.stderr));
        let bytes = fs::metadata(&out).with_context(|| out.display().to_string())?.len();
        if bytes <= MAX_BYTES {
            return Ok(());
        }
        if bytes > 3 * MAX_BYTES / 2 && most.is_none_or(|most| most > MAX_FRAMES / 2) {
            most = Some(most.map_or(MAX_FRAMES.min(frames / 2), |_| MAX_FRAMES / 2));
        } else {
            size = sizes.next();
        }
    }
    bail!("{} is larger than {MAX_BYTES} bytes at {}", out.display(), SIZES[SIZES.len() - 1])
}

/// The repository, in which scene files are found.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_has_a_film_on_the_page() {
        let page = fs::read_to_string(root().join(pages::GALLERY)).expect("a page");
        let files = fs::read_dir(root().join("assets/scenes")).expect("scene files");
        let mut missing = Vec::new();
        for file in files {
            let path = file.expect("a file").path();
            let name = path.file_stem().and_then(|name| name.to_str()).expect("a name").to_owned();
            let film = FILMS.iter().find(|film| film.name == name);
            let shown = film.is_some_and(|film| {
                page.contains(&format!("gallery/{name}.gif")) && page.contains(&format!("run {}", film.run))
            });
            let size = fs::metadata(root().join(pages::FILMS).join(&name).with_extension("gif"))
                .map(|file| file.len());
            if !shown || !size.is_ok_and(|size| (1..=MAX_BYTES).contains(&size)) {
                missing.push(name);
            }
        }
        assert!(missing.is_empty(), "no film of {missing:?}: `bowknot-bench gallery` draws it");
    }
}
