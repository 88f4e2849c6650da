//! The contacts that the dynamics knows of, their forces, and what they remember from one time step to the
//! next.

mod averaging;
mod contacts;
mod crowding;
mod friction;
mod near_contacts;
mod newton_bodies;
mod row_forces;

pub use averaging::ContactMean;
pub use contacts::CarriedContacts;
pub(crate) use contacts::Contacts;
pub use friction::ContactForce;
pub(crate) use friction::vertices_of;
pub(super) use row_forces::features;
