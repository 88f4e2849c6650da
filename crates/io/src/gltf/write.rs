//! Scenes of glTF 2.0 as one binary file, `.glb`, whose frames are morph targets.

use crate::atomic::write_atomic;
use crate::error::{IoError, Place};
use crate::mesh::MeshView;
use bowknot_geometry::Point;
use serde_json::{Value, json};
use std::io::{Error, Result as IoResult, Write};
use std::path::Path;

/// A body of a scene.
#[derive(Clone, Copy, Debug)]
pub struct GltfBody<'a> {
    /// Its name.
    pub name: &'a str,
    /// Elements, over its own vertices; positions are not looked at, polygons are their triangles.
    pub elements: MeshView<'a>,
    /// Whether it is an obstacle, which is shown in a muted color.
    pub obstacle: bool,
}

/// Morph targets of one mesh from which on programs are slow or refuse; a warning says so.
const MANY_TARGETS: usize = 256;

const FLOAT: u32 = 5126;
const U32: u32 = 5125;

/// Writes a scene of all `frames` (1 at least), atomically. `read(body, frame)` gives the positions of a body
/// [m]; only one frame of one body is held at a time, but that each is asked for twice.
///
/// A body that moves is its first frame and a morph target for each other frame; an animation of weights
/// shows frame k at k `time_step` seconds, and what is between two frames on the straight line. Positions are
/// single-precision. They have z up; the root node turns the scene, so that y is up.
///
/// # Errors
/// The system's refusal, with the path; what `read` reports; more than 4 GiB.
pub fn write_glb(
    path: &Path,
    bodies: &[GltfBody<'_>],
    frames: usize,
    time_step: f64,
    mut read: impl FnMut(usize, usize) -> IoResult<Vec<Point>>,
) -> Result<(), IoError> {
    let mut motions = Vec::with_capacity(bodies.len());
    for body in 0..bodies.len() {
        let motion = Motion::of(frames, |frame| read(body, frame));
        motions.push(motion.map_err(|source| IoError::system("write", path, source))?);
    }
    if frames > MANY_TARGETS && motions.iter().any(|motion| motion.moves) {
        tracing::warn!(
            "{}: {} morph targets for each mesh that moves; programs may be slow or refuse them: every other \
             frame or fewer make a lighter file",
            path.display(),
            frames - 1
        );
    }
    let mut layout = Layout::default();
    let document = layout.document(bodies, &motions, frames);
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + text.len() + 8 + layout.length;
    let Ok(length) = u32::try_from(length) else {
        let message = format!("{length} bytes; the format holds 4 GiB: take fewer frames, or another format");
        return Err(IoError::content(path, Place::File, message));
    };
    write_atomic(path, |out| {
        let words = [0x4654_6C67, 2, length, text.len() as u32, 0x4E4F_534A];
        words.iter().try_for_each(|word: &u32| out.write_all(&word.to_le_bytes()))?;
        out.write_all(&text)?;
        out.write_all(&(layout.length as u32).to_le_bytes())?;
        out.write_all(&0x004E_4942_u32.to_le_bytes())?;
        for (index, (body, motion)) in bodies.iter().zip(&motions).enumerate() {
            for indices in primitives(&body.elements).iter().map(|(_, indices)| indices) {
                indices.iter().try_for_each(|index| out.write_all(&index.to_le_bytes()))?;
            }
            let first = singles(&read(index, 0)?);
            write_singles(out, first.iter().copied())?;
            for frame in 1..if motion.moves { frames } else { 1 } {
                let points = singles(&read(index, frame)?);
                if points.len() != first.len() {
                    return Err(Error::other("a frame with another number of vertices"));
                }
                write_singles(out, points.iter().zip(&first).map(|(p, q)| p - q))?;
            }
        }
        if motions.iter().any(|motion| motion.moves) {
            write_singles(out, (0..frames).map(|frame| (frame as f64 * time_step) as f32))?;
            for frame in 0..frames {
                write_singles(out, (1..frames).map(|target| f32::from(u8::from(target == frame))))?;
            }
        }
        Ok(())
    })
}

/// What must be known of the frames of a body before they are written.
struct Motion {
    vertices: usize,
    moves: bool,
    /// Corners of the box around the first frame, then around the displacements of each other frame.
    bounds: Vec<[[f32; 3]; 2]>,
}

impl Motion {
    fn of(frames: usize, mut read: impl FnMut(usize) -> IoResult<Vec<Point>>) -> IoResult<Self> {
        let first = singles(&read(0)?);
        let (mut bounds, mut moves) = (vec![bounds(first.iter().copied())], false);
        for frame in 1..frames {
            let points = singles(&read(frame)?);
            moves |= points != first;
            bounds.push(self::bounds(points.iter().zip(&first).map(|(p, q)| p - q)));
        }
        Ok(Self { vertices: first.len() / 3, moves, bounds })
    }
}

/// The buffer's parts, one after the other.
#[derive(Default)]
struct Layout {
    length: usize,
    accessors: Vec<Value>,
    views: Vec<Value>,
}

impl Layout {
    fn document(&mut self, bodies: &[GltfBody<'_>], motions: &[Motion], frames: usize) -> Value {
        let (mut meshes, mut nodes, mut channels) = (Vec::new(), Vec::new(), Vec::new());
        for (index, (body, motion)) in bodies.iter().zip(motions).enumerate() {
            let primitives = primitives(&body.elements);
            let indices: Vec<usize> =
                primitives.iter().map(|(_, indices)| self.add(U32, "SCALAR", indices.len(), None)).collect();
            let mut targets = Vec::new();
            let position = self.add(FLOAT, "VEC3", motion.vertices, Some(&motion.bounds[0]));
            for bounds in motion.bounds[1..].iter().filter(|_| motion.moves) {
                targets.push(json!({ "POSITION": self.add(FLOAT, "VEC3", motion.vertices, Some(bounds)) }));
            }
            let primitives = primitives.iter().zip(indices).map(|((mode, _), indices)| {
                let mut primitive = json!({
                    "attributes": { "POSITION": position },
                    "indices": indices,
                    "material": usize::from(body.obstacle),
                    "mode": mode,
                });
                if motion.moves {
                    primitive["targets"] = json!(targets);
                }
                primitive
            });
            let mut mesh = json!({ "name": body.name, "primitives": primitives.collect::<Vec<_>>() });
            // The root is node 0. Meshes without primitives are not allowed.
            let mut node = json!({ "name": body.name, "extras": { "obstacle": body.obstacle } });
            if mesh["primitives"].as_array().is_some_and(|primitives| !primitives.is_empty()) {
                node["mesh"] = json!(meshes.len());
                if motion.moves {
                    mesh["weights"] = json!(vec![0.0; frames - 1]);
                    let target = json!({ "node": 1 + index, "path": "weights" });
                    channels.push(json!({ "sampler": 0, "target": target }));
                }
                meshes.push(mesh);
            }
            nodes.push(node);
        }
        let children: Vec<usize> = (1..=nodes.len()).collect();
        // From z up to y up.
        let turn = [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1];
        nodes.insert(0, json!({ "name": "World", "matrix": turn, "children": children }));
        let mut document = json!({
            "asset": { "version": "2.0", "generator": format!("Bowknot {}", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": nodes,
            "materials": [material("body", [0.75, 0.35, 0.25]), material("obstacle", [0.6, 0.6, 0.62])],
        });
        // Lists may not be empty.
        if !meshes.is_empty() {
            document["meshes"] = json!(meshes);
        }
        if motions.iter().any(|motion| motion.moves) {
            let times = self.add(FLOAT, "SCALAR", frames, None);
            let weights = self.add(FLOAT, "SCALAR", frames * (frames - 1), None);
            let sampler = json!({ "input": times, "output": weights, "interpolation": "LINEAR" });
            document["animations"] =
                json!([{ "name": "simulation", "channels": channels, "samplers": [sampler] }]);
        }
        document["accessors"] = json!(self.accessors);
        document["bufferViews"] = json!(self.views);
        document["buffers"] = json!([{ "byteLength": self.length }]);
        document
    }

    /// Appends an array; returns its accessor.
    fn add(&mut self, component: u32, kind: &str, count: usize, bounds: Option<&[[f32; 3]; 2]>) -> usize {
        let bytes = 4 * count * if kind == "VEC3" { 3 } else { 1 };
        self.views.push(json!({ "buffer": 0, "byteOffset": self.length, "byteLength": bytes }));
        self.length += bytes;
        let view = self.views.len() - 1;
        let mut accessor =
            json!({ "bufferView": view, "componentType": component, "count": count, "type": kind });
        if let Some([low, high]) = bounds {
            (accessor["min"], accessor["max"]) = (json!(low), json!(high));
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

fn material(name: &str, [red, green, blue]: [f64; 3]) -> Value {
    json!({
        "name": name,
        "doubleSided": true,
        "pbrMetallicRoughness": { "baseColorFactor": [red, green, blue, 1.0], "metallicFactor": 0.0 },
    })
}

/// The modes and indices of the primitives of a body.
fn primitives(elements: &MeshView<'_>) -> Vec<(u32, Vec<u32>)> {
    let quads = elements.quads.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]);
    let triangles = elements.triangles.as_flattened().iter().copied().chain(quads).collect();
    let all =
        [(4, triangles), (1, elements.strands.as_flattened().to_vec()), (0, elements.particles.to_vec())];
    all.into_iter().filter(|(_, indices): &(u32, Vec<u32>)| !indices.is_empty()).collect()
}

fn singles(points: &[Point]) -> Vec<f32> {
    points.iter().flat_map(|p| [p.x as f32, p.y as f32, p.z as f32]).collect()
}

fn bounds(numbers: impl Iterator<Item = f32>) -> [[f32; 3]; 2] {
    let mut bounds = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    for (k, number) in numbers.enumerate() {
        bounds[0][k % 3] = bounds[0][k % 3].min(number);
        bounds[1][k % 3] = bounds[1][k % 3].max(number);
    }
    bounds
}

fn write_singles(out: &mut impl Write, numbers: impl Iterator<Item = f32>) -> IoResult<()> {
    numbers.into_iter().try_for_each(|number| out.write_all(&number.to_le_bytes()))
}
