//! What is the same in all frames of a run.

use bowknot_geometry::{HalfSpace, Point, Vector};
use bowknot_io::{Corner, Labels, Mesh, MeshView, Surface};
use bowknot_scene::world::World;

/// Elements, bodies and their names; half-spaces as quads.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub triangles: Vec<[u32; 3]>,
    pub strands: Vec<[u32; 2]>,
    pub particles: Vec<u32>,
    quads: Vec<[u32; 4]>,
    /// Corners of the quads, which follow the world's vertices [m].
    corners: Vec<Point>,
    pub obstacle: Vec<bool>,
    pub body: Vec<u32>,
    /// The polygons of all triangles and quads, if a mesh says more about its faces.
    surface: Option<Surface>,
    /// Names of the bodies, in the order of their numbers; there may be fewer than bodies.
    names: Vec<String>,
}

/// The elements of one body over its own vertices.
#[derive(Clone, Debug, Default)]
pub(super) struct Part {
    pub name: String,
    pub obstacle: bool,
    /// The body's vertices, ascending.
    pub vertices: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    quads: Vec<[u32; 4]>,
    strands: Vec<[u32; 2]>,
    particles: Vec<u32>,
    surface: Option<Surface>,
}

impl Layout {
    pub fn new(world: &World) -> Self {
        let topology = world.collision.topology();
        let names = world.bodies.iter().map(|b| b.name.clone()).chain(world.half_space_names.iter().cloned());
        let mut layout = Self {
            triangles: topology.triangles.clone(),
            strands: topology.strand_edges.iter().map(|&e| topology.edges[e as usize]).collect(),
            particles: topology.particles.clone(),
            quads: Vec::new(),
            corners: Vec::new(),
            obstacle: (0..topology.vertex_count as u32).map(|v| world.collision.is_obstacle(v)).collect(),
            body: world.collision.vertex_body().to_vec(),
            surface: None,
            names: names.collect(),
        };
        let (low, high) = world.bounds();
        let center = nalgebra::center(&low, &high);
        // Wide enough that what happens in a run happens above it.
        let half_size = 2.0 * (high - low).norm().max(0.5);
        for (index, half_space) in world.collision.half_spaces().iter().enumerate() {
            let first = layout.vertices() as u32;
            layout.quads.push([first, first + 1, first + 2, first + 3]);
            layout.corners.extend(quad(half_space, &center, half_size));
            layout.obstacle.extend([true; 4]);
            layout.body.extend([(world.bodies.len() + index) as u32; 4]);
        }
        layout.surface = surface(world, &layout.triangles, &layout.quads);
        layout
    }

    /// The layout of frames that are like this one, with the polygons of its triangles if they are known.
    pub fn of_mesh(mesh: &Mesh, surface: Option<Surface>, names: Vec<String>) -> Self {
        let count = mesh.positions.len();
        Self {
            triangles: mesh.triangles.clone(),
            strands: mesh.strands.clone(),
            particles: mesh.particles.clone(),
            quads: Vec::new(),
            corners: Vec::new(),
            obstacle: mesh.obstacle.clone().unwrap_or_else(|| vec![false; count]),
            body: mesh.body.clone().unwrap_or_else(|| vec![0; count]),
            surface,
            names,
        }
    }

    /// Vertices of a frame.
    pub fn vertices(&self) -> usize {
        self.obstacle.len()
    }

    /// Whether frames hold more about their faces than the PLY format does.
    pub fn has_surface(&self) -> bool {
        self.surface.is_some()
    }

    /// The world's positions, those inside of solids left out, and the corners of the quads. Obstacles and
    /// half-spaces that are not `present` (one entry per body, then per half-space) have all their vertices
    /// at their first one's place: they keep their elements, of which nothing is seen.
    pub fn with_corners(&self, positions: &[Point], present: &[bool]) -> Vec<Point> {
        let collide = self.obstacle.len() - self.corners.len();
        let mut all = [&positions[..collide], &self.corners].concat();
        for v in 1..all.len() {
            let body = self.body[v];
            if body == self.body[v - 1] && present.get(body as usize) == Some(&false) {
                all[v] = all[v - 1];
            }
        }
        all
    }

    pub fn view<'a>(&'a self, positions: &'a [Point]) -> MeshView<'a> {
        MeshView {
            positions,
            triangles: &self.triangles,
            quads: &self.quads,
            strands: &self.strands,
            particles: &self.particles,
            obstacle: &self.obstacle,
            body: &self.body,
            names: &self.names,
            surface: self.surface.as_ref(),
            ..MeshView::default()
        }
    }

    /// The bodies that have vertices, by their numbers. An element belongs to the body of its first vertex.
    pub fn parts(&self) -> Vec<Part> {
        // Any numbers may stand in a file.
        let mut numbers = self.body.clone();
        numbers.sort_unstable();
        numbers.dedup();
        let place = |number: &u32| numbers.partition_point(|other| other < number) as u32;
        let bodies: Vec<u32> = self.body.iter().map(place).collect();
        let mut parts = vec![Part::default(); numbers.len()];
        let mut local = Vec::with_capacity(self.body.len());
        for (vertex, body) in bodies.iter().enumerate() {
            let part = &mut parts[*body as usize];
            local.push(part.vertices.len() as u32);
            part.vertices.push(vertex as u32);
            part.obstacle = self.obstacle[vertex];
        }
        if let Some(surface) = &self.surface {
            let surfaces = surface.split(&bodies, &local, numbers.len());
            parts.iter_mut().zip(surfaces).for_each(|(part, surface)| part.surface = surface);
        }
        let owner = |element: &[u32]| bodies[element[0] as usize];
        let local = |v: u32| local[v as usize];
        self.triangles.iter().for_each(|t| parts[owner(t) as usize].triangles.push(t.map(local)));
        self.quads.iter().for_each(|q| parts[owner(q) as usize].quads.push(q.map(local)));
        self.strands.iter().for_each(|e| parts[owner(e) as usize].strands.push(e.map(local)));
        self.particles.iter().for_each(|&p| parts[owner(&[p]) as usize].particles.push(local(p)));
        for (number, part) in numbers.iter().zip(&mut parts) {
            part.name = self.names.get(*number as usize).cloned().unwrap_or_else(|| format!("body_{number}"));
        }
        parts
    }
}

impl Part {
    pub fn elements(&self) -> MeshView<'_> {
        MeshView {
            triangles: &self.triangles,
            quads: &self.quads,
            strands: &self.strands,
            particles: &self.particles,
            surface: self.surface.as_ref(),
            ..MeshView::default()
        }
    }

    /// The body's positions among those of all.
    pub fn positions(&self, all: &[Point]) -> Vec<Point> {
        self.vertices.iter().map(|&v| all[v as usize]).collect()
    }
}

/// The polygons of all bodies, then the squares of the half-spaces, if a mesh has any polygons. What belongs
/// to no object is one of the name of its body: otherwise it would belong to the object before it.
fn surface(world: &World, triangles: &[[u32; 3]], quads: &[[u32; 4]]) -> Option<Surface> {
    if world.bodies.iter().all(|body| body.surface.is_none()) {
        return None;
    }
    let labels = |name: &String| Labels { object: Some(name.clone()), ..Labels::default() };
    let mut all = Surface::default();
    let mut rest = triangles;
    for body in &world.bodies {
        let count = rest.iter().take_while(|triangle| body.vertices.contains(&triangle[0])).count();
        let (own, others) = rest.split_at(count);
        rest = others;
        match &body.surface {
            Some(surface) => {
                let mut named = surface.clone();
                named.name_objects(&body.name);
                all.append(&named, body.vertices.start);
            }
            None => all.push_triangles(own, &labels(&body.name)),
        }
    }
    for (quad, name) in quads.iter().zip(&world.half_space_names) {
        all.push(quad.map(|v| Corner::new(v, None, None)), &labels(name));
    }
    Some(all)
}

/// A square of the plane around the foot of `center`, counter-clockwise seen from outside.
fn quad(half_space: &HalfSpace, center: &Point, half_size: f64) -> [Point; 4] {
    let n = half_space.normal;
    let foot = center - n * half_space.signed_distance(center);
    let axis = if n.x.abs() < 0.6 { Vector::x() } else { Vector::y() };
    let u = (axis - n * n.dot(&axis)).normalize() * half_size;
    let v = n.cross(&u);
    [foot - u - v, foot + u - v, foot + u + v, foot - u + v]
}
