//! The methods that are compared. Another method takes a line in [`METHODS`].

use crate::bench::Size;
use anyhow::{Context, Result};
use bowknot::constraints::ContactForm;
use bowknot::twoway::{
    BackwardStep, CertifiedForward, CollisionScene, ForwardStep, LcpBackward, Params, Resolver, Search,
    TrustRegionSearch,
};
use bowknot_baselines::barrier::{BarrierParams, by_descent, by_newton};
use bowknot_baselines::ccd::{AdditiveCcd, EarliestImpact, PerVertexImpact, SweptSearch};
use bowknot_baselines::rows::{
    AugmentedLagrangian, InterStepChebyshev, LinearSystem, ProjectedJacobi, preserving_volume, two_way_with,
    two_way_with_stage,
};
use bowknot_baselines::zones::{ImpactZones, RigidZones, TwoPhase, ZoneGoal, ZoneParams, ZoneSolver};
use bowknot_baselines::{Composed, Method};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

/// A method built from a problem, which holds the parameters.
type Built = Result<Box<dyn Method>>;

/// A method by name: its parameters, and the function that builds it.
pub struct Entry {
    pub name: &'static str,
    /// What it does not do of the problem as stated; empty: nothing.
    pub lacks: &'static str,
    params: fn() -> Params,
    build: fn(CollisionScene) -> Built,
}

/// Tolerance of a system that is solved, in mean edge lengths, and the most iterations that may take.
const SOLVED: (f64, u32) = (1e-6, 5000);

const HALF_OF_FOLDS: &str = "half of the distance in sharp folds";
const NO_LIMITS: &str = "edge limits";
const BARRIER: &str = "edge limits, the contact distance where something presses";
const NO_DISTANCE: &str = "edge limits, contact distance";

/// A method that replaces one part of `paper`.
const fn variant(name: &'static str, build: fn(CollisionScene) -> Built) -> Entry {
    Entry { name, lacks: "", params: Params::paper, build }
}

/// A method that solves a smaller problem than `paper`, with its lengths.
const fn lacking(name: &'static str, lacks: &'static str, build: fn(CollisionScene) -> Built) -> Entry {
    Entry { name, lacks, params: Params::paper, build }
}

/// All of them.
pub const METHODS: &[Entry] = &[
    Entry { name: "fast", lacks: HALF_OF_FOLDS, params: Params::fast, build: two_way },
    Entry { name: "quick", lacks: HALF_OF_FOLDS, params: Params::quick, build: two_way },
    variant("paper", two_way),
    Entry { name: "paper, active rows", lacks: "", params: active_rows, build: two_way },
    Entry {
        name: "log barrier",
        lacks: BARRIER,
        params: near_alone,
        build: |p| log_barrier(p, BarrierParams::default()),
    },
    Entry { name: "IPC", lacks: BARRIER, params: near_alone, build: |p| ipc(p, BarrierParams::ipc()) },
    lacking("IPC, own range", "edge limits, the contact distance", |p| {
        let params = BarrierParams::ipc_with_own_range(&p);
        ipc(p, params)
    }),
    Entry {
        name: "Harmon 2008",
        lacks: "edge limits, contacts that open",
        params: without_edges,
        build: |p| rows(p, LinearSystem::default()),
    },
    Entry {
        name: "Harmon, projected",
        lacks: NO_LIMITS,
        params: without_edges,
        build: |p| rows(p, LinearSystem::projected()),
    },
    variant("Tang 2018, 20", |p| rows(p, AugmentedLagrangian::new(20))),
    variant("Tang 2018, 100", |p| rows(p, AugmentedLagrangian::new(100))),
    variant("Tang, steps by vertex, 100", |p| rows(p, AugmentedLagrangian::by_vertices(100))),
    variant("Jacobi", |p| rows(p, ProjectedJacobi::new(1, 0.0))),
    variant("Jacobi, Chebyshev", chebyshev),
    Entry { name: "Sifakis 2008", lacks: "", params: || preserving_volume(Params::paper()), build: two_way },
    Entry { name: "face normals", lacks: "", params: face_normals, build: two_way },
    variant("CCD, earliest", |p| forward(p, EarliestImpact::default())),
    variant("CCD, per vertex", |p| forward(p, PerVertexImpact::default())),
    lacking("impact zones", NO_DISTANCE, |p| impact_zones(p, ZoneParams::default())),
    lacking("impact zones, Harmon", "edge limits, contact distance, contacts that open", |p| {
        let (solver, goal) = (ZoneSolver::LinearSystem, ZoneGoal::ZeroVelocity);
        let (tolerance, max_sweeps) = SOLVED;
        impact_zones(p, ZoneParams { solver, goal, tolerance, max_sweeps, ..ZoneParams::default() })
    }),
    lacking("impact zones, Harmon, to delta", "edge limits, contact distance, contacts that open", |p| {
        impact_zones(p, ZoneParams { solver: ZoneSolver::LinearSystem, ..ZoneParams::default() })
    }),
    lacking("impact zones, Tang", NO_DISTANCE, |p| {
        // XRTailor takes at most 100 steps.
        let solver = ZoneSolver::AugmentedLagrangian;
        impact_zones(p, ZoneParams { solver, max_sweeps: 100, ..ZoneParams::default() })
    }),
    // They keep 0.8 of the distance that the other methods keep. Zones as published keep none.
    lacking("impact zones, 0.8 delta", "edge limits, a fifth of the contact distance", |p| {
        impact_zones(p, ZoneParams { thickness: 0.8, ..ZoneParams::default() })
    }),
    lacking("rigid zones", "edge limits, contact distance, sliding", |p| Ok(Box::new(RigidZones::new(p)))),
    lacking("two phases", NO_DISTANCE, |p| two_phases(p, SOFT_ROUNDS)),
];

/// Rounds of the soft phase of `two phases`. A solve with more steps needed the hard phase.
pub const SOFT_ROUNDS: usize = 5;

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
        size.pick(self.limit.unwrap_or(4.0), 0.5, 1.0)
    }

    /// A key that distinguishes its measurements from those of other settings, and of this one with other parameters of
    /// the two-way loop. Parameters of the other methods are in their name alone.
    pub fn key(&self) -> String {
        let mut hasher = DefaultHasher::new();
        format!("{:?} {:?}", self.params, self.limit).hash(&mut hasher);
        format!("{} {:016x}", self.name(), hasher.finish())
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

/// Incremental potential contact (Li et al. 2020), and Eq. 7-8 by its Newton steps.
pub fn ipc(scene: CollisionScene, params: BarrierParams) -> Built {
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

/// The two-way method with a forward step by CCD, and one search per step along the paths.
fn forward<F: ForwardStep<SweptSearch> + 'static>(scene: CollisionScene, step: F) -> Built {
    let search = SweptSearch::new(&scene);
    let backward = LcpBackward::new();
    composed(Resolver::with_stages(scene, search, backward, step))
}

pub fn impact_zones(scene: CollisionScene, params: ZoneParams) -> Built {
    Ok(Box::new(ImpactZones::new(scene, params)?))
}

/// Wu et al. 2020: some rounds of impact zones, then a log barrier.
pub fn two_phases(scene: CollisionScene, soft_rounds: usize) -> Built {
    let hard = Composed::new("log barrier", by_descent(scene.clone(), BarrierParams::default())?);
    Ok(Box::new(TwoPhase::new(scene, soft_rounds, hard)?))
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

/// `paper` with the pairs within the contact distance as candidates: a barrier that ends there needs no others.
fn near_alone() -> Params {
    let mut params = Params::paper();
    params.contact.range = 1.0;
    params
}

/// `paper` with rows of active pairs only, as the methods have them that solve equations: those would glue all
/// pairs in range together.
fn active_rows() -> Params {
    let mut params = Params::paper();
    params.solver.backward.active_rows = true;
    params
}

/// The same without edge limits, which a linear system of equations would turn into rigid links (paper,
/// section 4.3.1).
fn without_edges() -> Params {
    let mut params = active_rows();
    params.contact.edges = false;
    params
}
