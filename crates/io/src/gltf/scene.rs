//! A scene as an animation.

use super::accessors::Accessors;
use super::document::{self, Document, Extras, Node};
use super::motion::{Motion, Pose};
use super::part::Part;
use crate::animation::{Animation, FrameOptions, frame_times};
use crate::error::{IoError, Place};
use crate::mesh::Mesh;
use crate::parts::PartsBuilder;
use crate::transform::place;
use bowknot_errors::counted;
use bowknot_geometry::Point;
use bowknot_geometry::nalgebra::Matrix4;
use std::path::Path;

/// The meshes of the default scene, each node with one a part, and the first animation.
#[derive(Debug)]
pub(crate) struct GltfScene {
    accessors: Accessors,
    motion: Motion,
    parts: Vec<PlacedPart>,
    skins: Vec<Joints>,
    /// All parts as the nodes stand.
    mesh: Mesh,
    /// Times of the frames [s]; none if nothing moves.
    times: Option<Vec<f64>>,
}

#[derive(Debug)]
struct PlacedPart {
    node: usize,
    part: Part,
    skin: Option<usize>,
    /// Weights of the morph targets where no animation gives others.
    weights: Vec<f64>,
}

/// The joints of a skin: their nodes, and from the mesh to each where it is bound.
#[derive(Debug)]
struct Joints(Vec<(usize, Matrix4<f64>)>);

impl GltfScene {
    /// Reads everything but the displacements of morph targets.
    ///
    /// # Errors
    /// A missing or malformed file, with the line; accessors, meshes and nodes that do not fit, with their
    /// numbers; no meshes.
    pub fn open(path: &Path, options: &FrameOptions) -> Result<Self, IoError> {
        let (mut document, chunk) = document::read(path)?;
        let accessors = Accessors::new(path, &mut document, chunk)?;
        let animations = std::mem::take(&mut document.animations);
        if let [first, _, ..] = animations.as_slice() {
            let name = first.name.as_deref().unwrap_or("nameless");
            tracing::warn!(
                "{}: of {} animations the first, {name}, is taken",
                path.display(),
                animations.len()
            );
        }
        let meshes = std::mem::take(&mut document.meshes);
        let targets = |node: &Node| {
            let mesh = node.mesh.and_then(|mesh| meshes.get(mesh));
            let counts = mesh.map(|mesh| mesh.primitives.iter().map(|primitive| primitive.targets.len()));
            counts.and_then(Iterator::max).unwrap_or(0)
        };
        let motion = Motion::new(&mut document, animations.first(), &accessors, targets)?;
        let skins = skins(&document, &accessors, motion.nodes.len())?;
        let mut scene =
            Self { accessors, motion, parts: Vec::new(), skins, mesh: Mesh::default(), times: None };
        for node in scene.motion.scene().collect::<Vec<_>>() {
            let Node { mesh: Some(mesh), skin, weights, .. } = &scene.motion.nodes[node] else { continue };
            let fault = |message: String| scene.fault(node, message);
            let entry = meshes.get(*mesh).ok_or_else(|| fault(format!("there is no mesh {mesh}")))?;
            let part = Part::read(&scene.accessors, entry, *mesh, skin.is_some(), options.keep_seams)?;
            if let (Some(skin), Some(most)) = (skin, part.most_joint()) {
                let joints = scene.skins.get(*skin).map_or(0, |joints| joints.0.len());
                if most as usize >= joints {
                    return Err(fault(format!("it needs joint {most}, but skin {skin} has {joints} joints")));
                }
            }
            let weights = weights.clone().unwrap_or_else(|| entry.weights.clone());
            scene.parts.push(PlacedPart { node, part, skin: *skin, weights });
        }
        if scene.parts.iter().all(|part| part.part.len() == 0) {
            return Err(IoError::content(path, Place::File, "no meshes in its scene"));
        }
        scene.put_together(&meshes)?;
        let keys = scene.motion.keys();
        scene.times = (!keys.is_empty()).then(|| frame_times(&keys, options.rate));
        Ok(scene)
    }

    /// The mesh as the nodes stand, without animation.
    pub fn into_mesh(self) -> Mesh {
        self.mesh
    }

    fn put_together(&mut self, meshes: &[document::MeshEntry]) -> Result<(), IoError> {
        let pose = self.motion.pose(None, &self.accessors)?;
        let mut builder = PartsBuilder::default();
        let (mut joined, mut dropped) = (0, 0);
        let mut names: Vec<String> = Vec::new();
        for placed in &self.parts {
            let node = &self.motion.nodes[placed.node];
            let of_mesh = node.mesh.and_then(|mesh| meshes.get(mesh)).and_then(|mesh| mesh.name.clone());
            let name = node.name.clone().or(of_mesh).unwrap_or_else(|| format!("node_{}", placed.node));
            let unique = if names.contains(&name) { format!("{name}#{}", placed.node) } else { name };
            names.push(unique.clone());
            let mut mesh = placed.part.elements.clone();
            // The winding of triangles is that of the mesh before it is mirrored (section 3.7.4).
            if !placed.part.is_skinned() && pose.global[placed.node].determinant() < 0.0 {
                mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
            }
            mesh.positions = self.positions(placed, &pose)?;
            if let Some(Extras::Ours { obstacle }) = node.extras {
                mesh.obstacle = Some(vec![obstacle; mesh.positions.len()]);
            }
            joined += placed.part.joined;
            dropped += placed.part.dropped;
            let overflow = || self.fault(placed.node, "more vertices than can be counted in 32 bits");
            builder.add(mesh, unique).ok_or_else(overflow)?;
        }
        self.mesh = builder.finish();
        let path = self.accessors.path.display();
        if joined > 0 {
            let vertices = counted(joined, "vertex", "vertices");
            tracing::info!("{path}: {vertices} joined to others at the same place in all morph targets");
        }
        if dropped > 0 {
            let triangles = counted(dropped, "triangle names", "triangles name");
            tracing::warn!("{path}: {triangles} a vertex twice, so they are left out");
        }
        Ok(())
    }

    fn positions(&self, placed: &PlacedPart, pose: &Pose) -> Result<Vec<Point>, IoError> {
        let weights = pose.weights[placed.node].as_deref().unwrap_or(&placed.weights);
        let mut points = placed.part.morphed(&self.accessors, weights)?;
        match placed.skin.and_then(|skin| self.skins.get(skin)) {
            Some(Joints(joints)) => {
                let matrices: Vec<Matrix4<f64>> =
                    joints.iter().map(|(node, bind)| pose.global[*node] * bind).collect();
                placed.part.skinned(&mut points, &matrices);
            }
            None => place(&pose.global[placed.node], &mut points),
        }
        match points.iter().position(|point| !point.iter().all(|c| c.is_finite())) {
            None => Ok(points),
            Some(vertex) => Err(self.fault(placed.node, format!("vertex {vertex} is not finite"))),
        }
    }

    fn fault(&self, node: usize, message: impl Into<String>) -> IoError {
        IoError::content(&self.accessors.path, Place::Element("node".to_owned(), node), message)
    }
}

/// The skins of a document of so many nodes (section 3.7.3).
fn skins(document: &Document, accessors: &Accessors, nodes: usize) -> Result<Vec<Joints>, IoError> {
    let skins = document.skins.iter().enumerate().map(|(index, skin)| {
        let fault = |message: String| {
            IoError::content(&accessors.path, Place::Element("skin".to_owned(), index), message)
        };
        if let Some(joint) = skin.joints.iter().find(|joint| **joint >= nodes) {
            return Err(fault(format!("its joint is node {joint}, which does not exist")));
        }
        let matrices = match skin.inverse_bind_matrices {
            Some(accessor) => {
                let numbers = accessors.all(accessor, 16)?;
                numbers.chunks_exact(16).map(Matrix4::from_column_slice).collect()
            }
            None => vec![Matrix4::identity(); skin.joints.len()],
        };
        if matrices.len() < skin.joints.len() {
            let joints = counted(skin.joints.len(), "joint", "joints");
            return Err(fault(format!("it has {joints}, but {} inverseBindMatrices", matrices.len())));
        }
        Ok(Joints(skin.joints.iter().copied().zip(matrices).collect()))
    });
    skins.collect()
}

impl Animation for GltfScene {
    fn len(&self) -> usize {
        self.times.as_ref().map_or(1, Vec::len)
    }

    fn times(&self) -> Option<&[f64]> {
        self.times.as_deref()
    }

    fn names(&self) -> &[String] {
        &self.mesh.names
    }

    fn path(&self, _index: usize) -> &Path {
        &self.accessors.path
    }

    fn read(&self, index: usize) -> Result<Mesh, IoError> {
        let Some(times) = &self.times else { return Ok(self.mesh.clone()) };
        let pose = self.motion.pose(Some(times[index]), &self.accessors)?;
        let mut positions = Vec::with_capacity(self.mesh.positions.len());
        for placed in &self.parts {
            positions.append(&mut self.positions(placed, &pose)?);
        }
        Ok(Mesh { positions, ..self.mesh.clone() })
    }
}
