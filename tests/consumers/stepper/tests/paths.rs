//! Whatever is asked of `Forward`, no path crosses: problems are drawn by proptest, and every path is judged
//! by code that the stepper and the search do not share.

use bowknot_check::{Judge, PathOptions, StateOptions};
use bowknot_stepper::geometry::{HalfSpace, Point, Topology, Vector};
use bowknot_stepper::proximity::{BodyFilter, CollisionModel};
use bowknot_stepper::{Bound, Forward, ForwardOptions};
use proptest::prelude::{Just, Strategy, any, prop_oneof};
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};
use proptest::{bool, collection, option};
use std::cell::Cell;

/// Number of problems.
const CASES: u32 = 2000;

/// What a body is made of. It lies in a slab of its own, so that bodies do not intersect.
#[derive(Clone, Copy, Debug)]
enum Shape {
    /// A square of so many cells along its side, with an uneven surface.
    Sheet(u32),
    /// The surface of a tetrahedron.
    Tetrahedron,
    /// A zigzag of so many edges.
    Strand(u32),
    /// So many particles.
    Particles(u32),
}

/// A body, above the last one.
#[derive(Clone, Debug)]
struct Piece {
    shape: Shape,
    is_obstacle: bool,
    /// Decadic logarithm of the gap below, in body sizes.
    gap: f64,
    /// Place across, in body sizes.
    place: [f64; 2],
}

/// Where the vertices are asked to go.
#[derive(Clone, Copy, Debug)]
enum Wish {
    /// Bodies go up and down in turns, through each other.
    Through,
    /// Every vertex goes in its own direction.
    Scatter,
    /// Every vertex goes through the center of all.
    Invert,
    /// All vertices go to one point.
    Collapse,
    /// A vertex goes where the last one of the list is, and so on.
    Reverse,
    /// One vertex alone goes, through whatever is there.
    Dart,
    /// As `Scatter`, and a third of the targets are not finite.
    NotFinite,
}

/// A search, and steps with its list.
#[derive(Clone, Debug)]
struct Round {
    /// Decadic logarithm of the radii, in body sizes; in fractions of it they differ by vertex.
    radius: f64,
    spread: f64,
    /// Wishes, with the decadic logarithm of their distance in body sizes, and their numbers of steps.
    wishes: Vec<(Wish, f64, u32)>,
}

#[derive(Clone, Debug)]
struct Problem {
    pieces: Vec<Piece>,
    has_ground: bool,
    /// Decadic logarithm of the size of bodies [m], and their distance from the origin in body sizes.
    scale: f64,
    far: f64,
    turn: [f64; 3],
    bound: Bound,
    damping: f64,
    /// Decadic logarithm of the minimum separation, in body sizes.
    min_separation: Option<f64>,
    rounds: Vec<Round>,
    seed: u64,
}

fn problem() -> impl Strategy<Value = Problem> {
    let shape = prop_oneof![
        Just(Shape::Tetrahedron),
        (1..4u32).prop_map(Shape::Sheet),
        (1..5u32).prop_map(Shape::Strand),
        (1..4u32).prop_map(Shape::Particles),
    ];
    let piece = (shape, bool::weighted(0.25), -6.0..-0.5, [-0.7..0.7, -0.7..0.7])
        .prop_map(|(shape, is_obstacle, gap, place)| Piece { shape, is_obstacle, gap, place });
    let wish = prop_oneof![
        3 => Just(Wish::Through),
        1 => Just(Wish::Scatter),
        1 => Just(Wish::Invert),
        1 => Just(Wish::Collapse),
        1 => Just(Wish::Reverse),
        1 => Just(Wish::Dart),
        1 => Just(Wish::NotFinite),
    ];
    let wishes = collection::vec((wish, -2.0..6.0, 1..5u32), 1..4);
    let round =
        (-3.0..1.0, 0.0..0.9, wishes).prop_map(|(radius, spread, wishes)| Round { radius, spread, wishes });
    let scene = (collection::vec(piece, 2..5), bool::weighted(0.3), -4.0..4.0, 0.0..100.0);
    let bound = prop_oneof![3 => Just(Bound::Planes), 1 => Just(Bound::Isotropic)];
    let options = (bound, 0.1..0.99, option::of(-9.0..-2.0));
    let turn = [-3.0..3.0, -3.0..3.0, -3.0..3.0];
    (scene, options, collection::vec(round, 1..5), turn, any::<u64>()).prop_map(
        |((pieces, has_ground, scale, far), (bound, damping, min_separation), rounds, turn, seed)| Problem {
            pieces,
            has_ground,
            scale,
            far,
            turn,
            bound,
            damping,
            min_separation,
            rounds,
            seed,
        },
    )
}

/// Random numbers in [-1, 1) from a seed (splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> Vector {
        Vector::new(self.next(), self.next(), self.next())
    }
}

impl Problem {
    fn size(&self) -> f64 {
        10f64.powf(self.scale)
    }

    /// The model and the start.
    fn build(&self, random: &mut Random) -> (CollisionModel, Vec<Point>) {
        let (mut points, mut bodies, mut filters) = (Vec::new(), Vec::new(), Vec::new());
        let (mut triangles, mut strands, mut particles) = (Vec::new(), Vec::new(), Vec::new());
        let mut height = 0.0;
        for (body, piece) in (0..).zip(&self.pieces) {
            height += 10f64.powf(piece.gap);
            let first = points.len() as u32;
            let mut own: Vec<Vector> = Vec::new();
            match piece.shape {
                Shape::Sheet(cells) => {
                    let side = cells + 1;
                    let place = |k: u32| f64::from(k) / f64::from(cells) - 0.5;
                    own.extend(
                        (0..side * side).map(|v| {
                            Vector::new(place(v % side), place(v / side), 0.1 + 0.1 * random.next())
                        }),
                    );
                    for v in (0..cells * side).filter(|v| v % side < cells) {
                        triangles.extend(
                            [[v, v + 1, v + side], [v + 1, v + side + 1, v + side]]
                                .map(|t| t.map(|v| v + first)),
                        );
                    }
                }
                Shape::Tetrahedron => {
                    let corners = [[-0.5, -0.4, 0.0], [0.5, -0.4, 0.2], [0.0, 0.5, 0.1], [0.0, 0.0, 0.5]];
                    own.extend(corners.map(Vector::from));
                    triangles
                        .extend([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|t| t.map(|v| v + first)));
                }
                Shape::Strand(edges) => {
                    own.extend((0..=edges).map(|v| {
                        let x = f64::from(v) / f64::from(edges) - 0.5;
                        Vector::new(x, 0.3 * random.next(), 0.05 + 0.05 * random.next())
                    }));
                    strands.extend((0..edges).map(|v| [first + v, first + v + 1]));
                }
                Shape::Particles(count) => {
                    own.extend((0..count).map(|v| {
                        let x = (f64::from(v) + 0.4 * random.next()) / f64::from(count) - 0.5;
                        Vector::new(x, 0.3 * random.next(), 0.05 + 0.05 * random.next())
                    }));
                    particles.extend((0..count).map(|v| first + v));
                }
            }
            let base = Vector::new(piece.place[0], piece.place[1], height);
            height += own.iter().map(|p| p.z).fold(0.0, f64::max);
            bodies.extend(own.iter().map(|_| body));
            filters.push(if piece.is_obstacle { BodyFilter::OBSTACLE } else { BodyFilter::DEFORMABLE });
            points.extend(own.into_iter().map(|p| p + base));
        }
        let [a, b, c] = self.turn;
        let turn = bowknot_stepper::geometry::nalgebra::Rotation3::from_euler_angles(a, b, c);
        let place = |p: Vector| Point::from(turn * p * self.size() + Vector::repeat(self.far * self.size()));
        let ground = self.has_ground.then(|| HalfSpace::new(place(Vector::zeros()), turn * Vector::z()));
        let topology = Topology::builder(points.len())
            .triangles(triangles)
            .strand_edges(strands)
            .particles(particles)
            .build()
            .expect("elements of their own vertices");
        let half_spaces = ground.flatten().into_iter().collect();
        let model = CollisionModel::new(topology, bodies, filters, half_spaces).expect("a body per vertex");
        (model, points.into_iter().map(place).collect())
    }

    fn radii(&self, round: &Round, count: usize, random: &mut Random) -> Vec<f64> {
        let radius = 10f64.powf(round.radius) * self.size();
        (0..count).map(|_| radius * (1.0 + round.spread * random.next())).collect()
    }

    fn target(
        &self,
        model: &CollisionModel,
        x: &[Point],
        wish: (Wish, f64),
        random: &mut Random,
    ) -> Vec<Point> {
        let (wish, way) = (wish.0, 10f64.powf(wish.1) * self.size());
        let [a, b, c] = self.turn;
        let up =
            bowknot_stepper::geometry::nalgebra::Rotation3::from_euler_angles(a, b, c) * Vector::z() * way;
        let center = Point::from(x.iter().map(|p| p.coords).sum::<Vector>() / x.len() as f64);
        let chosen = ((random.next() + 1.0) * 0.5 * x.len() as f64) as usize;
        let point = center + random.vector() * way;
        let target = |(v, p): (usize, &Point)| match wish {
            Wish::Through if model.vertex_body()[v].is_multiple_of(2) => p + up,
            Wish::Through => p - up,
            Wish::Scatter => p + random.vector() * way,
            Wish::Invert => p + (center - p) * (way / self.size()),
            Wish::Collapse => point,
            Wish::Reverse => x[x.len() - 1 - v],
            Wish::Dart if v == chosen => p + random.vector() * way,
            Wish::Dart => *p,
            Wish::NotFinite => match (random.next() * 6.0) as i32 {
                1 => Point::new(f64::NAN, p.y, p.z),
                2 => Point::new(p.x, f64::INFINITY, 1e308),
                _ => p + random.vector() * way,
            },
        };
        x.iter().enumerate().map(target).collect()
    }

    /// Makes all steps and judges their paths. Returns how many moved and how many were made; none if the
    /// start intersects.
    fn run(&self) -> Result<Option<[u32; 2]>, String> {
        let mut random = Random(self.seed);
        let (model, start) = self.build(&mut random);
        let judge = Judge::from_model(&model);
        let state = StateOptions { limit: 1, distance: false };
        if !judge.check_state(&start, &state).map_err(|e| e.to_string())?.is_clear() {
            return Ok(None);
        }
        let min_separation = self.min_separation.map_or(0.0, |xi| 10f64.powf(xi) * self.size());
        let options = ForwardOptions { bound: self.bound, damping: self.damping, min_separation };
        let first = self.radii(&self.rounds[0], start.len(), &mut random);
        let mut forward = Forward::new(model.clone(), start, &first, options).map_err(|e| e.to_string())?;
        let mut counts = [0, 0];
        for (number, round) in self.rounds.iter().enumerate() {
            if number > 0 {
                let radii = self.radii(round, first.len(), &mut random);
                forward.search(&radii).map_err(|e| e.to_string())?;
            }
            for &(wish, way, steps) in &round.wishes {
                let target = self.target(&model, forward.positions(), (wish, way), &mut random);
                for step in 0..steps {
                    let before = forward.positions().to_vec();
                    let report = forward.advance(&target).map_err(|e| e.to_string())?;
                    let path = judge.check_path(&before, forward.positions(), &PathOptions::default());
                    if let Some(hit) = path.map_err(|e| e.to_string())?.hits.first() {
                        return Err(format!("round {number}, {wish:?}, step {step}: {hit}"));
                    }
                    counts[0] += u32::from(report.largest_move > 0.0);
                    counts[1] += 1;
                }
            }
        }
        let report = judge.check_state(forward.positions(), &state).map_err(|e| e.to_string())?;
        report.intersections.first().map_or(Ok(Some(counts)), |first| Err(first.to_string()))
    }
}

#[test]
fn no_path_crosses_whatever_is_asked() {
    let config =
        Config { cases: CASES, failure_persistence: None, max_shrink_iters: 5_000, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]));
    let counts = Cell::new([0, 0, 0]);
    let outcome = runner.run(&problem(), |problem| {
        let [moved, steps, skipped] = counts.get();
        match problem.run().map_err(TestCaseError::fail)? {
            Some(new) => counts.set([moved + new[0], steps + new[1], skipped]),
            None => counts.set([moved, steps, skipped + 1]),
        }
        Ok(())
    });
    if let Err(failure) = outcome {
        panic!("{failure}");
    }
    // Who never moves is safe but useless.
    let [moved, steps, skipped] = counts.get();
    assert!(10 * moved >= 8 * steps && steps >= 10 * CASES && 10 * skipped < CASES, "{:?}", counts.get());
}
