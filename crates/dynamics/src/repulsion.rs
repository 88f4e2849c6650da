//! Quadratic repulsion: springs that push close pairs apart before contact has to (section 6.2 of the paper).
//!
//! Whoever knows which primitives are near each other hands in springs; the Newton system then has, for each,
//!
//! ```text
//! E = k/2 max(0, desired - gap)^2,   gap = sum_i g_i . x_i - offset,   g_i = beta_i n
//! ```
//!
//! with weights beta (positive on one side, negative on the other) and normal n kept for the step. Its Hessian
//! k g g^T is applied without being stored; the blocks g_i g_i^T stand in the diagonal, where preconditioners see
//! them.

use crate::elements::CHUNK;
use crate::model::NO_NODE;
use crate::{DynamicsModel, StepError};
use bowknot_geometry::{Point, Vector};
use nalgebra::Matrix3;
use rayon::prelude::*;

/// A spring between up to four vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RepulsionSpring {
    /// The vertices; obstacles are welcome. Where there are fewer than four, any vertex with weight 0.
    pub vertices: [u32; 4],
    /// Their weights beta [1], barycentric: positive on the side that the normal points to, negative on the other.
    pub weights: [f64; 4],
    /// Unit normal n [1].
    pub normal: Vector,
    /// What is taken from sum beta_i n.x_i [m]: 0 between primitives, n.p for a half-space through p.
    pub offset: f64,
    /// Gap below which it pushes [m].
    pub desired: f64,
    /// Stiffness k [N/m].
    pub stiffness: f64,
}

impl RepulsionSpring {
    /// Signed gap [m] at positions `x` [m] of all vertices.
    pub fn gap(&self, x: &[Point]) -> f64 {
        (0..4)
            .filter(|&k| self.weights[k] != 0.0)
            .map(|k| self.weights[k] * self.normal.dot(&x[self.vertices[k] as usize].coords))
            .sum::<f64>()
            - self.offset
    }

    /// Energy [J] at a gap [m].
    pub fn energy(&self, gap: f64) -> f64 {
        0.5 * self.stiffness * (self.desired - gap).max(0.0).powi(2)
    }
}

/// The springs of a scene, over nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Repulsion {
    springs: Vec<RepulsionSpring>,
    /// Nodes of each spring; NO_NODE for obstacles and weights of 0.
    nodes: Vec<[u32; 4]>,
    /// Springs and places there by node: `entries[starts[n]..starts[n + 1]]`.
    starts: Vec<u32>,
    entries: Vec<(u32, u8)>,
    /// What obstacles add to the gap, less the offset [m].
    fixed: Vec<f64>,
    /// Stiffness where it pushes, else 0 [N/m], and force [N] of the last linearisation.
    active: Vec<f64>,
    force: Vec<f64>,
}

impl Repulsion {
    /// Checks and sorts the springs.
    pub fn new(model: &DynamicsModel, springs: &[RepulsionSpring]) -> Result<Self, StepError> {
        for (spring, s) in springs.iter().enumerate() {
            let refuse = |problem| Err(StepError::Repulsion { spring, problem });
            if s.vertices.iter().zip(s.weights).any(|(&v, w)| w != 0.0 && v as usize >= model.vertex_count())
            {
                return refuse("it names a vertex that does not exist");
            }
            let numbers = s.weights.iter().chain(s.normal.iter()).chain([&s.offset, &s.desired]);
            if !numbers.into_iter().all(|value| value.is_finite()) {
                return refuse("its weights, normal, offset and desired gap must be finite");
            }
            if !(s.stiffness >= 0.0 && s.stiffness.is_finite()) {
                return refuse("its stiffness must be a finite number, 0 or more");
            }
        }
        let node = |v: u32, w: f64| if w == 0.0 { NO_NODE } else { model.vertex_node[v as usize] };
        let nodes: Vec<[u32; 4]> =
            springs.iter().map(|s| std::array::from_fn(|k| node(s.vertices[k], s.weights[k]))).collect();
        // Counting sort by node: entries of a node stay in the order of springs.
        let mut starts = vec![0u32; model.node_vertex.len() + 1];
        let used = || {
            nodes.iter().enumerate().flat_map(|(s, n)| (0..4u8).map(move |k| (s as u32, k, n[k as usize])))
        };
        used().filter(|entry| entry.2 != NO_NODE).for_each(|(_, _, n)| starts[n as usize + 1] += 1);
        (1..starts.len()).for_each(|n| starts[n] += starts[n - 1]);
        let mut next = starts.clone();
        let mut entries = vec![(0, 0); starts.last().map_or(0, |end| *end as usize)];
        for (s, k, n) in used().filter(|entry| entry.2 != NO_NODE) {
            entries[next[n as usize] as usize] = (s, k);
            next[n as usize] += 1;
        }
        let count = springs.len();
        Ok(Self {
            springs: springs.to_vec(),
            nodes,
            starts,
            entries,
            fixed: vec![0.0; count],
            active: vec![0.0; count],
            force: vec![0.0; count],
        })
    }

    pub fn is_empty(&self) -> bool {
        self.springs.is_empty()
    }

    /// Places obstacles at their keyframes, by vertex.
    pub fn place_obstacles(&mut self, keyframes: &[Point]) {
        for ((fixed, spring), nodes) in self.fixed.iter_mut().zip(&self.springs).zip(&self.nodes) {
            *fixed = -spring.offset;
            for k in (0..4).filter(|&k| nodes[k] == NO_NODE && spring.weights[k] != 0.0) {
                let place = keyframes[spring.vertices[k] as usize].coords;
                *fixed += spring.weights[k] * spring.normal.dot(&place);
            }
        }
    }

    #[inline]
    fn gap(&self, spring: usize, x: impl Fn(usize) -> Vector) -> f64 {
        let s = &self.springs[spring];
        let mut sum = Vector::zeros();
        for (&node, weight) in self.nodes[spring].iter().zip(s.weights) {
            if node != NO_NODE {
                sum += x(node as usize) * weight;
            }
        }
        s.normal.dot(&sum) + self.fixed[spring]
    }

    /// Linearises at `x`; a spring pushes if its gap is too small with prescribed nodes moved by `imposed`.
    pub fn linearise(&mut self, x: &[Vector], imposed: &[Vector]) {
        let mut active = std::mem::take(&mut self.active);
        let mut force = std::mem::take(&mut self.force);
        active.par_iter_mut().zip(&mut force).enumerate().with_min_len(CHUNK).for_each(
            |(spring, (active, force))| {
                let s = &self.springs[spring];
                let pushes = self.gap(spring, |n| x[n] + imposed[n]) < s.desired;
                *active = if pushes { s.stiffness } else { 0.0 };
                *force = *active * (s.desired - self.gap(spring, |n| x[n]));
            },
        );
        (self.active, self.force) = (active, force);
    }

    /// The diagonal block of a node, and its share of the gradient.
    #[inline]
    pub fn add_node(&self, node: usize, diagonal: &mut Matrix3<f64>, gradient: &mut Vector) {
        for &(spring, k) in self.entries(node) {
            let (spring, k) = (spring as usize, k as usize);
            if self.active[spring] > 0.0 {
                let g = self.springs[spring].normal * self.springs[spring].weights[k];
                *diagonal += g * g.transpose() * self.active[spring];
                *gradient -= g * self.force[spring];
            }
        }
    }

    /// A row of the off-diagonal part times `x`.
    #[inline]
    pub fn row_product(&self, node: usize, x: &[Vector]) -> Vector {
        let mut sum = Vector::zeros();
        for &(spring, place) in self.entries(node) {
            let spring = spring as usize;
            if self.active[spring] > 0.0 {
                let s = &self.springs[spring];
                let mut others = Vector::zeros();
                for (k, &other) in self.nodes[spring].iter().enumerate() {
                    if k != place as usize && other != NO_NODE {
                        others += x[other as usize] * s.weights[k];
                    }
                }
                sum += s.normal * (self.active[spring] * s.weights[place as usize] * s.normal.dot(&others));
            }
        }
        sum
    }

    fn entries(&self, node: usize) -> &[(u32, u8)] {
        &self.entries[self.starts[node] as usize..self.starts[node + 1] as usize]
    }

    /// Energy [J] at positions `x` of nodes.
    pub fn energy(&self, x: &[Vector]) -> f64 {
        let partial: Vec<f64> = (0..self.springs.len().div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let springs = chunk * CHUNK..((chunk + 1) * CHUNK).min(self.springs.len());
                springs.map(|s| self.springs[s].energy(self.gap(s, |n| x[n]))).sum()
            })
            .collect();
        partial.iter().sum()
    }

    /// Nodes that springs join and push, with whether anything but them holds: weights that do not cancel, obstacles.
    pub fn for_each_bond(&self, mut visit: impl FnMut(&[u32], bool)) {
        for (spring, nodes) in self.nodes.iter().enumerate().filter(|(s, _)| self.active[*s] > 0.0) {
            let mut joined = [NO_NODE; 4];
            let (mut count, mut sum) = (0, 0.0);
            for (&node, weight) in nodes.iter().zip(self.springs[spring].weights) {
                if node != NO_NODE {
                    joined[count] = node;
                    count += 1;
                    sum += weight;
                }
            }
            visit(&joined[..count], sum.abs() > 1e-9);
        }
    }

    /// The springs, as given.
    pub fn springs(&self) -> &[RepulsionSpring] {
        &self.springs
    }
}
