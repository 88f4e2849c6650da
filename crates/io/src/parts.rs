//! Meshes put together to one, whose bodies they are.

use crate::mesh::Mesh;
use crate::surface::Surface;

/// Puts parts together.
#[derive(Debug, Default)]
pub(crate) struct PartsBuilder {
    mesh: Mesh,
    body: Vec<u32>,
    obstacle: Vec<bool>,
    /// Whether a part says what is an obstacle.
    tells_obstacles: bool,
    parts: u32,
}

impl PartsBuilder {
    /// Appends a mesh whose bodies are parts: those that it tells, else one of this name. `None` if there are
    /// more vertices than indices can count.
    #[must_use]
    pub fn add_bodies(&mut self, mut mesh: Mesh, name: String) -> Option<()> {
        mesh.name_bodies(|number| format!("{name}, body {number}"));
        let Some(body) = mesh.body.take() else { return self.add(mesh, name) };
        let (start, first) = (self.body.len(), self.parts);
        let mut names = std::mem::take(&mut mesh.names);
        self.add(mesh, name)?;
        self.body[start..].iter_mut().zip(body).for_each(|(part, body)| *part = first + body);
        self.mesh.names.truncate(first as usize);
        self.parts = first + names.len() as u32;
        self.mesh.names.append(&mut names);
        Some(())
    }

    /// Appends a part. All its vertices become one body of this name, whatever bodies it tells. `None` if
    /// there are more vertices than indices can count.
    #[must_use]
    pub fn add(&mut self, part: Mesh, name: String) -> Option<()> {
        let first = u32::try_from(self.mesh.positions.len()).ok()?;
        let count = u32::try_from(part.positions.len()).ok()?;
        first.checked_add(count)?;
        let Mesh { positions, triangles, tets, strands, particles, obstacle, surface, groups, .. } = part;
        // The polygons of the whole are its triangles, in the same order.
        if surface.is_some() || self.mesh.surface.is_some() {
            let whole = self.mesh.surface.get_or_insert_with(|| Surface::of_triangles(&self.mesh.triangles));
            let mut surface = surface.unwrap_or_else(|| Surface::of_triangles(&triangles));
            surface.name_objects(&name);
            whole.append(&surface, first);
        }
        // Groups of one name in several parts are one.
        groups.iter().for_each(|(name, group)| self.mesh.groups.add(name, group.iter().map(|v| v + first)));
        self.mesh.positions.extend(positions);
        self.mesh.triangles.extend(triangles.iter().map(|t| t.map(|v| v + first)));
        self.mesh.tets.extend(tets.iter().map(|t| t.map(|v| v + first)));
        self.mesh.strands.extend(strands.iter().map(|e| e.map(|v| v + first)));
        self.mesh.particles.extend(particles.iter().map(|v| v + first));
        self.body.resize(self.mesh.positions.len(), self.parts);
        self.tells_obstacles |= obstacle.is_some();
        self.obstacle.extend(obstacle.unwrap_or_default());
        self.obstacle.resize(self.mesh.positions.len(), false);
        self.mesh.names.push(name);
        self.parts += 1;
        Some(())
    }

    /// The whole.
    pub fn finish(self) -> Mesh {
        let obstacle = self.tells_obstacles.then_some(self.obstacle);
        Mesh { body: Some(self.body), obstacle, ..self.mesh }
    }
}
