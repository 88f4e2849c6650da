//! Scenes that are hard by themselves.

use super::case::{Case, Start};
use super::scenes::{EDGE, Setting};
use crate::bench::Size;

/// A motion by a displacement [m] between two times [s], as TOML.
fn motion(from: f64, until: f64, by: [f64; 3]) -> String {
    format!(
        "motion = {{ keyframes = [{{ time = {from:?} }}, {{ time = {until:?}, translate = [{:?}, {:?}, {:?}] \
         }}] }}\n",
        by[0], by[1], by[2]
    )
}

/// All of them.
pub fn all(size: Size) -> Vec<Case> {
    let steps = size.pick(100, 40, 16);
    let falling = size.pick(60, 30, 10);
    let mut cases = vec![
        stack(size.pick(100_000, 3_000, 100), false),
        stack(size.pick(100_000, 3_000, 100), true),
        press(steps, 0.0),
        press(steps, 0.03),
        taut(steps, false),
        taut(steps, true),
        fine_obstacle(falling),
        coarse_obstacle(falling),
        inverted(Start::InsideOut(1.0), steps),
        inverted(Start::InsideOut(4.0), steps),
        inverted(Start::Mirrored, steps),
    ];
    let cells = size.pick(20, 12, 8);
    for depth in size.pick(vec![-0.01, 0.01, 0.05], vec![-0.01, 0.01], vec![0.01]) {
        cases.push(pins_in_ball(depth, cells, size.pick(40, 30, 16)));
    }
    cases.push(pins_below_plane(cells, size.pick(40, 30, 16)));
    cases
}

/// Sheets that lie on each other on a box, for a long time.
fn stack(steps: usize, sleep: bool) -> Case {
    let setting = Setting { cells: 4, ..Setting::default() };
    let mut scene = setting.head(steps).replace("enabled = false", &format!("enabled = {sleep}"));
    for layer in 0..4 {
        scene += &setting.sheet(&format!("sheet{layer}"), [0.0, 0.0, 0.02 + 0.012 * f64::from(layer)], 0.0);
    }
    scene += &setting.ground();
    let sweep = if sleep { "resting stack" } else { "resting stack, no sleep" };
    Case::new(sweep, format!("{steps} steps"), scene, steps)
}

/// A plate comes down on a soft block until `gap` is left of its height of 0.12 m; with a gap of 0 there is no room for it.
fn press(steps: usize, gap: f64) -> Case {
    let setting = Setting::default();
    let time = 0.5 * steps as f64 * setting.dt;
    let mut scene = setting.head(steps) + &setting.block("block", [0.0, 0.0, 0.07], 0.0);
    scene += &setting.ground();
    scene +=
        "\n[[obstacle]]\nname = \"press\"\nshape = { type = \"box\", size = [0.4, 0.4, 0.04], edge = 0.1 }\n";
    scene += &format!("translate = {}\n", setting.at(0.0, 0.0, 0.17));
    scene += &motion(0.0, time, [0.0, 0.0, gap - 0.15]);
    let mut case = Case::new("press on a block of 120 mm", format!("to {:.0} mm", 1e3 * gap), scene, steps);
    case.driven_until = f64::INFINITY;
    case.can_converge = gap > 0.0;
    // A block that is crushed to nothing has no room for tetrahedra of positive volume.
    case.can_recover = gap > 0.0;
    case
}

/// A sheet is pulled to its stretch limit and then moved along itself, alone or over a ball.
fn taut(steps: usize, over_ball: bool) -> Case {
    let setting = Setting::default();
    let time = steps as f64 * setting.dt;
    let mut scene = setting.head(steps);
    scene += &setting.sheet("sheet", [0.0, 0.0, 0.3], 0.0).replace("rotate = [0.0, 0.0, 10.0]\n", "");
    for (side, pull) in [("x-min", -0.01), ("x-max", 0.01)] {
        scene += &format!(
            "\n[[pin]]\nbody = \"sheet\"\nside = \"{side}\"\nmotion = {{ keyframes = [{{ time = 0.0 }}, {{ \
             time = {:?}, translate = [{pull:?}, 0.0, 0.0] }}, {{ time = {:?}, translate = [{:?}, 0.0, 0.0] \
             }}] }}\n",
            0.2 * time,
            0.8 * time,
            0.5 + pull
        );
    }
    if over_ball {
        scene += "\n[[obstacle]]\nname = \"ball\"\nfriction = 0.3\nshape = \
                  { type = \"ball\", radius = 0.1, edge = 0.03 }\n";
        scene += "translate = [0.2, 0.0, 0.19]\n";
    }
    let value = if over_ball { "over a ball" } else { "alone" };
    let mut case = Case::new("taut sheet moved along itself", value, scene, steps);
    case.driven_until = 0.8 * time;
    case
}

/// A sheet falls on a ball whose edges are a hundred times shorter than its own.
fn fine_obstacle(steps: usize) -> Case {
    let setting = Setting { cells: 4, ..Setting::default() };
    let mut scene = setting.head(steps) + &setting.sheet("sheet", [0.0, 0.0, 0.03], 0.0);
    scene += "\n[[obstacle]]\nname = \"ball\"\nshape = { type = \"ball\", radius = 0.02, edge = 0.001 }\n";
    Case::new("obstacle", "100 times finer", scene, steps)
}

/// A sheet falls on the edge of a box whose edges are a hundred times longer than its own.
fn coarse_obstacle(steps: usize) -> Case {
    let setting = Setting::default();
    let mut scene = setting.head(steps) + &setting.sheet("sheet", [1.9, 0.0, 0.05], 0.0);
    scene +=
        "\n[[obstacle]]\nname = \"box\"\nshape = { type = \"box\", size = [4.0, 4.0, 4.0], edge = 4.0 }\n";
    scene += "translate = [0.0, 0.0, -2.0]\n";
    Case::new("obstacle", "100 times coarser", scene, steps)
}

/// A soft block without gravity whose tetrahedra are inverted at the start.
fn inverted(start: Start, steps: usize) -> Case {
    let setting = Setting::default();
    let mut scene = setting.head(steps).replace("[simulation]", "[simulation]\ngravity = [0.0, 0.0, 0.0]");
    scene += &setting.block("block", [0.0, 0.0, 0.0], 0.0);
    let value = match start {
        Start::InsideOut(factor) => format!("inside mirrored, x {factor}"),
        Start::Mirrored => "all mirrored".to_owned(),
        Start::Scene => "none".to_owned(),
    };
    let mut case = Case::new("inverted tetrahedra", value, scene, steps);
    case.start = start;
    if start == Start::Mirrored {
        case.can_recover = false;
        case.known = "the surface would have to pass through itself";
    }
    case
}

/// The setting of a sheet of `cells` squares a side, and the length of its edges [m].
fn pinned(cells: usize) -> (Setting, f64) {
    let setting = Setting { cells, ..Setting::default() };
    (setting, 10.0 * EDGE / cells as f64)
}

/// Pins whose place is inside of a ball: four vertices in the middle of a sheet are led down to `depth` below
/// its top.
fn pins_in_ball(depth: f64, cells: usize, steps: usize) -> Case {
    let (setting, edge) = pinned(cells);
    let time = 0.3 * steps as f64 * setting.dt;
    let mut scene = setting.head(steps);
    scene += &setting.sheet("sheet", [0.0, 0.0, 0.05], 0.0).replace("rotate = [0.0, 0.0, 10.0]\n", "");
    // Four vertices about the point half an edge off the middle.
    let (low, high) = (-0.1 * edge, 1.1 * edge);
    scene +=
        &format!("\n[[pin]]\nbox = {{ min = [{low:?}, {low:?}, -1.0], max = [{high:?}, {high:?}, 1.0] }}\n");
    scene += &motion(0.0, time, [0.0, 0.0, -0.05 - depth]);
    scene += "\n[[obstacle]]\nname = \"ball\"\nshape = { type = \"ball\", radius = 0.1, edge = 0.02 }\n";
    scene += "translate = [0.0, 0.0, -0.1]\n";
    let value = match depth {
        d if d < 0.0 => format!("{:.0} mm above", -1e3 * d),
        d => format!("{:.0} mm inside", 1e3 * d),
    };
    let mut case = Case::new("pins led into a ball", value, scene, steps);
    case.driven_until = time;
    case.can_converge = depth < 0.0;
    case
}

/// The same with a half-space.
fn pins_below_plane(cells: usize, steps: usize) -> Case {
    let mut case = pins_in_ball(0.01, cells, steps);
    let (before, _) = case.scene.split_once("\n[[obstacle]]").unwrap_or_default();
    case.scene = format!("{before}\n[[obstacle]]\nname = \"plane\"\nshape = \"half-space\"\n");
    case.sweep = "pins led into a half-space";
    case
}
