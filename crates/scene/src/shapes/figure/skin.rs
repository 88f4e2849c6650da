//! How the surface follows the bones: linear blend skinning.

use super::body::RestBody;
use super::skeleton::{BONES, Pose};
use bowknot_geometry::{Point, Topology, Vector};
use nalgebra::Matrix3;

/// Distance over which the influence of a bone falls by e [m]: joints bend over about twice of it.
const FALLOFF: f64 = 0.018;
/// Influences below this share are dropped.
const LEAST: f64 = 1e-3;
/// Length over which influences are evened out along the surface [m].
const SMOOTHING: f64 = 0.025;

/// Influences of the bones on each vertex.
#[derive(Clone, Debug)]
pub(super) struct Skin {
    /// `influences[starts[v]..starts[v + 1]]` are those of vertex v.
    starts: Vec<u32>,
    /// Bone and its share; the shares of a vertex add up to 1.
    influences: Vec<(u8, f64)>,
}

impl Skin {
    /// Influences by distance to the parts of each bone, evened out over the mesh of edges `edge` [m].
    pub fn new(body: &RestBody, positions: &[Point], topology: &Topology, edge: f64) -> Self {
        let mut weights: Vec<[f64; BONES]> = positions
            .iter()
            .map(|p| {
                let distances: [f64; BONES] = body.bone_distances(p);
                let nearest = distances.iter().copied().fold(f64::INFINITY, f64::min);
                normalized(distances.map(|d| libm::exp((nearest - d) / FALLOFF)))
            })
            .collect();
        let rounds = (SMOOTHING / edge).powi(2).round().clamp(0.0, 40.0) as usize;
        for _ in 0..rounds {
            let mut sums = weights.clone();
            let mut counts = vec![1.0; weights.len()];
            for &[a, b] in &topology.edges {
                let (a, b) = (a as usize, b as usize);
                for bone in 0..BONES {
                    sums[a][bone] += weights[b][bone];
                    sums[b][bone] += weights[a][bone];
                }
                counts[a] += 1.0;
                counts[b] += 1.0;
            }
            for ((weights, sum), count) in weights.iter_mut().zip(sums).zip(counts) {
                *weights = sum.map(|w| w / count);
            }
        }
        let (mut starts, mut influences) = (vec![0], Vec::new());
        for weights in weights {
            let kept = normalized(weights.map(|w| if w < LEAST { 0.0 } else { w }));
            influences.extend((0..BONES).filter(|&b| kept[b] > 0.0).map(|b| (b as u8, kept[b])));
            starts.push(influences.len() as u32);
        }
        Self { starts, influences }
    }

    /// Where vertices are in a pose, given where they are at rest.
    pub fn apply(&self, pose: &Pose, rest: &[Point]) -> Vec<Point> {
        let bones = pose.placements().map(|placement| {
            (placement.rotation.to_rotation_matrix().into_inner(), placement.translation.vector)
        });
        let place = |(v, rest): (usize, &Point)| {
            let own = &self.influences[self.starts[v] as usize..self.starts[v + 1] as usize];
            let (mut matrix, mut shift) = (Matrix3::zeros(), Vector::zeros());
            for &(bone, share) in own {
                let (rotation, translation) = &bones[bone as usize];
                matrix += rotation * share;
                shift += translation * share;
            }
            Point::from(matrix * rest.coords + shift)
        };
        rest.iter().enumerate().map(place).collect()
    }
}

fn normalized(weights: [f64; BONES]) -> [f64; BONES] {
    let sum: f64 = weights.iter().sum();
    weights.map(|w| w / sum)
}
