//! The figures and tables, a file each.

mod barrier;
mod breakdown;
mod collision_error;
mod contacts_alone;
mod convergence;
mod defaults;
mod early_contact;
mod edge_limits;
mod funnel;
mod goals;
mod impact_zones;
mod joint;
mod lengths;
mod newton;
mod overview;
mod parameters;
mod row_solvers;
mod simulation_error;
mod step_sizes;
mod steps;
mod sweeps;
mod switches;
mod table_1;
mod table_2;

use crate::bench::Bench;
use crate::chart::Chart;
use crate::table::Table;
use anyhow::Result;

/// All of them, in the order of the page.
pub const ALL: &[&dyn Figure] = &[
    &overview::Overview,
    &collision_error::CollisionError { blind: false },
    &collision_error::CollisionError { blind: true },
    &contacts_alone::ContactsAlone,
    &simulation_error::SimulationError,
    &convergence::Convergence,
    &table_1::Table1,
    &table_2::Table2,
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
];

/// A figure or table.
pub trait Figure: Sync {
    /// What the command calls it.
    fn name(&self) -> &'static str;
    /// Heading of its section.
    fn title(&self) -> &'static str;
    /// What it asks, and how it is measured.
    fn question(&self) -> &'static str;
    /// Measures it.
    fn run(&self, bench: &Bench) -> Result<Section>;
}

/// How a finding begins: whether the paper's holds here.
fn verdict(holds: bool) -> &'static str {
    if holds { "The paper's finding holds here" } else { "The paper's finding does not hold here" }
}

/// Whether a scene's problems are of a dynamics that is blind to contact.
fn is_blind(scene: &str) -> bool {
    scene.contains("-blind")
}

/// What a figure found.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// One sentence: whether the paper's finding holds here, with the ratio; where it does not, why.
    pub finding: String,
    pub parts: Vec<Part>,
}

/// A part of a section.
#[derive(Clone, Debug)]
pub enum Part {
    /// A table, on the page and as NAME.csv.
    Table { name: String, caption: String, table: Table },
    /// A table for NAME.csv alone.
    Data { name: String, table: Table },
    /// A chart, NAME.svg.
    Chart { name: String, chart: Chart },
}
