//! The state of a simulator in the numbers of another one, with other bodies.

use super::driven::Driven;
use crate::simulator::Simulator;
use crate::simulator::checkpoint::Checkpoint;
use crate::simulator::contact_forces::{CarriedContacts, ContactForce, ContactMean, vertices_of};
use crate::simulator::sleep::SleepState;
use bowknot_constraints::Feature;
use bowknot_geometry::{Point, Vector};
use bowknot_scene::world::{Pin, World};
use bowknot_twoway::lcp::DistanceLimit;
use rustc_hash::FxHashMap;

/// The state of a simulator as one of the `next`, which is at its start. Bodies of one name are the same
/// body. All bodies are awake.
pub(super) fn renumbered(simulator: &Simulator, next: &Simulator) -> Checkpoint {
    let numbers = Numbers::new(&simulator.world, &next.world);
    let (time, dt) = (simulator.time(), simulator.dt);
    let before = simulator.world.names().zip(&simulator.present);
    let before: FxHashMap<&String, bool> = before.map(|(name, present)| (name, *present)).collect();
    let present = next.world.names().zip(next.world.present(time, dt));
    let pins = simulator.world.pins.iter().zip(&simulator.anchors);
    let pins = pins.filter_map(|(pin, anchors)| Some((numbers.pin(pin)?, anchors.clone())));
    let (pins, anchors): (Vec<Pin>, Vec<Vec<Point>>) = pins.unzip();
    Checkpoint {
        step: simulator.step,
        positions: numbers.of_vertices(&simulator.positions, positions_at(next, time)),
        velocities: numbers.of_vertices(&simulator.velocities, next.velocities.clone()),
        anchors,
        present: present.map(|(name, wanted)| before.get(name).copied().unwrap_or(wanted)).collect(),
        contacts: numbers.contacts(&simulator.carried()),
        sleep: SleepState::default(),
        order: Vec::new(),
        driven: numbers.driven(&simulator.driven, &next.driven, pins),
    }
}

/// The positions that a simulator begins with, with obstacles where their motion has them at a `time` [s].
fn positions_at(simulator: &Simulator, time: f64) -> Vec<Point> {
    let Simulator { world, positions, .. } = simulator;
    let mut positions = positions.clone();
    for body in world.bodies.iter().filter(|body| body.kind.is_none()) {
        let range = body.vertices.start as usize..body.vertices.end as usize;
        body.motion.positions(&world.base[range.clone()], time, &mut positions[range]);
    }
    positions
}

/// Numbers of one world in those of another.
pub(super) struct Numbers<'a> {
    old: &'a World,
    new: &'a World,
    /// By vertex; none for what is gone.
    vertices: Vec<Option<u32>>,
    edges: FxHashMap<[u32; 2], u32>,
    triangles: FxHashMap<[u32; 3], u32>,
}

impl<'a> Numbers<'a> {
    pub fn new(old: &'a World, new: &'a World) -> Self {
        let mut vertices = vec![None; old.positions.len()];
        for then in &old.bodies {
            let Some(now) = new.bodies.iter().find(|now| now.name == then.name) else { continue };
            then.all_vertices().zip(now.all_vertices()).for_each(|(v, w)| vertices[v as usize] = Some(w));
        }
        let topology = new.collision.topology();
        Self {
            old,
            new,
            vertices,
            edges: (0..).zip(&topology.edges).map(|(e, edge)| (sorted(*edge), e)).collect(),
            triangles: (0..).zip(&topology.triangles).map(|(t, triangle)| (sorted(*triangle), t)).collect(),
        }
    }

    /// What `before` has by vertex, and what `new` has for vertices that were not there.
    fn of_vertices<T: Copy>(&self, before: &[T], mut new: Vec<T>) -> Vec<T> {
        let kept = self.vertices.iter().zip(before).filter_map(|(now, then)| Some(((*now)?, then)));
        kept.for_each(|(now, then)| new[now as usize] = *then);
        new
    }

    /// What was changed and is still there, with scene and elements of the `next` simulator and its pins.
    fn driven(&self, before: &Driven, next: &Driven, pins: Vec<Pin>) -> Driven {
        let (scene, elements) = (next.scene.clone(), next.elements.clone());
        let mut driven = Driven { scene, elements, pushed: Vec::new(), ..before.clone() };
        driven.grips.retain(|name, _| pins.iter().any(|pin| pin.name == *name));
        driven.obstacles.retain(|name, _| self.new.index_of(name).is_some());
        if !driven.external_forces.is_empty() {
            let none = vec![Vector::zeros(); self.new.positions.len()];
            driven.external_forces = self.of_vertices(&before.external_forces, none);
        }
        Driven { pins: Some(pins), ..driven }
    }

    /// The number of a vertex; none if it is gone.
    pub fn vertex(&self, vertex: u32) -> Option<u32> {
        self.vertices.get(vertex as usize).copied().flatten()
    }

    /// Numbers of several vertices; none if one of them is gone.
    fn all<const N: usize>(&self, vertices: [u32; N]) -> Option<[u32; N]> {
        let mut numbers = [0; N];
        for (number, vertex) in numbers.iter_mut().zip(vertices) {
            *number = self.vertex(vertex)?;
        }
        Some(numbers)
    }

    fn feature(&self, feature: Feature) -> Option<Feature> {
        let of_feature = vertices_of(self.old.collision.topology(), &feature);
        match (feature, of_feature) {
            (Feature::HalfSpace(half_space), _) => {
                let name = self.old.half_space_names.get(half_space as usize)?;
                let now = self.new.half_space_names.iter().position(|other| other == name)?;
                Some(Feature::HalfSpace(now as u32))
            }
            (Feature::Vertex(v), _) => self.vertex(v).map(Feature::Vertex),
            (Feature::Edge(_), &[a, b]) => {
                self.edges.get(&sorted(self.all([a, b])?)).copied().map(Feature::Edge)
            }
            (Feature::Triangle(_), &[a, b, c]) => {
                self.triangles.get(&sorted(self.all([a, b, c])?)).copied().map(Feature::Triangle)
            }
            _ => None,
        }
    }

    fn features(&self, [a, b]: [Feature; 2]) -> Option<[Feature; 2]> {
        Some([self.feature(a)?, self.feature(b)?])
    }

    /// The contacts whose bodies are all there.
    fn contacts(&self, carried: &CarriedContacts) -> CarriedContacts {
        let force =
            |force: &ContactForce| Some(ContactForce { features: self.features(force.features)?, ..*force });
        let mean = |mean: &ContactMean| {
            let mut now = ContactMean { features: self.features(mean.features)?, ..*mean };
            now.spring.vertices = self.all(mean.spring.vertices)?;
            Some(now)
        };
        let limit =
            |limit: &DistanceLimit| Some(DistanceLimit { vertices: self.all(limit.vertices)?, ..*limit });
        CarriedContacts {
            forces: carried.forces.iter().filter_map(force).collect(),
            means: carried.means.iter().filter_map(mean).collect(),
            yielding: carried.yielding.iter().filter_map(limit).collect(),
        }
    }

    /// A pin, if its body is there.
    fn pin(&self, pin: &Pin) -> Option<Pin> {
        let vertices: Option<Vec<u32>> = pin.vertices.iter().map(|&v| self.vertex(v)).collect();
        let follow = match pin.follow {
            Some(body) => Some(self.new.index_of(self.old.name_of(body))? as u32),
            None => None,
        };
        Some(Pin { vertices: vertices?, follow, ..pin.clone() })
    }
}

fn sorted<const N: usize>(mut vertices: [u32; N]) -> [u32; N] {
    vertices.sort_unstable();
    vertices
}
