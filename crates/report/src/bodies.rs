//! The first frame split into bodies.

use bowknot_geometry::Point;
use bowknot_io::Mesh;

/// What `scene.toml` says of a body.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BodyFacts {
    pub(super) name: String,
    /// `cloth`, `solid`, `strands`, `particles`, `obstacle`, `half-space`.
    pub(super) kind: String,
}

/// A body as the page shows it; elements index its own vertices.
#[derive(Clone, Debug, Default)]
pub(super) struct Body {
    pub(super) name: String,
    /// As in [`BodyFacts`]; `mesh` or `obstacle` where the scene does not tell.
    pub(super) kind: String,
    pub(super) obstacle: bool,
    /// Its vertices in the frame.
    pub(super) vertices: Vec<u32>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) strands: Vec<[u32; 2]>,
    pub(super) particles: Vec<u32>,
    /// Corners of the box that holds it in every frame shown [m].
    pub(super) low: Point,
    pub(super) high: Point,
    /// Whether any of its vertices moves at all.
    pub(super) moves: bool,
}

/// Splits a frame by its vertices' bodies; `facts` name them in the order of the world: deformable bodies,
/// obstacles with a mesh, half-spaces. A file without bodies is split into what is obstacle and what is not,
/// one whose elements join bodies is not split.
pub(super) fn split(mesh: &Mesh, facts: &[BodyFacts]) -> Vec<Body> {
    let count = mesh.positions.len();
    let obstacle = mesh.obstacle.clone().unwrap_or_else(|| vec![false; count]);
    let named = mesh.body.is_some();
    let mut body = mesh.body.clone().unwrap_or_else(|| obstacle.iter().map(|&o| u32::from(o)).collect());
    let torn = |vertices: &[u32]| vertices.iter().any(|&v| body[v as usize] != body[vertices[0] as usize]);
    if mesh.triangles.iter().any(|t| torn(t)) || mesh.strands.iter().any(|e| torn(e)) {
        body = vec![0; count];
    }

    // Body numbers come from a file: any u32, in any order.
    let mut numbers = body.clone();
    numbers.sort_unstable();
    numbers.dedup();
    let place = |v: u32| numbers.binary_search(&body[v as usize]).unwrap_or(0);
    let mut bodies: Vec<Body> = numbers.iter().map(|&number| start(number, named, facts)).collect();
    let mut local = vec![0u32; count];
    for vertex in 0..count as u32 {
        let body = &mut bodies[place(vertex)];
        local[vertex as usize] = body.vertices.len() as u32;
        body.vertices.push(vertex);
        body.obstacle |= obstacle[vertex as usize];
    }
    for triangle in &mesh.triangles {
        bodies[place(triangle[0])].triangles.push(triangle.map(|v| local[v as usize]));
    }
    for edge in &mesh.strands {
        bodies[place(edge[0])].strands.push(edge.map(|v| local[v as usize]));
    }
    for &vertex in &mesh.particles {
        bodies[place(vertex)].particles.push(local[vertex as usize]);
    }
    for body in &mut bodies {
        if body.kind.is_empty() {
            body.kind = if body.obstacle { "obstacle" } else { "mesh" }.to_owned();
        }
        let first = mesh.positions[body.vertices[0] as usize];
        (body.low, body.high) = (first, first);
    }
    bodies
}

fn start(number: u32, named: bool, facts: &[BodyFacts]) -> Body {
    let known = facts.get(number as usize).filter(|_| named);
    Body {
        name: known.map_or_else(|| format!("body {number}"), |f| f.name.clone()),
        kind: known.map_or_else(String::new, |f| f.kind.clone()),
        ..Body::default()
    }
}

impl Body {
    /// Grows the box by a frame, and notes whether anything has moved since the `first`.
    pub(super) fn take(&mut self, positions: &[Point], first: &[Point]) {
        for &vertex in &self.vertices {
            let p = &positions[vertex as usize];
            self.low = self.low.inf(p);
            self.high = self.high.sup(p);
            self.moves |= *p != first[vertex as usize];
        }
    }
}
