//! Which bodies asleep something comes near in a time step.
//!
//! Elements of a body are covered by boxes around their vertices' places at the start and at the end of the
//! time step, and at the ends of its stages in between, if the integrator has several. An element that moves along
//! straight lines from one to the next stays in its box, since the box is convex.
//!
//! **This test is part of the guarantee.** Bodies asleep are obstacles for the collision stage, and two
//! obstacles never form a pair. So nothing but this test keeps an obstacle that moves away from them. It
//! holds because the places at the ends of stages are the obstacle's keyframes: in each stage the collision stage
//! moves each of its vertices along the straight line from its place to its keyframe, a part of the way at a time, and
//! never beyond, and a place on the way lies in the box of what came before. Bodies that are awake form pairs with
//! those asleep, so the collision stage keeps them apart wherever they go, and a place at the end that is only predicted does no harm: what wakes later than it is
//! touched has been an unyielding obstacle for a moment. For the same reason bodies at rest need not count as
//! movers. If they did, two that are near each other without touching would wake each other in turn for ever.

use bowknot_geometry::{Aabb, Point};
use bowknot_scene::world::World;

/// The elements of all bodies: triangles, edges and vertices, as three vertices with repetitions.
#[derive(Clone, Debug, Default)]
pub(crate) struct BodyElements {
    of_bodies: Vec<Vec<[u32; 3]>>,
}

/// The places of the vertices that collide in a time step [m], and what else decides whether bodies meet.
pub(crate) struct Motion<'a> {
    /// At its start.
    pub start: &'a [Point],
    /// Of what is prescribed at the end of each stage but the last; others are where they were at the start.
    pub inner: &'a [Vec<Point>],
    /// At its end.
    pub end: &'a [Point],
    /// Distance around each body within which it is in contact, its part [m].
    pub margins: &'a [f64],
    /// Which bodies sleep.
    pub asleep: &'a [bool],
    /// Which deformable bodies are at rest; they sleep or soon will. Others count as movers.
    pub at_rest: &'a [bool],
    /// Which obstacles appear or vanish, and so count as movers; empty: none.
    pub changed: &'a [bool],
}

impl Motion<'_> {
    /// Where a vertex is at the ends of the stages.
    fn later(&self, v: usize) -> impl Iterator<Item = &Point> {
        self.inner.iter().map(move |places| &places[v]).chain([&self.end[v]])
    }

    /// The same with its start.
    fn places(&self, v: usize) -> impl Iterator<Item = &Point> {
        [&self.start[v]].into_iter().chain(self.later(v))
    }
}

impl BodyElements {
    pub fn new(world: &World) -> Self {
        let topology = world.collision.topology();
        let mut of_bodies = vec![Vec::new(); world.bodies.len()];
        let mut add = |element: [u32; 3]| {
            of_bodies[world.collision.vertex_body()[element[0] as usize] as usize].push(element);
        };
        topology.triangles.iter().for_each(|t| add(*t));
        for &edge in &topology.strand_edges {
            let [a, b] = topology.edges[edge as usize];
            add([a, b, b]);
        }
        topology.particles.iter().for_each(|&v| add([v; 3]));
        Self { of_bodies }
    }

    /// Which bodies asleep are in contact range of the path of a body that is not and with which they may
    /// collide: one entry per body. Obstacles that do not move, and bodies at rest, come near nothing.
    pub fn approached(&self, world: &World, motion: &Motion<'_>) -> Vec<bool> {
        let bodies = 0..world.bodies.len();
        let bounds: Vec<Aabb> = bodies.clone().map(|body| Self::bounds(world, body, motion)).collect();
        let moves = |body: usize| {
            let vertices = world.bodies[body].vertices.clone();
            match world.bodies[body].kind {
                Some(_) => !motion.at_rest[body],
                None if motion.changed.get(body) == Some(&true) => true,
                None => vertices.map(|v| v as usize).any(|v| motion.later(v).any(|x| *x != motion.start[v])),
            }
        };
        let movers: Vec<usize> = bodies.clone().filter(|&b| !motion.asleep[b] && moves(b)).collect();
        let comes_near = |sleeper: usize| {
            let near = |mover: &usize| {
                let collide = world.collision.may_collide(*mover as u32, sleeper as u32);
                collide && bounds[*mover].overlaps(&bounds[sleeper]) && {
                    let [mut a, mut b] = [(*mover, sleeper), (sleeper, *mover)]
                        .map(|(body, other)| self.bounds_near(body, &bounds[other], motion));
                    any_meet(&mut a, &mut b)
                }
            };
            movers.iter().any(near)
        };
        bodies.map(|body| motion.asleep[body] && comes_near(body)).collect()
    }

    fn bounds(world: &World, body: usize, motion: &Motion<'_>) -> Aabb {
        let vertices = world.bodies[body].vertices.clone().map(|v| v as usize);
        Aabb::of_points(vertices.flat_map(|v| motion.places(v))).inflated(motion.margins[body])
    }

    /// The boxes of a body's elements that meet the box of another body.
    fn bounds_near(&self, body: usize, other: &Aabb, motion: &Motion<'_>) -> Vec<Aabb> {
        let bounds = |element: &[u32; 3]| {
            let vertices = element.iter().map(|&v| v as usize);
            let points = vertices.flat_map(|v| motion.places(v));
            Aabb::of_points(points).inflated(motion.margins[body])
        };
        self.of_bodies[body].iter().map(bounds).filter(|own| own.overlaps(other)).collect()
    }
}

/// Whether a box of one list meets one of the other, by a sweep along x.
fn any_meet(a: &mut [Aabb], b: &mut [Aabb]) -> bool {
    for list in [&mut *a, &mut *b] {
        list.sort_unstable_by(|a, b| a.min.x.total_cmp(&b.min.x));
    }
    let (mut a, mut b) = (&*a, &*b);
    while let (Some(first_a), Some(first_b)) = (a.first(), b.first()) {
        let (first, others) = if first_a.min.x <= first_b.min.x { (first_a, b) } else { (first_b, a) };
        if others.iter().take_while(|other| other.min.x <= first.max.x).any(|other| first.overlaps(other)) {
            return true;
        }
        if first_a.min.x <= first_b.min.x {
            a = &a[1..];
        } else {
            b = &b[1..];
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sweeping_finds_what_testing_all_finds() {
        // A linear congruential generator (Knuth) in place of a crate.
        let mut seed = 7_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 40) as f64 / (1_u64 << 24) as f64
        };
        let mut met = 0;
        for _ in 0..200 {
            let mut boxes = || -> Vec<Aabb> {
                let mut point = || Point::new(random(), random(), random());
                (0..4).map(|_| Aabb::of_points(&[point()]).inflated(0.08)).collect()
            };
            let (mut a, mut b) = (boxes(), boxes());
            let expected = a.iter().any(|a| b.iter().any(|b| a.overlaps(b)));
            assert_eq!(any_meet(&mut a, &mut b), expected);
            met += usize::from(expected);
        }
        assert!((20..180).contains(&met), "{met} of 200: both cases should occur");
        assert!(!any_meet(&mut [], &mut [Aabb::of_points(&[Point::origin()]).inflated(1.0)]));
    }
}
