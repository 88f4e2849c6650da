//! Other solvers of the backward step's rows (paper, sections 4.2.2 and 4.3). All else is shared with the
//! two-way method: rows, multipliers that are kept from step to step, search and forward step.
//!
//! - [`LinearSystem`]: Harmon et al. 2008, without and with the projection lambda >= 0 (Fig. 13, 14);
//! - [`AugmentedLagrangian`]: Tang et al. 2018, by gradient descent (Fig. 15);
//! - [`ProjectedJacobi`]: with Chebyshev weights within the step (Fig. 11, 12), or between steps
//!   ([`InterStepChebyshev`]).
//!
//! They are compared with projected Gauss-Seidel ([`bowknot_twoway::ColoredSweeps`]) and, for small
//! problems, the exact [`bowknot_twoway::lcp::solve_exact`].

mod augmented_lagrangian;
mod incidence;
mod inter_step;
mod jacobi;
mod linear_system;
mod zone_descent;

pub use augmented_lagrangian::{AugmentedLagrangian, Descent};
pub use inter_step::InterStepChebyshev;
pub use jacobi::ProjectedJacobi;
pub use linear_system::LinearSystem;
pub(crate) use linear_system::solve_equations;

use bowknot_twoway::constraints::ContactForm;
use bowknot_twoway::{
    BackwardStep, CertifiedForward, CollisionScene, LcpBackward, Params, Resolver, RowSolver,
    TrustRegionSearch,
};

/// The two-way method with another row solver; `scene` has the parameters, usually those of
/// [`bowknot_twoway::Params::paper`].
pub fn two_way_with<K: RowSolver + Default>(
    scene: CollisionScene,
    solver: K,
) -> Resolver<TrustRegionSearch, LcpBackward<K>, CertifiedForward> {
    two_way_with_stage(scene, LcpBackward::with_solver(solver))
}

/// The two-way method with another backward step.
pub fn two_way_with_stage<B: BackwardStep>(
    scene: CollisionScene,
    backward: B,
) -> Resolver<TrustRegionSearch, B, CertifiedForward> {
    let search = TrustRegionSearch::new(&scene);
    Resolver::with_stages(scene, search, backward, CertifiedForward::default())
}

/// Parameters under which contacts keep their volume, as in Sifakis et al. 2008 ("Globally coupled collision
/// handling using volume preserving impulses"), and are not separated to the volume of the contact distance
/// (paper, section 4.1): a pair below its contact distance keeps the gap at which it became a candidate in
/// the call. Calls must have a time step, because the growth of gaps is switched off by a separation speed of
/// almost 0.
#[must_use]
pub fn preserving_volume(mut params: Params) -> Params {
    params.contact.form = ContactForm::Volume;
    params.contact.separation_speed = Some(f64::MIN_POSITIVE);
    params
}
