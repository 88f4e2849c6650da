//! No archive makes a reader panic: collision problems, stacks of frames and checkpoints whose arrays are
//! damaged.

use super::parts::split;
use super::read_mesh::check_archive;
use bowknot::run::RunOptions;
use bowknot::simulator::Checkpoint;
use bowknot::{Scene, Simulator};
use std::fs;
use std::io::{Cursor, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::OnceLock;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// Names of arrays, by the choices of the parts: those of problems and stacks, then those of checkpoints.
const NAMES: [&str; 43] = [
    "x",
    "y",
    "F",
    "E",
    "P",
    "rest",
    "mass",
    "fixed",
    "O",
    "body",
    "planes",
    "dt",
    "thickness",
    "delta",
    "friction",
    "stretch_limit",
    "plane_thickness",
    "plane_friction",
    "pair_friction",
    "group",
    "start",
    "collision_groups",
    "collides_with",
    "self_collision",
    "X",
    "T",
    "step",
    "anchor_counts",
    "contact_features",
    "contact_normals",
    "contact_forces",
    "positions",
    "velocities",
    "anchors",
    "checksum",
    "sleep_origins",
    "sleep_calm_steps",
    "sleep_islands",
    "contact_means",
    "present",
    "yielding",
    "yielding_limit",
    "yielding_edges",
];

/// Reads the parts of the input as arrays, header included, of an archive whose sums are right. The first
/// byte chooses whether they are deflated. A bare archive would be refused at its sums, whatever its arrays
/// hold.
pub fn arrays(data: &[u8]) -> bool {
    let Some((&method, data)) = data.split_first() else { return false };
    let Ok(folder) = tempfile::tempdir() else { return false };
    let path = folder.path().join("mesh.npz");
    let Some(bytes) = archive_of(&split(data), method % 2 == 1) else { return false };
    fs::write(&path, bytes).is_ok() && check_archive(&path)
}

/// The parts as an archive; none if a name is given twice.
fn archive_of(parts: &[(u8, &[u8])], deflated: bool) -> Option<Vec<u8>> {
    let method = if deflated { CompressionMethod::Deflated } else { CompressionMethod::Stored };
    let options = SimpleFileOptions::default().compression_method(method);
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (choice, content) in parts {
        let name = NAMES[usize::from(*choice) % NAMES.len()];
        zip.start_file(format!("{name}.npy"), options).ok()?;
        zip.write_all(content).ok()?;
    }
    zip.finish().ok().map(Cursor::into_inner)
}

/// The input of [`arrays`] that holds the arrays of an archive. Arrays without a choice are left out.
pub fn arrays_of(archive: &[u8]) -> Vec<u8> {
    let mut parts = Vec::new();
    let mut zip = ZipArchive::new(Cursor::new(archive)).expect("a sound archive");
    for index in 0..zip.len() {
        let mut file = zip.by_index(index).expect("an entry");
        let name = file.name().trim_end_matches(".npy").to_owned();
        let mut content = Vec::new();
        std::io::copy(&mut file, &mut content).expect("an array");
        if let Some(choice) = NAMES.iter().position(|known| *known == name) {
            parts.push((choice as u8, content));
        }
    }
    [vec![0], super::parts::join(&parts)].concat()
}

/// A sheet above the ground, pinned on a side from a later time on, and a ball: checkpoints of it have every
/// array.
const SCENE: &str = r#"
    [simulation]
    frames = 2

    [output]
    formats = ["ply", "npz"]

    [[body]]
    name = "sheet"
    shape = { type = "sheet", size = [0.2, 0.2], edge = 0.1 }
    translate = [0.0, 0.0, 0.001]
    velocity = [0.0, 0.0, -1.0]

    [[pin]]
    body = "sheet"
    side = "x-max"
    start = 0.005

    [[obstacle]]
    shape = { type = "half-space" }
"#;

/// A scene whose checkpoints have every array.
fn scene() -> &'static Scene {
    static SCENE_OF_CHECKPOINTS: OnceLock<Scene> = OnceLock::new();
    SCENE_OF_CHECKPOINTS.get_or_init(|| Scene::from_toml(SCENE, ".").expect("a scene"))
}

/// A checkpoint of a simulation in contact.
pub fn sound_checkpoint() -> Checkpoint {
    let mut simulator = Simulator::new(scene()).expect("a simulator");
    for _ in 0..40 {
        simulator.step().expect("a step");
    }
    let checkpoint = simulator.checkpoint();
    assert!(!checkpoint.contacts.forces.is_empty() && !checkpoint.contacts.means.is_empty());
    checkpoint
}

/// Reads a checkpoint: the bytes as they are, or as arrays of a sound archive. What is read must be refused
/// by a simulation of another size, or be resumed and stepped.
pub fn checkpoint(data: &[u8]) -> bool {
    let Some((&choice, data)) = data.split_first() else { return false };
    let Ok(folder) = tempfile::tempdir() else { return false };
    let path = folder.path().join("state.npz");
    let bytes = if choice % 2 == 0 { Some(data.to_vec()) } else { archive_of(&split(data), false) };
    let Some(bytes) = bytes else { return false };
    if fs::write(&path, bytes).is_err() {
        return false;
    }
    match Checkpoint::read(&path) {
        Ok(checkpoint) => {
            resume(&checkpoint);
            true
        }
        Err(error) => {
            assert!(error.to_string().contains("state.npz"), "an error names its file: {error}");
            false
        }
    }
}

/// Goes on from a checkpoint that no checksum guards: numbers of the input replace some of a sound one.
pub fn restore(data: &[u8]) -> bool {
    static SOUND: OnceLock<Checkpoint> = OnceLock::new();
    let mut checkpoint = SOUND.get_or_init(sound_checkpoint).clone();
    let mut draw = super::Draw::new(data);
    for _ in 0..1 + draw.below(3) {
        damage(&mut checkpoint, &mut draw);
    }
    resume(&checkpoint)
}

/// Changes one thing of a checkpoint.
fn damage(checkpoint: &mut Checkpoint, draw: &mut super::Draw<'_>) {
    use bowknot::constraints::Feature;
    let number = |draw: &mut super::Draw<'_>| if draw.below(2) == 0 { draw.any() } else { draw.grid() };
    let (vertex, axis) = (draw.below(256), draw.below(3));
    match draw.below(12) {
        0 => checkpoint.step = draw.any().to_bits() as usize,
        1 => {
            let count = checkpoint.positions.len().max(1);
            if let Some(point) = checkpoint.positions.get_mut(vertex % count) {
                point[axis] = number(draw);
            }
        }
        2 => {
            let count = checkpoint.velocities.len().max(1);
            if let Some(velocity) = checkpoint.velocities.get_mut(vertex % count) {
                velocity[axis] = number(draw);
            }
        }
        3 => checkpoint.positions.truncate(vertex),
        4 => checkpoint.velocities.truncate(vertex),
        5 => {
            if let Some(point) = checkpoint.anchors.iter_mut().flatten().next() {
                point[axis] = number(draw);
            }
        }
        6 => checkpoint.anchors.iter_mut().for_each(|anchors| anchors.truncate(vertex)),
        7 | 8 => {
            let forces = &mut checkpoint.contacts.forces;
            let count = forces.len().max(1);
            if let Some(contact) = forces.get_mut(vertex % count) {
                let index = [0, 1, 7, 100, 1 << 20, u32::MAX][draw.below(6)];
                match draw.below(6) {
                    0 => contact.features[axis % 2] = Feature::Vertex(index),
                    1 => contact.features[axis % 2] = Feature::Edge(index),
                    2 => contact.features[axis % 2] = Feature::Triangle(index),
                    3 => contact.features[axis % 2] = Feature::HalfSpace(index),
                    4 => contact.force[axis] = number(draw),
                    _ => contact.normal[axis] = number(draw),
                }
            }
        }
        9 | 10 => {
            let means = &mut checkpoint.contacts.means;
            let count = means.len().max(1);
            if let Some(mean) = means.get_mut(vertex % count) {
                let spring = &mut mean.spring;
                match draw.below(8) {
                    0 => spring.vertices[axis] = [0, 1, 7, 100, 1 << 20, u32::MAX][draw.below(6)],
                    1 => spring.weights[axis] = number(draw),
                    2 => spring.normal[axis] = number(draw),
                    3 => spring.floor = number(draw),
                    4 => spring.reach = number(draw),
                    5 => spring.stiffness = number(draw),
                    6 => mean.features[axis % 2] = Feature::Edge([0, 1 << 20][draw.below(2)]),
                    _ => mean.depth = draw.any().to_bits() as u32,
                }
            }
        }
        _ => {
            checkpoint.sleep.islands.iter_mut().for_each(|island| *island = draw.below(256) as u32);
            checkpoint.sleep.calm_steps.iter_mut().for_each(|steps| *steps = u32::MAX);
        }
    }
}

/// Whether a simulation takes the checkpoint. It then makes a time step, which may be refused with an error.
fn resume(checkpoint: &Checkpoint) -> bool {
    let mut simulator = Simulator::new(scene()).expect("a simulator");
    match simulator.restore(checkpoint) {
        Ok(()) => {
            assert_eq!(simulator.step_index(), checkpoint.step);
            if checkpoint.step < usize::MAX {
                let _ = simulator.step();
            }
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            assert_eq!(simulator.step_index(), 0, "a refused checkpoint changes nothing");
            simulator.step().expect("a step of the state before");
            false
        }
    }
}

/// Runs the scene of the checkpoints into a folder.
pub fn write_run(folder: &Path) {
    let options = RunOptions { out: folder.to_owned(), ..RunOptions::default() };
    bowknot::run::run(scene(), &options, &mut |_| ControlFlow::Continue(())).expect("a run");
}
