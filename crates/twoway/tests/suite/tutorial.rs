//! The tutorial `docs/tutorials/own-solver.md` and its program.

#[path = "../../examples/xpbd.rs"]
mod xpbd;

/// Code in the tutorial is that of the program.
#[test]
fn the_tutorial_shows_the_program() {
    let tutorial = include_str!("../../../../docs/tutorials/own-solver.md");
    let program = include_str!("../../examples/xpbd.rs");
    let blocks: Vec<&str> =
        tutorial.split("```rust\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert_eq!(blocks.len(), 6);
    for block in blocks {
        assert!(program.contains(block), "{block}");
    }
}

#[test]
fn the_program_of_the_tutorial_runs_as_its_command_does() {
    xpbd::main().unwrap();
}

/// A sheet of 12 x 12 cells: pins hold, then it drapes over the obstacle, and friction keeps it there.
#[test]
fn the_program_of_the_tutorial_drapes_the_sheet() {
    let (pinned, steps, gap) = xpbd::simulate(12, 0.5, 40).unwrap();
    let corner = &pinned.x[0];
    assert!((corner.x, corner.y, corner.z) == (-0.49, -0.48, 0.75), "{corner}");
    assert!(gap > 0.0 && steps < 2 * 400, "{steps} steps, gap {gap}");
    let (cloth, _, gap) = xpbd::simulate(12, 0.5, 120).unwrap();
    let top = cloth.x.iter().map(|p| p.z).fold(0.0, f64::max);
    // The obstacle's top has risen to 0.8 m.
    assert!(gap > 0.0 && (0.8..0.9).contains(&top), "{top}");
    assert!(cloth.x.iter().all(|p| p.z > 0.0), "nothing is below the ground");
    assert!(cloth.x.iter().any(|p| p.z < 0.6), "the released corners hang");
}
