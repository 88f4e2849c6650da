//! A vertex moves toward a triangle and along it, step by step: it comes near, and never through.
//!
//! By planes only what closes the gap is limited, so that a target on the vertex's own side is reached at once;
//! by distances, the paper's bound, every step is at most half of the gap, whatever its direction. Either way a
//! target on the other side is approached until the gap floor, and no further: a step shortens the
//! whole displacement, and it is for others to find a target that does not lead through.
//!
//! `cargo run --release -p bowknot-stepper --example approach`
#![allow(clippy::print_stdout)]

use bowknot_geometry::{PairKind, Point, Separation, Vector, separation};
use bowknot_proximity::{Pair, PairList};
use bowknot_stepper::{Bound, Contacts, StepReport, Stepper};

/// The gap that no step goes below [m].
const FLOOR: f64 = 1e-4;
/// Share of a gap that one step may use.
const DAMPING: f64 = 0.9;
/// Steps at most.
const STEPS: usize = 12;

fn main() {
    // Half a metre below the plane, and a tenth above it; both two metres along it.
    for (place, way) in
        [("through", Vector::new(1.6, 1.2, -1.0)), ("on the same side", Vector::new(1.6, 1.2, -0.4))]
    {
        for bound in [Bound::Planes, Bound::Isotropic] {
            println!("target {place}, bound {bound:?}");
            approach(bound, way);
        }
    }
}

fn approach(bound: Bound, way: Vector) {
    println!("  step   gap [m]    moved [m]  remaining [m]  clock r");
    let mut x = [[0.1, 0.1, 0.5], [0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]].map(Point::from);
    let target = [x[0] + way, x[1], x[2], x[3]];
    let pair = Pair { elements: [0, 0], vertices: [0, 1, 2, 3] };
    let pairs = PairList::from_kinds([vec![], vec![], vec![pair], vec![], vec![]]);

    let mut stepper = Stepper::default();
    stepper.begin(x.len());
    for step in 0..STEPS {
        let separations = [separation::separate(PairKind::VertexTriangle, &x)];
        let report = forward_step(&mut stepper, bound, &pairs, &separations, &mut x, &target);
        let StepReport { remaining_r, remaining, largest_move, .. } = report;
        let gap = separations[0].width;
        println!("  {step:4}  {gap:.6}  {largest_move:11.3e}  {remaining:13.6}  {remaining_r:7.5}");
        assert!(x[0].z >= FLOOR, "the floor holds");
        if remaining == 0.0 {
            println!("  there");
            break;
        }
    }
}

/// One step from `x` toward `target`, limited by the listed pairs alone: here there are no others.
fn forward_step(
    stepper: &mut Stepper,
    bound: Bound,
    pairs: &PairList,
    separations: &[Separation],
    x: &mut [Point],
    target: &[Point],
) -> StepReport {
    let contacts = Contacts { pairs, separations, floors: &[FLOOR] };
    stepper.aim(x, target);
    match bound {
        Bound::Planes => stepper.limit_by_planes(&contacts, DAMPING),
        Bound::Isotropic => stepper.limit_by_distances(&contacts, DAMPING),
    };
    stepper.advance(x)
}
