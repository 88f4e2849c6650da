//! Bodies as the caller describes them.

use crate::material::cloth::ClothMaterial;
use crate::material::particle::ParticleMaterial;
use crate::material::solid::SolidMaterial;
use crate::material::strand::StrandMaterial;
use bowknot_geometry::Vector;

/// A body of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its name, for messages.
    pub name: String,
    /// What it is made of.
    pub shape: BodyShape,
    /// Acceleration of gravity on it [m/s^2]; None: [`crate::Environment::gravity`].
    pub gravity: Option<Vector>,
}

/// What a body is made of. Vertices are indices into those of the scene.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum BodyShape {
    /// Cloth.
    Cloth {
        /// Its triangles.
        triangles: Vec<[u32; 3]>,
        /// Its material.
        material: ClothMaterial,
    },
    /// A solid.
    Solid {
        /// Its tets, with positive volume: (x1 - x0) x (x2 - x0) . (x3 - x0) > 0.
        tets: Vec<[u32; 4]>,
        /// Its material.
        material: SolidMaterial,
    },
    /// A solid of tets with nodes in the middles of their edges, which bend and shear as they should where
    /// those of [`Self::Solid`] are too stiff.
    QuadraticSolid {
        /// Its tets: the corners as in [`Self::Solid`], then the middles of the edges 01, 02, 03, 12, 13, 23,
        /// which must lie in the middles of straight edges at rest.
        tets: Vec<[u32; 10]>,
        /// Its material.
        material: SolidMaterial,
    },
    /// Hair, yarns: paths of edges, which may branch.
    Strands {
        /// Their edges.
        edges: Vec<[u32; 2]>,
        /// Their material.
        material: StrandMaterial,
    },
    /// Strands that resist twist, see [`StrandMaterial::twist_stiffness`].
    Rods {
        /// Their edges, each with its frame point, which shows how it is turned about itself: beside its middle, where
        /// [`bowknot_geometry::add_frame_points`] puts it.
        edges: Vec<[u32; 3]>,
        /// Their material.
        material: StrandMaterial,
    },
    /// Grains.
    Particles {
        /// Its vertices, one per grain.
        vertices: Vec<u32>,
        /// Their material.
        material: ParticleMaterial,
    },
    /// An obstacle: its vertices have no mass and are always prescribed.
    Obstacle {
        /// Its vertices.
        vertices: Vec<u32>,
    },
}

impl Body {
    /// A body with the gravity of the scene.
    pub fn new(name: impl Into<String>, shape: BodyShape) -> Self {
        Self { name: name.into(), shape, gravity: None }
    }

    /// A piece of cloth.
    pub fn cloth(name: impl Into<String>, triangles: Vec<[u32; 3]>, material: ClothMaterial) -> Self {
        Self::new(name, BodyShape::Cloth { triangles, material })
    }

    /// A solid of tets.
    pub fn solid(name: impl Into<String>, tets: Vec<[u32; 4]>, material: SolidMaterial) -> Self {
        Self::new(name, BodyShape::Solid { tets, material })
    }

    /// A solid of tets with nodes in the middles of their edges, see [`BodyShape::QuadraticSolid`].
    pub fn quadratic_solid(name: impl Into<String>, tets: Vec<[u32; 10]>, material: SolidMaterial) -> Self {
        Self::new(name, BodyShape::QuadraticSolid { tets, material })
    }

    /// Strands of edges.
    pub fn strands(name: impl Into<String>, edges: Vec<[u32; 2]>, material: StrandMaterial) -> Self {
        Self::new(name, BodyShape::Strands { edges, material })
    }

    /// Strands that resist twist, see [`BodyShape::Rods`].
    pub fn rods(name: impl Into<String>, edges: Vec<[u32; 3]>, material: StrandMaterial) -> Self {
        Self::new(name, BodyShape::Rods { edges, material })
    }

    /// Grains, one per vertex.
    pub fn particles(name: impl Into<String>, vertices: Vec<u32>, material: ParticleMaterial) -> Self {
        Self::new(name, BodyShape::Particles { vertices, material })
    }

    /// An obstacle.
    pub fn obstacle(name: impl Into<String>, vertices: Vec<u32>) -> Self {
        Self::new(name, BodyShape::Obstacle { vertices })
    }

    /// This body with a gravity of its own [m/s^2].
    pub fn with_gravity(mut self, gravity: Vector) -> Self {
        self.gravity = Some(gravity);
        self
    }
}

impl BodyShape {
    /// Calls `visit` with the vertices of every element: of a triangle, tet or edge (of a rod, with its frame point), or
    /// a single vertex.
    pub fn for_each_element(&self, mut visit: impl FnMut(&[u32])) {
        match self {
            Self::Cloth { triangles, .. } => triangles.iter().for_each(|t| visit(t)),
            Self::Solid { tets, .. } => tets.iter().for_each(|t| visit(t)),
            Self::QuadraticSolid { tets, .. } => tets.iter().for_each(|t| visit(t)),
            Self::Strands { edges, .. } => edges.iter().for_each(|e| visit(e)),
            Self::Rods { edges, .. } => edges.iter().for_each(|e| visit(e)),
            Self::Particles { vertices, .. } | Self::Obstacle { vertices } => {
                vertices.iter().for_each(|v| visit(&[*v]));
            }
        }
    }

    /// What of it the CPU alone computes, in words, and what it needs instead for a device.
    pub fn only_on_cpu(&self) -> Option<[&'static str; 2]> {
        match self {
            Self::QuadraticSolid { .. } => {
                Some(["quadratic elements", "linear ones (`elements = \"linear\"` in a scene)"])
            }
            Self::Rods { .. } => Some(["a twist stiffness", "`twist_stiffness = 0`"]),
            _ => None,
        }
    }

    /// Whether it is an obstacle, whose vertices have no mass and are always prescribed.
    pub fn is_obstacle(&self) -> bool {
        matches!(self, Self::Obstacle { .. })
    }
}
