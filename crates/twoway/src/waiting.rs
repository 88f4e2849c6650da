//! Prescribed vertices that wait: who goes as one, who is behind, and when waiting is in vain.

use crate::{Behind, Call, Follower, Problem, State};

/// Numbers the groups of pinned vertices from 0; obstacles go as one anyway.
pub(crate) fn set_groups(problem: &mut Problem, groups: &[u32]) {
    problem.groups.clear();
    let mut names = std::mem::take(&mut problem.group_names);
    names.clear();
    let grouped = |v: usize| groups[v] != Call::NO_GROUP && problem.prescribed[v];
    names.extend((0..groups.len()).filter(|&v| grouped(v)).map(|v| groups[v]));
    names.sort_unstable();
    names.dedup();
    problem.group_count = names.len();
    if !names.is_empty() {
        let number = |v: usize| match grouped(v) && !problem.model.is_obstacle(v as u32) {
            true => names.binary_search(&groups[v]).map_or(Call::NO_GROUP, |number| number as u32),
            false => Call::NO_GROUP,
        };
        problem.groups = (0..groups.len()).map(number).collect();
    }
    problem.group_names = names;
}

/// Who waits, and how far behind, in the order of [`Follower`].
pub(crate) fn behind(problem: &Problem, state: &State) -> Vec<Behind> {
    let tolerance = problem.params.stop.distance * problem.lengths.edge;
    let mut waiting = std::collections::BTreeMap::new();
    for v in (0..state.x.len()).filter(|&v| problem.prescribed[v]) {
        let left = (state.target[v] - state.x[v]).norm();
        if left > tolerance {
            let body = problem.model.vertex_body()[v];
            let group = problem.groups.get(v).and_then(|&g| problem.group_names.get(g as usize));
            let who = match group {
                _ if problem.model.is_obstacle(v as u32) => Follower::Obstacle(body),
                Some(&name) => Follower::Group(name),
                None => Follower::Pins(body),
            };
            let farthest = waiting.entry(who).or_insert(0.0f64);
            *farthest = farthest.max(left);
        }
    }
    waiting.into_iter().map(|(who, distance_m)| Behind { who, distance_m }).collect()
}

/// Notices when nothing goes on any more but obstacles or pins that are blocked for good: waiting for them would
/// use up all steps of the call, and of every call after it.
#[derive(Debug, Default)]
pub(crate) struct Patience {
    /// Smallest distance so far by which the prescribed vertices are behind [m].
    behind: Option<f64>,
    /// Steps since that shrank noticeably.
    steps: usize,
}

impl Patience {
    /// Steps without progress after which the call gives up.
    const STEPS: usize = 16;
    /// Progress that counts, in mean edge lengths.
    const PROGRESS: f64 = 1e-3;

    /// Whether the free vertices have arrived and the prescribed ones are stuck.
    pub(crate) fn update(&mut self, problem: &Problem, state: &State) -> bool {
        let farthest = |prescribed: bool| {
            // A stage may bring prescribed vertices to their keyframes by way of other places.
            let ends = if prescribed { &state.target } else { &state.y };
            let vertices = (0..state.x.len()).filter(|&v| problem.prescribed[v] == prescribed);
            vertices.map(|v| (ends[v] - state.x[v]).norm()).fold(0.0, f64::max)
        };
        let edge = problem.lengths.edge;
        let behind = farthest(true);
        if self.behind.is_none_or(|best| behind < best - Self::PROGRESS * edge) {
            self.behind = Some(behind);
            self.steps = 0;
            return false;
        }
        let tolerance = problem.params.stop.distance * edge;
        if behind < tolerance || farthest(false) > tolerance {
            self.steps = 0;
            return false;
        }
        self.steps += 1;
        self.steps >= Self::STEPS
    }
}
