//! Normals of a surface in any state.

use super::polygons::{Corner, Surface};
use bowknot_geometry::{Point, Vector};

impl Surface {
    /// The normals that corners refer to, of length 1: the mean of the normals of the polygons that share
    /// them, weighted by the angles of their corners, as modeling tools do it. Where that is zero, the z
    /// axis.
    pub fn normals(&self, positions: &[Point]) -> Vec<Vector> {
        let mut sums = vec![Vector::zeros(); self.normal_count()];
        for polygon in self.polygons() {
            let normal = flat_normal(polygon.corners, positions);
            let count = polygon.corners.len();
            for (k, corner) in polygon.corners.iter().enumerate() {
                let Some(number) = corner.normal() else { continue };
                let [before, after] = [k + count - 1, k + 1].map(|j| &polygon.corners[j % count]);
                sums[number as usize] += normal * angle([before, corner, after], positions);
            }
        }
        sums.iter().map(unit).collect()
    }

    /// The normal of every corner: the one that it refers to, else that of its polygon.
    pub fn corner_normals(&self, positions: &[Point]) -> Vec<Vector> {
        let normals = self.normals(positions);
        let mut all = Vec::with_capacity(self.corners.len());
        for polygon in self.polygons() {
            let flat = || unit(&flat_normal(polygon.corners, positions));
            let own = |corner: &Corner| corner.normal().map(|number| normals[number as usize]);
            all.extend(polygon.corners.iter().map(|corner| own(corner).unwrap_or_else(flat)));
        }
        all
    }
}

/// The unit normal of a polygon, of which nothing is said if it is not flat; zero if it has no area.
fn flat_normal(corners: &[Corner], positions: &[Point]) -> Vector {
    let origin = place(&corners[0], positions);
    let arm = |corner: &Corner| place(corner, positions) - origin;
    let area: Vector = corners[1..].windows(2).map(|pair| arm(&pair[0]).cross(&arm(&pair[1]))).sum();
    area.try_normalize(0.0).unwrap_or_default()
}

/// The angle between the two edges at the middle corner; 0 if one has no length.
fn angle(corners: [&Corner; 3], positions: &[Point]) -> f64 {
    let [before, here, after] = corners.map(|corner| place(corner, positions));
    let (a, b) = (before - here, after - here);
    a.cross(&b).norm().atan2(a.dot(&b))
}

fn unit(vector: &Vector) -> Vector {
    vector.try_normalize(0.0).unwrap_or_else(Vector::z)
}

fn place(corner: &Corner, positions: &[Point]) -> Point {
    positions[corner.vertex as usize]
}
