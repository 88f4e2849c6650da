//! The figures and tables, one file each.

mod barrier;
mod breakdown;
mod collision_error;
mod contacts_alone;
mod convergence;
mod defaults;
mod early_contact;
mod edge_limits;
mod funnel;
mod gallery;
mod goals;
mod gpu;
mod impact_zones;
mod integrators;
mod joint;
mod lengths;
mod newton;
mod overview;
mod parameters;
mod row_solvers;
mod simulation_error;
mod stability;
mod step_sizes;
mod steps;
mod sweeps;
mod switches;
mod table_1;
mod table_2;
mod table_2_full;
mod tolerance;

use crate::figure::Figure;

/// All of them, in the order of the page.
pub const ALL: &[&dyn Figure] = &[
    &overview::Overview,
    &collision_error::CollisionError { aware: true },
    &collision_error::CollisionError { aware: false },
    &contacts_alone::ContactsAlone,
    &tolerance::Tolerance,
    &simulation_error::SimulationError,
    &integrators::Integrators,
    &convergence::Convergence,
    &table_1::Table1,
    &table_2::Table2,
    &table_2_full::Table2Full,
    &defaults::Defaults,
    &switches::Switches,
    &barrier::Barrier,
    &edge_limits::EdgeLimits,
    &sweeps::Sweeps,
    &row_solvers::RowSolvers,
    &step_sizes::StepSizes,
    &impact_zones::ImpactZones,
    &parameters::Parameters,
    &lengths::LengthsSwept,
    &steps::Steps,
    &breakdown::Breakdown,
    &newton::Newton,
    &joint::Joint,
    &funnel::Funnel,
    &early_contact::EarlyContact,
    &goals::Goals,
    &gpu::Gpu,
    &gallery::Gallery,
    // The longest: in a preview it has what time is left.
    &stability::Stability,
];
