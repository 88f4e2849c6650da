//! Scenes of degenerate contacts, after the tests of Erleben (2018) that Li et al. (2020) collect: solids
//! with sharp tips and edges that fall on tips, edges, steps and notches; and sheets a micrometer apart,
//! closed meshes inside each other, needles and points as obstacles.
//!
//! K. Erleben, *Methodology for Assessing Mesh-Based Contact Point Methods*, ACM TOG 37(3), 2018. All meshes
//! are made here.

pub mod meshes;

use bowknot::run::Checker;
use bowknot::simulator::AcceptedStep;
use bowknot::{Scene, SimulationObserver, Simulator};
use meshes::{Solid, Surface};
use std::ops::ControlFlow;
use std::path::Path;

/// A degenerate scene.
#[derive(Clone, Debug)]
pub struct Degenerate {
    /// Its name.
    pub name: &'static str,
    /// Bodies and obstacles as TOML.
    pub bodies: String,
    /// Number of time steps.
    pub frames: usize,
}

/// What a run came to.
#[derive(Clone, Debug, Default)]
pub struct Judged {
    /// Accepted paths that were judged.
    pub paths: usize,
    /// Intersections found.
    pub intersections: usize,
    /// The first of them in words.
    pub findings: Vec<String>,
    /// Largest distance that a vertex ends from its start [m].
    pub moved: f64,
}

/// Settings of all scenes.
const HEAD: &str = "[simulation]\ndt = 0.01\n";

/// All scenes.
pub fn scenes() -> Vec<Degenerate> {
    let mut scenes = on_obstacles();
    scenes.extend(of_sheets());
    scenes.extend(on_needles());
    scenes
}

fn solid(mesh: &str, place: [f64; 3], more: &str) -> String {
    format!(
        "[[body]]\nkind = \"solid\"\nmesh = \"{mesh}\"\ntranslate = {place:?}\nvelocity = [0.0, 0.0, -2.0]\n\
         material = {{ base = \"jelly\", young_modulus = 1e5, poisson_ratio = 0.4, density = 1000 \
         }}\n{more}\n"
    )
}

fn cube(place: [f64; 3], more: &str) -> String {
    format!(
        "[[body]]\nkind = \"solid\"\nshape = {{ type = \"block\", size = [0.5, 0.5, 0.5], edge = 0.25 }}\n\
         translate = {place:?}\nvelocity = [0.0, 0.0, -2.0]\n\
         material = {{ base = \"jelly\", young_modulus = 1e5, poisson_ratio = 0.4, density = 1000 \
         }}\n{more}\n"
    )
}

/// An obstacle; of tetrahedra the surface.
fn obstacle(mesh: &str, more: &str) -> String {
    format!("[[obstacle]]\nmesh = \"{mesh}\"\n{more}\n")
}

const UPSIDE_DOWN: &str = "rotate = [180.0, 0.0, 0.0]";

/// Solids with tips and edges, and a cube, on obstacles.
fn on_obstacles() -> Vec<Degenerate> {
    let scene = |name, bodies: [String; 2]| Degenerate { name, bodies: bodies.concat(), frames: 25 };
    let above = [0.0, 0.0, 1e-3];
    let spike = || solid("spike.t", above, "");
    let wedge = || solid("wedge.t", above, "");
    let plane = || "[[obstacle]]\nshape = { type = \"half-space\" }\n".to_owned();
    vec![
        scene("spike on plane", [spike(), plane()]),
        scene("spike on spike", [spike(), obstacle("spike.t", UPSIDE_DOWN)]),
        scene("spike on wedge", [spike(), obstacle("wedge.t", UPSIDE_DOWN)]),
        scene("spike in crack", [solid("spike.t", [0.0, 0.0, -0.2], ""), obstacle("crack.obj", "")]),
        scene(
            "spike in hole",
            [
                solid("spike.t", [0.0, 0.0, -0.1], ""),
                "[[obstacle]]\nshape = \
             { type = \"lathe\", edge = 0.1, profile = [[0.1, -0.3], [0.6, -0.3], [0.6, 0.0], [0.1, 0.0]] }\n"
                    .to_owned(),
            ],
        ),
        scene("wedge on plane", [wedge(), plane()]),
        scene("wedge on wedge along", [wedge(), obstacle("wedge.t", UPSIDE_DOWN)]),
        scene("wedge on wedge across", [wedge(), obstacle("wedge.t", "rotate = [180.0, 0.0, 90.0]")]),
        scene("wedge in crack", [solid("wedge.t", [0.0, 0.0, -0.2], ""), obstacle("crack.obj", "")]),
        scene("cube on cliff", [cube([0.0, 0.0, 0.252], ""), obstacle("cliff.obj", "")]),
        scene("cube on inner edges", [cube([0.0, 0.0, 0.252], ""), obstacle("slivers.obj", "")]),
        scene("cube on spike", [cube([0.0, 0.0, 0.252], ""), obstacle("spike.t", UPSIDE_DOWN)]),
        Degenerate {
            name: "sliding spike",
            bodies: solid("spike.t", above, "").replace("[0.0, 0.0, -2.0]", "[3.0, 0.1, -0.5]")
                + &obstacle("slivers.obj", ""),
            frames: 25,
        },
        Degenerate {
            name: "spikes of solids, tip to tip",
            bodies: spike()
                + &solid("spike.t", [0.0, 0.0, 0.0], UPSIDE_DOWN).replace("-2.0", "2.0")
                + &solid("wedge.t", [0.0, 0.0, 0.55], ""),
            frames: 20,
        },
    ]
}

/// Sheets a micrometer apart, and closed meshes inside each other.
fn of_sheets() -> Vec<Degenerate> {
    let sheet = |z: f64| {
        format!(
            "[[body]]\nshape = {{ type = \"sheet\", size = [0.2, 0.2], edge = 0.05 }}\ntranslate = [0.0, \
             0.0, {z:?}]\n\
             velocity = [0.0, 0.0, {:?}]\nmaterial = {{ base = \"cotton\", thickness = 1e-7 }}\n",
            if z > 0.0 { -1.0 } else { 1.0 }
        )
    };
    let ball = "[[obstacle]]\nshape = { type = \"ball\", radius = 0.05, edge = 0.02 }\ntranslate = [0.0, \
                0.0, -0.0501]\n";
    let layers = |gap: f64| (1..4).map(|k| sheet(gap * f64::from(k))).collect::<String>() + ball;
    let closed = |size: f64, velocity: f64| {
        format!(
            "[[body]]\nmesh = \"box.obj\"\nscale = {size:?}\ntranslate = [0.0, 0.0, 0.5]\n\
             velocity = [{velocity:?}, 0.0, -3.0]\nmaterial = {{ base = \"cotton\", thickness = 1e-7 }}\n"
        )
    };
    let plane = "[[obstacle]]\nshape = { type = \"half-space\" }\n";
    vec![
        Degenerate { name: "sheets 1 mm apart", bodies: layers(1e-3), frames: 15 },
        Degenerate { name: "sheets 10 um apart", bodies: layers(1e-5), frames: 15 },
        Degenerate { name: "sheets 1 um apart", bodies: layers(1e-6), frames: 15 },
        Degenerate {
            name: "boxes inside each other",
            bodies: closed(0.2, 0.0) + &closed(0.1999, 1.0) + &closed(0.1, -2.0) + plane,
            frames: 30,
        },
        Degenerate {
            name: "a cube in a box",
            bodies: closed(0.7, 0.0) + &cube([0.0, 0.0, 0.5], "") + plane,
            frames: 25,
        },
    ]
}

/// A sheet, a cube, strands and grains on needles and on points.
fn on_needles() -> Vec<Degenerate> {
    let sheet = "[[body]]\nshape = { type = \"sheet\", size = [0.3, 0.3], edge = 0.05 }\n\
                 translate = [0.0, 0.0, 0.01]\nvelocity = [0.0, 0.0, -3.0]\n";
    let hair = "[[body]]\nkind = \"strands\"\nmaterial = \"rope\"\n\
                shape = { type = \"strands\", count = 4, length = 0.2, segments = 6, spacing = 0.05 }\n\
                rotate = [0.0, 80.0, 0.0]\ntranslate = [-0.1, 0.0, 0.1]\nvelocity = [0.0, 0.0, -3.0]\n";
    let grains = "[[body]]\nkind = \"particles\"\nmaterial = \"gravel\"\n\
                  shape = { type = \"grains\", count = [4, 4, 2], spacing = 0.03 }\n\
                  translate = [0.0, 0.0, 0.1]\nvelocity = [0.0, 0.0, -3.0]\n";
    let needles = obstacle("needles.obj", "");
    let points = obstacle("points.obj", "");
    vec![
        Degenerate { name: "sheet on needles", bodies: sheet.to_owned() + &needles, frames: 20 },
        Degenerate { name: "sheet on points", bodies: sheet.to_owned() + &points, frames: 20 },
        Degenerate { name: "cube on needles", bodies: cube([0.0, 0.0, 0.252], "") + &needles, frames: 20 },
        Degenerate { name: "strands on needles", bodies: hair.to_owned() + &needles, frames: 20 },
        Degenerate { name: "grains on points", bodies: grains.to_owned() + &points, frames: 20 },
    ]
}

/// Writes the meshes that the scenes name.
fn write_meshes(folder: &Path) {
    let crack =
        [[-0.6, 0.0], [-0.12, 0.0], [-0.12, -0.3], [0.0, -0.6], [0.12, -0.3], [0.12, 0.0], [0.6, 0.0]];
    let cliff = [[-0.6, 0.0], [0.0, 0.0], [0.0, -0.6], [0.6, -0.6]];
    let files = [
        ("spike.t", Solid::spike(6, 0.15, 0.5).text()),
        ("wedge.t", Solid::wedge(3, 0.3, 0.5, 0.5).text()),
        ("crack.obj", Surface::extruded(&crack, 2, 0.8).text()),
        ("cliff.obj", Surface::extruded(&cliff, 2, 0.8).text()),
        ("slivers.obj", Surface::slivers(10, 1e-4, 2.0).text()),
        ("box.obj", Surface::closed_box(1.0).text()),
        ("points.obj", Surface::points(4, 0.06).text()),
        ("needles.obj", Surface::needles(4, 0.06, 0.3).text()),
    ];
    for (name, text) in files {
        std::fs::write(folder.join(name), text).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

struct Watch<'a> {
    checker: &'a mut Checker,
    simulator: &'a bowknot::World,
    fault: Option<String>,
}

impl SimulationObserver for Watch<'_> {
    fn accepted(&mut self, accepted: &AcceptedStep<'_>) -> ControlFlow<()> {
        if let Err(error) = self.checker.judge(accepted, self.simulator) {
            self.fault.get_or_insert(error.to_string());
        }
        ControlFlow::Continue(())
    }
}

/// Runs a scene with more settings, and judges the path to every accepted state and the end of every time
/// step.
///
/// # Panics
/// The scene is refused, or a time step fails.
pub fn run(scene: &Degenerate, settings: &[String]) -> Judged {
    let folder = tempfile::tempdir().expect("a folder");
    write_meshes(folder.path());
    let text = format!("{HEAD}{}", scene.bodies);
    let loaded = Scene::from_toml(&text, folder.path()).and_then(|loaded| loaded.with_sets(settings));
    let loaded = loaded.unwrap_or_else(|error| panic!("{}: {error}", scene.name));
    let mut simulator = Simulator::new(&loaded).unwrap_or_else(|error| panic!("{}: {error}", scene.name));
    let (start, world) = (simulator.positions().to_vec(), simulator.world().clone());
    let mut checker = Checker::new(&simulator);
    // Those inside of solids stand behind them.
    let judgeable = simulator.judge().vertex_count();
    let mut judged = Judged::default();
    for step in 0..scene.frames {
        let mut watch = Watch { checker: &mut checker, simulator: &world, fault: None };
        let stepped = simulator.step_observed(&mut watch);
        let fault = stepped.err().map(|error| error.to_string()).or(watch.fault);
        if let Some(fault) = fault {
            panic!("{}, time step {step}: {fault}", scene.name);
        }
        let ended = checker.judge_end(step, &simulator.positions()[..judgeable], &world);
        ended.unwrap_or_else(|error| panic!("{}, time step {step}: {error}", scene.name));
    }
    judged.paths = checker.paths();
    judged.intersections = checker.intersections();
    judged.findings = checker.findings().to_vec();
    let moves = simulator.positions().iter().zip(&start).map(|(p, q)| (p - q).norm());
    judged.moved = moves.fold(0.0, f64::max);
    judged
}
