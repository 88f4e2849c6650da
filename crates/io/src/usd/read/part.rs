//! From a prim to the elements of a part.

use super::layer::{Attribute, Prim, Value};
use super::text::Arrays;
use crate::error::IoError;
use crate::mesh::Mesh;
use crate::surface::{Corner, Labels, Surface};
use crate::usd::names::OBSTACLE;
use bowknot_errors::counted;

/// Kinds of prims that are parts of a mesh.
const KINDS: [&str; 4] = ["Mesh", "TetMesh", "BasisCurves", "Points"];

/// The kind of prims that are subsets of the mesh that they are in.
pub(super) const SUBSET: &str = "GeomSubset";

/// Whether prims of this kind are parts of a mesh.
pub(super) fn is_part(kind: &str) -> bool {
    KINDS.contains(&kind)
}

/// Whether prims of this kind are seen but are no meshes, so that leaving them out must be said.
pub(super) fn is_other_shape(kind: &str) -> bool {
    const OTHERS: [&str; 13] = [
        "Cube",
        "Sphere",
        "Cylinder",
        "Cylinder_1",
        "Capsule",
        "Capsule_1",
        "Cone",
        "Plane",
        "NurbsPatch",
        "NurbsCurves",
        "HermiteCurves",
        "PointInstancer",
        "Volume",
    ];
    OTHERS.contains(&kind)
}

/// The elements of a prim, over `points` points, without positions. If the prim is `mirrored`, its faces are turned
/// round.
///
/// # Errors
/// Arrays that are missing, do not fit to each other, change with time, or name points that do not exist.
pub(super) fn elements(
    arrays: &Arrays,
    path: &str,
    prim: &Prim,
    points: usize,
    mirrored: bool,
) -> Result<Mesh, IoError> {
    let reader = Reader { arrays, path, prim, points, mirrored };
    let mut mesh = Mesh::default();
    match prim.kind.as_str() {
        "Mesh" => reader.faces(&mut mesh)?,
        "TetMesh" => {
            let indices = reader.indices("tetVertexIndices")?;
            let (tets, rest) = indices.as_chunks::<4>();
            if !rest.is_empty() {
                return Err(reader.fault("tetVertexIndices needs 4 points for each tetrahedron"));
            }
            mesh.tets = tets.to_vec();
        }
        "BasisCurves" => reader.curves(&mut mesh)?,
        _ => mesh.particles = (0..points as u32).collect(),
    }
    if let Some(Value::Numbers(flag)) = prim.attributes.get(OBSTACLE).and_then(Attribute::first) {
        mesh.obstacle = Some(vec![flag.first() == Some(&1.0); points]);
    }
    Ok(mesh)
}

struct Reader<'a> {
    arrays: &'a Arrays,
    path: &'a str,
    prim: &'a Prim,
    points: usize,
    mirrored: bool,
}

impl Reader<'_> {
    fn faces(&self, mesh: &mut Mesh) -> Result<(), IoError> {
        let counts = self.counts("faceVertexCounts", 3)?;
        let indices = self.indices("faceVertexIndices")?;
        let mut rest = indices.as_slice();
        let flipped = self.prim.text("orientation") == Some("leftHanded");
        let flipped = flipped != self.mirrored;
        for (face, &count) in counts.iter().enumerate() {
            let Some((corners, others)) = rest.split_at_checked(count) else {
                return Err(self.fault(format!("face {face} has {count} points, {} are left", rest.len())));
            };
            rest = others;
            let mut corners = corners.to_vec();
            if flipped {
                corners[1..].reverse();
            }
            if count > 3 {
                mesh.surface.get_or_insert_with(|| Surface::of_triangles(&mesh.triangles));
            }
            if let Some(surface) = &mut mesh.surface {
                surface.push(corners.iter().map(|&v| Corner::new(v, None, None)), &Labels::default());
            }
            mesh.triangles.extend(corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]));
        }
        match rest.len() {
            0 => Ok(()),
            left => Err(self.fault(format!("{} of faceVertexIndices belong to no face", left))),
        }
    }

    fn curves(&self, mesh: &mut Mesh) -> Result<(), IoError> {
        let counts = self.counts("curveVertexCounts", 2)?;
        let closed = self.prim.text("wrap") == Some("periodic");
        let mut first = 0;
        for count in counts {
            let end = first + count;
            if end > self.points {
                let points = counted(self.points, "point", "points");
                return Err(self.fault(format!("curveVertexCounts needs {end} points, it has {points}")));
            }
            mesh.strands.extend((first as u32 + 1..end as u32).map(|v| [v - 1, v]));
            if closed && count > 2 {
                mesh.strands.push([end as u32 - 1, first as u32]);
            }
            first = end;
        }
        Ok(())
    }

    /// An array of counts, each at least so large.
    fn counts(&self, name: &str, least: usize) -> Result<Vec<usize>, IoError> {
        let counts = self.whole(name)?;
        let fault = |count: &f64| self.fault(format!("{name} has {count}, at least {least} are needed"));
        counts.iter().map(|n| if *n >= least as f64 { Ok(*n as usize) } else { Err(fault(n)) }).collect()
    }

    /// An array of indices of points.
    fn indices(&self, name: &str) -> Result<Vec<u32>, IoError> {
        let indices = self.whole(name)?;
        let fault = |index: &f64| {
            let points = counted(self.points, "point", "points");
            self.fault(format!("{name} has {index}, but there are {points}, counted from 0"))
        };
        let index =
            |n: &f64| if (0.0..self.points as f64).contains(n) { Ok(*n as u32) } else { Err(fault(n)) };
        indices.iter().map(index).collect()
    }

    /// An array of whole numbers that does not change.
    fn whole(&self, name: &str) -> Result<Vec<f64>, IoError> {
        let attribute = self.prim.attributes.get(name);
        let read = |value: Option<&Value>| match value {
            Some(Value::Array(place)) => self.arrays.read(place),
            _ => Err(self.fault(format!("{name} is missing"))),
        };
        let first = read(attribute.and_then(Attribute::first))?;
        for (code, value) in attribute.map_or(&[][..], |attribute| &attribute.samples) {
            if read(Some(value))? != first {
                let message = format!(
                    "{name} changes at time code {code}: all frames must have the same elements; export a \
                     mesh file for each frame"
                );
                return Err(self.fault(message));
            }
        }
        match first.iter().find(|n| n.fract() != 0.0 || n.abs() > f64::from(i32::MAX)) {
            None => Ok(first),
            Some(number) => Err(self.fault(format!("{name} has {number}, which is no 32-bit whole number"))),
        }
    }

    fn fault(&self, message: impl Into<String>) -> IoError {
        self.arrays.fault(self.path, message)
    }
}
