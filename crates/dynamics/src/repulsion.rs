//! Quadratic repulsion (section 6.2 of the paper): springs by which Newton's method knows of contacts.
//!
//! Without them a target is made as if nothing were in the way: a stiff body that rests on something falls on within
//! itself, and the collision stage, which knows no elasticity, pushes back the vertices that touch alone. Whoever knows
//! which primitives are near each other hands in springs; the Newton system then has, for each that pushes,
//!
//! ```text
//! E = k/2 (desired - gap)^2 + F(|slip|),   gap = n . s - offset,   slip = (1 - n n^T)(s - s0),   s = sum_i beta_i x_i
//! ```
//!
//! with weights beta (positive on one side, negative on the other) and normal n kept for the step, s0 = s at its start.
//! F is friction with the lagged bound f = mu k (desired - gap): k/2 |slip|^2 while k |slip| <= f, from there on
//! f (|slip| - f / 2k); smooth and convex, as in Li et al. 2020 (IPC), section 5, but for the lag of f and of what pushes.
//! Both are brought up to date after a solve, by `settle`.
//!
//! The Hessian is applied without being stored: each spring's reaction first, then the nodes gather them. Preconditioners
//! ask for its blocks.

use crate::elements::CHUNK;
use crate::model::NO_NODE;
use crate::{DynamicsModel, StepError};
use bowknot_geometry::{Point, Vector};
use nalgebra::Matrix3;
use rayon::prelude::*;

/// A spring counts as pushing at first if inertia leads to less than the desired gap and this share of it more: bodies at
/// rest keep their gap to rounding.
const NEARLY: f64 = 0.01;

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
    /// Stiffness k in units of the bodies' own at the contact [1]: 1 / sum beta_i^2 / (n . H_ii n), H_ii the blocks of the
    /// Newton system, inertia included, of vertices that are free at the start of the time step.
    pub stiffness: f64,
    /// Coefficient of friction mu [1]; 0: it pushes along the normal alone.
    pub friction: f64,
}

/// The springs of a scene, over nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Repulsion {
    springs: Vec<RepulsionSpring>,
    /// Nodes of each spring; NO_NODE for obstacles and weights of 0.
    nodes: Vec<[u32; 4]>,
    /// What obstacles add to s [m].
    fixed: Vec<Vector>,
    /// s at the start of the time step [m].
    anchors: Vec<Vector>,
    /// k [N/m], fixed within a time step; 0 if no vertex is free.
    stiffness: Vec<f64>,
    /// f [N]; infinite before it is known: sticks.
    friction: Vec<f64>,
    pushes: Vec<bool>,
    /// The springs that push, as of the last linearisation, with Hessian by s [N/m] and force [N].
    pushing: Vec<Pushing>,
    /// Places of nodes in `pushing`: `entries[starts[n]..starts[n + 1]]`, with their weights.
    starts: Vec<u32>,
    entries: Vec<(u32, f64)>,
}

/// A spring that pushes.
#[derive(Clone, Copy, Debug)]
struct Pushing {
    nodes: [u32; 4],
    weights: [f64; 4],
    hessian: Matrix3<f64>,
    force: Vector,
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
            if ![s.stiffness, s.friction].iter().all(|value| *value >= 0.0 && value.is_finite()) {
                return refuse("its stiffness and friction must be finite numbers, 0 or more");
            }
        }
        let node = |v: u32, w: f64| if w == 0.0 { NO_NODE } else { model.vertex_node[v as usize] };
        let nodes: Vec<[u32; 4]> =
            springs.iter().map(|s| std::array::from_fn(|k| node(s.vertices[k], s.weights[k]))).collect();
        let count = springs.len();
        Ok(Self {
            springs: springs.to_vec(),
            nodes,
            fixed: vec![Vector::zeros(); count],
            anchors: vec![Vector::zeros(); count],
            stiffness: vec![0.0; count],
            friction: vec![0.0; count],
            pushes: vec![false; count],
            pushing: Vec::new(),
            starts: vec![0; model.node_vertex.len() + 1],
            entries: Vec::new(),
        })
    }

    pub fn is_empty(&self) -> bool {
        self.springs.is_empty()
    }

    /// Whether any pushed at the last linearisation.
    pub fn any_pushes(&self) -> bool {
        !self.pushing.is_empty()
    }

    /// Starts a time step at positions `x` of all vertices.
    pub fn begin_step(&mut self, x: &[Point]) {
        for (anchor, s) in self.anchors.iter_mut().zip(&self.springs) {
            let used = (0..4).filter(|&k| s.weights[k] != 0.0);
            *anchor = used.map(|k| x[s.vertices[k] as usize].coords * s.weights[k]).sum();
        }
    }

    /// Places obstacles at their keyframes, by vertex.
    pub fn place_obstacles(&mut self, keyframes: &[Point]) {
        for ((fixed, spring), nodes) in self.fixed.iter_mut().zip(&self.springs).zip(&self.nodes) {
            let obstacles = (0..4).filter(|&k| nodes[k] == NO_NODE && spring.weights[k] != 0.0);
            *fixed =
                obstacles.map(|k| keyframes[spring.vertices[k] as usize].coords * spring.weights[k]).sum();
        }
    }

    /// How much is missing to the desired gap [m], and the slip [m], with nodes at `x`.
    #[inline]
    fn depth_and_slip(&self, spring: usize, x: &[Vector]) -> (f64, Vector) {
        let s = &self.springs[spring];
        let mut sides = self.fixed[spring];
        for (&node, weight) in self.nodes[spring].iter().zip(s.weights) {
            if node != NO_NODE {
                sides += x[node as usize] * weight;
            }
        }
        let moved = sides - self.anchors[spring];
        (s.desired + s.offset - s.normal.dot(&sides), moved - s.normal * s.normal.dot(&moved))
    }

    /// Fixes the stiffness for a time step and says which springs push at first: those that would with nodes where inertia
    /// leads, `predicted`. `diagonal` has the blocks of the Newton system without springs.
    pub fn stiffen(&mut self, diagonal: &[Matrix3<f64>], free: &[bool], predicted: &[Vector]) {
        let mut stiffness = std::mem::take(&mut self.stiffness);
        let mut friction = std::mem::take(&mut self.friction);
        let mut pushes = std::mem::take(&mut self.pushes);
        let all = stiffness.par_iter_mut().zip(&mut friction).zip(&mut pushes).enumerate();
        all.with_min_len(CHUNK).for_each(|(spring, ((stiffness, friction), pushes))| {
            let s = &self.springs[spring];
            let mut compliance = 0.0;
            for (&node, weight) in self.nodes[spring].iter().zip(s.weights) {
                if node != NO_NODE && free[node as usize] {
                    compliance += weight * weight / s.normal.dot(&(diagonal[node as usize] * s.normal));
                }
            }
            *stiffness = if compliance > 0.0 { s.stiffness / compliance } else { 0.0 };
            let (depth, slip) = self.depth_and_slip(spring, predicted);
            *pushes = *stiffness > 0.0 && depth > -NEARLY * s.desired;
            // Coulomb's law for the vertices on their own: it holds at first what they would hold.
            *friction = if slip.norm() <= s.friction * depth { f64::INFINITY } else { 0.0 };
        });
        (self.stiffness, self.friction, self.pushes) = (stiffness, friction, pushes);
    }

    /// Linearises the springs that push at `x`.
    pub fn linearise(&mut self, x: &[Vector]) {
        let live: Vec<u32> = (0..self.springs.len() as u32).filter(|&s| self.pushes[s as usize]).collect();
        let mut pushing = std::mem::take(&mut self.pushing);
        live.par_iter().map(|&s| self.linearised(s as usize, x)).collect_into_vec(&mut pushing);
        self.pushing = pushing;

        // Counting sort by node: entries of a node stay in the order of springs.
        self.starts.fill(0);
        for &node in self.pushing.iter().flat_map(|p| &p.nodes).filter(|node| **node != NO_NODE) {
            self.starts[node as usize + 1] += 1;
        }
        (1..self.starts.len()).for_each(|n| self.starts[n] += self.starts[n - 1]);
        let mut next = self.starts.clone();
        self.entries.clear();
        self.entries.resize(next.last().map_or(0, |end| *end as usize), (0, 0.0));
        for (spring, pushing) in self.pushing.iter().enumerate() {
            for (&node, weight) in pushing.nodes.iter().zip(pushing.weights) {
                if node != NO_NODE {
                    let slot = &mut next[node as usize];
                    self.entries[*slot as usize] = (spring as u32, weight);
                    *slot += 1;
                }
            }
        }
    }

    fn linearised(&self, spring: usize, x: &[Vector]) -> Pushing {
        let (k, n) = (self.stiffness[spring], self.springs[spring].normal);
        let (depth, slip) = self.depth_and_slip(spring, x);
        let along_normal = n * n.transpose();
        let (mut hessian, mut force) = (along_normal * k, n * (k * depth));
        let most = self.friction[spring];
        if most > 0.0 {
            let length = slip.norm();
            let across = Matrix3::identity() - along_normal;
            if k * length <= most {
                hessian += across * k;
                force -= slip * k;
            } else {
                let along = slip / length;
                hessian += (across - along * along.transpose()) * (most / length);
                force -= along * most;
            }
        }
        Pushing { nodes: self.nodes[spring], weights: self.springs[spring].weights, hessian, force }
    }

    /// The diagonal block of a node.
    pub fn block(&self, node: usize) -> Matrix3<f64> {
        self.entries(node).iter().fold(Matrix3::zeros(), |sum, &(spring, weight)| {
            sum + self.pushing[spring as usize].hessian * (weight * weight)
        })
    }

    /// A node's share of the gradient.
    pub fn gradient(&self, node: usize) -> Vector {
        self.entries(node).iter().fold(Vector::zeros(), |sum, &(spring, weight)| {
            sum - self.pushing[spring as usize].force * weight
        })
    }

    /// What each pushing spring makes of motions `x` of the nodes: Hessian times sum beta_i x_i.
    pub fn reactions(&self, x: &[Vector]) -> Vec<Vector> {
        let reaction = |spring: &Pushing| {
            let mut sum = Vector::zeros();
            for (&node, weight) in spring.nodes.iter().zip(spring.weights) {
                if node != NO_NODE {
                    sum += x[node as usize] * weight;
                }
            }
            spring.hessian * sum
        };
        self.pushing.par_iter().with_min_len(CHUNK).map(reaction).collect()
    }

    /// A row of the Hessian times what the [`Self::reactions`] were made of.
    #[inline]
    pub fn row_product(&self, node: usize, reactions: &[Vector]) -> Vector {
        self.entries(node)
            .iter()
            .fold(Vector::zeros(), |sum, &(spring, weight)| sum + reactions[spring as usize] * weight)
    }

    /// Blocks of the off-diagonal part in a row, with the nodes that they belong to.
    pub fn for_each_coupling(&self, node: usize, mut visit: impl FnMut(usize, Matrix3<f64>)) {
        for &(spring, weight) in self.entries(node) {
            let spring = &self.pushing[spring as usize];
            for (&other, other_weight) in spring.nodes.iter().zip(spring.weights) {
                if other != NO_NODE && other as usize != node {
                    visit(other as usize, spring.hessian * (weight * other_weight));
                }
            }
        }
    }

    fn entries(&self, node: usize) -> &[(u32, f64)] {
        &self.entries[self.starts[node] as usize..self.starts[node + 1] as usize]
    }

    /// Lets springs that pull at positions `x` go, takes in those whose gap is too small there, and bounds friction by mu
    /// times the normal force. Returns how much force was wrong, as a share of the normal forces that are right.
    pub fn settle(&mut self, x: &[Vector]) -> f64 {
        let (mut wrong, mut right) = (0.0, 0.0);
        for spring in 0..self.springs.len() {
            let k = self.stiffness[spring];
            let (depth, slip) = self.depth_and_slip(spring, x);
            let pushed = std::mem::replace(&mut self.pushes[spring], k > 0.0 && depth > 0.0);
            let pushes = self.pushes[spring];
            if !(pushes || pushed) {
                continue;
            }
            let push = k * depth.max(0.0);
            let (held, most) = (k * slip.norm(), self.springs[spring].friction * push);
            let before = std::mem::replace(&mut self.friction[spring], most);
            right += push;
            if pushes != pushed {
                wrong += k * depth.abs();
            }
            if most > 0.0 || (pushed && before > 0.0) {
                wrong += (held.min(most) - if pushed { held.min(before) } else { 0.0 }).abs();
            }
        }
        if wrong > 0.0 { wrong / right.max(f64::MIN_POSITIVE) } else { 0.0 }
    }

    /// Makes no spring push, for the rest of the time step unless some settle again.
    pub fn let_go(&mut self) {
        self.pushes.fill(false);
    }

    /// Energy [J] at positions `x` of nodes, of the springs that push.
    pub fn energy(&self, x: &[Vector]) -> f64 {
        let partial: Vec<f64> = (0..self.springs.len().div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let springs = chunk * CHUNK..((chunk + 1) * CHUNK).min(self.springs.len());
                springs.filter(|&s| self.pushes[s]).map(|s| self.energy_of(s, x)).sum()
            })
            .collect();
        partial.iter().sum()
    }

    /// Energy [J] at positions `x` of nodes, of those that are pressed there and could push.
    pub fn stored_energy(&self, x: &[Vector]) -> f64 {
        let depth = |spring: usize| self.depth_and_slip(spring, x).0.max(0.0);
        (0..self.springs.len()).map(|s| 0.5 * self.stiffness[s] * depth(s).powi(2)).sum()
    }

    fn energy_of(&self, spring: usize, x: &[Vector]) -> f64 {
        let (depth, slip) = self.depth_and_slip(spring, x);
        let (k, most) = (self.stiffness[spring], self.friction[spring]);
        let pushed = 0.5 * k * depth * depth;
        let length = slip.norm();
        match most > 0.0 {
            false => pushed,
            true if k * length <= most => pushed + 0.5 * k * length * length,
            true => pushed + most * (length - 0.5 * most / k),
        }
    }

    /// Nodes that springs join and push, with whether anything but them holds: weights that do not cancel, obstacles.
    pub fn for_each_bond(&self, mut visit: impl FnMut(&[u32], bool)) {
        for spring in &self.pushing {
            let mut joined = [NO_NODE; 4];
            let (mut count, mut sum) = (0, 0.0);
            for (&node, weight) in spring.nodes.iter().zip(spring.weights) {
                if node != NO_NODE {
                    joined[count] = node;
                    count += 1;
                    sum += weight;
                }
            }
            visit(&joined[..count], sum.abs() > 1e-9);
        }
    }
}
