//! The methods that are compared. Another method takes a line in [`METHODS`].

use crate::bench::Size;
use anyhow::{Context, Result};
use bowknot::constraints::ContactForm;
use bowknot::twoway::{
    BackwardStep, CertifiedForward, CollisionScene, ForwardStep, LcpBackward, Params, Resolver, Search,
    TrustRegionSearch,
};
use bowknot_baselines::barrier::{BarrierParams, by_descent, by_newton};
use bowknot_baselines::ccd::{AdditiveCcd, EarliestImpact, PerVertexImpact};
use bowknot_baselines::rows::{
    AugmentedLagrangian, InterStepChebyshev, LinearSystem, ProjectedJacobi, preserving_volume, two_way_with,
    two_way_with_stage,
};
use bowknot_baselines::zones::{ImpactZones, RigidZones, TwoPhase, ZoneParams, ZoneSolver};
use bowknot_baselines::{Composed, Method};
use std::sync::Arc;

/// A method built from a problem, which holds the parameters.
type Built = Result<Box<dyn Method>>;

/// A method by name: its parameters, and the function that builds it.
pub struct Entry {
    pub name: &'static str,
    params: fn() -> Params,
    build: fn(CollisionScene) -> Built,
}

/// All of them.
pub const METHODS: &[Entry] = &[
    Entry { name: "fast", params: Params::fast, build: two_way },
    Entry { name: "quick", params: Params::quick, build: two_way },
    Entry { name: "paper", params: Params::paper, build: two_way },
    Entry { name: "log barrier", params: Params::paper, build: |p| log_barrier(p, BarrierParams::default()) },
    Entry { name: "log barrier, Newton", params: Params::paper, build: |p| newton(p, BarrierParams::default()) },
    Entry { name: "IPC", params: Params::paper, build: |p| ipc(p, BarrierParams::ipc()) },
    Entry {
        name: "IPC, own range",
        params: Params::paper,
        build: |p| {
            let params = BarrierParams::ipc_with_own_range(&p);
            ipc(p, params)
        },
    },
    Entry { name: "Harmon 2008", params: without_edges, build: |p| rows(p, LinearSystem::default()) },
    Entry { name: "Harmon, projected", params: without_edges, build: |p| rows(p, LinearSystem::projected()) },
    Entry { name: "Tang 2018, 20", params: Params::paper, build: |p| rows(p, AugmentedLagrangian::new(20)) },
    Entry {
        name: "Tang 2018, 100",
        params: Params::paper,
        build: |p| rows(p, AugmentedLagrangian::new(100)),
    },
    Entry { name: "Jacobi", params: Params::paper, build: |p| rows(p, ProjectedJacobi::new(1, 0.0)) },
    Entry { name: "Jacobi, Chebyshev", params: Params::paper, build: chebyshev },
    Entry { name: "Sifakis 2008", params: || preserving_volume(Params::paper()), build: two_way },
    Entry { name: "face normals", params: face_normals, build: two_way },
    Entry { name: "CCD, earliest", params: Params::paper, build: |p| forward(p, EarliestImpact::default()) },
    Entry {
        name: "CCD, per vertex",
        params: Params::paper,
        build: |p| forward(p, PerVertexImpact::default()),
    },
    Entry {
        name: "impact zones",
        params: Params::paper,
        build: |p| impact_zones(p, ZoneSolver::GaussSeidel),
    },
    Entry {
        name: "impact zones, Harmon",
        params: Params::paper,
        build: |p| impact_zones(p, ZoneSolver::LinearSystem),
    },
    Entry {
        name: "impact zones, Tang",
        params: Params::paper,
        build: |p| impact_zones(p, ZoneSolver::AugmentedLagrangian),
    },
    Entry { name: "impact zones, 0.8 delta", params: Params::paper, build: thick_zones },
    Entry { name: "rigid zones", params: Params::paper, build: |p| Ok(Box::new(RigidZones::new(p))) },
    Entry { name: "two phases", params: Params::paper, build: two_phases },
];

/// A method with chosen parameters.
#[derive(Clone)]
pub struct Setting {
    /// Name of the method; charts have one series per method.
    pub method: &'static str,
    /// What differs from the method's own parameters; empty: nothing.
    pub change: String,
    pub params: Params,
    pub build: Arc<dyn Fn(CollisionScene) -> Built>,
    /// Time limit of a solve in a full run [s]; none: 4 s.
    limit: Option<f64>,
}

impl Setting {
    /// A method with its own parameters.
    pub fn plain(entry: &Entry) -> Self {
        let build = entry.build;
        Self {
            method: entry.name,
            change: String::new(),
            params: (entry.params)(),
            build: Arc::new(build),
            limit: None,
        }
    }

    /// The method of that name with its own parameters.
    pub fn of(method: &str) -> Result<Self> {
        let entry = METHODS.iter().find(|e| e.name == method);
        entry.map(Self::plain).with_context(|| format!("no method {method}"))
    }

    /// The method with other parameters of the two-way loop.
    #[must_use]
    pub fn with(mut self, change: impl Into<String>, set: impl FnOnce(&mut Params)) -> Self {
        self.add(change.into());
        set(&mut self.params);
        self
    }

    /// The method, built by another function.
    #[must_use]
    pub fn built(
        mut self,
        change: impl Into<String>,
        build: impl Fn(CollisionScene) -> Built + 'static,
    ) -> Self {
        self.add(change.into());
        self.build = Arc::new(build);
        self
    }

    /// The same with another time limit of a solve in a full run [s].
    #[must_use]
    pub fn within(mut self, seconds: f64) -> Self {
        self.limit = Some(seconds);
        self
    }

    /// Time limit of a solve [s].
    pub fn limit(&self, size: Size) -> f64 {
        size.pick(self.limit.unwrap_or(4.0), 2.0, 1.0)
    }

    /// A key that distinguishes its measurements from those of other settings.
    pub fn key(&self) -> String {
        match self.limit {
            Some(seconds) => format!("{} within {seconds} s", self.name()),
            None => self.name(),
        }
    }

    fn add(&mut self, change: String) {
        let separator = if self.change.is_empty() { "" } else { ", " };
        self.change = format!("{}{separator}{change}", self.change);
    }

    /// Method and change.
    pub fn name(&self) -> String {
        name_of(self.method, &self.change)
    }
}

/// The name of a method with a change.
pub fn name_of(method: &str, change: &str) -> String {
    if change.is_empty() { method.to_owned() } else { format!("{method}, {change}") }
}

/// The two-way method of this project; its parameters define the presets.
fn two_way(scene: CollisionScene) -> Built {
    let search = TrustRegionSearch::new(&scene);
    let backward = LcpBackward::new();
    composed(Resolver::with_stages(scene, search, backward, CertifiedForward::default()))
}

/// Eq. 7-8 by gradient descent.
pub fn log_barrier(scene: CollisionScene, params: BarrierParams) -> Built {
    composed(by_descent(scene, params)?)
}

/// Incremental potential contact (Li et al. 2020).
pub fn ipc(scene: CollisionScene, params: BarrierParams) -> Built {
    composed(by_newton(scene, params, AdditiveCcd::default())?)
}
fn newton(scene: CollisionScene, params: BarrierParams) -> Built {
    composed(by_newton(scene, params, AdditiveCcd::default())?)
}

/// The two-way method with another row solver.
pub fn rows<K: bowknot::twoway::RowSolver + Default + 'static>(scene: CollisionScene, solver: K) -> Built {
    composed(two_way_with(scene, solver))
}

/// Projected Jacobi with Chebyshev weights between two-way steps (Wang 2015).
fn chebyshev(scene: CollisionScene) -> Built {
    let jacobi = LcpBackward::with_solver(ProjectedJacobi::new(1, 0.0));
    composed(two_way_with_stage(scene, InterStepChebyshev::new(jacobi, 0.9, 5)))
}

/// The two-way method with another forward step.
fn forward<F: ForwardStep<TrustRegionSearch> + 'static>(scene: CollisionScene, step: F) -> Built {
    let search = TrustRegionSearch::new(&scene);
    let backward = LcpBackward::new();
    composed(Resolver::with_stages(scene, search, backward, step))
}

fn impact_zones(scene: CollisionScene, solver: ZoneSolver) -> Built {
    Ok(Box::new(ImpactZones::new(scene, ZoneParams { solver, ..ZoneParams::default() })?))
}

/// Impact zones that keep 0.8 of the distance that the other methods keep. Zones as published keep no
/// distance: they only prevent intersections.
fn thick_zones(scene: CollisionScene) -> Built {
    Ok(Box::new(ImpactZones::new(scene, ZoneParams { thickness: 0.8, ..ZoneParams::default() })?))
}

/// Wu et al. 2020: five rounds of impact zones, then a log barrier.
fn two_phases(scene: CollisionScene) -> Built {
    let hard = Composed::new("log barrier", by_descent(scene.clone(), BarrierParams::default())?);
    Ok(Box::new(TwoPhase::new(scene, 5, hard)?))
}

fn composed<S, B, F>(resolver: Resolver<S, B, F>) -> Built
where
    S: Search + 'static,
    B: BackwardStep + 'static,
    F: ForwardStep<S> + 'static,
{
    Ok(Box::new(Composed::new("", resolver)))
}

/// `paper` with contacts along the normals of faces, as in Harmon et al. 2008 and Tang et al. 2018.
fn face_normals() -> Params {
    let mut params = Params::paper();
    params.contact.form = ContactForm::Face;
    params
}

/// `paper` without edge limits, which a linear system of equations would turn into rigid links (paper,
/// section 4.3.1). Only active pairs have rows, which is close to the collisions of Harmon et al.; equations
/// for all pairs in range would glue them together.
fn without_edges() -> Params {
    let mut params = Params::paper();
    params.solver.backward.active_rows = true;
    params.contact.edges = false;
    params
}
