//! Contacts in Newton's method: a force that follows from the gap, and Coulomb's friction.
//!
//! Without them a target is computed as if there were no contacts. A stiff body that rests on something then
//! keeps falling, and the collision stage, which knows no elasticity, pushes back only the vertices in
//! contact. Callers that know which primitives are in contact therefore pass springs.
//!
//! With s = sum beta_i x_i the gap is g = n . s - offset. With the room r = reach - floor and the share
//! w = (g - floor) / r of it, a contact has the normal force along n
//!
//! ```text
//! static    k r (1 - w) / w^2                 energy  k r^2 (1 / w - 1 + ln w)
//! drag      d (g0 - g)                        energy  d/2 (g0 - g)^2
//! ```
//!
//! as long as the sum pushes; g0 is the gap at the start of the time step. The static force is zero at the
//! reach, where its slope is -k, and infinite at the floor. It is a barrier as in Incremental Potential
//! Contact (Li et al. 2020). As in "A cubic barrier with elasticity-inclusive dynamic stiffness" (Ando 2024),
//! its stiffness follows from inertia and from the bodies' own stiffness. Below a small gap the force goes on
//! linearly, so that an iterate may be anywhere; the collision stage keeps distances. The drag lets contacts
//! open without bouncing.
//!
//! A spring may also be a mere [`SpringKind::Repulsion`], k (reach - g), whose energy is quadratic (paper, section 6.2).
//!
//! Friction is Coulomb's law as an elastic-plastic return mapping (Simo and Laursen 1992, "An augmented
//! Lagrangian treatment of contact problems involving friction") that begins with the friction at the start
//! of the time step, so that what sticks does not creep. Its bound lags by one Newton iteration (Li et al.
//! 2020, section 5). An edge that is taut is a contact as well, with the gap -offset - |s|.
//!
//! There are no multipliers. Where two contacts ask for more room than there is, as in a narrow gap,
//! multipliers grow from solve to solve without bound. A force that follows from the gap alone balances. Nor
//! is there an active set: the force vanishes continuously at the release. In exchange gaps decrease with the
//! load.
//!
//! Callers carry friction from one time step to the next: as a share of the normal force, in
//! [`RepulsionSpring::friction_ratio`], from what [`crate::Dynamics::contact_forces`] returns.
//!
//! | file | holds |
//! |---|---|
//! | `spring` | [`RepulsionSpring`], the description of a contact |
//! | `law` | the normal force of a gap |
//! | `state` | what changes from solve to solve, friction |
//! | `springs` | all springs, their gaps, slips and forces |
//! | `prepare` | the laws in a time step: stiffness, drag, friction at the start |
//! | `linearize` | force and Hessian of each spring |
//! | `update` | bends of laws and bounds of friction after a solve |
//! | `energy` | energies |
//! | `impacts` | what contacts do to velocities at the end of a stage of a time step |
//! | `potential` | [`ContactPotential`], for other solvers |

mod energy;
pub(crate) mod impacts;
mod law;
mod linearize;
mod potential;
mod prepare;
pub(crate) mod spring;
pub(crate) mod springs;
mod state;
mod update;

pub use potential::{ContactForces, ContactPotential};
pub use spring::{ContactLaw, RepulsionSpring, SpringKind};
