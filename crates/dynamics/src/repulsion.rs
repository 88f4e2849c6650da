//! Contacts in Newton's method: springs with multipliers, an augmented Lagrangian.
//!
//! Without them a target is made as if nothing were in the way: a stiff body that rests on something falls on within
//! itself, and the collision stage, which knows no elasticity, pushes back the vertices that touch alone. Whoever knows
//! which primitives touch hands in springs. With s = sum_i beta_i x_i, depth = desired + offset - n . s and
//! slip = (1 - n n^T)(s - s0), s0 at the start of the time step, a contact that pushes has the energy
//!
//! ```text
//! normal    k/2 (depth + lambda/k)^2                     force  lambda + k depth along n
//! sticking  k/2 |slip - tau/k|^2                         force  tau - k slip
//! sliding   (m |tau - k slip| - m^2/2) / k               force  m in the direction of tau - k slip
//! ```
//!
//! lambda and tau are its multipliers [N]. A contact that already carries what it must is not moved: at the solution depth
//! and slip vanish, however soft the spring (Hestenes 1969 and Powell 1969; for friction Simo and Laursen 1992, "An
//! augmented Lagrangian treatment of contact problems involving friction"). `settle` brings multipliers up to date after a
//! solve: lambda <- max(0, lambda + k depth), tau <- tau - k slip, cut to mu lambda. Multipliers are handed in, and handed out by
//! `forces`, so that they outlive the springs: they pass from one Newton iteration to the next and from step to step.
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

/// How much softer springs are for bodies that give way as a whole, in dt^2 / M. A stiff body has far less inertia than a
/// diagonal block suggests: springs as stiff as that turn micrometres, by which one linear solve misses a rotation,
/// into forces of many times its weight, and settling diverges.
const WHOLE: f64 = 0.3;

/// Share of its bound by which friction may be below it and slides.
const AT_BOUND: f64 = 1e-6;

/// Share of the slip that inertia leads to below which a contact counts as sticking.
const STUCK: f64 = 0.1;

/// Share by which the bound of friction may differ from that of the solve before.
const SETTLED_BOUND: f64 = 0.1;

/// A contact between up to four vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RepulsionSpring {
    /// The vertices; obstacles are welcome. Where there are fewer than four, any vertex with weight 0.
    pub vertices: [u32; 4],
    /// Their weights beta [1], barycentric: positive on the side that the normal points to, negative on the other. For a
    /// largest distance the signs are reversed.
    pub weights: [f64; 4],
    /// Unit normal n [1].
    pub normal: Vector,
    /// What is taken from sum beta_i n.x_i [m]: 0 between primitives, n.p for a half-space through p.
    pub offset: f64,
    /// Gap below which it pushes [m]. For a largest distance: minus that distance.
    pub desired: f64,
    /// Stiffness k in units of the bodies' own at the contact [1]: 1 / sum beta_i^2 / (n . H_ii n), H_ii the blocks of the
    /// Newton system, inertia included, of free vertices; softer for light bodies and for strands.
    pub stiffness: f64,
    /// Coefficient of friction mu [1]; 0: it pushes along the normal alone.
    pub friction: f64,
    /// Force that it is known to carry, on the side that the normal points to [N]: its multipliers, lambda n + tau.
    pub force: Vector,
}

/// How a contact resists slip.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Friction {
    /// Not at all.
    None,
    /// It sticks, with the multiplier tau [N].
    Stick(Vector),
    /// It slides: direction d of the slip, bound m [N], curvature c across d [N/m].
    Slide(Vector, f64, f64),
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
    states: Vec<SpringState>,
    /// Whether which of them push, stick and slide is a guess, which the energy takes for granted until it is settled.
    guessed: bool,
    /// The springs that push, as of the last linearisation, with Hessian by s [N/m] and force [N].
    pushing: Vec<Pushing>,
    /// Places of nodes in `pushing`: `entries[starts[n]..starts[n + 1]]`, with their weights.
    starts: Vec<u32>,
    entries: Vec<(u32, f64)>,
}

/// What changes about a spring from solve to solve.
#[derive(Clone, Copy, Debug)]
struct SpringState {
    /// k [N/m]; 0 if no vertex is free.
    stiffness: f64,
    pushes: bool,
    /// lambda [N].
    pressure: f64,
    friction: Friction,
    /// mu times the normal force [N], or infinite: what friction may be.
    most: f64,
}

impl SpringState {
    const IDLE: Self =
        Self { stiffness: 0.0, pushes: false, pressure: 0.0, friction: Friction::None, most: 0.0 };

    /// Friction with the multiplier `tau` after a slip of `slip`, for a bound `most`: Coulomb's law.
    fn rub(&self, tau: Vector, slip: &Vector, most: f64) -> Friction {
        let trial = tau - slip * self.stiffness;
        let size = trial.norm();
        if most == 0.0 {
            Friction::None
        } else if size <= most {
            Friction::Stick(trial)
        } else {
            Friction::Slide(-trial / size, most, most / slip.norm().max(most / self.stiffness))
        }
    }

    /// The multiplier tau.
    fn tau(&self) -> Vector {
        match self.friction {
            Friction::None => Vector::zeros(),
            Friction::Stick(tau) => tau,
            Friction::Slide(direction, most, _) => direction * -most,
        }
    }
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
            let numbers = s.weights.iter().chain(s.normal.iter()).chain(s.force.iter());
            if !numbers.chain([&s.offset, &s.desired]).all(|value| value.is_finite()) {
                return refuse("its weights, normal, offset, desired gap and force must be finite");
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
            states: vec![SpringState::IDLE; count],
            guessed: false,
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

    /// Measures slip from positions `x` of all vertices, those at the start of the time step.
    pub fn anchor(&mut self, x: &[Point]) {
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

    /// Fixes the stiffness until springs are set again, and guesses which of them push and which stick: in the first iteration
    /// what would with nodes where inertia leads, `inertial`; in later ones what does at the `iterate`. `diagonal` has the
    /// blocks of the Newton system without springs, `rate` is 1 / dt [1/s].
    pub fn prepare(
        &mut self,
        model: &DynamicsModel,
        diagonal: &[Matrix3<f64>],
        rate: f64,
        free: &[bool],
        inertial: &[Vector],
        iterate: Option<&[Vector]>,
    ) {
        self.guessed = true;
        let softest = self.softest(model, diagonal);
        let mut states = std::mem::take(&mut self.states);
        states.par_iter_mut().enumerate().with_min_len(CHUNK).for_each(|(spring, state)| {
            let s = &self.springs[spring];
            let mut compliance = 0.0;
            for (&node, weight) in self.nodes[spring].iter().zip(s.weights) {
                if node != NO_NODE && free[node as usize] {
                    let node = node as usize;
                    let along = || s.normal.dot(&(diagonal[node] * s.normal));
                    let local = if model.strands[node] { softest[node] } else { along() };
                    let whole = model.body_masses[node] * rate * rate;
                    compliance += weight * weight * (1.0 / local + WHOLE / whole);
                }
            }
            *state = SpringState::IDLE;
            if compliance <= 0.0 || s.stiffness == 0.0 {
                return;
            }
            state.stiffness = s.stiffness / compliance;
            let carried = s.normal.dot(&s.force).max(0.0);
            let tau = s.force - s.normal * s.normal.dot(&s.force);
            let (depth, slip) = self.depth_and_slip(spring, iterate.unwrap_or(inertial));
            if iterate.is_none() {
                // What inertia takes apart carries nothing.
                state.pushes = depth > -NEARLY * s.desired.max(0.0) || s.desired < 0.0 && carried > 0.0;
                let length = slip.norm();
                if state.pushes && s.friction > 0.0 {
                    // Coulomb's law for the vertices on their own: it holds at first what they would hold, and what held before where
                    // inertia leads to no more than its bound.
                    let bound = s.friction * (carried + state.stiffness * depth.max(0.0));
                    let holds = carried > 0.0 && (tau - slip * state.stiffness).norm() < bound;
                    state.friction = if holds || length <= s.friction * depth {
                        Friction::Stick(tau)
                    } else {
                        let most = s.friction * carried;
                        Friction::Slide(slip / length, most, (most / length).min(state.stiffness))
                    };
                }
            } else {
                state.pushes = carried > 0.0 || depth > 0.0;
                if state.pushes {
                    let (most, length) = (s.friction * carried, slip.norm());
                    let free = self.depth_and_slip(spring, inertial).1.norm();
                    let sticks = tau.norm() < (1.0 - AT_BOUND) * most && length < STUCK * free;
                    state.friction = if sticks {
                        Friction::Stick(tau)
                    } else if most > 0.0 && length > 0.0 {
                        Friction::Slide(slip / length, most, (most / length).min(state.stiffness))
                    } else {
                        Friction::None
                    };
                }
            }
            state.pressure = if state.pushes { carried } else { 0.0 };
        });
        self.states = states;
    }

    /// Stiffness of the strands' nodes with springs in their softest direction [N/m], 0 elsewhere. A kinked strand resists along both of its
    /// edges, but only as long as its neighbours stay: springs as stiff as that are too stiff for it, and settling diverges
    /// where strands cross.
    fn softest(&self, model: &DynamicsModel, diagonal: &[Matrix3<f64>]) -> Vec<f64> {
        let mut touched = vec![false; diagonal.len()];
        self.nodes.iter().flatten().filter(|n| **n != NO_NODE).for_each(|n| touched[*n as usize] = true);
        let of_node = |(node, block): (usize, &Matrix3<f64>)| {
            if touched[node] && model.strands[node] { block.symmetric_eigenvalues().min() } else { 0.0 }
        };
        diagonal.par_iter().enumerate().with_min_len(CHUNK).map(of_node).collect()
    }

    /// Linearises the springs that push at `x`.
    pub fn linearise(&mut self, x: &[Vector]) {
        let live: Vec<u32> =
            (0..self.springs.len() as u32).filter(|&s| self.states[s as usize].pushes).collect();
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
        let (state, n) = (&self.states[spring], self.springs[spring].normal);
        let k = state.stiffness;
        let (depth, slip) = self.depth_and_slip(spring, x);
        let along_normal = n * n.transpose();
        let across = || Matrix3::identity() - along_normal;
        let (mut hessian, mut force) = (along_normal * k, n * (state.pressure + k * depth));
        match state.friction {
            Friction::None => {}
            Friction::Slide(direction, most, curvature) if self.guessed => {
                let beside = across() - direction * direction.transpose();
                hessian += beside * curvature;
                force -= direction * most + beside * slip * curvature;
            }
            _ => {
                let trial = state.tau() - slip * k;
                let size = trial.norm();
                if self.guessed || size <= state.most {
                    hessian += across() * k;
                    force += trial;
                } else {
                    let direction = trial / size;
                    hessian += (across() - direction * direction.transpose()) * (k * state.most / size);
                    force += direction * state.most;
                }
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

    /// Brings multipliers up to date with nodes at `x`: lets springs that pull go, takes in those whose gap is too small, bounds
    /// friction by mu times the normal force. Returns how much force was wrong, as a share of the normal forces that are
    /// right.
    pub fn settle(&mut self, x: &[Vector]) -> f64 {
        let guessed = std::mem::replace(&mut self.guessed, false);
        let (mut wrong, mut right) = (0.0, 0.0);
        for spring in 0..self.springs.len() {
            let before = self.states[spring];
            if before.stiffness == 0.0 {
                continue;
            }
            let (depth, slip) = self.depth_and_slip(spring, x);
            let trial = before.pressure + before.stiffness * depth;
            let state = &mut self.states[spring];
            state.pushes = trial > 0.0;
            if !(state.pushes || before.pushes) {
                continue;
            }
            let push = trial.max(0.0);
            right += push;
            state.most = self.springs[spring].friction * push;
            if state.pushes != before.pushes {
                wrong += trial.abs();
            }
            let rubs = before.rub(before.tau(), &slip, state.most);
            state.friction = match (rubs, before.friction) {
                (Friction::Stick(_), _) => Friction::Stick(before.tau()),
                // What turns back on its way has stopped in between.
                (Friction::Slide(d, ..), Friction::Slide(old, ..)) if d.dot(&old) < 0.0 => {
                    Friction::Stick(Vector::zeros())
                }
                _ => rubs,
            };
            let should = SpringState { friction: rubs, ..before }.tau();
            let acted = match before.friction {
                _ if !before.pushes => Vector::zeros(),
                Friction::None => Vector::zeros(),
                Friction::Stick(tau) if guessed => tau - slip * before.stiffness,
                Friction::Slide(direction, most, curvature) if guessed => {
                    -direction * most - (slip - direction * direction.dot(&slip)) * curvature
                }
                _ => {
                    let trial = before.tau() - slip * before.stiffness;
                    trial * (before.most / trial.norm()).min(1.0)
                }
            };
            wrong += (should - acted).norm();
        }
        if wrong > 0.0 { wrong / right.max(f64::MIN_POSITIVE) } else { 0.0 }
    }

    /// Forces that the springs carry with nodes at `x` [N], by spring: what the next ones start from.
    pub fn forces(&self, x: &[Vector]) -> Vec<Vector> {
        let force = |spring: usize| {
            let (state, s) = (&self.states[spring], &self.springs[spring]);
            if !state.pushes {
                return Vector::zeros();
            }
            let (depth, slip) = self.depth_and_slip(spring, x);
            let pressure = (state.pressure + state.stiffness * depth).max(0.0);
            let rubbing =
                SpringState { friction: state.rub(state.tau(), &slip, s.friction * pressure), ..*state };
            s.normal * pressure + rubbing.tau()
        };
        (0..self.springs.len()).into_par_iter().with_min_len(CHUNK).map(force).collect()
    }

    /// What the springs' carried forces do to the nodes [N]: taken from `gradient`.
    pub fn subtract_carried(&self, gradient: &mut [Vector]) {
        for (spring, nodes) in self.springs.iter().zip(&self.nodes) {
            for (&node, weight) in nodes.iter().zip(spring.weights) {
                if node != NO_NODE {
                    gradient[node as usize] -= spring.force * weight;
                }
            }
        }
    }

    /// Takes the multipliers from all springs, until they are set again, so that they store no energy but by being pressed and
    /// rub only against slip; those push that are pressed at `x`.
    pub fn forget_multipliers(&mut self, x: &[Vector]) {
        for state in &mut self.states {
            *state = SpringState { stiffness: state.stiffness, ..SpringState::IDLE };
        }
        self.settle_without_multipliers(x);
    }

    /// Brings what pushes and rubs up to date with nodes at `x`; whether anything that
    /// pushes changed, or a bound of friction by much.
    pub fn settle_without_multipliers(&mut self, x: &[Vector]) -> bool {
        self.guessed = false;
        let mut changed = false;
        for spring in 0..self.springs.len() {
            let mut state = self.states[spring];
            let (depth, slip) = self.depth_and_slip(spring, x);
            let pushes = state.stiffness > 0.0 && depth > 0.0;
            changed |= std::mem::replace(&mut state.pushes, pushes) != pushes;
            let most = self.springs[spring].friction * state.stiffness * depth.max(0.0);
            changed |= (most - state.most).abs() > SETTLED_BOUND * most;
            state.most = most;
            state.friction = match state.rub(Vector::zeros(), &slip, state.most) {
                Friction::None => Friction::None,
                _ => Friction::Stick(Vector::zeros()),
            };
            self.states[spring] = state;
        }
        changed
    }

    /// Energy [J] at positions `x` of nodes, but for a constant.
    pub fn energy(&self, x: &[Vector]) -> f64 {
        let partial: Vec<f64> = (0..self.springs.len().div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let springs = chunk * CHUNK..((chunk + 1) * CHUNK).min(self.springs.len());
                springs.map(|s| self.energy_of(s, x)).sum()
            })
            .collect();
        partial.iter().sum()
    }

    /// Energy [J] at positions `x` of nodes, of those that are pressed there and could push.
    pub fn stored_energy(&self, x: &[Vector]) -> f64 {
        let energy = |spring: usize| {
            let state = &self.states[spring];
            if state.stiffness == 0.0 {
                return 0.0;
            }
            let pressed = self.depth_and_slip(spring, x).0 + state.pressure / state.stiffness;
            0.5 * state.stiffness * pressed.max(0.0).powi(2)
        };
        (0..self.springs.len()).map(energy).sum()
    }

    fn energy_of(&self, spring: usize, x: &[Vector]) -> f64 {
        let state = &self.states[spring];
        let k = state.stiffness;
        if k == 0.0 {
            return 0.0;
        }
        let (depth, slip) = self.depth_and_slip(spring, x);
        let pressed = depth + state.pressure / k;
        if self.guessed {
            let friction = match state.friction {
                Friction::None => 0.0,
                Friction::Stick(tau) => 0.5 * k * (slip - tau / k).norm_squared(),
                Friction::Slide(direction, most, curvature) => {
                    let along = direction.dot(&slip);
                    most * along + 0.5 * curvature * (slip.norm_squared() - along * along)
                }
            };
            return if state.pushes { 0.5 * k * pressed * pressed + friction } else { 0.0 };
        }
        let pushed = 0.5 * k * pressed.max(0.0).powi(2);
        let trial = (state.tau() - slip * k).norm();
        pushed
            + match state.friction {
                Friction::None => 0.0,
                _ if trial <= state.most => 0.5 * trial * trial / k,
                _ => state.most * (trial - 0.5 * state.most) / k,
            }
    }

    /// Nodes that springs join and push, with whether anything but them holds: weights that do not cancel, obstacles.
    pub fn for_each_bond(&self, mut visit: impl FnMut(&[u32], bool)) {
        self.pushing.iter().for_each(|spring| bond(&spring.nodes, &spring.weights, &mut visit));
    }

    /// The same for all springs, whether they push or not.
    pub fn for_each_link(&self, mut visit: impl FnMut(&[u32], bool)) {
        let springs = self.nodes.iter().zip(&self.springs);
        springs.for_each(|(nodes, spring)| bond(nodes, &spring.weights, &mut visit));
    }
}

fn bond(nodes: &[u32; 4], weights: &[f64; 4], visit: &mut impl FnMut(&[u32], bool)) {
    let mut joined = [NO_NODE; 4];
    let (mut count, mut sum) = (0, 0.0);
    for (&node, weight) in nodes.iter().zip(weights) {
        if node != NO_NODE {
            joined[count] = node;
            count += 1;
            sum += weight;
        }
    }
    visit(&joined[..count], sum.abs() > 1e-9);
}
