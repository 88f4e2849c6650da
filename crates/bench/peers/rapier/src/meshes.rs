//! Generated meshes: sheets, blocks of tetrahedra, a ball.

pub type Point = [f64; 3];

/// A mesh. A cloth has springs, a solid tetrahedra, an obstacle neither.
#[derive(Clone, Default)]
pub struct Mesh {
    pub points: Vec<Point>,
    pub triangles: Vec<[u32; 3]>,
    pub tets: Vec<[u32; 4]>,
    /// Springs along the sides and both diagonals of the squares, as in rapier's `SoftBodyBuilder::cloth`.
    pub springs: Vec<[u32; 2]>,
    /// Springs to the second neighbors, as there.
    pub bends: Vec<[u32; 2]>,
    /// Distance of neighbors [m].
    pub spacing: f64,
}

impl Mesh {
    pub fn moved(mut self, place: impl Fn(Point) -> Point) -> Self {
        for point in &mut self.points {
            *point = place(*point);
        }
        self
    }

    /// The vertices of the surface, ascending.
    pub fn outside(&self) -> Vec<u32> {
        let mut used = self.triangles.concat();
        used.sort_unstable();
        used.dedup();
        used
    }
}

/// A rectangle in the xy plane about the origin; diagonals alternate.
pub fn sheet(size: [f64; 2], counts: [usize; 2]) -> Mesh {
    let index = |i: usize, j: usize| (i * counts[1] + j) as u32;
    let mut mesh = Mesh { spacing: size[0] / (counts[0] - 1) as f64, ..Mesh::default() };
    for i in 0..counts[0] {
        for j in 0..counts[1] {
            let along = |k: usize, axis: usize| (k as f64 / (counts[axis] - 1) as f64 - 0.5) * size[axis];
            mesh.points.push([along(i, 0), along(j, 1), 0.0]);
            let (a, d) = (index(i, j), index(i, j + 1));
            let (b, c) = (index(i + 1, j), index(i + 1, j + 1));
            let (right, up) = (i + 1 < counts[0], j + 1 < counts[1]);
            if right {
                mesh.springs.push([a, b]);
            }
            if up {
                mesh.springs.push([a, d]);
            }
            if right && up {
                mesh.springs.extend([[a, c], [b, d]]);
                mesh.triangles.extend(if (i + j) % 2 == 0 {
                    [[a, b, c], [a, c, d]]
                } else {
                    [[a, b, d], [b, c, d]]
                });
            }
            if i + 2 < counts[0] {
                mesh.bends.push([a, index(i + 2, j)]);
            }
            if j + 2 < counts[1] {
                mesh.bends.push([a, index(i, j + 2)]);
            }
        }
    }
    mesh
}

/// A box of tetrahedra about the origin: Kuhn's division, one tetrahedron for each order in which the axes are walked.
pub fn block(size: Point, counts: [usize; 3]) -> Mesh {
    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [1, 0, 2], [2, 1, 0]];
    let steps = [counts[1] * counts[2], counts[2], 1];
    let mut mesh = Mesh { spacing: size[0] / (counts[0] - 1) as f64, ..Mesh::default() };
    for corner in 0..counts.iter().product() {
        let at = [corner / steps[0], corner / steps[1] % counts[1], corner % counts[2]];
        mesh.points.push([0, 1, 2].map(|k| (at[k] as f64 / (counts[k] - 1) as f64 - 0.5) * size[k]));
        if (0..3).any(|k| at[k] + 1 == counts[k]) {
            continue;
        }
        for (number, order) in ORDERS.into_iter().enumerate() {
            let mut tet = [corner as u32; 4];
            for (k, axis) in order.into_iter().enumerate() {
                tet[k + 1] = tet[k] + steps[axis] as u32;
            }
            // Walks of odd order have negative volume.
            if number >= 3 {
                tet.swap(0, 1);
            }
            mesh.tets.push(tet);
        }
    }
    mesh.triangles = surface(&mesh.tets);
    mesh
}

/// The faces that one tetrahedron only has, outward.
fn surface(tets: &[[u32; 4]]) -> Vec<[u32; 3]> {
    let mut faces: Vec<[[u32; 3]; 2]> = Vec::new();
    for &[a, b, c, d] in tets {
        for face in [[a, c, b], [a, b, d], [a, d, c], [b, c, d]] {
            let mut key = face;
            key.sort_unstable();
            faces.push([key, face]);
        }
    }
    faces.sort_unstable();
    let alone = faces.chunk_by(|a, b| a[0] == b[0]).filter(|same| same.len() == 1);
    alone.map(|same| same[0][1]).collect()
}

/// A closed sphere about the origin, whose vertices lie on it.
pub fn ball(radius: f64, meridians: u32, parallels: u32) -> Mesh {
    let mut points = vec![[0.0, 0.0, -radius]];
    for ring in 1..parallels {
        let (z, r) = (std::f64::consts::PI * (f64::from(ring) / f64::from(parallels) - 0.5)).sin_cos();
        for k in 0..meridians {
            let (y, x) = (std::f64::consts::TAU * f64::from(k) / f64::from(meridians)).sin_cos();
            points.push([radius * r * x, radius * r * y, radius * z]);
        }
    }
    points.push([0.0, 0.0, radius]);
    let top = points.len() as u32 - 1;
    let mut triangles = Vec::new();
    for k in 0..meridians {
        let next = (k + 1) % meridians;
        triangles.push([0, 1 + next, 1 + k]);
        for ring in 0..parallels - 2 {
            let (a, b) = (1 + ring * meridians, 1 + (ring + 1) * meridians);
            triangles.extend([[a + k, a + next, b + next], [a + k, b + next, b + k]]);
        }
        let last = 1 + (parallels - 2) * meridians;
        triangles.push([last + k, last + next, top]);
    }
    Mesh { points, triangles, ..Mesh::default() }
}
