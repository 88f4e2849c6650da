//! A vertex moves toward a triangle and along it, step by step. It comes near and never passes through.
//!
//! Planes limit only the motion that closes the gap, so a target on the vertex's own side is reached at once.
//! Distances, the paper's bound, limit every step to half of the gap, whatever its direction. With either
//! bound a target on the other side is approached until the minimum separation and no further: a step
//! shortens the whole displacement; a target that does not lead through has to be found by the backward step.
//!
//! These are loose calls: the list has all pairs because there is only one. With a real search they need
//! trust regions, see `Forward` and the example `drape`.
//!
//! `cargo run --release -p bowknot-stepper --example approach`
#![allow(clippy::print_stdout)]

use bowknot_geometry::{PairKind, Point, Separation, Vector, separation};
use bowknot_proximity::{Pair, PairList};
use bowknot_stepper::{Bound, Contacts, StepReport, Stepper};

/// No step makes the gap smaller [m].
const MIN_SEPARATION: f64 = 1e-4;
/// Share of a gap that one step may use.
const DAMPING: f64 = 0.9;
/// Largest number of steps.
const MAX_STEPS: usize = 12;

fn main() {
    // One target is half a meter below the plane, the other a tenth above it; both are two meters along it.
    for (place, displacement) in
        [("through", Vector::new(1.6, 1.2, -1.0)), ("on the same side", Vector::new(1.6, 1.2, -0.4))]
    {
        for bound in [Bound::Planes, Bound::Isotropic] {
            println!("target {place}, bound {bound:?}");
            approach(bound, displacement);
        }
    }
}

fn approach(bound: Bound, displacement: Vector) {
    println!("  step   gap [m]    moved [m]  remaining [m]  fraction r");
    let mut x = [[0.1, 0.1, 0.5], [0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]].map(Point::from);
    let target = [x[0] + displacement, x[1], x[2], x[3]];
    let pair = Pair { elements: [0, 0], vertices: [0, 1, 2, 3] };
    let pairs = PairList::from_kinds([vec![], vec![], vec![pair], vec![], vec![]]);

    let mut stepper = Stepper::default();
    stepper.begin(x.len());
    for step in 0..MAX_STEPS {
        let separations = [separation::separate(PairKind::VertexTriangle, &x)];
        let report = forward_step(&mut stepper, bound, &pairs, &separations, &mut x, &target);
        let StepReport { remaining_fraction, remaining, largest_move, .. } = report;
        let gap = separations[0].width;
        println!("  {step:4}  {gap:.6}  {largest_move:11.3e}  {remaining:13.6}  {remaining_fraction:7.5}");
        assert!(x[0].z >= MIN_SEPARATION, "the minimum separation holds");
        if remaining == 0.0 {
            println!("  arrived");
            break;
        }
    }
}

/// One step from `x` toward `target`. Only candidate pairs limit it: here there are no others.
fn forward_step(
    stepper: &mut Stepper,
    bound: Bound,
    pairs: &PairList,
    separations: &[Separation],
    x: &mut [Point],
    target: &[Point],
) -> StepReport {
    let contacts = Contacts { pairs, separations, min_separations: &[MIN_SEPARATION] };
    stepper.set_target(x, target);
    match bound {
        Bound::Planes => stepper.limit_by_planes(&contacts, DAMPING),
        Bound::Isotropic => stepper.limit_by_distances(&contacts, DAMPING),
    };
    stepper.advance(x)
}
