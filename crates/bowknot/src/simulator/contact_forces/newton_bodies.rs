//! Which vertices Newton's method solves together with their contacts.
//!
//! Those of bodies that deform, and grains that press on them, be it through other grains: if rows of the
//! collision stage passed on what lies on such a grain, they and Newton's method would move the body in turn
//! for ever. All other grains have no forces but those of contacts, and rows hold them, at a fraction of the
//! cost.

use bowknot_dynamics::Touching;
use bowknot_geometry::UnionFind;
use bowknot_scene::BodyKind;
use bowknot_scene::world::World;

/// The vertices that Newton's method solves in a time step.
#[derive(Clone, Debug, Default)]
pub(super) struct NewtonBodies {
    /// Vertices of bodies that deform, grains that custom elements join included.
    deformable: Vec<bool>,
    grains: Vec<bool>,
    solved: Vec<bool>,
}

impl NewtonBodies {
    /// Of a world whose bodies `asleep` are obstacles; that has one entry per body, or none at all. Grains
    /// among the `joined` vertices are parts of a body that deforms.
    pub fn new(world: &World, asleep: &[bool], joined: &[u32]) -> Self {
        let nothing = vec![false; world.positions.len()];
        let [mut deformable, mut grains] = [nothing.clone(), nothing];
        for (index, body) in world.bodies.iter().enumerate() {
            let Some(kind) = body.kind else { continue };
            if !asleep.get(index).copied().unwrap_or(false) {
                let all = if kind == BodyKind::Particles { &mut grains } else { &mut deformable };
                body.vertices.clone().chain(body.interior.clone()).for_each(|v| all[v as usize] = true);
            }
        }
        for &vertex in joined {
            deformable[vertex as usize] |= std::mem::take(&mut grains[vertex as usize]);
        }
        Self { solved: deformable.clone(), deformable, grains }
    }

    /// Begins a time step in which pairs of vertices touch.
    pub fn begin_step(&mut self, touching: &Touching) {
        self.solved.clone_from(&self.deformable);
        let Self { deformable, grains, solved } = self;
        if !deformable.contains(&true) || !grains.contains(&true) {
            return;
        }
        let mut sets = UnionFind::new(solved.len());
        for &[a, b] in &touching.pairs {
            let [p, q] = [a as usize, b as usize];
            // What both touch that does not move joins nothing.
            if (grains[p] && (grains[q] || deformable[q])) || (deformable[p] && grains[q]) {
                sets.join(a, b);
            }
        }
        let mut presses = vec![false; solved.len()];
        (0..solved.len())
            .filter(|&v| deformable[v])
            .for_each(|v| presses[sets.find(v as u32) as usize] = true);
        for v in (0..solved.len()).filter(|&v| grains[v]) {
            solved[v] = presses[sets.find(v as u32) as usize];
        }
    }

    /// Whether a vertex is one of a deformable body or of grains that are awake.
    pub fn moves(&self, vertex: u32) -> bool {
        self.deformable[vertex as usize] || self.grains[vertex as usize]
    }

    /// Whether Newton's method solves any of the vertices.
    pub fn include_any(&self, vertices: &[u32]) -> bool {
        vertices.iter().any(|&v| self.solved[v as usize])
    }

    /// One entry per vertex of the world.
    pub fn flags(&self) -> &[bool] {
        &self.solved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grains_that_press_on_a_body_are_solved_and_no_others() {
        // A vertex of cloth, four grains, a vertex of an obstacle.
        let mut vertices = NewtonBodies {
            deformable: vec![true, false, false, false, false, false],
            grains: vec![false, true, true, true, true, false],
            solved: Vec::new(),
        };
        let mut solved = |pairs: &[[u32; 2]]| {
            vertices.begin_step(&Touching { pairs: pairs.to_vec(), held: Vec::new() });
            vertices.flags().to_vec()
        };
        assert_eq!(solved(&[[1, 0], [2, 1], [3, 4]]), [true, true, true, false, false, false]);
        // Cloth and a grain on the same ground.
        assert_eq!(solved(&[[0, 5], [3, 5]]), [true, false, false, false, false, false]);
    }
}
