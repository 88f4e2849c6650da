//! What the judge says of files.

use super::elements::{PartElement, part_name};
use crate::check::{BodyPair, PathHit};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Verdict on all frames.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct JudgingReport {
    /// Whether nothing intersects and nothing is too near. Hints between frames do not count.
    pub clear: bool,
    /// Number of states.
    pub states: usize,
    /// Number of states that intersect.
    pub intersecting_states: usize,
    /// Number of paths that were judged, those between frames included.
    pub paths: usize,
    /// Intersecting pairs of elements over all states.
    pub intersections: usize,
    /// Pairs that meet, or are not certified to stay apart, over the paths of traces.
    pub path_hits: usize,
    /// The same over straight paths between frames: hints.
    pub hints_between_frames: usize,
    /// Triangles that no deformable body may have, over all meshes; they do not count as intersections.
    pub mesh_problems: usize,
    /// Smallest distance over all states [m].
    pub min_distance_m: Option<f64>,
    /// Whether a distance is below the one asked for.
    pub too_near: bool,
    /// The pairs of parts that intersect in any state, the most frequent first.
    pub pairs: Vec<PartPair>,
    /// The pairs of parts that meet on a straight path between frames, the most frequent first: hints.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub hint_pairs: Vec<HintPair>,
    /// Parts that lie inside of others without meeting them: hints.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub inside: Vec<InsidePair>,
    /// All states in order, each with the path that leads to it.
    pub files: Vec<FrameVerdict>,
}

/// Two parts that intersect, or one that intersects itself, over all states.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PartPair {
    /// Names of the parts.
    pub parts: [String; 2],
    /// Number of states in which they intersect.
    pub states: usize,
    /// The first of these states.
    pub first: String,
    /// Pairs of elements in the state that has the most.
    pub most: usize,
    /// That state.
    pub worst: String,
    /// The deepest intersection [m], see [`Intersection::depth`](crate::check::Intersection::depth).
    pub depth_m: f64,
    /// The state that has it.
    pub deepest: String,
    /// Where it is there [m].
    pub place_m: [f64; 3],
}

/// Two parts that meet between frames, or one that meets itself, over all paths.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HintPair {
    /// Names of the parts.
    pub parts: [String; 2],
    /// Number of paths on which they meet.
    pub paths: usize,
    /// The state at the end of the first of them.
    pub first: String,
    /// Pairs of elements on the path that has the most.
    pub most: usize,
    /// The state at its end.
    pub worst: String,
    /// Where the first pair of elements of that path meets [m].
    pub place_m: [f64; 3],
}

/// A part that lies, with one of its connected components at least, inside of the closed surface of another one
/// and does not meet it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InsidePair {
    /// The part.
    pub part: String,
    /// The part whose surface is closed.
    pub within: String,
    /// Number of states in which it does.
    pub states: usize,
    /// The first of them.
    pub first: String,
}

/// Verdict on one state and the path that leads to it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FrameVerdict {
    /// The file; with the number of the frame if it has several.
    pub file: String,
    /// Time of the frame, if the file knows it [s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_s: Option<f64>,
    /// Time code of the frame, in a file that has them: a USD stage.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_code: Option<f64>,
    /// Pairs of elements that intersect.
    pub intersections: usize,
    /// Pairs that meet on the path of a trace that leads here; none if there is none.
    pub path_hits: Option<usize>,
    /// Pairs that meet on the straight path from the frame before: hints. None if it was not judged.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hints_between_frames: Option<usize>,
    /// Smallest distance [m]; none if there are no two elements.
    pub min_distance_m: Option<f64>,
    /// The pairs of parts that intersect, by their numbers.
    pub pairs: Vec<PartPairOfFrame>,
    /// The first intersections, as text.
    pub findings: Vec<String>,
    /// The elements of these intersections, as the parts number them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub elements: Vec<[PartElement; 2]>,
    /// The pairs of parts that meet on the straight path from the frame before.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub hint_pairs: Vec<HintPairOfFrame>,
}

/// Two parts that meet, or one that meets itself, on the straight path to a state.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HintPairOfFrame {
    /// Names of the parts.
    pub parts: [String; 2],
    /// Pairs of elements.
    pub hints: usize,
    /// Where the first of them meets [m].
    pub place_m: [f64; 3],
}

impl HintPairOfFrame {
    /// The pairs of hits, in the order of their parts' numbers.
    pub(super) fn all_of(hits: &[PathHit], names: &[String]) -> Vec<Self> {
        let mut pairs: BTreeMap<[Option<u32>; 2], (usize, [f64; 3])> = BTreeMap::new();
        for hit in hits {
            let mut bodies = hit.bodies;
            bodies.sort_unstable();
            pairs.entry(bodies).or_insert((0, hit.places[0].coords.into())).0 += 1;
        }
        let pair = |(bodies, (hints, place_m)): ([Option<u32>; 2], _)| Self {
            parts: bodies.map(|body| part_name(body, names)),
            hints,
            place_m,
        };
        pairs.into_iter().map(pair).collect()
    }
}

/// Two parts that intersect, or one that intersects itself, in one state.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PartPairOfFrame {
    /// Names of the parts.
    pub parts: [String; 2],
    /// Pairs of elements.
    pub intersections: usize,
    /// The deepest one [m], see [`Intersection::depth`](crate::check::Intersection::depth).
    pub depth_m: f64,
    /// Where it is [m].
    pub place_m: [f64; 3],
}

impl PartPairOfFrame {
    /// With the names of the bodies; half-spaces have none.
    pub(super) fn new(pair: &BodyPair, names: &[String]) -> Self {
        Self {
            parts: pair.bodies.map(|body| part_name(body, names)),
            intersections: pair.count,
            depth_m: pair.depth.unwrap_or(0.0),
            place_m: pair.place.coords.into(),
        }
    }
}

impl JudgingReport {
    /// Adds a state, with its counts.
    pub(super) fn add(&mut self, frame: FrameVerdict) {
        self.states += 1;
        self.intersecting_states += usize::from(frame.intersections > 0);
        self.intersections += frame.intersections;
        self.paths += usize::from(frame.path_hits.is_some() || frame.hints_between_frames.is_some());
        self.path_hits += frame.path_hits.unwrap_or(0);
        self.hints_between_frames += frame.hints_between_frames.unwrap_or(0);
        self.min_distance_m = match (self.min_distance_m, frame.min_distance_m) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
        for found in &frame.pairs {
            let state = || frame.file.clone();
            let known = self.pairs.iter_mut().find(|pair| pair.parts == found.parts);
            let Some(pair) = known else {
                self.pairs.push(PartPair {
                    parts: found.parts.clone(),
                    states: 1,
                    first: state(),
                    most: found.intersections,
                    worst: state(),
                    depth_m: found.depth_m,
                    deepest: state(),
                    place_m: found.place_m,
                });
                continue;
            };
            pair.states += 1;
            if found.intersections > pair.most {
                (pair.most, pair.worst) = (found.intersections, state());
            }
            if found.depth_m > pair.depth_m {
                (pair.depth_m, pair.deepest, pair.place_m) = (found.depth_m, state(), found.place_m);
            }
        }
        for found in &frame.hint_pairs {
            let state = || frame.file.clone();
            let known = self.hint_pairs.iter_mut().find(|pair| pair.parts == found.parts);
            let Some(pair) = known else {
                self.hint_pairs.push(HintPair {
                    parts: found.parts.clone(),
                    paths: 1,
                    first: state(),
                    most: found.hints,
                    worst: state(),
                    place_m: found.place_m,
                });
                continue;
            };
            pair.paths += 1;
            if found.hints > pair.most {
                (pair.most, pair.worst, pair.place_m) = (found.hints, state(), found.place_m);
            }
        }
        self.files.push(frame);
    }

    /// Adds the parts that lie inside of others in a state.
    pub(super) fn add_inside(&mut self, pairs: &BTreeSet<[u32; 2]>, names: &[String], state: &str) {
        for pair in pairs {
            let [part, within] = pair.map(|body| part_name(Some(body), names));
            match self.inside.iter_mut().find(|known| known.part == part && known.within == within) {
                Some(known) => known.states += 1,
                None => self.inside.push(InsidePair { part, within, states: 1, first: state.to_owned() }),
            }
        }
    }

    /// Puts the pairs in order and decides.
    pub(super) fn finish(mut self) -> Self {
        // The sort is stable: equal ones stay in the order in which they were found.
        self.pairs.sort_by_key(|pair| std::cmp::Reverse((pair.states, pair.most)));
        self.hint_pairs.sort_by_key(|pair| std::cmp::Reverse((pair.paths, pair.most)));
        self.clear = self.intersections == 0 && self.path_hits == 0 && !self.too_near;
        self
    }
}
