//! What lies wholly inside of a closed surface without meeting it: no intersection, but seldom meant.

use crate::check::BodyPair;
use crate::geometry::{Point, UnionFind};
use crate::io::Mesh;
use crate::proximity::MeshQuery;
use std::collections::BTreeSet;

/// A box around points.
#[derive(Clone, Copy)]
struct Bounds([Point; 2]);

impl Bounds {
    const EMPTY: Self = Self([
        Point::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        Point::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
    ]);

    fn add(&mut self, point: &Point) {
        self.0 = [self.0[0].inf(point), self.0[1].sup(point)];
    }

    fn contains(&self, other: &Self) -> bool {
        (0..3).all(|k| self.0[0][k] <= other.0[0][k] && other.0[1][k] <= self.0[1][k])
    }
}

/// A connected component of a part.
struct Component {
    part: u32,
    vertex: u32,
    vertices: usize,
    bounds: Bounds,
}

/// Parts of which a connected component lies inside of another part, whose surface is closed: pairs of both.
/// Parts that intersect are left out.
pub(super) fn inside(mesh: &Mesh, positions: &[Point], intersecting: &[BodyPair]) -> BTreeSet<[u32; 2]> {
    let mut found = BTreeSet::new();
    let Some(body) = mesh.body.as_ref().filter(|_| mesh.names.len() > 1) else { return found };
    let components = components(mesh, body, positions);
    let parts: BTreeSet<u32> = components.iter().map(|component| component.part).collect();
    if parts.len() < 2 {
        return found;
    }
    for &around in &parts {
        let mut bounds = Bounds::EMPTY;
        for component in components.iter().filter(|component| component.part == around) {
            component.bounds.0.iter().for_each(|corner| bounds.add(corner));
        }
        let meets = |part: u32| {
            let pairs = [[Some(part), Some(around)], [Some(around), Some(part)]];
            intersecting.iter().any(|pair| pairs.contains(&pair.bodies))
        };
        let candidates: Vec<&Component> = components
            .iter()
            .filter(|c| c.part != around && bounds.contains(&c.bounds) && !meets(c.part))
            .collect();
        if candidates.is_empty() {
            continue;
        }
        let triangles: Vec<[u32; 3]> =
            mesh.triangles.iter().filter(|t| body[t[0] as usize] == around).copied().collect();
        let Some(surface) = MeshQuery::new(positions, &triangles).ok().filter(MeshQuery::is_closed) else {
            continue;
        };
        for component in candidates {
            if surface.is_inside(&positions[component.vertex as usize]) == Some(true) {
                found.insert([component.part, around]);
            }
        }
    }
    found
}

/// The connected components of all parts, without those of obstacles that are not there: all of their vertices
/// are at one place.
fn components(mesh: &Mesh, body: &[u32], positions: &[Point]) -> Vec<Component> {
    let mut joined = UnionFind::new(positions.len());
    let sides = mesh.triangles.iter().flat_map(|&[i, j, k]| [[i, j], [i, k]]);
    let mut used = vec![false; positions.len()];
    for [i, j] in sides.chain(mesh.strands.iter().copied()) {
        joined.join(i, j);
        (used[i as usize], used[j as usize]) = (true, true);
    }
    mesh.particles.iter().for_each(|&v| used[v as usize] = true);
    let mut of_root: Vec<Option<usize>> = vec![None; positions.len()];
    let mut components: Vec<Component> = Vec::new();
    for vertex in (0..positions.len() as u32).filter(|&v| used[v as usize]) {
        let index = *of_root[joined.root(vertex) as usize].get_or_insert_with(|| {
            let part = body[vertex as usize];
            components.push(Component { part, vertex, vertices: 0, bounds: Bounds::EMPTY });
            components.len() - 1
        });
        components[index].vertices += 1;
        components[index].bounds.add(&positions[vertex as usize]);
    }
    components.retain(|c| c.vertices == 1 || c.bounds.0[0] != c.bounds.0[1]);
    components
}
