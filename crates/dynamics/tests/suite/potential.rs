//! The potential of contacts by itself, against finite differences and Coulomb's law.

use bowknot_dynamics::geometry::{HalfSpace, PairKind, separation};
use bowknot_dynamics::{ContactLaw, ContactPotential, RepulsionSpring, SpringKind, StepError};
use bowknot_geometry::{Point, Vector};
use fastrand::Rng;
use nalgebra::{DMatrix, Matrix3};

const LAW: ContactLaw = ContactLaw { stiffness: 50.0, reach: 0.3, floor: 0.01, friction: 0.4 };
const KINDS: [PairKind; 5] = PairKind::ALL;

fn vector(random: &mut Rng, size: f64) -> Vector {
    Vector::from([0; 3].map(|_| size * (2.0 * random.f64() - 1.0)))
}

/// Four vertices of a pair at about half of the reach.
fn pair(random: &mut Rng, kind: PairKind) -> Vec<Point> {
    let height = 0.05 + 0.2 * random.f64();
    let above = [0.1, 0.1, height];
    let plain = match kind {
        PairKind::VertexVertex => [above, [0.1, 0.1, 0.0], [9.0; 3], [9.0; 3]],
        PairKind::VertexEdge => [above, [-1.0, 0.1, 0.0], [2.0, 0.1, 0.0], [9.0; 3]],
        PairKind::EdgeEdge => [[-1.0, 0.0, height], [1.0, 0.1, height], [0.0, -1.0, 0.0], [0.1, 1.0, 0.0]],
        PairKind::VertexTriangle | PairKind::VertexHalfSpace => {
            [above, [-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]]
        }
    };
    let jitter = |p| Point::from(p) + vector(random, 0.02);
    plain.map(jitter).to_vec()
}

/// The spring of the pair at `x`, with friction at the start.
fn spring(kind: PairKind, x: &[Point], start: &[Point], ratio: Vector) -> RepulsionSpring {
    let ground = HalfSpace { normal: Vector::z(), offset: -0.02 };
    let separation = match kind {
        PairKind::VertexHalfSpace => separation::separate_half_space(&x[0], &ground),
        _ => separation::separate(kind, &[x[0], x[1], x[2], x[3]]),
    };
    let spring = RepulsionSpring::of_pair(kind, [0, 1, 2, 3], &separation, &LAW, x, start);
    RepulsionSpring { friction_ratio: ratio, ..spring }
}

/// Each coordinate moved by `h` in both directions.
fn differences(x: &[Point], h: f64, mut f: impl FnMut(&[Point]) -> Vec<f64>) -> Vec<Vec<f64>> {
    let mut moved = x.to_vec();
    let mut columns = Vec::new();
    for v in 0..x.len() {
        for k in 0..3 {
            moved[v][k] = x[v][k] + h;
            let high = f(&moved);
            moved[v][k] = x[v][k] - h;
            let low = f(&moved);
            moved[v][k] = x[v][k];
            columns.push(high.iter().zip(low).map(|(high, low)| (high - low) / (2.0 * h)).collect());
        }
    }
    columns
}

fn flat(vectors: &[Vector]) -> Vec<f64> {
    vectors.iter().flat_map(|v| [v.x, v.y, v.z]).collect()
}

fn dense(blocks: &[(u32, u32, Matrix3<f64>)], vertices: usize) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(3 * vertices, 3 * vertices);
    for (row, column, block) in blocks {
        let mut place = matrix.fixed_view_mut::<3, 3>(3 * *row as usize, 3 * *column as usize);
        place += block;
    }
    matrix
}

#[test]
fn gradient_and_hessian_are_derivatives_where_contacts_stick_and_slide() {
    let mut random = Rng::with_seed(1);
    let mut seen = [0; 2];
    for i in 0..400 {
        let kind = KINDS[i % 5];
        let x = pair(&mut random, kind);
        let way = [1e-3, 0.2][i % 2];
        let start: Vec<Point> = x.iter().map(|p| p + vector(&mut random, way)).collect();
        let ratio = vector(&mut random, 0.1);
        let potential = ContactPotential::new(&[spring(kind, &x, &start, ratio)], &x, &start).expect("valid");
        // Not only at the state that it was made for.
        let at: Vec<Point> = x.iter().map(|p| p + vector(&mut random, 0.01)).collect();
        let forces = potential.forces(&at)[0];
        let bound = LAW.friction * potential.forces(&x)[0].normal;
        let share = forces.friction.norm() / bound;
        assert!(share <= 1.0 + 1e-12, "{kind:?} {share}");
        if (0.99..1.0 - 1e-9).contains(&share) {
            // Too near to the kink.
            continue;
        }
        seen[usize::from(share > 0.999)] += 1;

        let gradient = flat(&potential.gradient(&at));
        let scale = forces.normal + bound;
        for (exact, of) in gradient.iter().zip(differences(&at, 1e-6, |x| vec![potential.energy(x)])) {
            assert!((exact - of[0]).abs() < 1e-6 * scale, "{kind:?} {share} {exact} {}", of[0]);
        }
        let hessian = dense(&potential.hessian(&at), 4);
        for (column, of) in differences(&at, 1e-6, |x| flat(&potential.gradient(x))).iter().enumerate() {
            for (row, of) in of.iter().enumerate() {
                let error = (hessian[(row, column)] - of).abs();
                assert!(error < 1e-5 * hessian.amax(), "{kind:?} {share} {row} {column} {error}");
            }
        }
        let lowest = hessian.clone().symmetric_eigenvalues().min();
        assert!(lowest > -1e-12 * hessian.amax(), "{kind:?} {lowest}");
        // What acts on one side acts on the other, but for half-spaces.
        let sum: Vector = potential.gradient(&at).iter().sum();
        assert!(kind == PairKind::VertexHalfSpace || sum.norm() < 1e-12 * scale, "{kind:?} {sum}");
    }
    assert!(seen.iter().all(|&count| count > 100), "{seen:?}");
}

#[test]
fn the_gradient_is_that_of_the_distances_where_the_potential_was_made() {
    let mut random = Rng::with_seed(2);
    for i in 0..200 {
        let kind = KINDS[i % 5];
        let x = pair(&mut random, kind);
        let at = |x: &[Point]| {
            let still = spring(kind, x, x, Vector::zeros());
            ContactPotential::new(&[RepulsionSpring { friction: 0.0, ..still }], x, x).expect("valid")
        };
        let gradient = flat(&at(&x).gradient(&x));
        for (exact, of) in gradient.iter().zip(differences(&x, 1e-6, |x| vec![at(x).energy(x)])) {
            let scale = at(&x).forces(&x)[0].normal;
            assert!((exact - of[0]).abs() < 1e-6 * scale, "{kind:?} {exact} {}", of[0]);
        }
    }
}

#[test]
fn energy_and_force_fall_with_the_gap_to_zero_at_the_reach() {
    let x = |gap: f64| [[0.2, 0.2, gap], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::from);
    let mut before = (f64::INFINITY, f64::INFINITY);
    for k in 1..400 {
        let x = x(1e-3 * f64::from(k));
        let spring = spring(PairKind::VertexTriangle, &x, &x, Vector::zeros());
        let potential = ContactPotential::new(&[spring], &x, &x).expect("valid");
        let (energy, force) = (potential.energy(&x), potential.forces(&x)[0].normal);
        if spring.start_gap < LAW.reach {
            assert!(energy > 0.0 && energy < before.0 && force > 0.0 && force < before.1, "{k}");
            // The law, above its bend.
            let room = LAW.reach - LAW.floor;
            let share = (spring.start_gap - LAW.floor) / room;
            let law = LAW.stiffness * room * (1.0 - share) / (share * share);
            assert!(share < 0.02 || (force - law).abs() < 1e-9 * law, "{k} {force} {law}");
        } else {
            assert_eq!((energy, force), (0.0, 0.0));
        }
        before = (energy, force);
    }
}

#[test]
fn friction_opposes_slip_up_to_coulombs_bound() {
    let start = [[0.2, 0.2, 0.1], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::from);
    for (slip, sticks) in [(0.0, true), (1e-4, true), (0.3, false)] {
        let mut x = start;
        x[0].y += slip;
        let spring = spring(PairKind::VertexTriangle, &x, &start, Vector::zeros());
        let forces = ContactPotential::new(&[spring], &x, &start).expect("valid").forces(&x)[0];
        let bound = LAW.friction * forces.normal;
        assert!((forces.friction.norm() - bound).abs() < 1e-12 || sticks && forces.friction.norm() < bound);
        assert!(forces.friction.y <= 0.0 && (forces.friction.y < 0.0) == (slip > 0.0), "{forces:?}");
        assert!(forces.friction.xz().norm() < 1e-12, "{forces:?}");
    }
    // What stuck at the start with half of the bound sticks on without slip.
    let half = RepulsionSpring {
        friction_ratio: Vector::x() * 0.2,
        ..spring(PairKind::VertexTriangle, &start, &start, Vector::zeros())
    };
    let forces = ContactPotential::new(&[half], &start, &start).expect("valid").forces(&start)[0];
    assert!((forces.friction - Vector::x() * (0.2 * forces.normal)).norm() < 1e-12, "{forces:?}");
}

#[test]
fn springs_that_cannot_be_are_refused_by_number() {
    let x = pair(&mut Rng::with_seed(3), PairKind::EdgeEdge);
    let good = spring(PairKind::EdgeEdge, &x, &x, Vector::zeros());
    assert!(ContactPotential::new(&[], &x, &x).expect("no contacts").gradient(&x) == [Vector::zeros(); 4]);
    let bad = [
        RepulsionSpring { vertices: [0, 1, 2, 4], ..good },
        RepulsionSpring { stiffness: -1.0, ..good },
        RepulsionSpring { floor: good.reach, ..good },
        RepulsionSpring { kind: SpringKind::Limit, ..good },
        RepulsionSpring { normal: Vector::repeat(f64::NAN), ..good },
    ];
    for bad in bad {
        let found = ContactPotential::new(&[good, bad], &x, &x);
        assert!(matches!(found, Err(StepError::Repulsion { spring: 1, .. })), "{bad:?}");
    }
}

#[test]
fn a_repulsion_has_the_energy_of_a_spring_at_any_depth() {
    let mut random = Rng::with_seed(7);
    for kind in KINDS {
        let x = pair(&mut random, kind);
        let contact = RepulsionSpring { friction: 0.0, ..spring(kind, &x, &x, Vector::zeros()) };
        let repulsion = RepulsionSpring { kind: SpringKind::Repulsion, ..contact };
        let potential = ContactPotential::new(&[repulsion], &x, &x).expect("a potential");
        let gap = |x: &[Point]| {
            let height = |k: usize| contact.weights[k] * contact.normal.dot(&x[k].coords);
            (0..4).filter(|&k| contact.weights[k] != 0.0).map(height).sum::<f64>() - contact.offset
        };
        // From the reach to far below the floor.
        for depth in [0.0, 0.1, 0.3, 1.0] {
            let mut moved = x.clone();
            moved[0] -= contact.normal * (depth / contact.weights[0]);
            let missing = (LAW.reach - gap(&moved)).max(0.0);
            let (force, energy) = (potential.forces(&moved)[0].normal, potential.energy(&moved));
            assert!((force - LAW.stiffness * missing).abs() < 1e-9, "{kind:?} {depth}: {force}");
            assert!(
                (energy - 0.5 * LAW.stiffness * missing * missing).abs() < 1e-9,
                "{kind:?} {depth}: {energy}"
            );
        }
    }
}
