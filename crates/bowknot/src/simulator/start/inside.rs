//! What lies inside of a closed surface.

use bowknot_geometry::{Aabb, MeshStructure, Point, Vector};
use bowknot_scene::world::{World, WorldBody};

/// Largest number of connected parts of a body that are looked at.
const MAX_PARTS: usize = 64;

/// Whether a point lies inside of closed surfaces: a ray from it crosses an odd number of triangles.
pub(crate) fn is_inside(point: &Point, triangles: impl Iterator<Item = [Point; 3]>) -> bool {
    triangles.filter(|triangle| ray_crosses(point, triangle)).count() % 2 == 1
}

/// A closed surface of a body, at given positions.
pub(crate) struct Enclosure<'a> {
    world: &'a World,
    positions: &'a [Point],
    triangles: Vec<[u32; 3]>,
    bounds: Aabb,
}

impl<'a> Enclosure<'a> {
    /// That of a body of the world, at the `positions` of all vertices that collide [m]; none if it is not
    /// closed.
    pub fn new(world: &'a World, positions: &'a [Point], body: usize) -> Option<Self> {
        let own = &world.bodies[body].vertices;
        let triangles = world.collision.topology().triangles.iter();
        let triangles: Vec<[u32; 3]> = triangles.filter(|t| own.contains(&t[0])).copied().collect();
        let bounds = Aabb::of_points(&positions[own.start as usize..own.end as usize]);
        let is_closed = MeshStructure::new(positions, &triangles).is_closed();
        is_closed.then_some(Self { world, positions, triangles, bounds })
    }

    /// Whether a connected part of another body lies inside. Looks at the first [`MAX_PARTS`] of them, and
    /// takes it that none intersects the surface.
    pub fn holds(&self, other: usize) -> bool {
        let component = self.world.collision.vertex_component();
        let mut seen = Vec::new();
        let mut starts = self.world.bodies[other].vertices.clone().filter(|v| {
            let component = component[*v as usize];
            let is_new = seen.len() < MAX_PARTS && !seen.contains(&component);
            seen.extend(is_new.then_some(component));
            is_new
        });
        let surface = || self.triangles.iter().map(|t| t.map(|v| self.positions[v as usize]));
        starts.any(|v| {
            let p = &self.positions[v as usize];
            self.bounds.contains(p) && is_inside(p, surface())
        })
    }
}

/// Deformable bodies that are inside of a closed obstacle that is `present`, which they can never leave, in
/// words. `positions` are those of all vertices [m].
pub(crate) fn enclosed_bodies(world: &World, positions: &[Point], present: &[bool]) -> Vec<String> {
    let is_obstacle = |body: &WorldBody| body.kind.is_none();
    let obstacles = world.bodies.iter().zip(present).enumerate();
    let mut found = Vec::new();
    for (o, (obstacle, _)) in obstacles.filter(|(_, (body, present))| is_obstacle(body) && **present) {
        let Some(enclosure) = Enclosure::new(world, positions, o) else { continue };
        for (b, body) in world.bodies.iter().enumerate().filter(|(_, body)| !is_obstacle(body)) {
            if world.collision.may_collide(b as u32, o as u32) && enclosure.holds(b) {
                found.push(format!(
                    "{} starts inside of obstacle {}, which is closed, and cannot leave it: are scale, up \
                     and translate of both right?",
                    body.name, obstacle.name
                ));
            }
        }
    }
    found
}

/// Whether a ray in a fixed general direction crosses a triangle. Source: Moeller and Trumbore, "Fast,
/// minimum storage ray-triangle intersection", 1997.
fn ray_crosses(start: &Point, [a, b, c]: &[Point; 3]) -> bool {
    let direction = Vector::new(0.267_261, 0.534_522, 0.801_784);
    let (e1, e2) = (b - a, c - a);
    let p = direction.cross(&e2);
    let determinant = e1.dot(&p);
    let offset = start - a;
    let u = offset.dot(&p) / determinant;
    let q = offset.cross(&e1);
    let v = direction.dot(&q) / determinant;
    // False where the ray is parallel to the triangle: the comparisons with NaN are.
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && e2.dot(&q) / determinant > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use bowknot_scene::Scene;

    #[test]
    fn a_sheet_inside_of_a_ball_is_noticed_and_one_beside_it_is_not() {
        let world = |x: f64| {
            let text = format!(
                "[[body]]\nname = \"sheet\"\nshape = {{ type = \"sheet\", size = [0.1, 0.1], edge = 0.05 }}\n\
                 translate = [{x}, 0.0, 0.0]\n\
                 [[obstacle]]\nname = \"ball\"\nshape = {{ type = \"ball\", radius = 0.3, edge = 0.1 }}\n"
            );
            World::new(&Scene::from_toml(&text, "").expect("a scene")).expect("a world")
        };
        let enclosed = |x: f64, present: &[bool]| {
            let world = world(x);
            enclosed_bodies(&world, &world.positions, present)
        };
        let found = enclosed(0.0, &[true; 2]);
        assert!(
            found.len() == 1 && found[0].starts_with("sheet starts inside of obstacle ball"),
            "{found:?}"
        );
        assert_eq!(enclosed(0.0, &[true, false]), [""; 0]);
        assert_eq!(enclosed(0.5, &[true; 2]), [""; 0]);
    }

    #[test]
    fn garments_around_a_figure_are_not_inside_of_it() {
        let world = World::new(&Scene::builtin("dress", 0.1).expect("a scene")).expect("a world");
        let present = world.present(0.0, 0.01);
        assert_eq!(enclosed_bodies(&world, &world.positions, &present), [""; 0]);
    }
}
