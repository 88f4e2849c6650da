//! Elements as users know them: by their part and their numbers within it.

use crate::check::{Intersection, PairClass, PathHit};
use crate::io::Mesh;
use serde::Serialize;
use std::collections::HashMap;
use std::fmt;

/// An element of a part.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PartElement {
    /// The name of the part; "half-space" for those.
    pub part: String,
    /// "edge", "triangle", "vertex" or "half-space".
    pub kind: &'static str,
    /// Its number among the triangles or vertices of the part; none for edges, which files do not number.
    pub number: Option<u32>,
    /// Its vertices, by their numbers among those of the part.
    pub vertices: Vec<u32>,
}

/// Numbers of vertices and triangles within the parts of a mesh.
pub(super) struct PartNumbers<'a> {
    mesh: &'a Mesh,
    vertices: Vec<u32>,
    /// By their vertices, in any order; of triangles that are there twice the first.
    triangles: HashMap<[u32; 3], u32>,
}

impl<'a> PartNumbers<'a> {
    /// Of a mesh whose vertices have parts.
    pub fn new(mesh: &'a Mesh) -> Self {
        let part = |v: u32| mesh.body.as_ref().map_or(0, |body| body[v as usize]);
        let vertices = numbers(mesh.body.iter().flatten().copied());
        let of_triangles = numbers(mesh.triangles.iter().map(|triangle| part(triangle[0])));
        let mut triangles = HashMap::with_capacity(mesh.triangles.len());
        for (triangle, number) in mesh.triangles.iter().zip(of_triangles) {
            triangles.entry(sorted(*triangle)).or_insert(number);
        }
        Self { mesh, vertices, triangles }
    }

    /// The two elements of an intersection.
    pub fn of(&self, found: &Intersection) -> [PartElement; 2] {
        self.pair(found.class, &found.vertices, found.bodies)
    }

    /// The two elements of a hit.
    pub fn of_hit(&self, found: &PathHit) -> [PartElement; 2] {
        self.pair(found.class, &found.vertices, found.bodies)
    }

    fn pair(&self, class: PairClass, vertices: &[Vec<u32>; 2], bodies: [Option<u32>; 2]) -> [PartElement; 2] {
        [0, 1].map(|side| {
            let given = &vertices[side];
            let own: Vec<u32> =
                given.iter().map(|&v| self.vertices.get(v as usize).copied().unwrap_or(v)).collect();
            let number = match given.as_slice() {
                [_] => own.first().copied(),
                &[i, j, k] => self.triangles.get(&sorted([i, j, k])).copied(),
                _ => None,
            };
            let part = part_name(bodies[side], &self.mesh.names);
            PartElement { part, kind: class.sides()[side], number, vertices: own }
        })
    }
}

/// The numbers of things within their parts.
fn numbers(parts: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut counts: HashMap<u32, u32> = HashMap::new();
    let number = |part| {
        let count = counts.entry(part).or_default();
        *count += 1;
        *count - 1
    };
    parts.map(number).collect()
}

impl fmt::Display for PartElement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { part, kind, number, vertices } = self;
        match (number, vertices.as_slice()) {
            (Some(number), [_]) => write!(f, "{kind} {number} of {part}"),
            (Some(number), list) => write!(f, "{kind} {number} (vertices {list:?}) of {part}"),
            (None, []) => write!(f, "{part}"),
            (None, list) => write!(f, "{kind} {list:?} of {part}"),
        }
    }
}

/// The name of a part; half-spaces have none.
pub(super) fn part_name(body: Option<u32>, names: &[String]) -> String {
    match body {
        None => "half-space".to_owned(),
        Some(body) => names.get(body as usize).cloned().unwrap_or_else(|| format!("body {body}")),
    }
}

fn sorted(mut triangle: [u32; 3]) -> [u32; 3] {
    triangle.sort_unstable();
    triangle
}
