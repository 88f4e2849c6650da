//! The state of a simulator in the numbers of another one, with other bodies.

use super::driven::Driven;
use crate::simulator::Simulator;
use crate::simulator::checkpoint::Checkpoint;
use crate::simulator::contact_forces::{CarriedContacts, ContactForce, ContactMean, vertices_of};
use crate::simulator::sleep::SleepState;
use bowknot_constraints::Feature;
use bowknot_scene::world::{Pin, World};
use bowknot_twoway::lcp::DistanceLimit;
use rustc_hash::FxHashMap;

/// The state of a simulator as one of the `next`, which is at its start. Bodies of one name are the same
/// body. All bodies are awake.
pub(super) fn renumbered(simulator: &Simulator, next: &Simulator) -> Checkpoint {
    let Simulator { world: old, .. } = simulator;
    let numbers = Numbers::new(old, &next.world);
    let (mut positions, mut velocities) = (next.positions.clone(), next.velocities.clone());
    let mut forces = simulator.driven.external_forces.clone();
    for body in next.world.bodies.iter().filter(|body| body.kind.is_none()) {
        let range = body.vertices.start as usize..body.vertices.end as usize;
        body.motion.positions(&next.world.base[range.clone()], simulator.time(), &mut positions[range]);
    }
    if !forces.is_empty() {
        forces = vec![Default::default(); positions.len()];
    }
    for (then, now) in numbers.vertices.iter().enumerate().filter_map(|(then, now)| Some((then, (*now)?))) {
        positions[now as usize] = simulator.positions[then];
        velocities[now as usize] = simulator.velocities[then];
        if let Some(force) = forces.get_mut(now as usize) {
            *force = simulator.driven.external_forces[then];
        }
    }
    let kept = old
        .pins
        .iter()
        .zip(&simulator.anchors)
        .filter_map(|(pin, anchors)| Some((numbers.pin(pin)?, anchors.clone())));
    let (pins, anchors): (Vec<Pin>, Vec<_>) = kept.unzip();
    let before = &simulator.driven;
    let has_pin = |name: &String| pins.iter().any(|pin| pin.name == *name);
    let driven = Driven {
        scene: next.driven.scene.clone(),
        grips: before.grips.clone().into_iter().filter(|(name, _)| has_pin(name)).collect(),
        obstacles: before
            .obstacles
            .clone()
            .into_iter()
            .filter(|(name, _)| next.world.index_of(name).is_some())
            .collect(),
        pins: Some(pins),
        external_forces: forces,
        pushed: Vec::new(),
        ..before.clone()
    };
    let presences: FxHashMap<&String, bool> =
        old.names().zip(&simulator.present).map(|(name, present)| (name, *present)).collect();
    let wanted = next.world.present(simulator.time(), simulator.dt);
    let present = next.world.names().zip(wanted);
    Checkpoint {
        step: simulator.step,
        positions,
        velocities,
        anchors,
        present: present.map(|(name, wanted)| presences.get(name).copied().unwrap_or(wanted)).collect(),
        contacts: numbers.contacts(&simulator.carried()),
        sleep: SleepState::default(),
        order: Vec::new(),
        driven,
    }
}

/// Numbers of one world in those of another.
struct Numbers<'a> {
    old: &'a World,
    new: &'a World,
    /// By vertex; none for what is gone.
    vertices: Vec<Option<u32>>,
    edges: FxHashMap<[u32; 2], u32>,
    triangles: FxHashMap<[u32; 3], u32>,
}

impl<'a> Numbers<'a> {
    fn new(old: &'a World, new: &'a World) -> Self {
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

    fn vertex(&self, vertex: u32) -> Option<u32> {
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
