//! Collision problems, loaded to be solved.

use crate::bench::Bench;
use crate::record::Spec;
use anyhow::{Context, Result, anyhow};
use bowknot::proximity::CollisionModel;
use bowknot::recording::States;
use bowknot::twoway::{BodyContact, CallInput, CollisionScene, Params, Resolver};
use std::path::Path;

/// A collision problem. Friction is left out: few of the methods that are compared have any, and what it adds to the
/// target is no projection, so that an error would be of something else.
#[derive(Clone, Debug)]
pub struct Case {
    /// `scene/step`.
    pub name: String,
    /// What it is made of, without friction.
    pub states: States,
    pub model: CollisionModel,
    /// What sets the problem apart from the one that was recorded, for all methods alike.
    lengths: ProblemLengths,
}

/// Parameters that make another problem of a recorded one; none: as recorded.
#[derive(Clone, Copy, Debug, Default)]
pub struct ProblemLengths {
    /// Desired distance, in that of the recorded problem.
    pub delta: Option<f64>,
    /// Minimum separation, in desired distances of the recorded problem.
    pub min_separation: Option<f64>,
    /// Stretch limit sigma; infinite: edges have none.
    pub stretch_limit: Option<f64>,
}

impl Case {
    pub fn read(name: &str, path: &Path) -> Result<Self> {
        Self::new(name, States::read(path)?).with_context(|| path.display().to_string())
    }

    pub fn new(name: &str, mut states: States) -> Result<Self> {
        states.body_contacts.iter_mut().for_each(|body| body.friction = 0.0);
        states.half_space_contacts.iter_mut().for_each(|plane| plane.friction = 0.0);
        states.pair_frictions.clear();
        let model = states.collision_model().map_err(|message| anyhow!(message))?;
        Ok(Self { name: name.to_owned(), states, model, lengths: ProblemLengths::default() })
    }

    /// The problem with other lengths; `change` tells its measurements from those of the recorded one.
    pub fn under(&self, change: &str, lengths: ProblemLengths) -> Self {
        let mut case = Self { name: format!("{}/{change}", self.name), lengths, ..self.clone() };
        if let Some(limit) = lengths.stretch_limit {
            case.states.body_contacts.resize(self.model.bodies().len(), BodyContact::default());
            case.states.body_contacts.iter_mut().for_each(|body| body.stretch_limit = Some(limit));
        }
        case
    }

    /// Makes a resolver of the problem: parameters of a method, lengths of the case.
    pub fn resolver(&self, mut params: Params) -> Result<Resolver> {
        let recorded = |params: &Params| -> Result<f64> {
            let resolver = self.states.resolver(self.model.clone(), params.clone())?;
            Ok(resolver.scene().lengths().delta)
        };
        let ProblemLengths { delta, min_separation, .. } = self.lengths;
        if delta.is_some() || min_separation.is_some() {
            let of = recorded(&params)?;
            params.contact.delta = delta.map(|share| share * of).or(params.contact.delta);
            let own = params.contact.min_separation;
            params.contact.min_separation = min_separation.map(|share| share * of).or(own);
        }
        Ok(self.states.resolver(self.model.clone(), params)?)
    }

    /// Mean rest length of the edges [m]; none where there are none, as among grains.
    pub fn mean_edge(&self) -> Option<f64> {
        let rest = &self.states.rest;
        let edges = &self.model.topology().edges;
        let lengths = edges.iter().map(|[a, b]| (rest[*a as usize] - rest[*b as usize]).norm());
        (!edges.is_empty()).then(|| lengths.sum::<f64>() / edges.len() as f64)
    }

    /// The scene of the problem, as the stages of a method see it.
    pub fn scene(&self, params: Params) -> Result<CollisionScene> {
        Ok(self.resolver(params)?.scene().clone())
    }

    /// The scene under the parameters that results are judged by, and the input of the call.
    pub fn reference(&self) -> Result<(CollisionScene, CallInput)> {
        let scene = self.scene(Params::fast())?;
        let call = CallInput::new(&scene, &self.states.x, &self.states.y, &self.states.input())?;
        Ok((scene, call))
    }
}

/// Problems of a scene: `count` of those recorded, spread over them.
pub fn cases(bench: &Bench, scene: &str, count: usize) -> Result<Vec<Case>> {
    let files = Spec::of(scene)?.files(bench)?;
    let count = count.min(files.len());
    (0..count)
        .map(|k| {
            let file = &files[(2 * k + 1) * files.len() / (2 * count)];
            let step = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            Case::read(&format!("{scene}/{step}"), file)
        })
        .collect()
}
