//! Distances between elements, one number per vertex.

use super::edges::mean_edge;
use super::folder::RunFolder;
use crate::exit::Failure;
use bowknot::geometry::{HalfSpace, Point, Topology};
use bowknot::proximity::{BodyFilter, CollisionModel, Pair, PairList, ProximitySearch};

/// Largest gap that is measured, relative to the mean edge length. Elements a few edges apart on the same
/// sheet are farther from each other, so that smaller gaps are contacts.
const CAP: f64 = 0.5;

/// Measures gaps.
pub struct Gaps {
    model: CollisionModel,
    cap: f64,
}

impl Gaps {
    /// Measures gaps up to `cap` [m], by default half the mean edge length. Collision groups are ignored.
    pub fn new(run: &RunFolder, cap: Option<f64>) -> Result<Self, Failure> {
        let mesh = run.elements();
        let n = mesh.positions.len();
        let default = || mean_edge(mesh).map_or(4.0 * run.radius(), |length| CAP * length);
        let cap = cap.unwrap_or_else(default);
        // Two bodies are enough here: the deformable bodies as one and the obstacles as one.
        let bodies = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
        let body = (0..n).map(|v| u32::from(run.is_obstacle(v))).collect();
        let bad_input =
            |error: &dyn std::fmt::Display| Failure::input(format!("the frames cannot be searched: {error}"));
        let topology = Topology::builder(n)
            .triangles(mesh.triangles.iter().copied())
            .strand_edges(mesh.strands.iter().copied())
            .particles(mesh.particles.iter().copied())
            .build()
            .map_err(|errors| bad_input(&errors.first().map(ToString::to_string).unwrap_or_default()))?;
        let model = CollisionModel::new(topology, body, bodies, Vec::new()).map_err(|e| bad_input(&e))?;
        Ok(Self { model, cap })
    }

    /// Largest gap that is measured [m].
    pub fn cap(&self) -> f64 {
        self.cap
    }

    /// For each vertex, the smallest distance from an element with this vertex to an element that shares no
    /// vertex with it [m], or to the `ground`; the cap, if there is none within the cap. Elements with a
    /// vertex that is `absent` count for nothing; one entry per vertex, or none at all.
    pub fn measure(&self, positions: &[Point], ground: &[HalfSpace], absent: &[bool]) -> Vec<f64> {
        let mut gaps = vec![self.cap; positions.len()];
        let (mut pairs, mut separations) = (PairList::default(), Vec::new());
        // A pair is a candidate if its distance is below the sum of the radii of its sides. Half-spaces have
        // no radius and are measured directly.
        let radii = vec![self.cap / 2.0; positions.len()];
        ProximitySearch::new(&self.model).search(
            &self.model,
            positions,
            &radii,
            &mut pairs,
            &mut separations,
        );
        let is_there = |pair: &Pair| !pair.vertices.iter().any(|v| absent.get(*v as usize) == Some(&true));
        for (pair, separation) in pairs.pairs().iter().zip(&separations).filter(|(pair, _)| is_there(pair)) {
            for &v in &pair.vertices {
                gaps[v as usize] = gaps[v as usize].min(separation.distance);
            }
        }
        for (gap, position) in gaps.iter_mut().zip(positions) {
            for half_space in ground {
                *gap = gap.min(half_space.signed_distance(position));
            }
        }
        gaps
    }
}
