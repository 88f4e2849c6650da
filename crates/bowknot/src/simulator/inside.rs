//! What lies inside of a closed surface.

use bowknot_geometry::{Aabb, MeshStructure, Point, Vector};
use bowknot_scene::world::{World, WorldBody};

/// Largest number of connected parts of a body that are looked at.
const MAX_PARTS: usize = 64;

/// Whether a point lies inside of closed surfaces: a ray from it crosses an odd number of triangles.
pub(super) fn is_inside(point: &Point, triangles: impl Iterator<Item = [Point; 3]>) -> bool {
    triangles.filter(|triangle| ray_crosses(point, triangle)).count() % 2 == 1
}

/// Deformable bodies that start inside of a closed obstacle, which they can never leave, in words.
pub(super) fn enclosed_bodies(world: &World) -> Vec<String> {
    let is_obstacle = |body: &WorldBody| body.kind.is_none();
    let topology = world.collision.topology();
    let components = topology.connected_components();
    let mut found = Vec::new();
    for (o, obstacle) in world.bodies.iter().enumerate().filter(|(_, body)| is_obstacle(body)) {
        let triangles: Vec<[u32; 3]> =
            topology.triangles.iter().filter(|t| obstacle.vertices.contains(&t[0])).copied().collect();
        if !MeshStructure::new(&world.positions, &triangles).is_closed() {
            continue;
        }
        let range = obstacle.vertices.start as usize..obstacle.vertices.end as usize;
        let bounds = Aabb::of_points(&world.positions[range]);
        let surface = || triangles.iter().map(|t| t.map(|v| world.positions[v as usize]));
        for (b, body) in world.bodies.iter().enumerate().filter(|(_, body)| !is_obstacle(body)) {
            let mut seen = Vec::new();
            let mut starts = body.vertices.clone().filter(|v| {
                let component = components.of_vertex[*v as usize];
                let is_new = seen.len() < MAX_PARTS && !seen.contains(&component);
                seen.extend(is_new.then_some(component));
                is_new
            });
            let is_enclosed = |v: u32| {
                let p = &world.positions[v as usize];
                bounds.contains(p) && is_inside(p, surface())
            };
            if world.collision.may_collide(b as u32, o as u32) && starts.any(is_enclosed) {
                found.push(format!(
                    "{} starts inside of obstacle {}, which is closed, and cannot leave it: are scale, up and \
                     translate of both right?",
                    body.name, obstacle.name
                ));
            }
        }
    }
    found
}

/// Whether a ray in a fixed general direction crosses a triangle. Source: Moeller and Trumbore, "Fast, minimum
/// storage ray-triangle intersection", 1997.
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
        let found = enclosed_bodies(&world(0.0));
        assert!(
            found.len() == 1 && found[0].starts_with("sheet starts inside of obstacle ball"),
            "{found:?}"
        );
        assert_eq!(enclosed_bodies(&world(0.5)), [""; 0]);
    }

    #[test]
    fn garments_around_a_figure_are_not_inside_of_it() {
        let world = World::new(&Scene::builtin("dress", 0.1).expect("a scene")).expect("a world");
        assert_eq!(enclosed_bodies(&world), [""; 0]);
    }
}
