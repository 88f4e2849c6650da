//! The kinds of deformable bodies.

use crate::fields::field_names;
use bowknot_dynamics::{ClothMaterial, ParticleMaterial, SolidMaterial, StrandMaterial};
use serde::{Deserialize, Serialize};

/// What a deformable body is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum BodyKind {
    /// A surface that stretches and bends.
    #[default]
    Cloth,
    /// A volume of tetrahedra; its surface collides.
    Solid,
    /// Hair or yarn: paths of edges that stretch and bend.
    Strands,
    /// Grains that only collide.
    Particles,
}

impl BodyKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Cloth, Self::Solid, Self::Strands, Self::Particles];

    /// The kind as a scene names it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cloth => "cloth",
            Self::Solid => "solid",
            Self::Strands => "strands",
            Self::Particles => "particles",
        }
    }

    /// Names of the materials of this kind; the first is the default.
    pub fn materials(self) -> &'static [&'static str] {
        match self {
            Self::Cloth => &ClothMaterial::NAMES,
            Self::Solid => &SolidMaterial::NAMES,
            Self::Strands => &StrandMaterial::NAMES,
            Self::Particles => &ParticleMaterial::NAMES,
        }
    }

    /// Keys of a material of this kind.
    pub(crate) fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Cloth => field_names::<ClothMaterial>(),
            Self::Solid => field_names::<SolidMaterial>(),
            Self::Strands => field_names::<StrandMaterial>(),
            Self::Particles => field_names::<ParticleMaterial>(),
        }
    }
}
