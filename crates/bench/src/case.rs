//! Recorded collision problems, loaded to be solved.

use crate::bench::Bench;
use crate::record::ProblemSet;
use anyhow::{Context, Result, anyhow};
use bowknot::geometry::CollisionModel;
use bowknot::recording::States;
use bowknot::twoway::{BodyContact, CallInput, CollisionScene, Params, Resolver};
use std::path::Path;

/// A collision problem without friction, and without what the dynamics know about its contacts. Few of the methods that
/// are compared have friction, and a problem with it is no projection of the target, so that distances to a projection
/// would not measure the error. Known contacts are asked for less distance by the two-way method alone.
#[derive(Clone, Debug)]
pub struct CollisionCase {
    /// `scene/step`.
    pub name: String,
    /// The recorded state and target, without friction.
    pub states: States,
    pub model: CollisionModel,
    /// How its lengths differ from the recorded problem's, for all methods alike.
    lengths: ProblemLengths,
}

/// Lengths that define the problem; none: as recorded.
#[derive(Clone, Copy, Debug, Default)]
pub struct ProblemLengths {
    /// Contact distance delta, as a multiple of the recorded problem's.
    pub delta: Option<f64>,
    /// Minimum separation, as a multiple of the recorded problem's delta.
    pub min_separation: Option<f64>,
    /// Stretch limit sigma; infinite: edges have none.
    pub stretch_limit: Option<f64>,
}

impl CollisionCase {
    pub fn read(name: &str, path: &Path) -> Result<Self> {
        Self::new(name, States::read(path)?).with_context(|| path.display().to_string())
    }

    pub fn new(name: &str, mut states: States) -> Result<Self> {
        states.body_contacts.iter_mut().for_each(|body| body.friction = 0.0);
        states.half_space_contacts.iter_mut().for_each(|plane| plane.friction = 0.0);
        states.pair_frictions.clear();
        states.known.clear();
        states.carried.clear();
        let model = states.collision_model().map_err(|message| anyhow!(message))?;
        Ok(Self { name: name.to_owned(), states, model, lengths: ProblemLengths::default() })
    }

    /// The problem with other lengths; `change` distinguishes its measurements from those of the recorded
    /// problem.
    pub fn with_lengths(&self, change: &str, lengths: ProblemLengths) -> Self {
        let mut case = Self { name: format!("{}/{change}", self.name), lengths, ..self.clone() };
        if let Some(limit) = lengths.stretch_limit {
            case.states.body_contacts.resize(self.model.bodies().len(), BodyContact::default());
            case.states.body_contacts.iter_mut().for_each(|body| body.stretch_limit = Some(limit));
        }
        case
    }

    /// A resolver of the problem, with the parameters of a method and the lengths of the case.
    pub fn resolver(&self, mut params: Params) -> Result<Resolver> {
        let recorded = |params: &Params| -> Result<f64> {
            let resolver = self.states.resolver(self.model.clone(), params.clone())?;
            Ok(resolver.scene().lengths().delta)
        };
        // The paper asks pairs that begin nearer than delta for the whole of it at once. Here all methods are asked for
        // the same.
        params.contact.separation_speed = params.contact.separation_speed.filter(|speed| speed.is_finite());
        let ProblemLengths { delta, min_separation, .. } = self.lengths;
        if delta.is_some() || min_separation.is_some() {
            let of = recorded(&params)?;
            params.contact.delta = delta.map(|share| share * of).or(params.contact.delta);
            let own = params.contact.min_separation;
            params.contact.min_separation = min_separation.map(|share| share * of).or(own);
        }
        Ok(self.states.resolver(self.model.clone(), params)?)
    }

    /// Mean rest length of the edges [m]; none if there are no edges, as in sand.
    pub fn mean_edge(&self) -> Option<f64> {
        let rest = &self.states.rest;
        let edges = &self.model.topology().edges;
        let lengths = edges.iter().map(|[a, b]| (rest[*a as usize] - rest[*b as usize]).norm());
        (!edges.is_empty()).then(|| lengths.sum::<f64>() / edges.len() as f64)
    }

    /// The scene of the problem, with the parameters of a method, as its stages take it.
    pub fn scene(&self, params: Params) -> Result<CollisionScene> {
        Ok(self.resolver(params)?.scene().clone())
    }

    /// The scene with the parameters that results are measured with, `fast`, and the input of
    /// the call.
    pub fn reference(&self) -> Result<(CollisionScene, CallInput)> {
        let scene = self.scene(Params::fast())?;
        let call = CallInput::new(&scene, &self.states.x, &self.states.y, &self.states.input())?;
        Ok((scene, call))
    }
}

/// `count` of the recorded problems of a set, spread evenly over them.
pub fn cases(bench: &Bench, scene: &str, count: usize) -> Result<Vec<CollisionCase>> {
    let files = ProblemSet::of(scene)?.files(bench)?;
    let count = count.min(files.len());
    (0..count)
        .map(|k| {
            let file = &files[(2 * k + 1) * files.len() / (2 * count)];
            let step = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            CollisionCase::read(&format!("{scene}/{step}"), file)
        })
        .collect()
}
