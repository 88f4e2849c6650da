//! Where a time step that is not solved is out of balance, with the names of a scene.

use super::blocking::WaitingElements;
use crate::simulator::contact_forces::Contacts;
use bowknot_constraints::Feature;
use bowknot_geometry::{Point, Vector};
use bowknot_scene::world::World;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Where a time step that is not solved is out of balance.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Unsolved {
    /// Name of the body with the part that is farthest from balance, and of what presses on that part most,
    /// if anything does: a body, an obstacle, a half-space, or the same body again. If forces balance and
    /// only the collision stage ended short: the bodies of what waits.
    pub bodies: Vec<String>,
    /// Place [m]: the strongest contact between the two; without one the mean of the part's vertices.
    pub place_m: [f64; 3],
}

impl Unsolved {
    /// The bodies in words.
    pub fn bodies(&self) -> String {
        match &self.bodies[..] {
            [a, b] if a == b => format!("{a} and itself"),
            names => names.join(" and "),
        }
    }

    /// The bodies and the place, for a line.
    pub fn short(&self) -> String {
        let [x, y, z] = self.place_m;
        format!("{} at ({x:.3}, {y:.3}, {z:.3})", self.bodies())
    }
}

/// What a time step ended with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Search<'a> {
    pub world: &'a World,
    pub contacts: &'a Contacts,
    /// Forces of the springs [N].
    pub forces: &'a [Vector],
    /// Of all vertices [m].
    pub positions: &'a [Point],
}

/// The contacts with a body that presses.
struct Pressing {
    name: String,
    /// Sum of the lengths of the forces [N].
    sum: f64,
    /// Length of the strongest force [N].
    strongest: f64,
    place: Point,
}

impl Search<'_> {
    /// Where the component of a `vertex` is out of balance.
    pub fn of_forces(&self, vertex: u32) -> Unsolved {
        let Self { world, contacts, .. } = *self;
        let body = self.body_of(vertex).unwrap_or(u32::MAX);
        let component = contacts.component(vertex);
        let own = world.name_of(body).to_owned();
        let pressing = self.pressing(component);
        // The first of equal ones, so that threads and devices name the same.
        let most = pressing.into_values().reduce(|a, b| if b.sum > a.sum { b } else { a });
        match most {
            Some(Pressing { name, place, .. }) => {
                Unsolved { bodies: vec![own, name], place_m: place.coords.into() }
            }
            None => Unsolved {
                bodies: vec![own],
                place_m: self.mean(body, |v| contacts.component(v) == component),
            },
        }
    }

    /// What the collision stage waits for: the first of the `waits`, or the slowest body; none if neither is
    /// known.
    pub fn of_collisions(&self, waits: &[WaitingElements], slowest_body: Option<u32>) -> Option<Unsolved> {
        if let Some(wait) = waits.first() {
            return Some(Unsolved { bodies: wait.bodies.clone(), place_m: wait.place_m });
        }
        let body = slowest_body?;
        let bodies = vec![self.world.name_of(body).to_owned()];
        Some(Unsolved { bodies, place_m: self.mean(body, |_| true) })
    }

    /// The bodies and half-spaces that press on a component, by index; half-spaces count down from
    /// `u32::MAX`.
    fn pressing(&self, component: u32) -> BTreeMap<u32, Pressing> {
        let Self { world, contacts, forces, positions } = *self;
        let mut pressing: BTreeMap<u32, Pressing> = BTreeMap::new();
        for (features, spring, force) in contacts.pushes(forces) {
            // The first feature has the positive weights.
            let vertex_of =
                |sign: f64| (0..4).find(|&k| sign * spring.weights[k] > 0.0).map(|k| spring.vertices[k]);
            let sides = [vertex_of(1.0), vertex_of(-1.0)];
            let is_own = |side: usize| sides[side].is_some_and(|v| contacts.component(v) == component);
            let Some(other) = [1, 0].into_iter().find(|&other| is_own(1 - other)) else { continue };
            let (index, name) = match (features[other], sides[other]) {
                (Feature::HalfSpace(plane), _) => {
                    (u32::MAX - plane, world.half_space_names.get(plane as usize).cloned())
                }
                (_, Some(vertex)) => {
                    let body = self.body_of(vertex).unwrap_or(u32::MAX);
                    (body, Some(world.name_of(body).to_owned()))
                }
                (_, None) => continue,
            };
            let size = force.norm();
            let entry = pressing.entry(index).or_insert_with(|| Pressing {
                name: name.unwrap_or_default(),
                sum: 0.0,
                strongest: 0.0,
                place: Point::origin(),
            });
            entry.sum += size;
            if size > entry.strongest {
                entry.strongest = size;
                let point =
                    |k: usize| positions[spring.vertices[k] as usize].coords * spring.weights[k].max(0.0);
                entry.place = Point::from((0..4).map(point).sum::<Vector>());
            }
        }
        pressing
    }

    /// The body of a vertex; inside of solids, too.
    fn body_of(&self, vertex: u32) -> Option<u32> {
        let inside = || self.world.bodies.iter().position(|body| body.interior.contains(&vertex));
        let colliding = self.world.collision.vertex_body().get(vertex as usize).copied();
        colliding.or_else(|| inside().map(|body| body as u32))
    }

    /// Mean of the vertices of a body that are `counted` [m].
    fn mean(&self, body: u32, counted: impl Fn(u32) -> bool) -> [f64; 3] {
        let Some(body) = self.world.bodies.get(body as usize) else { return [0.0; 3] };
        let vertices = body.vertices.clone().chain(body.interior.clone()).filter(|&v| counted(v));
        let mut count = 0.0;
        let sum: Vector = vertices
            .map(|v| {
                count += 1.0;
                self.positions[v as usize].coords
            })
            .sum();
        (sum / f64::max(count, 1.0)).into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_names_the_bodies_and_the_place() {
        let short = |bodies: &[&str]| {
            let bodies = bodies.iter().map(|name| (*name).to_owned()).collect();
            Unsolved { bodies, place_m: [0.1, -0.2, 0.0304] }.short()
        };
        assert_eq!(short(&["strip", "left"]), "strip and left at (0.100, -0.200, 0.030)");
        assert_eq!(short(&["strip", "strip"]), "strip and itself at (0.100, -0.200, 0.030)");
        assert_eq!(short(&["strip"]), "strip at (0.100, -0.200, 0.030)");
    }
}
