//! The mesh of a node (section 3.7): its elements, its morph targets, its skin.

use super::accessors::Accessors;
use super::document::{MeshEntry, Primitive};
use crate::error::{IoError, Place};
use crate::mesh::Mesh;
use bowknot_geometry::Point;
use std::collections::HashMap;

/// A mesh whose vertices are joined, and where its points come from.
#[derive(Debug)]
pub(super) struct Part {
    /// The elements, over no positions.
    pub elements: Mesh,
    /// Positions without morph targets.
    rest: Vec<Point>,
    /// For each vertex its first among those of the file, which are counted over all primitives.
    first: Vec<u32>,
    /// Of each primitive: its vertices, and the accessors of the displacements of each morph target.
    primitives: Vec<(usize, Vec<Option<usize>>)>,
    /// For each vertex the joints that move it and their weights; none: it has no skin.
    skin: Option<Vec<Vec<(u32, f64)>>>,
    pub targets: usize,
    /// Vertices that were joined to others.
    pub joined: usize,
    /// Triangles that name a vertex twice and are left out.
    pub dropped: usize,
}

const POSITION: &str = "POSITION";

impl Part {
    /// Reads a mesh. Vertices with the same bits in their positions, all displacements and their skin are
    /// joined, unless `keep_seams`.
    ///
    /// # Errors
    /// Attributes that are missing or do not fit, indices out of range, unknown modes.
    pub fn read(
        accessors: &Accessors,
        entry: &MeshEntry,
        index: usize,
        skinned: bool,
        keep_seams: bool,
    ) -> Result<Self, IoError> {
        let fault = |message: String| {
            IoError::content(&accessors.path, Place::Element("mesh".to_owned(), index), message)
        };
        let targets = entry.primitives.iter().map(|primitive| primitive.targets.len()).max().unwrap_or(0);
        let mut part = Self {
            elements: Mesh::default(),
            rest: Vec::new(),
            first: Vec::new(),
            primitives: Vec::new(),
            skin: skinned.then(Vec::new),
            targets,
            joined: 0,
            dropped: 0,
        };
        for primitive in &entry.primitives {
            let position = primitive.attributes.get(POSITION);
            let position = *position.ok_or_else(|| fault("a primitive has no POSITION".to_owned()))?;
            let numbers = accessors.all(position, 3)?;
            let points = numbers.as_chunks::<3>().0;
            let start = part.rest.len();
            if start + points.len() > u32::MAX as usize {
                return Err(fault("more vertices than can be counted in 32 bits".to_owned()));
            }
            part.rest.extend(points.iter().map(|&point| Point::from(point)));
            let of_target = |k: usize| primitive.targets.get(k)?.get(POSITION).copied();
            part.primitives.push((points.len(), (0..targets).map(of_target).collect()));
            if let Some(skin) = &mut part.skin {
                read_skin(accessors, primitive, points.len(), skin)?;
            }
            let indices = match primitive.indices {
                Some(indices) => accessors.all(indices, 1)?,
                None => (0..points.len()).map(|v| v as f64).collect(),
            };
            let vertices: Option<Vec<u32>> = indices
                .iter()
                .map(|&v| (v < points.len() as f64).then_some((start as f64 + v) as u32))
                .collect();
            let vertices = vertices.ok_or_else(|| {
                fault(format!("an index is not below the {} vertices of its primitive", points.len()))
            })?;
            add_elements(&mut part.elements, primitive.mode, &vertices).map_err(fault)?;
        }
        part.first = (0..part.rest.len() as u32).collect();
        if !keep_seams {
            part.join(accessors)?;
        }
        let count = part.elements.triangles.len();
        part.elements.triangles.retain(|[a, b, c]| a != b && b != c && c != a);
        part.dropped = count - part.elements.triangles.len();
        part.elements.strands.retain(|[a, b]| a != b);
        part.elements.particles.sort_unstable();
        part.elements.particles.dedup();
        Ok(part)
    }

    /// Number of vertices.
    pub fn len(&self) -> usize {
        self.rest.len()
    }

    /// Whether joints move it.
    pub fn is_skinned(&self) -> bool {
        self.skin.is_some()
    }

    /// Joints that move it must be below this.
    pub fn most_joint(&self) -> Option<u32> {
        self.skin.iter().flatten().flatten().map(|(joint, _)| *joint).max()
    }

    /// Positions with morph targets of these weights.
    ///
    /// # Errors
    /// Displacements that are not in their buffer.
    pub fn morphed(&self, accessors: &Accessors, weights: &[f64]) -> Result<Vec<Point>, IoError> {
        let mut points = self.rest.clone();
        for (target, &weight) in weights.iter().enumerate().take(self.targets) {
            if weight != 0.0 {
                let displacements = self.displacements(accessors, target)?;
                for (point, &first) in points.iter_mut().zip(&self.first) {
                    let [x, y, z] = displacements[first as usize];
                    point.x += weight * x;
                    point.y += weight * y;
                    point.z += weight * z;
                }
            }
        }
        Ok(points)
    }

    /// Moves points by the joints of the skin, whose matrices are given.
    pub fn skinned(&self, points: &mut [Point], joints: &[bowknot_geometry::nalgebra::Matrix4<f64>]) {
        for (point, influences) in points.iter_mut().zip(self.skin.iter().flatten()) {
            // A vertex without weights stays.
            if influences.is_empty() {
                continue;
            }
            let moved = influences
                .iter()
                .map(|&(joint, weight)| (joints[joint as usize] * point.to_homogeneous()).xyz() * weight);
            *point = Point::from(moved.sum::<bowknot_geometry::Vector>());
        }
    }

    /// Displacements of a target, of all vertices of the file.
    fn displacements(&self, accessors: &Accessors, target: usize) -> Result<Vec<[f64; 3]>, IoError> {
        let mut all = Vec::new();
        for (count, targets) in &self.primitives {
            match targets[target] {
                Some(accessor) => {
                    if accessors.count(accessor, 3)? != *count {
                        let message = format!("a morph target of {count} vertices needs as many elements");
                        return Err(accessors.fault(accessor, message));
                    }
                    all.extend_from_slice(accessors.rows(accessor, 3, 0, *count)?.as_chunks::<3>().0);
                }
                None => all.resize(all.len() + count, [0.0; 3]),
            }
        }
        Ok(all)
    }

    /// Joins vertices that are the same in everything that moves them. One morph target is in memory.
    fn join(&mut self, accessors: &Accessors) -> Result<(), IoError> {
        let mut classes = Classes { class: vec![0; self.rest.len()] };
        classes.refine(|v| self.rest[v].coords.map(f64::to_bits).into());
        for target in 0..self.targets {
            let displacements = self.displacements(accessors, target)?;
            classes.refine(|v| displacements[v].map(f64::to_bits));
        }
        if let Some(skin) = &self.skin {
            classes.refine_by(|v| {
                skin[v].iter().map(|(joint, weight)| (*joint, weight.to_bits())).collect::<Vec<_>>()
            });
        }
        let class = classes.class;
        // Classes are numbered in the order of their first vertices.
        let mut first: Vec<u32> = Vec::new();
        for (vertex, class) in class.iter().enumerate() {
            if *class as usize == first.len() {
                first.push(vertex as u32);
            }
        }
        self.joined = class.len() - first.len();
        self.rest = first.iter().map(|&v| self.rest[v as usize]).collect();
        if let Some(skin) = &mut self.skin {
            *skin = first.iter().map(|&v| std::mem::take(&mut skin[v as usize])).collect();
        }
        self.first = first;
        let renumber = |v: &mut u32| *v = class[*v as usize];
        self.elements.triangles.iter_mut().flatten().for_each(renumber);
        self.elements.strands.iter_mut().flatten().for_each(renumber);
        self.elements.particles.iter_mut().for_each(renumber);
        Ok(())
    }
}

/// Which vertices are the same so far.
struct Classes {
    class: Vec<u32>,
}

impl Classes {
    fn refine(&mut self, key: impl Fn(usize) -> [u64; 3]) {
        self.refine_by(key);
    }

    /// Takes vertices of different keys apart. Classes are numbered anew in the order of their vertices.
    fn refine_by<K: std::hash::Hash + Eq>(&mut self, key: impl Fn(usize) -> K) {
        let mut numbers = HashMap::new();
        for (vertex, class) in self.class.iter_mut().enumerate() {
            let next = numbers.len() as u32;
            *class = *numbers.entry((*class, key(vertex))).or_insert(next);
        }
    }
}

/// The joints and weights of the vertices of a primitive, up to eight each in the sets that it has.
fn read_skin(
    accessors: &Accessors,
    primitive: &Primitive,
    count: usize,
    skin: &mut Vec<Vec<(u32, f64)>>,
) -> Result<(), IoError> {
    let start = skin.len();
    skin.resize(start + count, Vec::new());
    for set in 0.. {
        let of = |name: &str| primitive.attributes.get(&format!("{name}_{set}")).copied();
        let (Some(joints), Some(weights)) = (of("JOINTS"), of("WEIGHTS")) else { break };
        for accessor in [joints, weights] {
            if accessors.count(accessor, 4)? != count {
                return Err(
                    accessors.fault(accessor, format!("a skin of {count} vertices needs as many elements"))
                );
            }
        }
        let (joints, weights) = (accessors.all(joints, 4)?, accessors.all(weights, 4)?);
        for (k, (joint, weight)) in joints.iter().zip(&weights).enumerate() {
            if *weight != 0.0 {
                skin[start + k / 4].push((*joint as u32, *weight));
            }
        }
    }
    Ok(())
}

/// The elements of a primitive of a mode (section 3.7.2.1).
fn add_elements(mesh: &mut Mesh, mode: u32, vertices: &[u32]) -> Result<(), String> {
    let edges = vertices.windows(2).map(|pair| [pair[0], pair[1]]);
    match mode {
        0 => mesh.particles.extend(vertices),
        1 => mesh.strands.extend(vertices.as_chunks::<2>().0),
        2 => {
            mesh.strands.extend(edges);
            mesh.strands.extend(vertices.last().zip(vertices.first()).map(|(&last, &first)| [last, first]));
        }
        3 => mesh.strands.extend(edges),
        4 => mesh.triangles.extend(vertices.as_chunks::<3>().0),
        5 => mesh.triangles.extend(vertices.windows(3).enumerate().map(|(k, v)| match k % 2 {
            0 => [v[0], v[1], v[2]],
            _ => [v[0], v[2], v[1]],
        })),
        6 => mesh.triangles.extend(vertices.windows(2).skip(1).map(|v| [vertices[0], v[0], v[1]])),
        _ => return Err(format!("mode {mode} of a primitive is none of 0 to 6")),
    }
    Ok(())
}
