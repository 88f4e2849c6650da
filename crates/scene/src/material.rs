//! What bodies are made of: materials by name or by numbers.

use crate::kind::BodyKind;
use bowknot_dynamics::{ClothMaterial, ParticleMaterial, SolidMaterial, StrandMaterial};
use bowknot_errors::{Checks, Parameters};
use serde::{Deserialize, Serialize};

/// Material of a body, of the kind that the body is.
// Read by its fields, so the one whose fields any other has as well comes last.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
#[non_exhaustive]
pub enum Material {
    /// Of a cloth.
    Cloth(ClothMaterial),
    /// Of a solid.
    Solid(SolidMaterial),
    /// Of particles.
    Particles(ParticleMaterial),
    /// Of strands.
    Strands(StrandMaterial),
}

impl Default for Material {
    fn default() -> Self {
        Self::Cloth(ClothMaterial::default())
    }
}

impl Material {
    /// The default of a kind.
    pub fn of(kind: BodyKind) -> Self {
        match kind {
            BodyKind::Cloth => Self::Cloth(ClothMaterial::default()),
            BodyKind::Solid => Self::Solid(SolidMaterial::default()),
            BodyKind::Strands => Self::Strands(StrandMaterial::default()),
            BodyKind::Particles => Self::Particles(ParticleMaterial::default()),
        }
    }

    /// The material of a kind by name.
    pub fn named(kind: BodyKind, name: &str) -> Option<Self> {
        Some(match kind {
            BodyKind::Cloth => Self::Cloth(ClothMaterial::named(name)?),
            BodyKind::Solid => Self::Solid(SolidMaterial::named(name)?),
            BodyKind::Strands => Self::Strands(StrandMaterial::named(name)?),
            BodyKind::Particles => Self::Particles(ParticleMaterial::named(name)?),
        })
    }

    /// The kind of body that it is for.
    pub fn kind(&self) -> BodyKind {
        match self {
            Self::Cloth(_) => BodyKind::Cloth,
            Self::Solid(_) => BodyKind::Solid,
            Self::Strands(_) => BodyKind::Strands,
            Self::Particles(_) => BodyKind::Particles,
        }
    }

    /// Largest ratio of an edge's length to its rest length [1], if the material says: that of a cloth.
    /// Solids have none: their own elasticity limits how far they stretch.
    pub fn stretch_limit(&self) -> Option<f64> {
        match self {
            Self::Cloth(material) => Some(material.stretch_limit),
            Self::Solid(_) => Some(f64::INFINITY),
            Self::Strands(_) | Self::Particles(_) => None,
        }
    }

    /// Its name, if all of its numbers are those of one that has a name.
    pub fn name(&self) -> Option<&'static str> {
        let kind = self.kind();
        kind.materials().iter().copied().find(|name| Self::named(kind, name).as_ref() == Some(self))
    }
}

impl Parameters for Material {
    fn check(&self, checks: &mut Checks) {
        match self {
            Self::Cloth(material) => material.check(checks),
            Self::Solid(material) => material.check(checks),
            Self::Strands(material) => material.check(checks),
            Self::Particles(material) => material.check(checks),
        }
    }
}
