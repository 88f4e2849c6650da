//! The cells of a grid as elements.

use crate::elements::{Becomes, Elements};
use std::collections::BTreeMap;

/// How the vertices of a cell are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Reading {
    /// As one element, by its corners, which come first.
    Corners(Becomes),
    /// As many elements as there are vertices, pairs of them, or threes, which alternate in orientation.
    Points,
    Chain,
    Strip,
    Polygon,
    /// Its corners, then the middles of its edges.
    QuadraticPolygon,
    /// Two rows of two vertices.
    Pixel,
    Skip,
}

use Becomes::{Line, Point, Quad, Tet, Triangle};
use Reading::{Corners, Skip};

/// Number of a type of cells, how it is read, its name in the plural.
const TYPES: [(u8, Reading, &str); 34] = [
    (0, Skip, "empty cells"),
    (1, Corners(Point), "vertices"),
    (2, Reading::Points, "sets of vertices"),
    (3, Corners(Line), "lines"),
    (4, Reading::Chain, "polylines"),
    (5, Corners(Triangle), "triangles"),
    (6, Reading::Strip, "triangle strips"),
    (7, Reading::Polygon, "polygons"),
    (8, Reading::Pixel, "pixels"),
    (9, Corners(Quad), "quadrilaterals"),
    (10, Corners(Tet), "tetrahedra"),
    (11, Skip, "voxels"),
    (12, Skip, "hexahedra"),
    (13, Skip, "prisms"),
    (14, Skip, "pyramids"),
    (21, Corners(Line), "quadratic lines"),
    (22, Corners(Triangle), "quadratic triangles"),
    (23, Corners(Quad), "quadratic quadrilaterals"),
    (24, Corners(Tet), "quadratic tetrahedra"),
    (25, Skip, "quadratic hexahedra"),
    (26, Skip, "quadratic prisms"),
    (27, Skip, "quadratic pyramids"),
    (28, Corners(Quad), "biquadratic quadrilaterals"),
    (34, Corners(Triangle), "biquadratic triangles"),
    (35, Corners(Line), "cubic lines"),
    (36, Reading::QuadraticPolygon, "quadratic polygons"),
    (42, Skip, "polyhedra"),
    (68, Corners(Line), "Lagrange curves"),
    (69, Corners(Triangle), "Lagrange triangles"),
    (70, Corners(Quad), "Lagrange quadrilaterals"),
    (71, Corners(Tet), "Lagrange tetrahedra"),
    (75, Corners(Line), "Bezier curves"),
    (76, Corners(Triangle), "Bezier triangles"),
    (78, Corners(Tet), "Bezier tetrahedra"),
];

/// The cells of a file.
#[derive(Default)]
pub(super) struct Cells {
    pub elements: Elements,
    /// Number of cells of each type that was skipped or reduced to its corners.
    noted: BTreeMap<u8, usize>,
}

impl Cells {
    /// Takes a cell of these vertices, which must exist.
    pub(super) fn add(&mut self, kind: u8, vertices: &[u32]) -> Result<(), String> {
        let known = TYPES.iter().find(|entry| entry.0 == kind);
        let (reading, name) = known.map_or((Skip, ""), |&(_, reading, name)| (reading, name));
        let elements = &mut self.elements;
        let count = vertices.len();
        let least = match reading {
            Corners(becomes) => becomes.corners(),
            Reading::Polygon | Reading::Strip => 3,
            Reading::QuadraticPolygon => 6,
            Reading::Pixel => 4,
            Reading::Chain => 2,
            Reading::Points => 1,
            Skip => 0,
        };
        if count < least {
            return Err(format!("{count} vertices; {name} have {least} at least"));
        }
        match reading {
            Corners(becomes) => elements.add(becomes, vertices),
            Reading::Points => vertices.iter().for_each(|&v| elements.add(Point, &[v])),
            Reading::Chain => vertices.windows(2).for_each(|pair| elements.add(Line, pair)),
            Reading::Strip => {
                for (index, three) in vertices.windows(3).enumerate() {
                    let [i, j, k] = [three[0], three[1], three[2]];
                    elements.add(Triangle, &if index % 2 == 0 { [i, j, k] } else { [j, i, k] });
                }
            }
            Reading::Polygon => elements.add_polygon(vertices),
            Reading::QuadraticPolygon => elements.add_polygon(&vertices[..count / 2]),
            Reading::Pixel => elements.add(Quad, &[vertices[0], vertices[1], vertices[3], vertices[2]]),
            Skip => {}
        }
        let is_reduced = match reading {
            Corners(becomes) => count > becomes.corners(),
            other => matches!(other, Reading::QuadraticPolygon | Skip),
        };
        if is_reduced {
            *self.noted.entry(kind).or_default() += 1;
        }
        Ok(())
    }

    /// What was skipped or reduced to its corners, in words.
    pub(super) fn notes(&self) -> Vec<String> {
        let note = |(kind, count): (&u8, &usize)| match TYPES.iter().find(|entry| entry.0 == *kind) {
            Some((_, Skip, name)) => format!("skipped {count} {name}"),
            Some((_, _, name)) => format!("took the corners only of {count} {name}"),
            None => format!("skipped {count} of the cell type {kind}"),
        };
        self.noted.iter().map(note).collect()
    }
}
