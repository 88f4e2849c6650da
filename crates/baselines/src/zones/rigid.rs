//! Rigid impact zones.

use super::impacts::{Impact, ImpactSearch};
use super::optimizer::growth;
use super::rigid_motion::Motion;
use crate::{Method, Outcome};
use bowknot_twoway::geometry::{PairKind, Point, UnionFind, Vector};
use bowknot_twoway::{CallInput, CollisionScene, ResolveError, ResolveInput};
use std::collections::BTreeMap;
use std::time::Instant;

/// Rigid impact zones (Provot 1997; Bridson et al. 2002, section 7.4). Vertices that meet on their way become
/// a zone, and zones that meet are merged. Each zone moves like a rigid body with the linear and angular
/// momentum of its vertices, and detection is repeated until nothing meets. A zone with a prescribed vertex,
/// or at a half-space, moves with it instead. If its prescribed vertices do not move as a rigid body, the
/// zone and these vertices stay where they are.
///
/// It never fails: pairs within a zone stay apart because its motion can be inverted at any time, and in the
/// worst case everything is one zone. Relative motion within a zone is lost. The method of 2002 applies
/// repulsions and some rounds of impulses first; here zones stand alone, as in Table 1 of the two-way paper.
#[derive(Debug)]
pub struct RigidZones {
    scene: CollisionScene,
    search: ImpactSearch,
}

impl RigidZones {
    /// For `scene`.
    pub fn new(scene: CollisionScene) -> Self {
        let search = ImpactSearch::new(scene.model());
        Self { scene, search }
    }
}

impl Method for RigidZones {
    fn name(&self) -> &str {
        "rigid impact zones"
    }

    fn solve(
        &mut self,
        positions: &mut [Point],
        target: &[Point],
        input: &ResolveInput<'_>,
    ) -> Result<Outcome, ResolveError> {
        let timer = Instant::now();
        let Self { scene, search } = self;
        let call = CallInput::new(scene, positions, target, input)?;
        let mut outcome = Outcome { converged: true, ..Outcome::default() };
        let growth = growth(scene, &call);
        let wanted: Vec<Vector> = target.iter().zip(&*positions).map(|(y, x)| y - x).collect();
        let mut paths = wanted.clone();
        let mut zones = Zones::new(scene, &call);
        loop {
            let accept = |impact: &Impact| !zones.keep_apart(impact);
            let impacts = search.find(scene, positions, &paths, growth, accept, &mut outcome);
            if impacts.is_empty() {
                break;
            }
            let merging = Instant::now();
            for impact in &impacts {
                zones.unite(impact);
            }
            zones.move_all(scene, &call, positions, &wanted, &mut paths);
            outcome.steps += 1;
            outcome.seconds.backward += merging.elapsed().as_secs_f64();
        }
        positions.iter_mut().zip(&paths).for_each(|(x, path)| *x += path);
        outcome.seconds.total = timer.elapsed().as_secs_f64();
        Ok(outcome)
    }
}

/// A partition of nodes into zones: vertices, followed by half-spaces.
#[derive(Debug)]
struct Zones {
    sets: UnionFind,
    vertices: usize,
    /// Whether the zone of a root contains an impact.
    met: Vec<bool>,
}

impl Zones {
    /// Every node is a zone of its own, except for obstacles and groups of pins, which are one zone each.
    fn new(scene: &CollisionScene, call: &CallInput) -> Self {
        let vertices = scene.rest().len();
        let nodes = vertices + scene.model().half_spaces().len();
        let mut zones = Self { sets: UnionFind::new(nodes), vertices, met: vec![false; nodes] };
        let mut first = BTreeMap::new();
        for v in (0..vertices).filter(|&v| call.is_prescribed(v)) {
            let who = if scene.model().is_obstacle(v as u32) {
                (0, scene.model().vertex_body()[v])
            } else {
                match call.groups().of(v) {
                    Some(group) => (1, group),
                    None => continue,
                }
            };
            let leader = *first.entry(who).or_insert(v);
            zones.join(leader, v);
        }
        zones
    }

    /// The nodes of a pair: its vertices, and its half-space.
    fn nodes(&self, impact: &Impact) -> impl Iterator<Item = usize> {
        let half_space = self.vertices + impact.pair.elements[1] as usize;
        let half_space = (impact.kind == PairKind::VertexHalfSpace).then_some(half_space);
        impact.vertices().iter().map(|&v| v as usize).chain(half_space)
    }

    /// Whether the motion of a zone keeps the pair apart. The keyframes of vertices in one zone without
    /// impacts need not.
    fn keep_apart(&self, impact: &Impact) -> bool {
        let mut roots = self.nodes(impact).map(|node| self.root(node));
        roots.next().is_some_and(|first| self.met[first] && roots.all(|root| root == first))
    }

    fn root(&self, node: usize) -> usize {
        self.sets.root(node as u32) as usize
    }

    /// Merges two zones; the smallest node is the root.
    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        let (low, high) = (a.min(b), a.max(b));
        self.sets.join(low as u32, high as u32);
        self.met[low] |= self.met[high];
    }

    /// Merges the zones of an impact.
    fn unite(&mut self, impact: &Impact) {
        let nodes: Vec<usize> = self.nodes(impact).collect();
        nodes.iter().for_each(|&node| self.join(nodes[0], node));
        let root = self.root(nodes[0]);
        self.met[root] = true;
    }

    /// Sets the paths of all zones with impacts.
    fn move_all(
        &mut self,
        scene: &CollisionScene,
        call: &CallInput,
        x: &[Point],
        wanted: &[Vector],
        paths: &mut [Vector],
    ) {
        let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for node in 0..self.sets.len() {
            let root = self.sets.find(node as u32) as usize;
            if self.met[root] {
                members.entry(root).or_default().push(node);
            }
        }
        for nodes in members.values() {
            let grounded = nodes.iter().any(|&node| node >= self.vertices);
            let vertices = || nodes.iter().copied().filter(|&node| node < self.vertices);
            let of = |v: usize| (x[v], wanted[v], scene.relative_mass(v));
            let prescribed: Vec<_> = vertices().filter(|&v| call.is_prescribed(v)).map(of).collect();
            let motion = if prescribed.is_empty() && !grounded {
                Motion::keeping_momentum(&vertices().map(of).collect::<Vec<_>>())
            } else if prescribed.is_empty() {
                Motion::Rest
            } else {
                match Motion::following(&prescribed) {
                    Some(motion) if !grounded => motion,
                    _ => Motion::Rest,
                }
            };
            vertices().for_each(|v| paths[v] = motion.displacement(&x[v]));
        }
    }
}
