//! Contacts in Newton's method: springs with multipliers, an augmented Lagrangian.
//!
//! Without them a target is computed as if there were no contacts. A stiff body that rests on something then
//! keeps falling, and the collision stage, which knows no elasticity, pushes back only the vertices in
//! contact. Callers that know which primitives are in contact therefore pass springs. With s = sum_i beta_i
//! x_i, depth = desired + offset - n . s and slip = (1 - n n^T)(s - s0), s0 being s at the start of the time
//! step, an active contact has the energy
//!
//! ```text
//! normal    k/2 (depth + lambda/k)^2                     force  lambda + k depth along n
//! sticking  k/2 |slip - tau/k|^2                         force  tau - k slip
//! sliding   (m |tau - k slip| - m^2/2) / k               force  m in the direction of tau - k slip
//! ```
//!
//! lambda and tau are its multipliers [N]. A contact whose multipliers are already the correct forces is not
//! displaced: at the solution depth and slip vanish, however soft the spring is (Hestenes 1969 and Powell
//! 1969; for friction Simo and Laursen 1992, "An augmented Lagrangian treatment of contact problems involving
//! friction"). Multipliers are updated after a solve: lambda <- max(0, lambda + k depth), tau <- tau - k
//! slip, limited to mu lambda. Callers pass them in as [`RepulsionSpring::force`] and read them with
//! [`crate::Dynamics::contact_forces`]: thus they pass from one Newton iteration to the next and from one
//! time step to the next, although the springs change.
//!
//! | file | holds |
//! |---|---|
//! | `spring` | [`RepulsionSpring`], the description of a contact |
//! | `state` | multipliers and friction of a contact |
//! | `springs` | all springs, their depths, slips and forces |
//! | `prepare` | stiffness and the initial active set |
//! | `linearize` | force and Hessian of each active spring |
//! | `active_set` | the update of active set and multipliers after a solve |
//! | `energy` | energies |

mod active_set;
mod energy;
mod linearize;
mod prepare;
pub(crate) mod spring;
pub(crate) mod springs;
mod state;

pub use spring::RepulsionSpring;
