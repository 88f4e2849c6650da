//! How thick a solid is, in elements.

use bowknot_geometry::{Point, Vector, boundary_triangles};

/// Fewer elements than this across a body that bends are too few for linear tetrahedra.
const FEW: f64 = 3.0;
/// A body bends if it is longer than this many times its thickness.
const SLENDER: f64 = 4.0;
/// Most tetrahedra that a line crosses; what is thicker than that is not thin.
const MOST: usize = 64;

/// The faces of a tetrahedron, by the vertex that each leaves out.
const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]];

/// How many elements thick a slender solid is, if that is fewer than three: the median over the triangles of
/// its surface of the way through it along their normals, over the size of the elements on the way. The size
/// of a tetrahedron is the edge of the cube that six such fill.
pub(super) fn few_elements_across(x: &[Point], tets: &[[u32; 4]]) -> Option<f64> {
    let faces = faces(tets);
    let lines = boundary_triangles(tets).into_iter().filter_map(|t| through(x, tets, &faces, t));
    let mut lines: Vec<(f64, f64)> = lines.collect();
    if lines.is_empty() {
        return None;
    }
    let middle = lines.len() / 2;
    let length = lines.select_nth_unstable_by(middle, |a, b| a.0.total_cmp(&b.0)).1.0;
    let elements = lines.select_nth_unstable_by(middle, |a, b| a.1.total_cmp(&b.1)).1.1;
    let (low, high) = super::bounds(x);
    (elements < FEW && (high - low).max() > SLENDER * length).then_some(elements)
}

/// The faces with a tetrahedron at each, ascending.
fn faces(tets: &[[u32; 4]]) -> Vec<([u32; 3], usize)> {
    let of = |(index, tet): (usize, &[u32; 4])| FACES.map(|face| (sorted(face.map(|k| tet[k])), index));
    let mut faces: Vec<([u32; 3], usize)> = tets.iter().enumerate().flat_map(of).collect();
    faces.sort_unstable();
    faces
}

/// The tetrahedra at a face.
fn at_face(faces: &[([u32; 3], usize)], face: [u32; 3]) -> impl Iterator<Item = usize> + '_ {
    let first = faces.partition_point(|(other, _)| *other < face);
    faces[first..].iter().take_while(move |(other, _)| *other == face).map(|(_, tet)| *tet)
}

fn sorted(mut face: [u32; 3]) -> [u32; 3] {
    face.sort_unstable();
    face
}

/// The way through a solid from the middle of a triangle of its surface, against the triangle's normal [m],
/// and that in elements.
fn through(
    x: &[Point],
    tets: &[[u32; 4]],
    faces: &[([u32; 3], usize)],
    triangle: [u32; 3],
) -> Option<(f64, f64)> {
    let normal =
        |[a, b, c]: [u32; 3]| (x[b as usize] - x[a as usize]).cross(&(x[c as usize] - x[a as usize]));
    let [a, b, c] = triangle.map(|v| x[v as usize].coords);
    let start = Point::from((a + b + c) / 3.0);
    let direction: Vector = -normal(triangle).try_normalize(0.0)?;
    let (mut face, mut tet) = (sorted(triangle), at_face(faces, sorted(triangle)).next()?);
    let (mut length, mut sizes, mut count) = (0.0, 0.0, 0usize);
    loop {
        let corners = tets[tet];
        let [p, q, r, s] = corners.map(|v| x[v as usize]);
        sizes += libm::cbrt((q - p).cross(&(r - p)).dot(&(s - p)).abs());
        count += 1;
        // It leaves by the nearest of the other faces that it runs toward.
        let exits = FACES.into_iter().enumerate().filter_map(|(apex, places)| {
            let other = places.map(|k| corners[k]);
            let normal = normal(other);
            let base = x[other[0] as usize];
            let outward =
                if normal.dot(&(x[corners[apex] as usize] - base)) > 0.0 { -normal } else { normal };
            let speed = outward.dot(&direction);
            let way = outward.dot(&(base - start)) / speed;
            (speed > 0.0 && sorted(other) != face).then(|| (way, sorted(other)))
        });
        let (way, exit) = exits.min_by(|a, b| a.0.total_cmp(&b.0))?;
        length = way.max(length);
        face = exit;
        match at_face(faces, face).find(|other| *other != tet) {
            Some(next) if count < MOST => tet = next,
            _ => return Some((length, length * count as f64 / sizes)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{Block, TetBall};

    fn across(size: [f64; 3], edge: f64) -> Option<f64> {
        let mesh = Block { size, edge }.mesh();
        few_elements_across(&mesh.positions, &mesh.tets)
    }

    #[test]
    fn thin_blocks_are_counted_in_elements() {
        for (edge, elements) in [(0.02, 1.0), (0.01, 2.0)] {
            for size in [[0.2, 0.02, 0.02], [0.02, 0.2, 0.2]] {
                let found = across(size, edge).expect("it is thin");
                assert!((found / elements - 1.0).abs() < 0.1, "{size:?}, {edge}: {found}");
            }
        }
    }

    #[test]
    fn what_is_thick_or_does_not_bend_is_left_out() {
        assert_eq!(across([0.2, 0.02, 0.02], 0.005), None, "four elements thick");
        assert_eq!(across([0.06, 0.02, 0.02], 0.02), None, "three times as long as thick");
        assert_eq!(across([0.1; 3], 0.05), None, "a cube");
        let ball = TetBall::default().mesh();
        assert_eq!(few_elements_across(&ball.positions, &ball.tets), None);
    }
}
