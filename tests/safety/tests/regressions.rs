//! Smallest cases of faults that searches have found, by their symptoms.

use bowknot_safety::check;
use bowknot_safety::scenario::{
    Drive, Masses, Motion, Piece, Pins, Role, Scenario, Seat, Setup, Shape, Start, Turn,
};
use bowknot_safety::targets::Rule;

fn piece(shape: Shape, turn: u32, seat: Seat, gap: f64) -> Piece {
    Piece { shape, role: Role::Deformable, size: 1.0, flipped: false, turn: Turn::Any(turn), seat, gap }
}

/// One call without pins, for equal masses.
fn problem(pieces: Vec<Piece>, calls: Vec<Motion>, setup: Setup) -> Scenario {
    Scenario {
        start: Start::Pieces { pieces, ground: None, scale: 1.0, offset: [0.0; 3] },
        masses: Masses { decades: 0.0, seed: 0 },
        pins: Pins { every: 0, groups: 0 },
        rest: 1.0,
        calls,
        setup,
    }
}

fn scattered() -> Motion {
    Motion { rule: Rule::Scattered, magnitude: 1.0, drive: Drive::Still, way: 1.0, time_step: None, seed: 0 }
}

/// The judge took a vertex 2e-13 m above a sliver for a hit. The step was safe.
#[test]
fn a_vertex_just_above_a_sliver_is_not_taken_for_a_hit() {
    let folded = Shape::Sheet { cells: [2, 1], layers: 3, gap: 1.0963670256852885e-7 };
    let pieces = vec![
        piece(folded, 52280, Seat::Above, 1.0),
        piece(Shape::Block { height: 1.0 }, 151_903, Seat::Triangle(13), 2.9605160276888466e-13),
    ];
    let checked = check(&problem(pieces, vec![scattered()], Setup { steps: 1, ..Setup::default() }));
    assert!(checked.as_ref().is_ok_and(|tally| tally.steps == 1), "{checked:?}");
}

/// The judge took two edges that cross at an angle of 5e-6, 4e-13 m apart, for a hit. The step was safe.
#[test]
fn nearly_parallel_edges_that_do_not_touch_are_not_taken_for_a_hit() {
    let sheet = Shape::Sheet { cells: [2, 2], layers: 2, gap: 9.228779644329812e-7 };
    let strand = Shape::Strands { count: 1, vertices: 2, spacing: 1.0 };
    let other = Shape::Sheet { cells: [1, 1], layers: 1, gap: 0.31622776601683794 };
    let pieces = vec![
        Piece { size: 4.516089197763698, ..piece(sheet, 402_364, Seat::Above, 1.0) },
        Piece { turn: Turn::None, ..piece(strand, 0, Seat::Edge(7), 9.714949411321357e-15) },
        Piece { turn: Turn::None, ..piece(other, 0, Seat::Above, 1.0) },
    ];
    let call = Motion { rule: Rule::Together, seed: 220_730, ..scattered() };
    let setup = Setup { floor: Some(0.0), delta: Some(0.001), steps: 8, ..Setup::default() };
    let checked = check(&problem(pieces, vec![call], setup));
    assert!(checked.as_ref().is_ok_and(|tally| tally.steps == 8), "{checked:?}");
}

/// An obstacle stopped between two swept searches. The tree of those that move was built anew without it and
/// kept its boxes, so that the search panicked.
#[test]
fn an_obstacle_that_stops_between_swept_steps_leaves_no_boxes_behind() {
    let shape =
        |shape: Shape, role: Role| Piece { role, turn: Turn::None, ..piece(shape, 0, Seat::Above, 1.0) };
    let pieces = vec![
        shape(Shape::Hinge { slope: -0.1173903635367452 }, Role::Obstacle),
        Piece {
            size: 2.557355163566862,
            flipped: true,
            seat: Seat::Vertex(11),
            gap: 0.0019547435318732114,
            ..shape(Shape::Spike { sides: 5, radius: 0.1551294893880613 }, Role::Deformable)
        },
        Piece {
            gap: 0.05476138188364474,
            ..shape(Shape::Slivers { columns: 1, width: 3.03252632640527e-5 }, Role::Obstacle)
        },
        Piece {
            turn: Turn::Quarter,
            gap: 1.3637948177344007e-11,
            ..shape(Shape::Strands { count: 2, vertices: 2, spacing: 0.005138127476513455 }, Role::Deformable)
        },
    ];
    let call = Motion { rule: Rule::Scattered, drive: Drive::Through, seed: 167_751, ..scattered() };
    let setup = Setup { floor: Some(0.0), delta: Some(0.001), steps: 11, ..Setup::default() };
    let mut problem = problem(pieces, vec![call], setup);
    problem.pins = Pins { every: 1, groups: 3 };
    if let Start::Pieces { offset, .. } = &mut problem.start {
        *offset = [1.0, -1.0, -97548.91972308858];
    }
    let checked = check(&problem);
    assert!(checked.as_ref().is_ok_and(|tally| tally.moved == 1), "{checked:?}");
}

/// The judge took an edge that slides off the side of a much longer one, 4e-12 m from it, for a hit. The step
/// was safe.
#[test]
fn an_edge_that_slides_off_a_long_one_is_not_taken_for_a_hit() {
    let strand = Shape::Strands { count: 1, vertices: 3, spacing: 1.0 };
    let slivers = Shape::Slivers { columns: 2, width: 1.2830382688149725e-6 };
    let sheet = Shape::Sheet { cells: [1, 2], layers: 2, gap: 0.31622776601683794 };
    let pieces = vec![
        Piece { role: Role::Obstacle, ..piece(strand, 521_180, Seat::Above, 1e-9) },
        Piece { turn: Turn::None, ..piece(slivers, 0, Seat::Edge(32), 5.147079482680101e-14) },
        piece(sheet, 693_156, Seat::Aside, 1.0),
    ];
    let call = Motion { rule: Rule::Collapsed, magnitude: 0.001, time_step: Some(0.01), ..scattered() };
    let checked = check(&problem(pieces, vec![call], Setup { steps: 1, ..Setup::default() }));
    assert!(checked.as_ref().is_ok_and(|tally| tally.steps == 1), "{checked:?}");
}
