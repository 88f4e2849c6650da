//! Soft bodies of rapier beside Bowknot: simulates one scene, writes frames that `bowknot check` reads, and prints one
//! line of JSON. `../soft.py` runs it; the README there says what is compared.

// Both programs read the same meshes: it does not matter that sines differ between machines.
#![allow(clippy::disallowed_methods)]

mod files;
mod meshes;
mod scenes;
mod world;

use cpu_time::ProcessTime;
use rapier3d::prelude::{SoftBodyCellModel, SoftBodySolver};
use scenes::Skin;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;
use world::{Settings, World};

const USAGE: &str = "usage: bowknot-peer-rapier SCENE --out DIR [options]
  SCENE            ball, sheets, ribbon, slope, stack or pinch
  --out DIR        folder for frames/000000.ply and so on
  --meshes         write the meshes of the bodies into DIR instead, for Bowknot's scene file
  --size N         vertices along a side of a sheet or a cube
  --seconds S      simulated time
  --dt S           time step [default 0.01]
  --every N        write every Nth frame [default 1]
  --substeps N     solver iterations [default 4]
  --radius R       thickness to each side, in distances of neighbors [default 0.5]
  --recovery       edge speculation and crossing repulsion, which are off by default
  --edge-hz F      frequency of a cloth's edges [Hz; default: from cotton's stiffness]
  --neo-hookean    cells by that law instead of the corotational one
  --fem            the solver by finite elements";

/// Bowknot holds contacts at a distance, of which bodies have a half each and planes nothing.
const BOWKNOT: Skin = Skin { side: 0.0625, on_plane: 0.125 };

struct Options {
    scene: String,
    out: PathBuf,
    meshes: bool,
    size: Option<usize>,
    seconds: Option<f64>,
    dt: f64,
    every: usize,
    settings: Settings,
}

fn main() -> ExitCode {
    match options(std::env::args().skip(1)).and_then(|options| run(&options)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

fn options(mut words: impl Iterator<Item = String>) -> Result<Options, String> {
    let mut options = Options {
        scene: String::new(),
        out: PathBuf::new(),
        meshes: false,
        size: None,
        seconds: None,
        dt: 0.01,
        every: 1,
        settings: Settings::default(),
    };
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value\n{USAGE}"));
        match word.as_str() {
            "--out" => options.out = value()?.into(),
            "--meshes" => options.meshes = true,
            "--size" => options.size = Some(count(&word, &value()?, 3)?),
            "--seconds" => options.seconds = Some(number(&word, &value()?)?),
            "--dt" => options.dt = number(&word, &value()?)?,
            "--every" => options.every = count(&word, &value()?, 1)?,
            "--substeps" => options.settings.substeps = count(&word, &value()?, 1)?,
            "--radius" => options.settings.radius = number(&word, &value()?)?,
            "--recovery" => options.settings.recovery = true,
            "--edge-hz" => options.settings.edge_hz = Some(number(&word, &value()?)?),
            "--neo-hookean" => options.settings.cells = SoftBodyCellModel::NeoHookean,
            "--fem" => options.settings.solver = SoftBodySolver::Fem,
            name if scenes::NAMES.contains(&name) && options.scene.is_empty() => options.scene = word,
            _ => return Err(format!("unknown option or scene {word}\n{USAGE}")),
        }
    }
    if options.scene.is_empty() || options.out.as_os_str().is_empty() {
        return Err(USAGE.into());
    }
    Ok(options)
}

fn number(name: &str, text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value: &f64| value.is_finite() && *value > 0.0);
    value.ok_or(format!("{name} {text}: give a number above 0"))
}

fn count(name: &str, text: &str, least: usize) -> Result<usize, String> {
    let value = text.parse().ok().filter(|value| *value >= least);
    value.ok_or(format!("{name} {text}: give a whole number from {least}"))
}

fn run(options: &Options) -> Result<(), String> {
    let radius = options.settings.radius;
    let skin = if options.meshes { BOWKNOT } else { Skin { side: radius, on_plane: radius } };
    let scene = scenes::named(&options.scene, options.size, &skin).ok_or(USAGE)?;
    let frames = options.out.join("frames");
    make_folder(if options.meshes { &options.out } else { &frames })?;
    if options.meshes {
        return files::write_meshes(&scene, &options.out).map_err(|error| at(&options.out, &error));
    }
    let steps = (options.seconds.unwrap_or(scene.seconds) / options.dt).round() as usize;
    let writer = files::Frames::new(&scene);
    let mut world = World::new(&scene, &options.settings, options.dt);
    let (mut cpu, mut wall, mut asleep) = (0.0, 0.0, None);
    for step in 0..=steps {
        if step > 0 {
            let (cpu_before, wall_before) = (ProcessTime::now(), Instant::now());
            world.step(&scene, step as f64 * options.dt);
            cpu += cpu_before.elapsed().as_secs_f64();
            wall += wall_before.elapsed().as_secs_f64();
        }
        if !world.asleep() {
            asleep = None;
        } else if asleep.is_none() {
            asleep = Some(step as f64 * options.dt);
        }
        if step % options.every == 0 {
            let path = frames.join(format!("{:06}.ply", step / options.every));
            writer.write(&world.positions(), &path).map_err(|error| at(&path, &error))?;
        }
    }
    let (vertices, triangles) = writer.sizes();
    let particles: usize = scene.bodies.iter().map(|body| body.mesh.points.len()).sum();
    let tets: usize = scene.bodies.iter().map(|body| body.mesh.tets.len()).sum();
    let asleep = asleep.map_or("null".into(), |time: f64| time.to_string());
    println!(
        "{{\"scene\":\"{}\",\"steps\":{steps},\"dt\":{},\"particles\":{particles},\"vertices\":{vertices},\
         \"triangles\":{triangles},\"tets\":{tets},\"cpu_s\":{cpu},\"wall_s\":{wall},\"asleep_at_s\":{asleep}}}",
        options.scene, options.dt
    );
    Ok(())
}

fn make_folder(folder: &Path) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|error| at(folder, &error))
}

fn at(path: &Path, error: &std::io::Error) -> String {
    format!("{}: {error}", path.display())
}
