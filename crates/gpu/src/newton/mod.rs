//! Newton's method of the dynamics with its vectors on a device:
//! [`NewtonBackend`](bowknot_dynamics::NewtonBackend) for [`ConjugateGradients`](crate::ConjugateGradients).
//!
//! Positions are integers on a grid that is chosen once per time step; vectors are in single precision. Sums
//! over all nodes are made in a fixed order: by workgroup, then over workgroups by one of them, or by block
//! of nodes, then over blocks by the host in double precision.
//!
//! | module | holds |
//! |---|---|
//! | `layout` | data that host, kernels and twins share |
//! | `vectors` | the vectors on the device |
//! | `blocks` | blocks of nodes, for sums over components |
//! | `places` | time steps and targets: positions, and which nodes are free |
//! | `solve`, `rounds` | linear solves: what is recorded, and when they end |
//! | `search`, `line` | the begin of a line search, and its trials |
//! | `balance` | sums over components: momentum, forces out of balance |
//! | `backend` | the interface of the dynamics |

mod backend;
mod balance;
mod blocks;
pub(crate) mod layout;
mod line;
mod places;
mod rounds;
mod search;
mod solve;
mod vectors;

pub(crate) use places::Newton;

#[cfg(test)]
mod tests;
