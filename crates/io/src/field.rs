//! What frames say of each vertex beside its position.

use bowknot_geometry::Vector;

/// A vector of each vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Field {
    /// Velocities [m/s].
    Velocity,
    /// What all contacts exert on a vertex [N].
    ContactForce,
}

impl Field {
    /// All fields.
    pub const ALL: [Self; 2] = [Self::Velocity, Self::ContactForce];

    /// Its name, as a point array of a VTU.
    pub fn name(self) -> &'static str {
        match self {
            Self::Velocity => "velocity",
            Self::ContactForce => "contact_force",
        }
    }

    /// Its array of an NPZ.
    pub fn array(self) -> &'static str {
        match self {
            Self::Velocity => "V",
            Self::ContactForce => "C",
        }
    }

    /// Its attribute of a USD prim. USD knows velocities; other vectors are primvars.
    pub(crate) fn attribute(self) -> &'static str {
        match self {
            Self::Velocity => "velocities",
            Self::ContactForce => "primvars:contactForce",
        }
    }
}

/// The values of a field in a frame, one per vertex.
#[derive(Clone, Copy, Debug)]
pub struct FieldValues<'a> {
    /// What they are.
    pub field: Field,
    /// In the unit of the field.
    pub values: &'a [Vector],
}
