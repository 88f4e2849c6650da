//! The potential of the bodies on a device: its gradient, and its change from one state to another.
//!
//! With d = x - x0 from the start of the time step it is, as `NewtonBackend` of the crate bowknot-dynamics
//! has it,
//!
//! ```text
//! P(x) = 1/2 d.(R + K) d + c.d + sum of elements e(x; x0)
//! ```
//!
//! Positions are integers, multiples of a quantum. Differences of positions, and of such differences, are
//! formed before they become single numbers: K and the elements do not feel a motion of the whole, and a
//! change from x to x + u, computed from u and the changes of strain that it makes, has no difference of two
//! energies in it.
//!
//! | module | holds |
//! |---|---|
//! | `layout` | data that host, kernels and twins share |
//! | `lists` | which gradients of elements, and which entries of K, the gradient by a node sums |
//! | `record` | the buffers of a model and the dispatches |

pub(crate) mod layout;
mod lists;
mod record;

#[cfg(test)]
pub(crate) use record::PotentialChange;
pub(crate) use record::{Places, Potential};

#[cfg(test)]
mod tests;
