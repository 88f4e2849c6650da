//! Distances between elements, a number a vertex.

use super::folder::RunFolder;
use super::mean_edge;
use crate::failure::Failure;
use bowknot::geometry::{Point, Topology};
use bowknot::proximity::{BodyFilter, CollisionModel, PairList, ProximitySearch};

/// Largest gap that is looked for, as a share of the mean edge length: elements a few edges apart on the same sheet are
/// farther from each other, so that what is seen are contacts.
const CAP: f64 = 0.5;

/// Finds gaps.
pub struct Gaps {
    model: CollisionModel,
    cap: f64,
}

impl Gaps {
    /// Gaps up to `cap` [m], by default half the mean edge length. Collision groups are not looked at.
    pub fn new(run: &RunFolder, cap: Option<f64>) -> Result<Self, Failure> {
        let mesh = run.elements();
        let n = mesh.positions.len();
        let default = || mean_edge(mesh, &mesh.positions).map_or(4.0 * run.radius(), |length| CAP * length);
        let cap = cap.unwrap_or_else(default);
        // A deformable body and an obstacle: more is not asked for.
        let bodies = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
        let body = (0..n).map(|v| u32::from(run.is_obstacle(v))).collect();
        let fault =
            |error: &dyn std::fmt::Display| Failure::input(format!("the frames cannot be searched: {error}"));
        let topology = Topology::builder(n)
            .triangles(mesh.triangles.iter().copied())
            .strand_edges(mesh.strands.iter().copied())
            .particles(mesh.particles.iter().copied())
            .build()
            .map_err(|errors| fault(&errors.first().map(ToString::to_string).unwrap_or_default()))?;
        let model =
            CollisionModel::new(topology, body, bodies, run.ground().to_vec()).map_err(|e| fault(&e))?;
        Ok(Self { model, cap })
    }

    /// Largest gap that is told [m].
    pub fn cap(&self) -> f64 {
        self.cap
    }

    /// Of each vertex the smallest distance of an element that it belongs to from one that shares no vertex with that
    /// [m]; where there is none within the cap, the cap.
    pub fn of(&self, positions: &[Point]) -> Vec<f64> {
        let mut gaps = vec![self.cap; positions.len()];
        let (mut pairs, mut separations) = (PairList::default(), Vec::new());
        let half_spaces = self.model.half_spaces();
        // A pair is listed within the sum of its sides' radii; half-spaces have none, and are simple.
        let radii = vec![self.cap / 2.0; positions.len()];
        ProximitySearch::new(&self.model).search(
            &self.model,
            positions,
            &radii,
            &mut pairs,
            &mut separations,
        );
        for (pair, separation) in pairs.pairs().iter().zip(&separations) {
            for &v in &pair.vertices {
                gaps[v as usize] = gaps[v as usize].min(separation.distance);
            }
        }
        for (gap, position) in gaps.iter_mut().zip(positions) {
            for half_space in half_spaces {
                *gap = gap.min(half_space.signed_distance(position));
            }
        }
        gaps
    }
}
